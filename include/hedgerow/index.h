/// A structure built over primitives. The questions it answers are in ask.h.
#pragma once

#include <concepts>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include <hedgerow/geometry/transform.h>
#include <hedgerow/parallel/ieee_executor.h>
#include <hedgerow/primitives/triangle_mesh.h>
#include <hedgerow/queries/filter.h>
#include <hedgerow/structures/bvh/bvh.h>
#include <hedgerow/structures/bvh/wide/kernels.h>
#include <hedgerow/structures/bvh/wide/wide_bvh.h>

namespace hedgerow {

/// A structure that can take up and let go of single primitives.
template <class S, class P>
concept ChangesOneByOne = requires(S& s, const P& set, PrimitiveId id) {
    { s.insert(set, id) } -> std::same_as<bool>;
    { s.erase(set, id) } -> std::same_as<bool>;
};

/// A structure that can be fitted to primitives that moved.
template <class S, class P>
concept Refittable = requires(S& s, const ReferenceList<typename P::Scalar, P::dimension>& references,
                              Executor& executor) {
    s.refit(references, executor);
    { s.drift() } -> std::convertible_to<double>;
};

namespace detail {
/// Takes a value, and leaves T() if there is one: of structures and views, an empty one.
template <class T>
T taken(T& from) noexcept {
    if constexpr (std::default_initializable<T> && std::is_move_assignable_v<T>)
        return std::exchange(from, T());
    else
        return std::move(from);
}
}  // namespace detail

/// A structure S over the primitives that the view P looks at. Const use is thread-safe, and queries allocate
/// nothing (those that return lists fill the caller's vector). Movable: an index that was moved from is empty
/// and may be asked, changed or assigned to. What it looks at is not to be changed once it is built, but
/// through `insert` and `erase`, or with a `refit` after, where the structure has them.
template <class S, PrimitiveSet P>
class Index {
    friend struct detail::IndexParts;

public:
    using Scalar = typename P::Scalar;
    static constexpr int dimension = P::dimension;
    using Structure = S;
    using Primitives = P;
    using BoxType = Box<Scalar, dimension>;
    /// Whether rays may be answered by the processor's vectors (structures/bvh/wide/kernels.h).
    static constexpr bool by_kernels =
        std::same_as<P, TriangleMeshView<float>> && requires(const S& s, const TriangleBlocks<float>& b) {
        WideScene{s.tree(), b.data(), {}};
    };

    /// The same for rays against instances of indexes that the kernels know, on both levels.
    static constexpr bool instances_by_kernels = requires(const S& s, const P& p) {
        WideInstances{s.tree(), p.for_kernels(), 0.0f};
    };
    struct Nothing {};
    using KernelInstance = std::conditional_t<by_kernels, WideInstance, Nothing>;

    /// Over nothing: no query finds anything. (A view of a type of your own needs a T() for it, and what that
    /// looks at is empty.)
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

    /// Borrows what `primitives` looks at; `owner`, if any, keeps it alive.
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
    /// Of the set, held or not.
    std::size_t size() const { return primitives_.size(); }
    /// Beyond the primitives themselves.
    std::size_t bytes() const {
        if constexpr (packs)
            return structure_.bytes() + leaves_.bytes();
        else
            return structure_.bytes();
    }
    std::string validate() const { return structure_.validate(primitives_); }

    /// Takes up primitive `id` of the caller's set as it is now: its arrays may have grown, and moved. What
    /// is held already must be as it was; what is not held may be anything and is asked nothing. False, and
    /// nothing is changed, if `id` is held already. Throws InputError, and changes nothing, if there is no
    /// such primitive or it is bad. Not to be called while others ask.
    ///
    ///   cloud.points.push_back(p);
    ///   index.insert(cloud, id_of_p);           // a new primitive
    ///   index.erase(cloud, 3);                  // one that moves: out, changed, in again
    ///   cloud.points[3] = q;
    ///   index.insert(cloud, 3);
    template <class Set>
    bool insert(const Set& set, PrimitiveId id) requires ChangesOneByOne<S, P> {
        return change(set, id, [&](const P& now) { return structure_.insert(now, id); });
    }
    /// Lets go of primitive `id`, which must still be as it was inserted. False, and nothing is changed, if
    /// it is not held.
    template <class Set>
    bool erase(const Set& set, PrimitiveId id) requires ChangesOneByOne<S, P> {
        return change(set, id, [&](const P& now) { return structure_.erase(now, id); });
    }
    /// After borrowed primitives moved where they lie: fits the structure to them, and returns how far its
    /// quality has drifted, as a multiple of its cost when it was built. O(n). No query may run meanwhile.
    /// Throws InputError as `build` does, and then the index is as it was, valid for the primitives of
    /// before. What an executor throws comes out too, from half way on after the refit was finished.
    double refit(Executor& executor = serial_executor()) requires(Refittable<S, P>) {
        return refit(primitives_, executor);
    }
    /// The same where the moved primitives lie elsewhere: as many as before, each under its id, and borrowed.
    double refit(const P& moved, Executor& executor = serial_executor()) requires(Refittable<S, P>) {
        if (moved.size() != size())
            throw InputError("a refit is for as many primitives as the index was built over: " +
                             std::to_string(size()) + ", not " + std::to_string(moved.size()));
        return in_ieee_mode([&] {
            IeeeExecutor threads(executor);
            const auto references = references_of(moved, threads);
            auto leaves = pack(moved, structure_, threads);
            const auto take = [&](Executor& by) {
                structure_.refit(references, by);
                leaves_ = std::move(leaves);
                primitives_ = moved;
            };
            threads.look();
            try {
                take(threads);
            } catch (...) {
                take(serial_executor());
                throw;
            }
            return structure_.drift();
        });
    }

    /// Any query of yours. `count` is a Visits, or NoVisits.
    template <Query Q, class Count>
    void ask(Q& query, Count& count) const {
        in_ieee_mode([&] { walk(query, count); });
    }
    template <Query Q>
    void ask(Q& query) const {
        NoVisits none;
        ask(query, none);
    }
    /// What Q(*this, arguments...) answers. The query is made in IEEE mode too: its probe computes.
    template <Query Q, class Count, class... Arguments>
    auto answer(Count& count, Arguments&&... arguments) const {
        return in_ieee_mode([&] {
            Q query(*this, arguments...);
            walk(query, count);
            return query.answer();
        });
    }

    /// What the kernels are told, where these primitives in this structure are what they know.
    WideScene wide_scene(const HitFilter& filter = {}, std::size_t first_ray = 0) const requires(by_kernels) {
        return {structure_.tree(), leaves_.data(), primitives_.faces(), filter, first_ray};
    }
    /// The same inside of an instance, for hits that name it.
    WideScene wide_scene(const HitFilter& filter, std::uint32_t instance, std::uint32_t geometry) const
        requires(by_kernels) {
        return {structure_.tree(), leaves_.data(), primitives_.faces(), filter, 0, instance, geometry};
    }
    /// What they are told of an instance of this index.
    KernelInstance kernel_instance(const Affine<3>& back, std::uint32_t mask, std::uint32_t geometry) const
        requires(by_kernels) {
        WideInstance placed{{}, &structure_.tree(), &leaves_, &primitives_.faces(), mask, geometry};
        for (int k = 0; k < 3; ++k) {
            for (int c = 0; c < 3; ++c) placed.back[c][k] = back.linear[static_cast<std::size_t>(k)][c];
            placed.back[3][k] = back.shift[k];
        }
        return placed;
    }
    /// And of instances of such indexes in this one, for a ray.
    WideInstances wide_instances(const Ray<Scalar, dimension>& ray, const HitFilter& filter) const
        requires(instances_by_kernels) {
        return {structure_.tree(), primitives_.for_kernels(), primitives_.hit_error(ray), filter};
    }
    /// Whichever of both this index is to them.
    auto kernel_scene(const Ray<Scalar, dimension>& ray, const HitFilter& filter) const
        requires(by_kernels || instances_by_kernels) {
        if constexpr (by_kernels)
            return wide_scene(filter);
        else
            return wide_instances(ray, filter);
    }
    /// The kernels in use, if any.
    static const WideKernels* kernels() { return wide_kernels(); }

private:
    /// A function of its own: in one with the query's making, the compiler takes the probe apart into more
    /// values than there are registers, and a node costs 10% more.
    template <Query Q, class Count>
    [[gnu::noinline]] void walk(Q& query, Count& count) const {
        structure_.walk(leaves(), query, count);
    }

    template <class Set, class F>
    bool change(const Set& set, PrimitiveId id, F f) {
        static_assert(std::same_as<ViewOf<Set>, P>, "the kind of primitives that the index was built over");
        primitives_ = view_of(set);
        if (!in_ieee_mode([&] { return f(primitives_); })) return false;
        if constexpr (packs && S::packed_order == PackedOrder::of_ids) {
            if (structure_.holds(id)) primitives_.pack(id, id, leaves_);
        } else if constexpr (packs) {
            for (const auto place : structure_.places_changed())
                primitives_.pack(structure_.items()[place], place, leaves_);
        }
        return true;
    }

    static constexpr bool packs = requires(const P& p) {
        p.template pack<S::packed_order>(std::span<const PrimitiveId>(), serial_executor());
    };

    static auto pack(const P& primitives, const S& structure, Executor& executor) {
        if constexpr (packs) {
            return primitives.template pack<S::packed_order>(structure.items(), executor);
        } else {
            static_cast<void>(executor);
            return Nothing{};
        }
    }
    /// What leaves are tested through for rays: the packed copy where there is one, else the view.
    struct Tested {
        const Index& index;
        template <class Probe, class Query>
        Flow test_leaf(const Probe& probe, const Leaf& leaf, Query& query) const {
            if constexpr (packs && requires { index.leaves_.test_leaf(probe, leaf, query); })
                return index.leaves_.test_leaf(probe, leaf, query);
            else
                return hedgerow::test_leaf(index.primitives_, probe, leaf, query);
        }
        void prefetch(const Leaf& leaf) const {
            if constexpr (packs && requires { index.leaves_.prefetch(leaf); }) index.leaves_.prefetch(leaf);
        }
        using Scalar = typename P::Scalar;
        static constexpr int dimension = P::dimension;
        std::size_t size() const { return index.size(); }
        BoxType bounds(std::size_t i) const { return index.primitives_.bounds(i); }
    };
    Tested leaves() const { return {*this}; }

    using Packed = std::conditional_t<
        packs, decltype(pack(std::declval<const P&>(), std::declval<const S&>(), serial_executor())),
        Nothing>;

    /// Of parts that belong together.
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

/// Builds a structure over primitives: `build<KdTree>(mesh, {.leaf_size = 2})`. An lvalue is borrowed (it
/// must outlive the index), an rvalue is moved into the index. Throws InputError for vertices that are NaN,
/// infinite or absurd and for indices out of range.
template <template <class, int> class S, class P>
auto build(P&& primitives,
           const typename S<typename std::remove_cvref_t<P>::Scalar,
                            std::remove_cvref_t<P>::dimension>::Options& options = {},
           Executor& executor = serial_executor()) {
    using Set = std::remove_cvref_t<P>;
    using Structure = S<typename Set::Scalar, Set::dimension>;
    using View = ViewOf<Set>;
    if constexpr (std::is_lvalue_reference_v<P> || std::is_same_v<View, Set>) {
        return Index<Structure, View>(view_of(primitives), options, executor);
    } else {
        auto owner = std::make_shared<const Set>(std::forward<P>(primitives));
        auto view = view_of(*owner);
        return Index<Structure, View>(std::move(view), options, executor, std::move(owner));
    }
}
/// With the structure's own options, over an executor: `build<KdTree>(mesh, default_executor())`.
template <template <class, int> class S, class P>
auto build(P&& primitives, Executor& executor) {
    return build<S>(std::forward<P>(primitives), {}, executor);
}
/// The default structure: the engine.
template <class P>
auto build(P&& primitives, Executor& executor = serial_executor()) {
    return build<WideBvh>(std::forward<P>(primitives), {}, executor);
}

}  // namespace hedgerow
