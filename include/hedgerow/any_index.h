/// An index of any structure behind one type. Its structure is chosen at run time, by name and options. The
/// tool and the tests link it.
#pragma once

#include <memory>
#include <mutex>
#include <string>
#include <string_view>
#include <type_traits>
#include <variant>
#include <vector>

#include <hedgerow/any_solid.h>
#include <hedgerow/ask.h>
#include <hedgerow/base/option.h>
#include <hedgerow/geometry/any_region.h>
#include <hedgerow/instances/placed.h>
#include <hedgerow/primitives/point_cloud.h>
#include <hedgerow/primitives/segment_set.h>
#include <hedgerow/primitives/sphere_set.h>
#include <hedgerow/surface.h>
#include <hedgerow/trace.h>
#include <hedgerow/walks/any_hierarchy.h>
#include <hedgerow/walks/virtual_query.h>

namespace hedgerow {

/// The sets that an AnyIndex may be built over, in space and in the plane.
template <std::floating_point T, int D>
using SetOfIndex = typename std::conditional_t<
    D == 3, std::type_identity<std::variant<TriangleMeshView<T>, PointCloudView<T, D>, SphereSetView<T, D>>>,
    std::type_identity<std::variant<SegmentSetView<T>, PointCloudView<T, D>>>>::type;

/// An index of any structure over any primitives: the functions of ask.h take it as they take an Index. What
/// has a virtual function below costs one virtual call without filter and visits, inside which the primitives
/// are known at compile time, and the engine too; other structures cost a virtual call a leaf
/// (any_structure.h). All else costs one a candidate: filters, masks and what is left out of rays, visits,
/// and the questions that are asked less often. Const use is thread-safe.
template <std::floating_point T, int D>
class AnyIndex {
public:
    virtual ~AnyIndex() = default;

    /// The spec that the index was built by, with its options; "wide" for `any_index`.
    virtual std::string_view structure() const = 0;
    virtual const Box<T, D>& bounds() const = 0;
    virtual std::size_t size() const = 0;
    /// Bytes of memory beyond the primitives themselves.
    virtual std::size_t bytes() const = 0;
    virtual std::size_t node_count() const = 0;
    virtual std::size_t leaf_count() const = 0;
    virtual std::size_t item_count() const = 0;
    virtual int depth() const = 0;
    /// Whether the structure holds each primitive once.
    virtual bool exclusive() const = 0;
    /// What is wrong with the structure; empty if nothing is.
    virtual std::string validate() const = 0;

    // `answer` runs any query type of yours, with this object as the index and as the set of primitives.

    using Scalar = T;
    static constexpr int dimension = D;
    using Primitives = AnyIndex;
    const AnyIndex& primitives() const { return *this; }
    /// The id that hits report for a primitive.
    virtual std::uint32_t id(PrimitiveId element) const = 0;
    /// Whether the structure holds a primitive, of which some may have been erased.
    virtual bool holds(PrimitiveId element) const = 0;

    /// The answer of Q(*this, arguments...): of what has a virtual function below, if nothing is counted, by
    /// that; else after a walk, where each candidate costs a virtual call. Throws InputError where the
    /// structure does not answer queries of this probe.
    template <AnsweringQuery Q, class Count, class... Arguments>
    auto answer(Count& count, Arguments&&... arguments) const {
        if constexpr (by_virtual_function<Q, Count, std::remove_reference_t<Arguments>...>)
            return EngineFor<Q, AnyIndex>(*this).answer(arguments...);
        else
            return in_ieee_mode([&] {
                Q query(*this, arguments...);
                ask(query, count);
                return query.answer();
            });
    }
    /// Runs any query of yours by a walk: of a ray, a point, a FarProbe, a box or an AnyRegion. `count` is a
    /// Visits, or NoVisits.
    template <Query Q, class Count = const NoVisits>
    void ask(Q& query, Count& count = no_visits) const {
        in_ieee_mode([&] {
            Virtual<Q> asked(query);
            detail::count_virtually<typename Q::Probe>(count, [&](auto& counted) { walk(asked, counted); });
        });
    }
    /// Runs a query of a point or a box over leaves of yours. Nothing is counted.
    template <class Leaves, Query Q>
    void ask_over(const Leaves& leaves, Q& query) const {
        in_ieee_mode([&] {
            LeafTests<Q, Leaves> asked(std::as_const(query).probe(), query, leaves);
            walk_leaves(asked);
        });
    }
    /// The answer of a query of a region. Shapes that have no walk of their own share one.
    template <template <class, class> class Q, class R, class Count, class... Arguments>
    auto answer_region(const R& region, Count& count, Arguments&&... arguments) const {
        using Query = Q<AnyIndex, R>;
        if constexpr (by_virtual_function<Query, Count, const R, std::remove_reference_t<Arguments>...> ||
                      std::same_as<R, Box<T, D>> || std::same_as<R, AnyRegion<T, D>>)
            return answer<Query>(count, region, arguments...);
        else
            return answer_region<Q>(AnyRegion<T, D>(region), count, arguments...);
    }
    /// The set that the index was built over: a view of it.
    virtual SetOfIndex<T, D> set() const = 0;
    /// The structure as nested boxes, for walks over pairs (walks/pairs.h; any_pairs.h asks the questions).
    virtual AnyHierarchy<T, D> hierarchy() const = 0;

    /// Whether the structure answers ray queries.
    virtual bool answers_rays() const = 0;
    /// Whether the primitives are triangles in space or segments in the plane: these have features, and may
    /// be the surface of a solid. `solid` and `make_solid` throw InputError for other primitives.
    virtual bool has_facets() const = 0;
    /// The solid whose surface the primitives are, in O(n). Throws as the constructor of Solid does.
    virtual std::unique_ptr<const AnySolid<T, D>> make_solid(const SolidOptions& options = {},
                                                             Threads threads = {}) const = 0;
    /// The solid with the default options. It is made at the first call, and kept until the index changes. A
    /// few threads that ask first at the same time may each make it; one of these is kept.
    const AnySolid<T, D>& solid() const {
        const auto kept = [&](auto make) -> const AnySolid<T, D>* {
            const std::lock_guard lock(keeping_solid_);
            if (!solid_) solid_ = make();
            return solid_.get();
        };
        if (const auto* const solid = kept([] { return nullptr; })) return *solid;
        // Not under the lock: a thread that waits for others here may take up work that asks for the solid.
        auto made = make_solid();
        return *kept([&] { return std::move(made); });
    }

    /// Calls a function for the structure's cells, parents before their children (walks/outline.h).
    virtual void visit_outline(const OutlineLimits<D>& limits, CellVisitor<D> visit) const = 0;
    /// The structure's cells, in a list.
    std::vector<OutlineCell<D>> outline(const OutlineLimits<D>& limits = {}) const {
        std::vector<OutlineCell<D>> cells;
        visit_outline(limits, [&](const OutlineCell<D>& cell) { return cells.push_back(cell), true; });
        return cells;
    }
    /// Whether single primitives can be inserted and erased, and whether the structure can be refitted to
    /// primitives that moved. `insert`, `erase` and `refit` throw InputError where the structure cannot do
    /// it; the index has to be built again then.
    virtual bool changes_one_by_one() const = 0;
    virtual bool refittable() const = 0;
    /// Like `insert`, `erase` and `refit` of Index, on the borrowed primitives in the caller's arrays.
    virtual bool insert(PrimitiveId id) = 0;
    virtual bool erase(PrimitiveId id) = 0;
    virtual Drift refit(Threads threads = {}) = 0;

    // What is answered by itself, without filters and visits.

    virtual void ray_uncounted(const Ray<T, D>& ray, Hit<T>& closest) const = 0;
    virtual void ray_uncounted(const Ray<T, D>& ray, bool& any) const = 0;
    virtual KernelUse rays_uncounted(const RayArray<T, D>& rays, Hit<T>* hits, Executor& executor) const = 0;
    virtual KernelUse rays_uncounted(const RayArray<T, D>& rays, bool* hits, Executor& executor) const = 0;
    virtual std::size_t all_hits_uncounted(const Ray<T, D>& ray, std::vector<Hit<T>>& hits) const = 0;
    virtual std::size_t first_hits_uncounted(const Ray<T, D>& ray, std::span<Hit<T>> hits,
                                             const PlaceOfHit<T>& after) const = 0;
    virtual Near<T, D> closest_point_uncounted(const Vec<T, D>& point, const NearLimits<T>& limits) const = 0;
    virtual void closest_points_uncounted(const Strided<Vec<T, D>>& points, std::span<Near<T, D>> found,
                                          const PointOptions& options) const = 0;
    virtual std::size_t nearest_uncounted(const Vec<T, D>& point, std::size_t k, const NearLimits<T>& limits,
                                          std::vector<Near<T, D>>& found) const = 0;
    virtual void nearest_uncounted(const Strided<Vec<T, D>>& points, std::size_t k, NearLists<T>& lists,
                                   const PointOptions& options) const = 0;
    virtual std::size_t within_uncounted(const Vec<T, D>& point, const NearLimits<T>& limits,
                                         std::vector<Near<T, D>>& found) const = 0;
    virtual void within_uncounted(const Strided<Vec<T, D>>& points, NearLists<T>& lists,
                                  const PointOptions& options) const = 0;
    virtual std::size_t list_uncounted(const Box<T, D>& region, std::vector<PrimitiveId>& found,
                                       Finds finds) const = 0;
    virtual std::size_t list_uncounted(const Sphere<T, D>& region, std::vector<PrimitiveId>& found,
                                       Finds finds) const = 0;
    virtual std::size_t count_uncounted(const Box<T, D>& region) const = 0;
    virtual std::size_t count_uncounted(const Sphere<T, D>& region) const = 0;
    virtual bool any_uncounted(const Box<T, D>& region) const = 0;
    virtual bool any_uncounted(const Sphere<T, D>& region) const = 0;

protected:
    /// To be called where the primitives change.
    void forget_solid() { solid_.reset(); }
    virtual void walk(VirtualQuery<RayProbe<T, D>>& query, detail::TraceLog<T, D>& log) const = 0;
    virtual void walk(VirtualQuery<PointProbe<T, D>>& query, Visits& count) const = 0;
    virtual void walk(VirtualQuery<FarProbe<T, D>>& query, Visits& count) const = 0;
    virtual void walk(VirtualQuery<BoxProbe<T, D>>& query, Visits& count) const = 0;
    virtual void walk(VirtualQuery<RegionProbe<AnyRegion<T, D>>>& query, Visits& count) const = 0;
    virtual void walk_leaves(LeafQuery<PointProbe<T, D>>& query) const = 0;
    virtual void walk_leaves(LeafQuery<BoxProbe<T, D>>& query) const = 0;

private:
    mutable std::mutex keeping_solid_;
    mutable std::unique_ptr<const AnySolid<T, D>> solid_;

    template <class Q, class Count, class... Arguments>
    static constexpr bool by_virtual_function =
        std::same_as<Count, const NoVisits>&& AnswersOne<EngineFor<Q, AnyIndex>, Arguments...>;
};

namespace detail {
template <class R, class T, int D>
concept BoxOrBall = std::same_as<R, Box<T, D>> || std::same_as<R, Sphere<T, D>>;

template <std::floating_point T, int D>
class AnyEngine {
public:
    explicit AnyEngine(const AnyIndex<T, D>& index) : index_(index) {}
    explicit operator bool() const { return true; }

protected:
    const AnyIndex<T, D>& index() const { return index_; }

private:
    const AnyIndex<T, D>& index_;
};
/// Closest or any hits.
template <std::floating_point T, int D, class Answer>
struct AnyEngineOfRays : AnyEngine<T, D> {
    using AnyEngine<T, D>::AnyEngine;
    Answer answer(const Ray<T, D>& ray, const KeepAll& = {}) const {
        Answer found;
        this->index().ray_uncounted(ray, found);
        return found;
    }
    KernelUse answer_batch(const RayArray<T, D>& rays, Answer* answers, const auto& how) const {
        return this->index().rays_uncounted(rays, answers, how.executor);
    }
    /// Where the index is an instance in a world.
    template <class Q>
    Flow offer_inside(Ray<T, D> ray, std::uint32_t instance, std::uint32_t, Q& query) const {
        ray.t_max = query.limit();
        const Answer found = answer(ray);
        if (!found) return Flow::go_on;
        if constexpr (std::same_as<Answer, bool>)
            return query.found();
        else
            return query.offer({found.t, found.u, found.v, found.element, instance});
    }
};
}  // namespace detail

// What an AnyIndex has virtual functions for comes through the door for engines (walks/engine.h).

template <class Set, std::floating_point T, int D>
struct EngineFor<ClosestHit<Set>, AnyIndex<T, D>> : detail::AnyEngineOfRays<T, D, Hit<T>> {
    using detail::AnyEngineOfRays<T, D, Hit<T>>::AnyEngineOfRays;
};
template <class Set, std::floating_point T, int D>
struct EngineFor<AnyHit<Set>, AnyIndex<T, D>> : detail::AnyEngineOfRays<T, D, bool> {
    using detail::AnyEngineOfRays<T, D, bool>::AnyEngineOfRays;
};
template <std::floating_point T, int D>
struct EngineFor<AllHits<AnyIndex<T, D>>, AnyIndex<T, D>> : detail::AnyEngine<T, D> {
    using detail::AnyEngine<T, D>::AnyEngine;
    std::size_t answer(const Ray<T, D>& ray, std::vector<Hit<T>>& hits, const KeepAll& = {}) const {
        return this->index().all_hits_uncounted(ray, hits);
    }
};
template <std::floating_point T, int D>
struct EngineFor<FirstHits<AnyIndex<T, D>>, AnyIndex<T, D>> : detail::AnyEngine<T, D> {
    using detail::AnyEngine<T, D>::AnyEngine;
    std::size_t answer(const Ray<T, D>& ray, std::span<Hit<T>> hits, const PlaceOfHit<T>& after,
                       const KeepAll& = {}) const {
        return this->index().first_hits_uncounted(ray, hits, after);
    }
};
template <std::floating_point T, int D>
struct EngineFor<ClosestPoint<AnyIndex<T, D>>, AnyIndex<T, D>> : detail::AnyEngine<T, D> {
    using detail::AnyEngine<T, D>::AnyEngine;
    Near<T, D> answer(const Vec<T, D>& point, const NearLimits<T>& limits) const {
        return this->index().closest_point_uncounted(point, limits);
    }
    void answer_batch(const Strided<Vec<T, D>>& points, Near<T, D>* found, const auto& how) const {
        this->index().closest_points_uncounted(points, {found, points.size()}, how.options);
    }
};
template <std::floating_point T, int D>
struct EngineFor<Nearest<AnyIndex<T, D>>, AnyIndex<T, D>> : detail::AnyEngine<T, D> {
    using detail::AnyEngine<T, D>::AnyEngine;
    std::size_t answer(const Vec<T, D>& point, std::size_t k, const NearLimits<T>& limits,
                       std::vector<Near<T, D>>& found) const {
        return this->index().nearest_uncounted(point, k, limits, found);
    }
    void answer_lists(const Strided<Vec<T, D>>& points, std::size_t k, NearLists<T>& lists,
                      const auto& how) const {
        this->index().nearest_uncounted(points, k, lists, how.options);
    }
};
template <std::floating_point T, int D>
struct EngineFor<Within<AnyIndex<T, D>>, AnyIndex<T, D>> : detail::AnyEngine<T, D> {
    using detail::AnyEngine<T, D>::AnyEngine;
    std::size_t answer(const Vec<T, D>& point, const NearLimits<T>& limits,
                       std::vector<Near<T, D>>& found) const {
        return this->index().within_uncounted(point, limits, found);
    }
    void answer_lists(const Strided<Vec<T, D>>& points, NearLists<T>& lists, const auto& how) const {
        this->index().within_uncounted(points, lists, how.options);
    }
};
template <std::floating_point T, int D, detail::BoxOrBall<T, D> R>
struct EngineFor<Overlapping<AnyIndex<T, D>, R>, AnyIndex<T, D>> : detail::AnyEngine<T, D> {
    using detail::AnyEngine<T, D>::AnyEngine;
    std::size_t answer(const R& region, std::vector<PrimitiveId>& found,
                       Finds finds = Finds::overlapping) const {
        return this->index().list_uncounted(region, found, finds);
    }
};
template <std::floating_point T, int D, detail::BoxOrBall<T, D> R>
struct EngineFor<OverlapCount<AnyIndex<T, D>, R>, AnyIndex<T, D>> : detail::AnyEngine<T, D> {
    using detail::AnyEngine<T, D>::AnyEngine;
    std::size_t answer(const R& region) const { return this->index().count_uncounted(region); }
};
template <std::floating_point T, int D, detail::BoxOrBall<T, D> R>
struct EngineFor<AnyOverlap<AnyIndex<T, D>, R>, AnyIndex<T, D>> : detail::AnyEngine<T, D> {
    using detail::AnyEngine<T, D>::AnyEngine;
    bool answer(const R& region) const { return this->index().any_uncounted(region); }
};

/// The primitives of an AnyIndex under a transform.
template <std::floating_point T, int D>
class Placed<AnyIndex<T, D>> {
public:
    using Scalar = T;
    static constexpr int dimension = D;

    Placed(const AnyIndex<T, D>& index, const Affine<D>& there, const Affine<D>& back, double scale)
        : set_(index.set()), there_(there), back_(back), scale_(scale) {}

    template <class Probe, class Query>
    Flow test_leaf(const Probe& probe, const Leaf& leaf, Query& query) const {
        return std::visit(
            [&]<class P>(const P& set) {
                return Placed<P>(set, there_, back_, scale_).test_leaf(probe, leaf, query);
            },
            set_);
    }

private:
    SetOfIndex<T, D> set_;
    const Affine<D>& there_;
    const Affine<D>& back_;
    double scale_;
};

/// The walk of a ray's closest-hit query, step by step (trace.h).
template <std::floating_point T, int D>
Trace<T, D> trace(const AnyIndex<T, D>& index, const Ray<T, D>& ray) {
    return detail::trace_over(index, ray, [&](const OutlineLimits<D>& limits, CellVisitor<D> visit) {
        index.visit_outline(limits, visit);
    });
}

struct StructureInfo {
    std::string_view name, description;
    std::vector<OptionInfo> options;
    /// The dimension of the sets that the structure can hold; 0 for any dimension.
    int dimension = 0;
    bool points_only = false;
    /// Whether the structure answers ray queries.
    bool rays = true;

    /// Whether the structure can be built over sets of this dimension; `points` says whether the sets hold
    /// points.
    bool holds(int set_dimension, bool points) const {
        return (dimension == 0 || dimension == set_dimension) && (points || !points_only);
    }
};
/// Every structure that `build_any` knows.
const std::vector<StructureInfo>& structure_list();

namespace detail {
template <class View>
std::unique_ptr<AnyIndex<typename View::Scalar, View::dimension>> build_any_over(std::string_view spec,
                                                                                 const View& primitives,
                                                                                 Executor& executor);
}

/// Builds the structure that `spec` names, over borrowed primitives: "bvh",
/// "bvh:builder=sweep,max_leaf_size=4". Throws UsageError for unknown names and options (with the nearest
/// that exists), for values out of range, and for primitives that the structure cannot hold. Throws
/// InputError for bad primitives.
/// Defined for TriangleMesh<T>, SphereSet<T, 3>, PointCloud<T, 2 or 3> and SegmentSet<T>, and for views of
/// such primitives in the caller's arrays, with T float or double.
template <class P>
auto build_any(std::string_view spec, const P& primitives, Threads threads = {}) {
    return detail::build_any_over(spec, view_of(primitives), threads.over(primitives.size()));
}
/// Primitives that would be gone after the call: only views of the caller's arrays may be temporary.
template <class P>
requires(!std::is_reference_v<P> &&
         !std::same_as<std::remove_const_t<P>, ViewOf<P>>) void build_any(std::string_view, P&&,
                                                                          Threads = {}) = delete;
/// An AnyIndex from an existing index of triangles or points in a WideBvh, built or loaded (io/index_file.h).
/// T is float or double.
template <std::floating_point T>
std::unique_ptr<AnyIndex<T, 3>> any_index(Index<WideBvh<T, 3>, TriangleMeshView<T>> index);
template <std::floating_point T, int D>
std::unique_ptr<AnyIndex<T, D>> any_index(Index<WideBvh<T, D>, PointCloudView<T, D>> index);

}  // namespace hedgerow
