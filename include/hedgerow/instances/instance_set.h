/// Two-level scenes: indexes, each placed by a transform, as the primitives of another index.
#pragma once

#include <initializer_list>
#include <span>
#include <vector>

#include <hedgerow/instances/placed_index.h>
#include <hedgerow/queries/filter.h>
#include <hedgerow/walks/engine.h>

namespace hedgerow {

namespace detail {
/// A query of the world, inside an object's index. Passes candidates on to the world's query, with the
/// instance's number. Of points and boxes the object's structure only finds the primitives; their shapes in
/// the world are tested (Placed).
template <class Q, class InnerProbe>
class Inside {
public:
    using Probe = InnerProbe;
    using T = typename Probe::Scalar;
    static constexpr Order order = Q::order;

    Inside(const Probe& probe, std::uint32_t instance, Q& query)
        : probe_(probe), query_(query), instance_(instance) {}

    const Probe& probe() const { return probe_; }
    const typename Q::Probe& world() const { return std::as_const(query_).probe(); }
    T limit() const { return query_.limit(); }
    bool done() const { return hedgerow::done(query_); }
    Flow offer(CandidateOf<Probe> c) {
        c.instance = instance_;
        return flow_ = query_.offer(c);
    }
    Flow flow() const { return flow_; }

private:
    Probe probe_;
    Q& query_;
    std::uint32_t instance_;
    Flow flow_ = Flow::go_on;
};
template <class I, class Q>
class RayInside : public Inside<Q, RayProbe<typename I::Scalar, I::dimension>> {
public:
    using T = typename I::Scalar;
    using Base = Inside<Q, RayProbe<T, I::dimension>>;

    RayInside(const PlacedIndex<I>& placed, std::uint32_t instance, const typename Q::Probe& asked, Q& query)
        : Base({placed.inside(asked.ray()), placed.index().bounds()}, instance, query) {}

    bool done() const { return !this->probe().usable() || Base::done(); }
};
template <class I, class Q>
class PointInside : public Inside<Q, PointProbe<typename I::Scalar, I::dimension>> {
public:
    using T = typename I::Scalar;
    using Base = Inside<Q, PointProbe<T, I::dimension>>;
    using Ball = typename PlacedIndex<I>::Ball;

    PointInside(const Ball& ball, std::uint32_t instance, Q& query)
        : Base(PointProbe<T, I::dimension>(ball.center()), instance, query), ball_(ball) {}

    /// The squared radius in the object's space. Computed again when the world's limit has shrunk.
    T limit() const {
        if (const T world = Base::limit(); world != world_limit_) {
            world_limit_ = world;
            limit_ = ball_.radius2(world);
        }
        return limit_;
    }

private:
    Ball ball_;
    mutable T world_limit_ = std::numeric_limits<T>::quiet_NaN(), limit_ = T(0);
};

}  // namespace detail

/// A view of an InstanceSet. Nothing is copied.
template <class I>
class InstanceSetView {
public:
    using Scalar = typename I::Scalar;
    static constexpr int dimension = I::dimension;
    static constexpr bool instanced = true;
    using T = Scalar;
    static constexpr int D = dimension;

    using ForKernels = typename InstanceForEngine<I>::Instance;

    InstanceSetView() = default;
    InstanceSetView(std::span<const PlacedIndex<I>> all, const ForKernels* for_kernels, double error,
                    double error_by_origin)
        : all_(all), for_kernels_(for_kernels), error_(error), error_by_origin_(error_by_origin) {}

    std::size_t size() const { return all_.size(); }
    Box<T, D> bounds(std::size_t i) const { return all_[i].bounds(); }
    const PlacedIndex<I>& operator[](std::size_t i) const { return all_[i]; }
    /// All instances in the form that the kernels read.
    const ForKernels* for_kernels() const { return for_kernels_; }
    /// Whether each candidate is offered once: false if the structure of any instance holds primitives in
    /// several cells, and so offers them several times. O(instances).
    bool offers_once() const {
        return std::all_of(all_.begin(), all_.end(),
                           [](const auto& placed) { return placed.index().exclusive(); });
    }
    /// The id that a hit reports for an element of an instance.
    std::uint32_t id(PrimitiveId element, std::uint32_t instance) const {
        return reported_id(all_[instance].index().primitives(), element, 0);
    }
    std::uint32_t geometry(std::uint32_t instance) const { return all_[instance].geometry(); }
    /// How much farther than RayProbe's slack a hit may lie from the box of its instance: a bound for all
    /// instances (PlacedIndex).
    T hit_error(const Ray<T, D>& ray) const {
        const double origin = max_component(abs(Vec<double, D>(ray.origin)));
        const double direction = max_component(abs(Vec<double, D>(ray.direction)));
        const double steps = 64 * static_cast<double>(std::numeric_limits<T>::denorm_min());
        const double by_origin =
            error_by_origin_ * (origin + (steps / static_cast<double>(unit_roundoff<T>)) * (1 + direction));
        return static_cast<T>(
            std::min((error_ + by_origin) * (1 + 0x1p-20), static_cast<double>(largest_coordinate<T>)));
    }

    template <class Q>
    Flow test_leaf(const RayProbe<T, D>& probe, const Leaf& leaf, Q& query) const {
        for (std::uint32_t i = leaf.first; i < leaf.first + leaf.count; ++i) {
            const PlacedIndex<I>& placed = all_[leaf.ids[i]];
            if (!lets_in(placed, query)) continue;
            if (ask_inside(placed, leaf.ids[i], probe, query) == Flow::stop) return Flow::stop;
        }
        return Flow::go_on;
    }
    template <class Q>
    Flow test_leaf(const PointProbe<T, D>& probe, const Leaf& leaf, Q& query) const {
        for (std::uint32_t i = leaf.first; i < leaf.first + leaf.count; ++i) {
            const PlacedIndex<I>& placed = all_[leaf.ids[i]];
            if (!lets_in(placed, query)) continue;
            const typename PlacedIndex<I>::Ball ball(placed, probe.point());
            if (walk(placed, detail::PointInside<I, Q>(ball, leaf.ids[i], query)) == Flow::stop)
                return Flow::stop;
        }
        return Flow::go_on;
    }
    /// Inside of an instance, a box around the region's part there finds the primitives.
    template <Region R, class Q>
    Flow test_leaf(const RegionProbe<R>& probe, const Leaf& leaf, Q& query) const {
        using Inside = detail::Inside<Q, BoxProbe<T, D>>;
        for (std::uint32_t i = leaf.first; i < leaf.first + leaf.count; ++i) {
            const PlacedIndex<I>& placed = all_[leaf.ids[i]];
            const Box<T, D> box = placed.inside(probe.region());
            if (box.empty()) continue;
            if (walk(placed, Inside(BoxProbe<T, D>(box), leaf.ids[i], query)) == Flow::stop)
                return Flow::stop;
        }
        return Flow::go_on;
    }

private:
    /// Whether the query's mask lets it into an instance.
    template <class Q>
    static bool lets_in(const PlacedIndex<I>& placed, const Q& query) {
        if constexpr (requires { query.enters(placed.mask()); })
            return query.enters(placed.mask());
        else
            return true;
    }
    /// Queries one instance by a ray. An engine, if there is one for the index, offers only the one candidate
    /// that the query needs.
    template <class Q>
    static Flow ask_inside(const PlacedIndex<I>& placed, std::uint32_t instance, const RayProbe<T, D>& probe,
                           Q& query) {
        if constexpr (AnswersInside<EngineFor<Q, I>, Ray<T, D>, Q>)
            if (const EngineFor<Q, I> engine(placed.index()); engine)
                return engine.offer_inside(placed.inside(probe.ray()), instance, placed.geometry(), query);
        detail::RayInside<I, Q> inside(placed, instance, probe, query);
        placed.index().ask(inside);
        return inside.flow();
    }
    template <class Inside>
    static Flow walk(const PlacedIndex<I>& placed, Inside inside) {
        placed.index().ask_over(placed.primitives(), inside);
        return inside.flow();
    }

    std::span<const PlacedIndex<I>> all_;
    const ForKernels* for_kernels_ = nullptr;
    double error_ = 0, error_by_origin_ = 0;
};

/// Instances as primitives: `build<Bvh>(InstanceSet{...})` is a BVH whose leaves are grids, if the indexes
/// are grids. Any structure can hold instances of indexes of any structure. All indexes of one set are of one
/// type; those of an InstanceSet<AnyIndex> (any_index.h) may be of any structures and primitives, but rays
/// need structures that answer them.
///
///   const auto grid = build<Grid>(mesh);
///   const InstanceSet scene{Instance(grid), Instance(grid, Transform<3>::translation({4, 0, 0}))};
///   const auto index = build<Bvh>(scene);
///
/// A hit is found by testing the ray in the object's space. It names the instance and the element of the
/// instance's index, and equal t goes to the lowest (instance, element). A ray hits nothing in an object if
/// its direction is shorter than `shortest_direction` (2^-98, in double 2^-965) in the object's space.
/// Closest points and overlaps are those of the primitives' shapes in the world, with corners transformed and
/// rounded to T, so they are right under any transform. Spheres and primitives of your own types have such
/// shapes only under similarities (placed.h). Visits count an instance as one primitive, and nothing inside
/// it.
///
/// Rays against instances of float triangles in a WideBvh are answered by the kernels (engine/kernels.h),
/// whatever structure holds the instances. If that structure is a WideBvh too, the kernels walk both levels.
///
/// Memory: about 600 bytes an instance in space, and 128 more if there are kernels for its index.
template <class I>
class InstanceSet {
public:
    using Scalar = typename I::Scalar;
    static constexpr int dimension = I::dimension;
    static_assert(!Instanced<typename I::Primitives>, "two levels: an instance is of an index of primitives");

    /// The indexes are borrowed and must outlive the set. Throws InputError for an index that holds nothing.
    explicit InstanceSet(std::span<const Instance<I>> instances) {
        for (const auto& instance : instances) {
            if (instance.index->bounds().empty())
                throw InputError("instance " + std::to_string(placed_.size()) +
                                 " is of an index that holds no primitives: leave it out");
            placed_.emplace_back(instance);
            error_ = std::max(error_, placed_.back().ray_error());
            error_by_origin_ = std::max(error_by_origin_, placed_.back().ray_error_by_origin());
            if constexpr (requires { &InstanceForEngine<I>::of; })
                for_kernels_.push_back(InstanceForEngine<I>::of(*instance.index, instance.transform.back(),
                                                                instance.mask, instance.geometry));
        }
    }
    explicit InstanceSet(const std::vector<Instance<I>>& instances) : InstanceSet(std::span(instances)) {}
    InstanceSet(std::initializer_list<Instance<I>> instances)
        : InstanceSet(std::span(instances.begin(), instances.size())) {}

    std::size_t size() const { return placed_.size(); }
    InstanceSetView<I> view() const { return {placed_, for_kernels_.data(), error_, error_by_origin_}; }

private:
    std::vector<PlacedIndex<I>> placed_;
    std::vector<typename InstanceForEngine<I>::Instance> for_kernels_;
    double error_ = 0, error_by_origin_ = 0;
};

}  // namespace hedgerow
