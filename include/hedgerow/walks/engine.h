/// The door for engines: what answers questions of an index in another way than by a walk, with the same
/// bits. Indexes, batches and instances ask it; the wide BVH's kernels (engine/) come through it, AnyIndex
/// does, and an engine of your own may, without a line in this library.
///
/// An engine is a structure (walks/structure.h) with specialisations of EngineFor for the questions that it
/// answers. What it has prepared, such as a copy on a device, is part of the index: of the structure, or of
/// what the structure's `pack` returns. All other questions are answered by the structure's walk.
///
///   template <class Set, class P>
///   struct EngineFor<ClosestHit<Set, KeepAll>, Index<MyStructure<float, 3>, P>> {
///       explicit EngineFor(const Index<MyStructure<float, 3>, P>& index);
///       explicit operator bool() const;
///       KernelUse answer_batch(const RayArray<float, 3>& rays, Hit<float>* hits, const auto& how) const;
///   };
#pragma once

#include <cstddef>
#include <cstdint>

#include <hedgerow/parallel/executor.h>

namespace hedgerow {

/// What answers questions Q of indexes I, made for each call of a question. Empty where no engine specialises
/// it. Q is the type of the question's query (queries/) with its set and filter, or of a question of whole
/// sets its name (ask/pairs.h). So the type tells what an engine cannot take: it specialises EngineFor for
/// KeepAll, if filters cannot be called where it works, and for the sets that it knows. It is not asked where
/// visits are counted.
///
/// A specialisation is made of the index, or of both, and fulfils Engine and one of the concepts below it. It
/// is asked in IEEE mode. Its answers are, to the bit, those of the walk.
template <class Q, class... I>
struct EngineFor {};

/// `operator bool` says whether the engine is to be asked now, or the walk: whether this processor has the
/// instructions, or a device is there.
template <class E>
concept Engine = requires(const E& engine) {
    static_cast<bool>(engine);
};

/// Single probes: `answer(arguments...)` is what the query Q(index, arguments...) answers after its walk.
/// Some of the arguments are written to, as lists are.
template <class E, class... Arguments>
concept AnswersOne = Engine<E> && requires(const E& engine, Arguments&... arguments) {
    engine.answer(arguments...);
};

/// How a batch is asked: what an engine gets beside the queries.
template <class Options, class Filter, class... Place>
struct HowAsked {
    const Options& options;  ///< of the call; of points, factor, mask and what is left out are to be obeyed
    const Filter& filter;  ///< of the call; of rays it also refuses what is left out, and what the mask does
    Executor& executor;    ///< the threads of the call, which it keeps in IEEE mode
    /// Asks query i alone, and writes the answer to its place: for queries that the engine cannot take. The
    /// walk answers, or the engine's own `answer` if it has one, which then must not come back here. May be
    /// called by several threads.
    FunctionRef<void(std::size_t i, Place...)> rest;
};

/// Batches: `answer_batch(queries, answers, how)` writes the answer to each query to its place among the
/// answers, where `how` is a HowAsked. It gets all queries of a call at once. Of closest and any hits it
/// returns a KernelUse.
template <class E, class Queries, class Answers, class How>
concept AnswersBatch = Engine<E> &&
    requires(const E& engine, const Queries& queries, Answers answers, const How& how) {
    engine.answer_batch(queries, answers, how);
};

/// Lists for a batch: `answer_lists(queries, arguments..., lists, how)` replaces what `lists` hold
/// (queries/lists.h) by the list of each query. `how.rest(i, place)` appends a list to Lists; of k nearest it
/// writes a NearRow (queries/near_rows.h).
template <class E, class Queries, class L, class How, class... Arguments>
concept AnswersLists = Engine<E> && requires(const E& engine, const Queries& queries,
                                             const Arguments&... arguments, L& lists, const How& how) {
    engine.answer_lists(queries, arguments..., lists, how);
};

/// Whole sets: `answer_whole(arguments..., found, executor)` writes what the question finds in the order that
/// the question promises.
template <class E, class Found, class... Arguments>
concept AnswersWhole = Engine<E> &&
    requires(const E& engine, const Arguments&... arguments, Found& found, Executor& executor) {
    engine.answer_whole(arguments..., found, executor);
};

/// Instances: `offer_inside(probe, instance, geometry, query)` is asked where the index is an instance in a
/// world that the query asks. It offers the candidates that the probe, in the instance's space, finds there,
/// and returns the query's Flow.
template <class E, class Probe, class Q>
concept AnswersInside = Engine<E> && requires(const E& engine, const Probe& probe, Q& query) {
    engine.offer_inside(probe, std::uint32_t(), std::uint32_t(), query);
};

/// The data of an instance of an index I that engines read. Empty, unless an engine specialises it with a
/// type `Instance` and a function `of(index, back, mask, geometry)`.
template <class I>
struct InstanceForEngine {
    struct Instance {};
};

/// The number of rays of a batch that each algorithm answered. `single` rays were answered one by one, by an
/// engine or by a walk; all rays against instances are. `phased` rays were answered in phases over the batch,
/// the others in `packets` of rays that go the same way or, for any hits, through the same region.
struct KernelUse {
    std::size_t single = 0, phased = 0, packets = 0;

    KernelUse& operator+=(const KernelUse& more) {
        single += more.single, phased += more.phased, packets += more.packets;
        return *this;
    }
};

}  // namespace hedgerow
