/// Implements AnyIndex over each kind of primitives, for the engine and for all other structures. Each scalar
/// is instantiated in files of its own, since it takes the compiler a while.
#pragma once

#include <hedgerow/any_index.h>
#include <hedgerow/any_structure.h>

#include "option_reader.h"
#include "structures.h"

namespace hedgerow::detail {

template <class I>
class SolidHolder final : public AnySolid<typename I::Scalar, I::dimension> {
public:
    using T = typename I::Scalar;
    static constexpr int D = I::dimension;
    using Any = AnySolid<T, D>;
    using Point = Vec<T, D>;
    using Points = PointBatch<T, D>;
    using Any::tell_distance, Any::tell_side, Any::tell_winding_number;

    SolidHolder(const I& index, const SolidOptions& options, Threads threads)
        : solid_(index, options, threads) {}

    bool closed() const override { return solid_.closed(); }
    bool oriented() const override { return solid_.oriented(); }
    SideBy by() const override { return solid_.by(); }
    std::size_t bytes() const override { return solid_.bytes(); }
    std::size_t bytes_of_index() const override { return solid_.bytes_of_index(); }
    const Box<T, D>& bounds() const override { return solid_.bounds(); }

    Side tell_side(const Point& point, Visits& visits) const override {
        return solid_.tell_side(point, visits);
    }
    double tell_winding_number(const Point& point, Visits& visits) const override {
        return solid_.tell_winding_number(point, visits);
    }
    SignedDistance<T, D> tell_distance(const Point& point, Visits& visits) const override {
        return solid_.tell_distance(point, visits);
    }
    void write_sides(const Points& points, std::span<Side> found) const override {
        solid_.write_sides(points, found);
    }
    void write_winding_numbers(const Points& points, std::span<double> found) const override {
        solid_.write_winding_numbers(points, found);
    }
    void write_distances(const Points& points, std::span<T> found) const override {
        solid_.write_distances(points, found);
    }

private:
    Solid<I> solid_;
};

/// An index I of known type, whose structure is the engine or any (any_structure.h).
template <class I>
class Holder final : public AnyIndex<typename I::Scalar, I::dimension> {
public:
    using T = typename I::Scalar;
    static constexpr int D = I::dimension;
    using P = typename I::Primitives;
    using Any = AnyIndex<T, D>;

    Holder(std::string name, I index) : name_(std::move(name)), index_(std::move(index)) {}

    std::string_view structure() const override { return name_; }
    const Box<T, D>& bounds() const override { return index_.bounds(); }
    std::size_t size() const override { return index_.size(); }
    std::size_t bytes() const override { return index_.bytes(); }
    std::size_t node_count() const override { return node_count_of(index_.structure()); }
    std::size_t leaf_count() const override { return index_.structure().leaf_count(); }
    std::size_t item_count() const override { return item_count_of(index_.structure()); }
    int depth() const override { return index_.structure().depth(); }
    bool exclusive() const override { return index_.structure().exclusive(); }
    std::string validate() const override { return index_.validate(); }
    std::uint32_t id(PrimitiveId element) const override {
        return reported_id(index_.primitives(), element, 0);
    }
    bool holds(PrimitiveId element) const override {
        if constexpr (requires { index_.structure().holds(element); })
            return index_.structure().holds(element);
        else
            return element < index_.size();
    }
    void visit_outline(const OutlineLimits<D>& limits, CellVisitor<D> visit) const override {
        hedgerow::visit_outline(index_.structure(), limits, visit);
    }

    SetOfIndex<T, D> set() const override {
        if constexpr (std::convertible_to<P, SetOfIndex<T, D>>)
            return index_.primitives();
        else
            throw InputError("the primitives of this index are of a type that no question of pairs knows");
    }
    AnyHierarchy<T, D> hierarchy() const override {
        if constexpr (is_any)
            return hierarchy_of(index_.structure(), index_.primitives());
        else {
            auto own = hierarchy_of(index_.structure(), index_.primitives());
            return AnyHierarchy<T, D>(
                std::make_unique<const HierarchyOf<decltype(own), T, D>>(std::move(own)));
        }
    }

    bool answers_rays() const override {
        if constexpr (is_any)
            return index_.structure().answers_rays();
        else
            return true;
    }
    void ray_uncounted(const Ray<T, D>& ray, Hit<T>& closest) const override {
        closest = closest_hit(index_, ray);
    }
    void ray_uncounted(const Ray<T, D>& ray, bool& any) const override { any = any_hit(index_, ray); }
    KernelUse rays_uncounted(const RayArray<T, D>& all, Hit<T>* hits, Executor& executor) const override {
        return closest_hits(index_, all, std::span(hits, all.size()), {.threads = executor});
    }
    KernelUse rays_uncounted(const RayArray<T, D>& all, bool* hits, Executor& executor) const override {
        return any_hits(index_, all, Truths(hits, all.size()), {.threads = executor});
    }
    std::size_t all_hits_uncounted(const Ray<T, D>& ray, std::vector<Hit<T>>& hits) const override {
        return hedgerow::all_hits(index_, ray, hits);
    }
    std::size_t first_hits_uncounted(const Ray<T, D>& ray, std::span<Hit<T>> hits,
                                     const PlaceOfHit<T>& after) const override {
        return index_.template answer<FirstHits<P>>(no_visits, ray, hits, after);
    }
    Near<T, D> closest_point_uncounted(const Vec<T, D>& point, const NearLimits<T>& limits) const override {
        return index_.template answer<ClosestPoint<P>>(no_visits, point, limits);
    }
    void closest_points_uncounted(const Strided<Vec<T, D>>& points, std::span<Near<T, D>> found,
                                  const PointOptions& options) const override {
        closest_points(index_, points, found, options);
    }
    std::size_t nearest_uncounted(const Vec<T, D>& point, std::size_t k, const NearLimits<T>& limits,
                                  std::vector<Near<T, D>>& found) const override {
        return index_.template answer<Nearest<P>>(no_visits, point, k, limits, found);
    }
    void nearest_uncounted(const Strided<Vec<T, D>>& points, std::size_t k, NearLists<T>& lists,
                           const PointOptions& options) const override {
        hedgerow::nearest(index_, points, k, lists, options);
    }
    std::size_t within_uncounted(const Vec<T, D>& point, const NearLimits<T>& limits,
                                 std::vector<Near<T, D>>& found) const override {
        return index_.template answer<Within<P>>(no_visits, point, limits, found);
    }
    void within_uncounted(const Strided<Vec<T, D>>& points, NearLists<T>& lists,
                          const PointOptions& options) const override {
        hedgerow::within(index_, points, PointOptions::anywhere, lists, options);
    }
    std::size_t list_uncounted(const Box<T, D>& region, std::vector<PrimitiveId>& found,
                               Finds finds) const override {
        return list_in(region, found, finds);
    }
    std::size_t list_uncounted(const Sphere<T, D>& region, std::vector<PrimitiveId>& found,
                               Finds finds) const override {
        return list_in(region, found, finds);
    }
    std::size_t count_uncounted(const Box<T, D>& region) const override {
        return overlap_count(index_, region);
    }
    std::size_t count_uncounted(const Sphere<T, D>& region) const override {
        return overlap_count(index_, region);
    }
    bool any_uncounted(const Box<T, D>& region) const override { return any_overlap(index_, region); }
    bool any_uncounted(const Sphere<T, D>& region) const override { return any_overlap(index_, region); }
    void walk(VirtualQuery<RayProbe<T, D>>& query, TraceLog<T, D>& log) const override {
        index_.ask(query, log);
    }
    void walk(VirtualQuery<PointProbe<T, D>>& query, Visits& count) const override {
        index_.ask(query, count);
    }
    void walk(VirtualQuery<FarProbe<T, D>>& query, Visits& count) const override { index_.ask(query, count); }
    void walk(VirtualQuery<BoxProbe<T, D>>& query, Visits& count) const override { index_.ask(query, count); }
    void walk(VirtualQuery<RegionProbe<AnyRegion<T, D>>>& query, Visits& count) const override {
        index_.ask(query, count);
    }

    void walk_leaves(LeafQuery<PointProbe<T, D>>& query) const override { walk_over(query); }
    void walk_leaves(LeafQuery<BoxProbe<T, D>>& query) const override { walk_over(query); }

    bool has_facets() const override { return facets; }
    std::unique_ptr<const AnySolid<T, D>> make_solid(const SolidOptions& options,
                                                     Threads threads) const override {
        if constexpr (facets)
            return std::make_unique<const SolidHolder<I>>(index_, options, threads);
        else
            refuse_without_facets();
    }

    bool changes_one_by_one() const override {
        if constexpr (is_any)
            return index_.structure().changes_one_by_one();
        else
            return false;
    }
    bool refittable() const override {
        if constexpr (is_any)
            return index_.structure().refittable();
        else
            return true;
    }
    bool insert(PrimitiveId id) override {
        Any::forget_solid();
        if constexpr (is_any)
            return index_.insert(index_.primitives(), id);
        else
            refuse("insert " + std::to_string(id));
    }
    bool erase(PrimitiveId id) override {
        Any::forget_solid();
        if constexpr (is_any)
            return index_.erase(index_.primitives(), id);
        else
            refuse("erase " + std::to_string(id));
    }
    Drift refit(Threads threads) override {
        Any::forget_solid();
        return index_.refit(threads);
    }

private:
    static constexpr bool is_any = std::same_as<typename I::Structure, AnyStructure<T, D>>;
    static constexpr bool facets = FacetSet<P>;

    template <class Probe>
    void walk_over(LeafQuery<Probe>& query) const {
        index_.ask_over(LeavesOfQuery<Probe>{query}, query);
    }
    template <class R>
    std::size_t list_in(const R& region, std::vector<PrimitiveId>& found, Finds finds) const {
        return finds == Finds::contained ? contained(index_, region, found)
                                         : overlapping(index_, region, found);
    }
    [[noreturn]] static void refuse_without_facets() {
        throw InputError("insides are those of triangles in space or segments in the plane");
    }
    [[noreturn]] void refuse(const std::string& wanted) const { hedgerow::detail::refuse(name_, wanted); }

    std::string name_;
    I index_;
};

/// The options of the engine, if `spec` names it.
inline std::optional<WideOptions> engine_options(std::string_view spec) {
    OptionReader in(spec);
    if (in.structure() != "wide") return std::nullopt;
    WideOptions options;
    options.list(in);
    in.finish();
    return options;
}

template <class View>
std::unique_ptr<AnyIndex<typename View::Scalar, View::dimension>> build_any_over(std::string_view spec,
                                                                                 const View& primitives,
                                                                                 Executor& executor) {
    using T = typename View::Scalar;
    constexpr int D = View::dimension;
    using Any = AnyIndex<T, D>;
    const auto held = [&]<class S>(const typename S::Options& options) -> std::unique_ptr<Any> {
        return std::make_unique<Holder<Index<S, View>>>(std::string(spec),
                                                        Index<S, View>(primitives, options, executor));
    };
    // The engine has kernels for what it packs itself.
    if constexpr (requires(const WideBvh<T, D>& engine) { engine.pack(primitives, executor); })
        if (const auto options = engine_options(spec))
            return held.template operator()<WideBvh<T, D>>(*options);
    return held.template operator()<AnyStructure<T, D>>({std::string(spec)});
}

}  // namespace hedgerow::detail

namespace hedgerow {

template <std::floating_point T>
std::unique_ptr<AnyIndex<T, 3>> any_index(Index<WideBvh<T, 3>, TriangleMeshView<T>> index) {
    return std::make_unique<detail::Holder<Index<WideBvh<T, 3>, TriangleMeshView<T>>>>("wide",
                                                                                       std::move(index));
}

template <std::floating_point T, int D>
std::unique_ptr<AnyIndex<T, D>> any_index(Index<WideBvh<T, D>, PointCloudView<T, D>> index) {
    return std::make_unique<detail::Holder<Index<WideBvh<T, D>, PointCloudView<T, D>>>>("wide",
                                                                                        std::move(index));
}

// Instantiates everything for one scalar. NOLINTBEGIN(bugprone-macro-parentheses)
#define HEDGEROW_BUILD_ANY(T)                                                                                \
    template std::unique_ptr<AnyIndex<T, 3>> any_index(Index<WideBvh<T, 3>, TriangleMeshView<T>>);           \
    template std::unique_ptr<AnyIndex<T, 2>> any_index(Index<WideBvh<T, 2>, PointCloudView<T, 2>>);          \
    template std::unique_ptr<AnyIndex<T, 3>> any_index(Index<WideBvh<T, 3>, PointCloudView<T, 3>>);          \
    template std::unique_ptr<AnyIndex<T, 3>> detail::build_any_over(std::string_view,                        \
                                                                    const TriangleMeshView<T>&, Executor&);  \
    template std::unique_ptr<AnyIndex<T, 3>> detail::build_any_over(std::string_view,                        \
                                                                    const SphereSetView<T, 3>&, Executor&);  \
    template std::unique_ptr<AnyIndex<T, 3>> detail::build_any_over(std::string_view,                        \
                                                                    const PointCloudView<T, 3>&, Executor&); \
    template std::unique_ptr<AnyIndex<T, 2>> detail::build_any_over(std::string_view,                        \
                                                                    const PointCloudView<T, 2>&, Executor&); \
    template std::unique_ptr<AnyIndex<T, 2>> detail::build_any_over(std::string_view,                        \
                                                                    const SegmentSetView<T>&, Executor&);
// NOLINTEND(bugprone-macro-parentheses)
}  // namespace hedgerow
