/// A structure built over primitives, and the questions it answers.
#pragma once

#include <atomic>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include <hedgerow/geometry/offset.h>
#include <hedgerow/geometry/transform.h>
#include <hedgerow/parallel/ieee_executor.h>
#include <hedgerow/primitives/triangle_mesh.h>
#include <hedgerow/queries/all_hits.h>
#include <hedgerow/queries/any_hit.h>
#include <hedgerow/queries/closest_hit.h>
#include <hedgerow/queries/closest_point.h>
#include <hedgerow/queries/hit_count.h>
#include <hedgerow/queries/nearest.h>
#include <hedgerow/queries/overlapping.h>
#include <hedgerow/ray_array.h>
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

/// A structure S over the primitives that the view P looks at. Const use is thread-safe, and queries allocate
/// nothing (those that return lists fill the caller's vector). Movable. What it looks at is not to be changed
/// once it is built, but through `insert` and `erase`, or with a `refit` after, where the structure has them.
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
    /// before. (Only an executor that throws on its own may leave boxes of both.)
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
            structure_.refit(references, threads);
            leaves_ = std::move(leaves);
            primitives_ = moved;
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
/// The default structure: the engine.
template <class P>
auto build(P&& primitives, Executor& executor = serial_executor()) {
    return build<WideBvh>(std::forward<P>(primitives), {}, executor);
}

template <class I>
using RayOf = Ray<typename I::Scalar, I::dimension>;
template <class I>
using HitOf = Hit<typename I::Scalar>;
template <class I>
using PointOf = Vec<typename I::Scalar, I::dimension>;
template <class I>
using NearOf = Near<typename I::Scalar, I::dimension>;

inline constexpr NoVisits no_visits{};

/// The kernels that are to answer, if any do: they do not count.
template <class S, class P, class Count = const NoVisits>
const WideKernels* kernels_for(const Index<S, P>&) {
    using I = Index<S, P>;
    if constexpr ((I::by_kernels || I::instances_by_kernels) && std::same_as<Count, const NoVisits>)
        return wide_kernels();
    else
        return nullptr;
}

/// The hit of least t in [t_min, t_max], if any. `filter(hit)` may refuse; `count` may be a Visits.
template <class S, class P, class Filter = KeepAll, class Count = const NoVisits>
std::optional<Hit<typename P::Scalar>> closest_hit(const Index<S, P>& index,
                                                   const Ray<typename P::Scalar, P::dimension>& ray,
                                                   const Filter& filter = {}, Count& count = no_visits) {
    [[maybe_unused]] const auto* kernels = kernels_for<S, P, Count>(index);
    [[maybe_unused]] const auto found = [](const Hit<float>& hit) {
        return hit ? std::optional(hit) : std::nullopt;
    };
    if constexpr (Index<S, P>::by_kernels) {
        if (kernels != nullptr)
            return found(in_ieee_mode(
                [&] { return kernels->closest_hit(index.wide_scene(hit_filter(filter)), ray); }));
    } else if constexpr (Index<S, P>::instances_by_kernels) {
        if (kernels != nullptr)
            return found(in_ieee_mode([&] {
                return kernels->closest_hit_of_instances(index.wide_instances(ray, hit_filter(filter)), ray);
            }));
    }
    return index.template answer<ClosestHit<P, Filter>>(count, ray, filter);
}
/// Whether anything is hit.
template <class S, class P, class Filter = KeepAll, class Count = const NoVisits>
bool any_hit(const Index<S, P>& index, const Ray<typename P::Scalar, P::dimension>& ray,
             const Filter& filter = {}, Count& count = no_visits) {
    [[maybe_unused]] const auto* kernels = kernels_for<S, P, Count>(index);
    if constexpr (Index<S, P>::by_kernels) {
        if (kernels != nullptr)
            return in_ieee_mode([&] { return kernels->any_hit(index.wide_scene(hit_filter(filter)), ray); });
    } else if constexpr (Index<S, P>::instances_by_kernels) {
        if (kernels != nullptr)
            return in_ieee_mode([&] {
                return kernels->any_hit_of_instances(index.wide_instances(ray, hit_filter(filter)), ray);
            });
    }
    return index.template answer<AnyHit<P, Filter>>(count, ray, filter);
}
/// Every hit in the order of (t, id), each primitive once, into `hits`; returns how many.
template <class S, class P, class Filter = KeepAll, class Count = const NoVisits>
std::size_t all_hits(const Index<S, P>& index, const Ray<typename P::Scalar, P::dimension>& ray,
                     std::vector<Hit<typename P::Scalar>>& hits, const Filter& filter = {},
                     Count& count = no_visits) {
    return index.template answer<AllHits<P, Filter>>(count, ray, hits, filter);
}
/// How many primitives are hit (two at a shared edge). A structure that may offer a primitive twice has its
/// hits kept until they are told apart, in memory that the thread keeps.
template <class S, class P, class Filter = KeepAll, class Count = const NoVisits>
std::size_t hit_count(const Index<S, P>& index, const Ray<typename P::Scalar, P::dimension>& ray,
                      const Filter& filter = {}, Count& count = no_visits) {
    if (index.structure().exclusive() && offers_once(index.primitives())) {
        return index.template answer<HitCount<P, Filter>>(count, ray, filter);
    } else {
        static thread_local std::vector<Hit<typename P::Scalar>> hits;
        return all_hits(index, ray, hits, filter, count);
    }
}
/// The closest point of any primitive within a squared distance.
template <class S, class P, class Count = const NoVisits>
std::optional<Near<typename P::Scalar, P::dimension>> closest_point(
    const Index<S, P>& index, const Vec<typename P::Scalar, P::dimension>& point,
    typename P::Scalar max_distance2 = std::numeric_limits<typename P::Scalar>::max(),
    Count& count = no_visits) {
    return index.template answer<ClosestPoint<P>>(count, point, max_distance2);
}
/// The k nearest primitives within a squared distance, in the order of (distance², id), into `found`.
template <class S, class P, class Count = const NoVisits>
std::size_t nearest(const Index<S, P>& index, const Vec<typename P::Scalar, P::dimension>& point,
                    std::size_t k, std::vector<Near<typename P::Scalar, P::dimension>>& found,
                    typename P::Scalar max_distance2 = std::numeric_limits<typename P::Scalar>::max(),
                    Count& count = no_visits) {
    return index.template answer<Nearest<P>>(count, point, k, max_distance2, found);
}
/// The primitives that overlap a box, ascending, into `found`: their positions, among instances PlacedIds.
template <class S, class P, class Count = const NoVisits>
std::size_t overlapping(const Index<S, P>& index, const Box<typename P::Scalar, P::dimension>& box,
                        std::vector<IdOf<P>>& found, Count& count = no_visits) {
    return index.template answer<Overlapping<P>>(count, box, found);
}

namespace detail {
inline void expect_room(std::size_t rays, std::size_t answers) {
    if (answers < rays)
        throw InputError("there are " + std::to_string(rays) + " rays, but room for " +
                         std::to_string(answers) +
                         " answers: make the array of answers as long as that of rays");
}
/// Rays `begin` to `end` of a batch by `by_kernels(kernels, scene, begin, end)` where kernels answer, else
/// `one(i, filter)` each; in pieces over the executor.
template <class S, class P, class Filter, class ByKernels, class One>
KernelUse answer_batch(const Index<S, P>& index, std::size_t count, Executor& executor, const Filter& filter,
                       ByKernels by_kernels, One one) {
    std::atomic<std::size_t> phased{0}, packets{0};
    executor.for_each_piece(count, 4096, [&](std::size_t begin, std::size_t end) {
        if constexpr (Index<S, P>::by_kernels)
            if (const auto* kernels = kernels_for(index)) {
                const WideScene scene = index.wide_scene(hit_filter(filter), begin);
                const KernelUse use = in_ieee_mode([&] { return by_kernels(*kernels, scene, begin, end); });
                phased += use.phased, packets += use.packets;
                return;
            }
        for (std::size_t i = begin; i < end; ++i) one(i, filter_of_ray(filter, i));
    });
    return {count - phased - packets, phased, packets};
}
}  // namespace detail

/// One answer a ray, in pieces over the executor. The rays may lie in memory as they like (ray_array.h); a
/// vector or a span of them will do. `filter(hit)` or `filter(i, hit)`, for ray i, may refuse
/// (queries/hit.h). Where nothing is hit, a Hit that is false. Throws InputError, and writes nothing, if
/// there are fewer places for answers than rays. Returns which algorithms answered
/// (structures/bvh/wide/kernels.h): other indexes than those of triangles of float in a WideBvh go ray by
/// ray.
///
///   closest_hits(index, rays, hits, default_executor(),
///                [&](std::size_t i, const Hit<float>& h) { return h.element != starts_on[i]; });
template <class S, class P, class Filter = KeepAll>
KernelUse closest_hits(const Index<S, P>& index, const RayArray<typename P::Scalar, P::dimension>& rays,
                       std::span<Hit<typename P::Scalar>> hits, Executor& executor = serial_executor(),
                       const Filter& filter = {}) {
    detail::expect_room(rays.size(), hits.size());
    return detail::answer_batch(
        index, rays.size(), executor, filter,
        [&](const auto& kernels, const auto& wide, std::size_t begin, std::size_t end) {
            return kernels.closest_hits(wide, rays.part(begin, end - begin), hits.data() + begin);
        },
        [&](std::size_t i, const auto& own) {
            hits[i] = closest_hit(index, rays[i], own).value_or(Hit<typename P::Scalar>{});
        });
}
template <class S, class P, class Filter = KeepAll>
KernelUse any_hits(const Index<S, P>& index, const RayArray<typename P::Scalar, P::dimension>& rays,
                   std::span<bool> hits, Executor& executor = serial_executor(), const Filter& filter = {}) {
    detail::expect_room(rays.size(), hits.size());
    return detail::answer_batch(
        index, rays.size(), executor, filter,
        [&](const auto& kernels, const auto& wide, std::size_t begin, std::size_t end) {
            return kernels.any_hits(wide, rays.part(begin, end - begin), hits.data() + begin);
        },
        [&](std::size_t i, const auto& own) { hits[i] = any_hit(index, rays[i], own); });
}

}  // namespace hedgerow
