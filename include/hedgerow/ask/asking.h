/// What the questions of all families share: their one grammar, and the steps of a batch.
///
/// Every function that asks reads question(index, asked, out, options, filter, visits). `asked` is all that
/// the question cannot be without. `out` is left out where the answer is returned. `options` is a plain
/// struct, and may be left out before a filter too. A filter refuses answers (queries/hit.h); visits count
/// what was looked at (walks/visits.h): one Visits for one query, a span of them, one for each, for a batch.
///
/// A batch answers each of many queries as the function of one query does. Large batches use all cores, or
/// the threads of their options. A filter may keep state, which threads would share, so a batch with a filter
/// stays in the calling thread unless the options give it threads. A batch throws InputError, and writes
/// nothing, where there are fewer places for answers than queries. Lists take the memory of all answers, and
/// twice as much while the call runs over several threads; those of the k nearest take k places for each
/// query while it runs, however few are found.
#pragma once

#include <optional>
#include <string>

#include <hedgerow/base/error.h>
#include <hedgerow/base/scratch.h>
#include <hedgerow/base/strided.h>
#include <hedgerow/index.h>
#include <hedgerow/parallel/ieee_executor.h>
#include <hedgerow/queries/lists.h>
#include <hedgerow/walks/engine.h>

namespace hedgerow {

inline constexpr NoVisits no_visits{};
inline constexpr KeepAll keep_all{};

namespace detail {
/// Throws InputError if there are fewer places for answers than queries.
inline void expect_room(const std::string& asked, std::size_t count, std::size_t answers) {
    if (answers < count)
        throw InputError("there are " + std::to_string(count) + " " + asked + ", but room for " +
                         std::to_string(answers) + " answers: make the array of answers as long as that of " +
                         asked);
}

/// The executor of a batch of `count` queries. A filter is called by other threads only if these are the
/// caller's choice.
template <class Filter>
Executor& executor_for(Threads threads, std::size_t count) {
    return std::same_as<Filter, KeepAll> || threads.chosen() ? threads.over(count) : serial_executor();
}
/// Answers by f(count), where the count is the visits of query i of a batch, or none.
template <class F>
auto with_visits(std::span<Visits> visits, std::size_t i, F f) {
    return visits.empty() ? f(no_visits) : f(visits[i]);
}
inline void expect_visits(std::span<Visits> visits, std::size_t queries) {
    if (!visits.empty()) expect_room("queries", queries, visits.size());
}
/// How a batch is asked. Visits are empty where nothing is counted, else one for each query.
template <class Options, class Filter = KeepAll>
struct AskedBatch {
    const Options& options;
    const Filter& filter;
    Executor& executor;
    std::span<Visits> visits;
};
template <class Options, class Filter>
AskedBatch(const Options&, const Filter&, Executor&, std::span<Visits>) -> AskedBatch<Options, Filter>;

/// Has the engine of question Q answer a batch, if nothing is counted and the index has one that takes such
/// batches and is in use. rest(i) answers query i without it. No value, and nothing is written, where there
/// is no such engine.
template <class Q, class I, class Queries, class Answer, class Options, class Filter, class Rest>
std::optional<KernelUse> answered_by_engine(const I& index, const Queries& queries, Answer* answers,
                                            const AskedBatch<Options, Filter>& batch, const Rest& rest) {
    using How = HowAsked<Options, Filter>;
    using E = EngineFor<Q, I>;
    if constexpr (AnswersBatch<E, Queries, Answer*, How>) {
        if (!batch.visits.empty()) return std::nullopt;
        if (const E engine(index); engine)
            return in_ieee_mode([&] {
                IeeeExecutor threads(batch.executor);
                const How how{batch.options, batch.filter, threads, rest};
                if constexpr (std::is_void_v<decltype(engine.answer_batch(queries, answers, how))>)
                    return engine.answer_batch(queries, answers, how), KernelUse{};
                else
                    return engine.answer_batch(queries, answers, how);
            });
    }
    return std::nullopt;
}
/// The same of a question of lists. rest(i, place) lists what query i finds.
template <class Q, class Place, class I, class Queries, class L, class Options, class Filter, class Rest,
          class... Arguments>
bool listed_by_engine(const I& index, const Queries& queries, L& lists,
                      const AskedBatch<Options, Filter>& batch, const Rest& rest,
                      const Arguments&... arguments) {
    using How = HowAsked<Options, Filter, Place>;
    using E = EngineFor<Q, I>;
    if constexpr (AnswersLists<E, Queries, L, How, Arguments...>) {
        if (!batch.visits.empty()) return false;
        if (const E engine(index); engine) {
            in_ieee_mode([&] {
                IeeeExecutor threads(batch.executor);
                engine.answer_lists(queries, arguments..., lists,
                                    How{batch.options, batch.filter, threads, rest});
            });
            return true;
        }
    }
    return false;
}
/// Answers each query of a batch: by the engine of question Q, or by one(i, count), which returns the answer.
template <class Q, class I, class Queries, class Answer, class Options, class Filter, class One>
KernelUse answer_batch(const I& index, const Queries& queries, Answer* answers,
                       const AskedBatch<Options, Filter>& batch, One one) {
    const auto rest = [&](std::size_t i) { answers[i] = one(i, no_visits); };
    if (const auto use = answered_by_engine<Q>(index, queries, answers, batch, rest)) return *use;
    batch.executor.for_each_piece(queries.size(), 256, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i)
            with_visits(batch.visits, i, [&](auto& count) { answers[i] = one(i, count); });
    });
    return {.single = queries.size()};
}
/// Fills lists: by the engine of question Q, or by append(i, to, count), which appends the list of query i.
template <class Q, class I, class Queries, class C, class Options, class Filter, class Append,
          class... Arguments>
void list_batch(const I& index, const Queries& queries, Lists<C>& lists,
                const AskedBatch<Options, Filter>& batch, Append append, const Arguments&... arguments) {
    list_in_own_memory(lists, [&](Lists<C>& own) {
        const auto rest = [&](std::size_t i, Lists<C>& to) { append(i, to, no_visits); };
        if (listed_by_engine<Q, Lists<C>&>(index, queries, own, batch, rest, arguments...)) return;
        list_in_pieces(queries.size(), batch.executor, own,
                       [&](std::size_t begin, std::size_t end, Lists<C>& to) {
                           for (std::size_t i = begin; i < end; ++i)
                               with_visits(batch.visits, i, [&](auto& count) { append(i, to, count); });
                       });
    });
}
/// Appends lists of one column: one(i, list, count) replaces what a vector holds by the list of query i.
template <class C, class T, class One>
auto appending(Buffer<T> C::*column, One one) {
    return [column, one](std::size_t i, Lists<C>& to, auto& count) {
        const Scratch<std::vector<T>> list;
        one(i, *list, count);
        (to.*column).append(*list);
        to.offsets.push_back((to.*column).size());
    };
}

/// The number of primitives that a query may answer.
template <class P>
std::size_t primitives_in(const P& set) {
    if constexpr (Instanced<P>) {
        std::size_t all = 0;
        for (std::size_t i = 0; i < set.size(); ++i) all += set[i].index().size();
        return all;
    } else {
        return set.size();
    }
}
/// Whether a walk offers each primitive once: not where a structure has it in several cells.
template <class I>
bool offers_each_once(const I& index) {
    return index.exclusive() && offers_once(index.primitives());
}
}  // namespace detail

}  // namespace hedgerow
