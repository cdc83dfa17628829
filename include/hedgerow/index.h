/// An index: a structure built over primitives. Its queries are in ask.h.
#pragma once

#include <concepts>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include <hedgerow/engine/crossing_kernels.h>
#include <hedgerow/engine/point_kernels.h>
#include <hedgerow/engine/ray_kernels.h>
#include <hedgerow/parallel/ieee_executor.h>
#include <hedgerow/structures/references.h>
#include <hedgerow/walks/engine.h>
#include <hedgerow/walks/structure.h>

namespace hedgerow {

/// A structure that can be fitted to primitives that moved.
template <class S, class P>
concept Refittable = requires(S& s, const ReferenceList<typename P::Scalar, P::dimension>& references,
                              Executor& executor) {
    s.refit(references, executor);
    { s.drift() } -> std::convertible_to<double>;
};

/// How far a structure that was fitted to moved primitives has drifted from one that is built over them: the
/// SAH cost of a query, as a multiple of the cost when it was built.
struct Drift {
    double cost = 1;

    operator double() const { return cost; }  // NOLINT(google-explicit-constructor): it is that number
    /// The rule: build again once a query costs two fifths more than when the structure was built. Sooner
    /// pays where many queries are asked between two refits, later where few are: what is lost is (cost − 1)
    /// of the time of these queries.
    bool build_again() const { return cost > 1.4; }
};

namespace detail {
/// Moves a value out, and leaves T() behind if T has a default constructor and can be assigned to: an empty
/// structure or view.
template <class T>
T taken(T& from) noexcept {
    if constexpr (std::default_initializable<T> && std::is_move_assignable_v<T>)
        return std::exchange(from, T());
    else
        return std::move(from);
}
}  // namespace detail

/// A structure S over the primitives that the view P looks at. Const use is thread-safe, and queries allocate
/// nothing (those that return lists fill the caller's vector). Movable: an index that was moved from is
/// empty, and may be queried, changed or assigned to. Once an index is built, its primitives may change only
/// through `insert` and `erase`, or with a `refit` afterwards, if the structure has these functions.
template <class S, class P>
requires Structure<S, P>
class Index {
    friend struct detail::IndexParts;

public:
    using Scalar = typename P::Scalar;
    static constexpr int dimension = P::dimension;
    using Structure = S;
    using Primitives = P;
    using BoxType = Box<Scalar, dimension>;
    /// An index over nothing: no query finds anything. A view type of your own needs a default constructor
    /// for this, which makes an empty view.
    Index() requires std::default_initializable<S> && std::default_initializable<P>
        : primitives_(), structure_(), leaves_() {}
    Index(const Index&) = default;
    Index(Index&& other) noexcept
        : owner_(std::move(other.owner_)),
          primitives_(detail::taken(other.primitives_)),
          structure_(detail::taken(other.structure_)),
          leaves_(detail::taken(other.leaves_)) {}
    Index& operator=(const Index&) = default;
    Index& operator=(Index&& other) noexcept {
        if (this == &other) return *this;
        primitives_ = detail::taken(other.primitives_);
        structure_ = detail::taken(other.structure_);
        leaves_ = detail::taken(other.leaves_);
        owner_ = std::move(other.owner_);
        return *this;
    }
    ~Index() = default;

    /// Borrows the arrays that `primitives` looks at; `owner`, if any, keeps those arrays alive.
    Index(P primitives, const typename S::Options& options, Executor& executor,
          std::shared_ptr<const void> owner = {})
        : owner_(std::move(owner)),
          primitives_(std::move(primitives)),
          structure_(in_ieee_mode([&] {
              IeeeExecutor threads(executor);
              return S::build(primitives_, options, threads);
          })),
          leaves_(pack(primitives_, structure_, executor)) {}

    const S& structure() const { return structure_; }
    const P& primitives() const { return primitives_; }
    const BoxType& bounds() const { return structure_.bounds(); }
    /// The copy of the primitives, packed by the structure or the set, that rays are tested against; an empty
    /// struct if neither packs.
    const auto& packed() const { return leaves_; }
    /// The number of primitives in the set, including those that the structure does not hold.
    std::size_t size() const { return primitives_.size(); }
    /// Bytes of memory beyond the primitives themselves.
    std::size_t bytes() const {
        if constexpr (packs)
            return structure_.bytes() + leaves_.bytes();
        else
            return structure_.bytes();
    }
    /// Whether the structure holds each primitive once.
    bool exclusive() const { return structure_.exclusive(); }
    std::string validate() const { return structure_.validate(primitives_); }

    /// Inserts primitive `id` of the caller's set as it is now. The set's arrays may have grown and moved.
    /// Primitives that the index already holds must be unchanged; all others may be anything, and are not
    /// read. Returns false, and changes nothing, if `id` is held already. Throws InputError, and changes
    /// nothing, if the set has no such primitive or the primitive is bad. Must not run while other threads
    /// query the index.
    ///
    ///   cloud.points.push_back(p);
    ///   index.insert(cloud, id_of_p);           // a new primitive
    ///   index.erase(cloud, 3);                  // a primitive that moves: erase, change, insert
    ///   cloud.points[3] = q;
    ///   index.insert(cloud, 3);
    template <class Set>
    bool insert(const Set& set, PrimitiveId id) requires ChangesOneByOne<S, P> {
        return change(set, id, [&](const P& now) { return structure_.insert(now, id); });
    }
    /// Erases primitive `id`, which must still be as it was inserted. Returns false, and changes nothing, if
    /// `id` is not held.
    template <class Set>
    bool erase(const Set& set, PrimitiveId id) requires ChangesOneByOne<S, P> {
        return change(set, id, [&](const P& now) { return structure_.erase(now, id); });
    }
    /// Fits the structure to borrowed primitives that moved within the same arrays. O(n). Returns how far the
    /// structure's quality has drifted, and whether to build it again:
    ///
    ///   if (index.refit().build_again()) index = build(mesh);
    ///
    /// No query may run meanwhile. Throws InputError as `build` does; the index is then unchanged, and valid
    /// for the primitives before they moved. Exceptions of the executor reach the caller too: from half way
    /// on, only after the refit is finished.
    Drift refit(Threads threads = {}) requires(Refittable<S, P>) { return refit(primitives_, threads); }
    /// Fits the structure to moved primitives in other arrays, which the index then borrows. They must be as
    /// many as before, each under its old id; throws InputError for another number.
    Drift refit(const P& moved, Threads workers = {}) requires(Refittable<S, P>) {
        Executor& executor = workers.over(moved.size());
        if (moved.size() != size())
            throw InputError("a refit is for as many primitives as the index was built over: " +
                             std::to_string(size()) + ", not " + std::to_string(moved.size()));
        return in_ieee_mode([&] {
            IeeeExecutor threads(executor);
            // First do all that may throw. Nothing of the index changes until then.
            constexpr bool by_leaves = requires(S & s, Packed & packed) {
                s.refit(packed, threads);
            };
            const auto references = [&] {
                if constexpr (by_leaves)
                    return refuse_unsound(moved, threads), Nothing{};
                else
                    return references_of(moved, threads);
            }();
            auto leaves = pack(moved, structure_, threads);
            const auto take = [&](Executor& by) {
                if constexpr (by_leaves)
                    structure_.refit(leaves, by);
                else
                    structure_.refit(references, by);
                leaves_ = std::move(leaves);
                primitives_ = moved;
            };
            // The last place where the executor may stop the refit and leave the index unchanged.
            threads.look();
            try {
                take(threads);
            } catch (...) {
                // The refit is half done: finish it in this thread before the exception leaves.
                take(serial_executor());
                throw;
            }
            return Drift{static_cast<double>(structure_.drift())};
        });
    }

    /// Tests the primitives of one of the structure's leaves, as a walk does.
    template <class Probe, class Query>
    Flow test_leaf(const Probe& probe, const Leaf& leaf, Query& query) const {
        return leaves().test_leaf(probe, leaf, query);
    }
    /// Runs any query of yours by a walk. `count` is a Visits, or NoVisits.
    template <Query Q, class Count>
    void ask(Q& query, Count& count) const {
        in_ieee_mode([&] { walk(query, count); });
    }
    template <Query Q>
    void ask(Q& query) const {
        NoVisits none;
        ask(query, none);
    }
    /// Runs a query over leaves of yours, such as this index's primitives as the world sees them
    /// (instances/placed.h). Nothing is counted.
    template <class Leaves, Query Q>
    void ask_over(const Leaves& leaves, Q& query) const {
        const NoVisits none;
        in_ieee_mode([&] { walk_through(structure_, leaves, query, none); });
    }
    /// The answer of Q(*this, arguments...): by an engine (walks/engine.h) if there is one and nothing is
    /// counted, else by a walk. The query is constructed in IEEE mode too, since its probe computes.
    template <AnsweringQuery Q, class Count, class... Arguments>
    auto answer(Count& count, Arguments&&... arguments) const {
        static_assert(AnswersProbe<S, typename Q::Probe>,
                      "this structure does not answer queries of this probe");
        return in_ieee_mode([&] {
            if constexpr (std::same_as<Count, const NoVisits> &&
                          AnswersOne<EngineFor<Q, Index>, std::remove_reference_t<Arguments>...>)
                if (const EngineFor<Q, Index> engine(*this); engine) return engine.answer(arguments...);
            Q query(*this, arguments...);
            walk(query, count);
            return query.answer();
        });
    }

private:
    struct Nothing {};

    /// Not inlined: in one function with the query's construction, the compiler splits the probe into more
    /// values than there are registers, and a node costs 10% more.
    template <Query Q, class Count>
    [[gnu::noinline]] void walk(Q& query, Count& count) const {
        walk_through(structure_, leaves(), query, count);
    }

    template <class Set, class F>
    bool change(const Set& set, PrimitiveId id, F f) {
        static_assert(std::same_as<ViewOf<Set>, P>, "the kind of primitives that the index was built over");
        primitives_ = view_of(set);
        if (!in_ieee_mode([&] { return f(primitives_); })) return false;
        if constexpr (requires { leaves_.change(primitives_, structure_, id); })
            leaves_.change(primitives_, structure_, id);
        else if constexpr (packs)
            detail::pack_changed<S::packed_order>(primitives_, structure_, id, leaves_);
        return true;
    }

    static constexpr bool packs_itself = requires(const S& s, const P& p) { s.pack(p, serial_executor()); };
    static constexpr bool packs = packs_itself || requires(const P& p) {
        p.template pack<S::packed_order>(std::span<const PrimitiveId>(), serial_executor());
    };

    static auto pack(const P& primitives, const S& structure, Executor& executor) {
        if constexpr (packs_itself) {
            return structure.pack(primitives, executor);
        } else if constexpr (packs) {
            return primitives.template pack<S::packed_order>(structure.items(), executor);
        } else {
            static_cast<void>(executor);
            return Nothing{};
        }
    }
    using Packed = std::conditional_t<
        packs, decltype(pack(std::declval<const P&>(), std::declval<const S&>(), serial_executor())),
        Nothing>;

    /// Tests leaves: in the packed copy if it has a test for the probe, else in the view.
    struct Tested {
        const Index& index;
        template <class Probe, class Query>
        Flow test_leaf(const Probe& probe, const Leaf& leaf, Query& query) const {
            if constexpr (packs && requires { index.leaves_.test_leaf(probe, leaf, query); })
                return index.leaves_.test_leaf(probe, leaf, query);
            else
                return hedgerow::test_leaf(index.primitives_, probe, leaf, query);
        }
        const Packed& packed() const { return index.leaves_; }
        void prefetch(const Leaf& leaf) const {
            if constexpr (packs && requires { index.leaves_.prefetch(leaf); }) index.leaves_.prefetch(leaf);
        }
    };
    Tested leaves() const { return {*this}; }

    /// An index of parts that belong together.
    Index(P primitives, S structure, Packed leaves, std::shared_ptr<const void> owner)
        : owner_(std::move(owner)),
          primitives_(std::move(primitives)),
          structure_(std::move(structure)),
          leaves_(std::move(leaves)) {}

    std::shared_ptr<const void> owner_;
    P primitives_;
    S structure_;
    Packed leaves_;
};

/// The type of `build<S>(primitives)` for primitives of type P, to be written where there is no `auto`:
///
///   IndexOf<KdTree, SphereSet<float, 3>> spheres;
template <template <class, int> class S, class P>
using IndexOf = Index<S<typename P::Scalar, P::dimension>, ViewOf<P>>;

/// Builds a structure over primitives: `build<KdTree>(mesh, {.leaf_size = 2})`. An lvalue or a view is
/// borrowed: its arrays must outlive the index. An rvalue of a set that owns its arrays is moved into the
/// index. Large sets are built on all cores unless an executor is given (Threads). Throws InputError for
/// vertices that are NaN, infinite or beyond `largest_coordinate` and for indices out of range.
template <template <class, int> class S, class P>
auto build(P&& primitives,
           const typename S<typename std::remove_cvref_t<P>::Scalar,
                            std::remove_cvref_t<P>::dimension>::Options& options = {},
           Threads threads = {}) {
    using Set = std::remove_cvref_t<P>;
    using Built = IndexOf<S, Set>;
    Executor& executor = threads.over(primitives.size());
    if constexpr (std::is_lvalue_reference_v<P> || std::is_same_v<ViewOf<Set>, Set>) {
        return Built(view_of(primitives), options, executor);
    } else {
        auto owner = std::make_shared<const Set>(std::forward<P>(primitives));
        auto view = view_of(*owner);
        return Built(std::move(view), options, executor, std::move(owner));
    }
}
/// Builds a structure with its default options, over an executor: `build<KdTree>(mesh, default_executor())`.
template <template <class, int> class S, class P>
auto build(P&& primitives, Executor& executor) {
    return build<S>(std::forward<P>(primitives), {}, executor);
}
/// Builds the default structure, WideBvh (the engine).
template <class P>
auto build(P&& primitives, Threads threads = {}) {
    return build<WideBvh>(std::forward<P>(primitives), {}, threads);
}

}  // namespace hedgerow
