/// Implements AnyIndex over each structure and kind of primitives. Each scalar is instantiated in a file of
/// its own, since it takes the compiler a while.
#pragma once

#include <hedgerow/any_index.h>

#include "option_reader.h"
#include "structures.h"

namespace hedgerow::detail {

[[noreturn]] inline void refuse(const std::string& structure, const std::string& wanted,
                                const char* instead) {
    throw InputError("structure '" + structure + "' cannot " + wanted + ": " + instead);
}

/// A solid of an index. The engine alone has batches of its own: one more walk of each other structure would
/// take the compiler longer.
template <class S, class P>
class SolidHolder final : public AnySolid<typename P::Scalar, P::dimension> {
public:
    using T = typename P::Scalar;
    static constexpr int D = P::dimension;
    using Any = AnySolid<T, D>;
    using Point = Vec<T, D>;
    using Points = PointBatch<T, D>;
    using Any::tell_distance, Any::tell_side, Any::tell_winding_number;

    SolidHolder(const Index<S, P>& index, const SolidOptions& options, Threads threads)
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
        if constexpr (is_engine)
            solid_.write_sides(points, found);
        else
            Any::write_sides(points, found);
    }
    void write_winding_numbers(const Points& points, std::span<double> found) const override {
        if constexpr (is_engine)
            solid_.write_winding_numbers(points, found);
        else
            Any::write_winding_numbers(points, found);
    }
    void write_distances(const Points& points, std::span<T> found) const override {
        if constexpr (is_engine)
            solid_.write_distances(points, found);
        else
            Any::write_distances(points, found);
    }

private:
    static constexpr bool is_engine = std::same_as<S, WideBvh<T, D>>;

    Solid<Index<S, P>> solid_;
};

template <class S, class P>
class Holder final : public AnyIndex<typename P::Scalar, P::dimension> {
public:
    using T = typename P::Scalar;
    static constexpr int D = P::dimension;
    using Any = AnyIndex<T, D>;

    Holder(std::string name, Index<S, P> index) : name_(std::move(name)), index_(std::move(index)) {}

    std::string_view structure() const override { return name_; }
    const Box<T, D>& bounds() const override { return index_.bounds(); }
    std::size_t size() const override { return index_.size(); }
    std::size_t bytes() const override { return index_.bytes(); }
    std::size_t node_count() const override {
        if constexpr (requires { index_.structure().used_node_count(); })
            return index_.structure().used_node_count();
        else
            return index_.structure().node_count();
    }
    std::size_t leaf_count() const override { return index_.structure().leaf_count(); }
    std::size_t item_count() const override {
        if constexpr (requires { index_.structure().item_count(); })
            return index_.structure().item_count();
        else
            return index_.structure().items().size();
    }
    int depth() const override { return index_.structure().depth(); }
    bool exclusive() const override { return index_.structure().exclusive(); }
    std::string validate() const override { return index_.validate(); }

    std::uint32_t id(PrimitiveId element) const override {
        return reported_id(index_.primitives(), element, 0);
    }
    bool answers_rays() const override { return rays; }
    KernelUse rays_uncounted(const RayArray<T, D>& all, Hit<T>* hits, Executor& executor) const override {
        if constexpr (rays)
            return answer_each<ClosestHit>(index_, all, hits, executor, KeepAll());
        else
            refuse_rays();
    }
    KernelUse rays_uncounted(const RayArray<T, D>& all, bool* hits, Executor& executor) const override {
        if constexpr (rays)
            return answer_each<AnyHit>(index_, all, hits, executor, KeepAll());
        else
            refuse_rays();
    }
    std::size_t all_hits_uncounted(const Ray<T, D>& ray, std::vector<Hit<T>>& hits) const override {
        if constexpr (is_engine)
            return hedgerow::all_hits(index_, ray, hits);
        else
            return Any::all_hits_uncounted(ray, hits);
    }
    std::size_t first_hits_uncounted(const Ray<T, D>& ray, std::span<Hit<T>> hits,
                                     const PlaceOfHit<T>& after) const override {
        if constexpr (is_engine)
            return index_.template answer<FirstHits<P>>(no_visits, ray, hits, after);
        else
            return Any::first_hits_uncounted(ray, hits, after);
    }
    void closest_points_uncounted(const Strided<Vec<T, D>>& points, std::span<Near<T, D>> found,
                                  const PointOptions& options) const override {
        hedgerow::closest_points(index_, points, found, options);
    }
    std::size_t nearest_uncounted(const Vec<T, D>& point, std::size_t k, const NearLimits<T>& limits,
                                  std::vector<Near<T, D>>& found) const override {
        if constexpr (is_engine)
            return index_.template answer<Nearest<P>>(no_visits, point, k, limits, found);
        else
            return Any::nearest_uncounted(point, k, limits, found);
    }
    bool nearest_uncounted(const Strided<Vec<T, D>>& points, std::size_t k, NearLists<T>& lists,
                           const PointOptions& options) const override {
        if constexpr (is_engine) hedgerow::nearest(index_, points, k, lists, options);
        return is_engine;
    }
    std::size_t within_uncounted(const Vec<T, D>& point, const NearLimits<T>& limits,
                                 std::vector<Near<T, D>>& found) const override {
        if constexpr (is_engine)
            return index_.template answer<Within<P>>(no_visits, point, limits, found);
        else
            return Any::within_uncounted(point, limits, found);
    }
    bool within_uncounted(const Strided<Vec<T, D>>& points, NearLists<T>& lists,
                          const PointOptions& options) const override {
        if constexpr (is_engine)
            return hedgerow::within(index_, points, PointOptions::anywhere, lists, options), true;
        else
            return listed_by_cells(index_.primitives(), points, lists, options);
    }
    std::size_t list_uncounted(const Box<T, D>& region, std::vector<PrimitiveId>& found,
                               Finds finds) const override {
        return list_by<Box<T, D>>(region, found, finds);
    }
    std::size_t list_uncounted(const Sphere<T, D>& region, std::vector<PrimitiveId>& found,
                               Finds finds) const override {
        return list_by<Sphere<T, D>>(region, found, finds);
    }
    std::size_t count_uncounted(const Box<T, D>& region) const override {
        return count_by<Box<T, D>>(region);
    }
    std::size_t count_uncounted(const Sphere<T, D>& region) const override {
        return count_by<Sphere<T, D>>(region);
    }
    bool any_uncounted(const Box<T, D>& region) const override { return any_by<Box<T, D>>(region); }
    bool any_uncounted(const Sphere<T, D>& region) const override { return any_by<Sphere<T, D>>(region); }
    void walk(VirtualQuery<RayProbe<T, D>>& query, TraceLog<T, D>& log) const override {
        if constexpr (rays)
            index_.ask(query, log);
        else
            refuse_rays();
    }
    void walk(VirtualQuery<PointProbe<T, D>>& query, Visits& count) const override {
        index_.ask(query, count);
    }
    void walk(VirtualQuery<BoxProbe<T, D>>& query, Visits& count) const override { index_.ask(query, count); }
    void walk(VirtualQuery<RegionProbe<AnyRegion<T, D>>>& query, Visits& count) const override {
        index_.ask(query, count);
    }
    void visit_outline(const OutlineLimits<D>& limits, CellVisitor<D> visit) const override {
        hedgerow::visit_outline(index_.structure(), limits, visit);
    }

    bool has_facets() const override { return facets; }
    FeatureOfNear<T, D> feature(const Vec<T, D>& point, const Near<T, D>& near) const override {
        if constexpr (facets)
            return hedgerow::feature(index_, point, near);
        else
            refuse_without_facets();
    }
    std::unique_ptr<const AnySolid<T, D>> make_solid(const SolidOptions& options,
                                                     Threads threads) const override {
        if constexpr (facets)
            return std::make_unique<const SolidHolder<S, P>>(index_, options, threads);
        else
            refuse_without_facets();
    }

    bool changes_one_by_one() const override { return one_by_one; }
    bool refittable() const override { return fits_again; }
    bool insert(PrimitiveId id) override {
        Any::forget_solid();
        if constexpr (one_by_one)
            return index_.insert(index_.primitives(), id);
        else
            refuse("insert " + std::to_string(id));
    }
    bool erase(PrimitiveId id) override {
        Any::forget_solid();
        if constexpr (one_by_one)
            return index_.erase(index_.primitives(), id);
        else
            refuse("erase " + std::to_string(id));
    }
    double refit(Threads threads) override {
        Any::forget_solid();
        if constexpr (fits_again) {
            return index_.refit(threads);
        } else {
            static_cast<void>(threads);
            refuse("refit");
        }
    }

private:
    static constexpr bool rays = AnswersProbe<S, RayProbe<T, D>>;
    static constexpr bool facets = FacetSet<P>;
    /// Lists of the other structures share a walk: one for each would take the compiler minutes.
    static constexpr bool is_engine = std::same_as<S, WideBvh<T, D>>;
    template <class R>
    std::size_t list_by(const R& region, std::vector<PrimitiveId>& found, Finds finds) const {
        if constexpr (is_engine)
            return finds == Finds::contained ? hedgerow::contained(index_, region, found)
                                             : hedgerow::overlapping(index_, region, found);
        else
            return Any::list_uncounted(region, found, finds);
    }
    template <class R>
    std::size_t count_by(const R& region) const {
        if constexpr (is_engine)
            return hedgerow::overlap_count(index_, region);
        else
            return Any::count_uncounted(region);
    }
    template <class R>
    bool any_by(const R& region) const {
        if constexpr (is_engine)
            return hedgerow::any_overlap(index_, region);
        else
            return Any::any_uncounted(region);
    }
    static constexpr bool one_by_one = ChangesOneByOne<S, P>;
    static constexpr bool fits_again = Refittable<S, P>;
    [[noreturn]] void refuse_rays() const {
        hedgerow::detail::refuse(name_, "answer rays", "ask it for neighbours, or take another structure");
    }
    [[noreturn]] static void refuse_without_facets() {
        throw InputError("features and insides are those of triangles in space or segments in the plane");
    }
    [[noreturn]] void refuse(const std::string& wanted) const {
        hedgerow::detail::refuse(name_, wanted, "build it again");
    }

    std::string name_;
    Index<S, P> index_;
};

template <class View>
std::unique_ptr<AnyIndex<typename View::Scalar, View::dimension>> build_any_over(std::string_view spec,
                                                                                 const View& primitives,
                                                                                 Executor& executor) {
    using T = typename View::Scalar;
    constexpr int D = View::dimension;
    // Split the specification into name and options.
    const auto colon = spec.find(':');
    const std::string_view wanted = spec.substr(0, colon);
    OptionReader in(wanted, colon == std::string_view::npos ? std::string_view() : spec.substr(colon + 1));
    const auto type = wanted == "bvh" && in.differs("volume", "box") ? bvh_of_volumes : wanted;
    // Build the structure of that name.
    std::unique_ptr<AnyIndex<T, D>> built;
    std::vector<std::string_view> known;
    for_each_structure<D>([&]<template <class, int> class S>(std::string_view name, std::string_view) {
        if (name != bvh_of_volumes) known.push_back(name);
        if (name != type) return;
        typename S<T, D>::Options options;
        list_options<S<T, D>>(options, in);
        in.finish();
        if constexpr (Structure<S<T, D>, View>)
            built = std::make_unique<Holder<S<T, D>, View>>(
                std::string(spec), Index<S<T, D>, View>(primitives, options, executor));
        else
            throw UsageError("structure '" + std::string(wanted) + "' holds points alone");
    });
    // Refuse an octree in the plane, a quadtree in space, and names that are not in the list.
    if (const auto here = name_in<D>(wanted); !built && !here.empty())
        throw UsageError("structure '" + std::string(wanted) + "' holds what lies in " +
                         (D == 2 ? "space" : "the plane") + ": in " + (D == 2 ? "the plane" : "space") +
                         " use '" + std::string(here) + "'");
    if (!built)
        throw UsageError("no structure is called '" + std::string(wanted) + "'" + suggestion(wanted, known) +
                         "; there are " + choices(known));
    return built;
}

}  // namespace hedgerow::detail

namespace hedgerow {

template <std::floating_point T>
std::unique_ptr<AnyIndex<T, 3>> any_index(Index<WideBvh<T, 3>, TriangleMeshView<T>> index) {
    return std::make_unique<detail::Holder<WideBvh<T, 3>, TriangleMeshView<T>>>("wide", std::move(index));
}

template <std::floating_point T, int D>
std::unique_ptr<AnyIndex<T, D>> any_index(Index<WideBvh<T, D>, PointCloudView<T, D>> index) {
    return std::make_unique<detail::Holder<WideBvh<T, D>, PointCloudView<T, D>>>("wide", std::move(index));
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
