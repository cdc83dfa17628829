/// Two-level scenes: indexes, each placed by a transform, as the primitives of another index.
#pragma once

#include <initializer_list>
#include <span>
#include <vector>

#include <hedgerow/primitives/placed_index.h>
#include <hedgerow/queries/filter.h>

namespace hedgerow {

namespace detail {
/// What a query of the world asks of an object: it passes candidates on, with the instance's name.
template <class I, class Q>
class RayInside {
public:
    using Probe = RayProbe<typename I::Scalar, I::dimension>;
    static constexpr Order order = Q::order;

    RayInside(const PlacedIndex<I>& placed, std::uint32_t instance, const typename Q::Probe& asked, Q& query)
        : probe_(placed.inside(asked.ray()), placed.index().bounds()), query_(query), instance_(instance) {}

    const Probe& probe() const { return probe_; }
    typename I::Scalar limit() const { return probe_.usable() ? query_.limit() : typename I::Scalar(-1); }
    Flow offer(RayCandidate<typename I::Scalar> c) {
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

/// The same for regions, where the object's structure only finds the primitives, and the world's shapes are
/// tested.
template <class I, class Q, class InnerProbe>
class RegionInside {
public:
    using Probe = InnerProbe;
    using T = typename I::Scalar;
    static constexpr Order order = Q::order;

    RegionInside(const Probe& probe, std::uint32_t instance, Q& query)
        : probe_(probe), query_(query), instance_(instance) {}

    const Probe& probe() const { return probe_; }
    const typename Q::Probe& world() const { return std::as_const(query_).probe(); }
    T limit() const { return query_.limit(); }
    template <class Candidate>
    Flow offer(Candidate c) {
        c.instance = instance_;
        return flow_ = query_.offer(c);
    }
    Flow flow() const { return flow_; }

protected:
    Probe probe_;
    Q& query_;
    std::uint32_t instance_;
    Flow flow_ = Flow::go_on;
};
template <class I, class Q>
class PointInside : public RegionInside<I, Q, PointProbe<typename I::Scalar, I::dimension>> {
public:
    using T = typename I::Scalar;
    using Base = RegionInside<I, Q, PointProbe<T, I::dimension>>;
    using Ball = typename PlacedIndex<I>::Ball;

    PointInside(const Ball& ball, std::uint32_t instance, Q& query)
        : Base(PointProbe<T, I::dimension>(ball.center()), instance, query), ball_(ball) {}

    /// Worked out anew when the world's limit has shrunk.
    T limit() const {
        if (const T world = this->query_.limit(); world != world_limit_) {
            world_limit_ = world;
            limit_ = world < 0 ? world : ball_.radius2(world);
        }
        return limit_;
    }

private:
    Ball ball_;
    mutable T world_limit_ = std::numeric_limits<T>::quiet_NaN(), limit_ = T(0);
};

/// The filter of a ray query, for kernels that answer a part of it.
template <class Q>
HitFilter filter_of_query(const Q& query) {
    if constexpr (Q::keeps_all) return {};
    return {[](const void* asked, std::size_t, const Hit<float>& hit) {
                return static_cast<const Q*>(asked)->keeps(hit);
            },
            static_cast<const void*>(&query)};
}
}  // namespace detail

/// The same over an InstanceSet, copied nowhere.
template <class I>
class InstanceSetView {
public:
    using Scalar = typename I::Scalar;
    static constexpr int dimension = I::dimension;
    static constexpr bool instanced = true;
    using T = Scalar;
    static constexpr int D = dimension;

    using KernelInstance = typename I::KernelInstance;

    InstanceSetView() = default;
    InstanceSetView(std::span<const PlacedIndex<I>> all, const KernelInstance* for_kernels, double error,
                    double error_by_origin)
        : all_(all), for_kernels_(for_kernels), error_(error), error_by_origin_(error_by_origin) {}

    std::size_t size() const { return all_.size(); }
    Box<T, D> bounds(std::size_t i) const { return all_[i].bounds(); }
    const PlacedIndex<I>& operator[](std::size_t i) const { return all_[i]; }
    /// All, as the kernels know them.
    const KernelInstance* for_kernels() const requires(I::by_kernels) { return for_kernels_; }
    /// An object's structure that holds primitives in several cells offers them several times. O(instances).
    bool offers_once() const {
        return std::all_of(all_.begin(), all_.end(),
                           [](const auto& placed) { return placed.index().structure().exclusive(); });
    }
    /// What a hit on an element of an instance reports as its primitive.
    std::uint32_t id(PrimitiveId element, std::uint32_t instance) const {
        return reported_id(all_[instance].index().primitives(), element, 0);
    }
    std::uint32_t geometry(std::uint32_t instance) const { return all_[instance].geometry(); }
    /// The greatest of all instances' (PlacedIndex).
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
            if constexpr (requires { query.enters(placed.mask()); })
                if (!query.enters(placed.mask())) continue;
            if (ask_inside(placed, leaf.ids[i], probe, query) == Flow::stop) return Flow::stop;
        }
        return Flow::go_on;
    }
    template <class Q>
    Flow test_leaf(const PointProbe<T, D>& probe, const Leaf& leaf, Q& query) const {
        for (std::uint32_t i = leaf.first; i < leaf.first + leaf.count; ++i) {
            const PlacedIndex<I>& placed = all_[leaf.ids[i]];
            const typename PlacedIndex<I>::Ball ball(placed, probe.point());
            if (walk(placed, detail::PointInside<I, Q>(ball, leaf.ids[i], query)) == Flow::stop)
                return Flow::stop;
        }
        return Flow::go_on;
    }
    template <class Q>
    Flow test_leaf(const BoxProbe<T, D>& probe, const Leaf& leaf, Q& query) const {
        using Inside = detail::RegionInside<I, Q, BoxProbe<T, D>>;
        for (std::uint32_t i = leaf.first; i < leaf.first + leaf.count; ++i) {
            const PlacedIndex<I>& placed = all_[leaf.ids[i]];
            const Box<T, D> box = placed.inside(probe.box());
            if (box.empty()) continue;
            if (walk(placed, Inside(BoxProbe<T, D>(box), leaf.ids[i], query)) == Flow::stop)
                return Flow::stop;
        }
        return Flow::go_on;
    }

private:
    /// By the kernels, where they know the index, for the one candidate that the query wants of it.
    template <class Q>
    static Flow ask_inside(const PlacedIndex<I>& placed, std::uint32_t instance, const RayProbe<T, D>& probe,
                           Q& query) {
        if constexpr (I::by_kernels && requires { Q::sought; }) {
            if (const auto* kernels = I::kernels()) {
                const auto scene =
                    placed.index().wide_scene(detail::filter_of_query(query), instance, placed.geometry());
                Ray<T, D> ray = placed.inside(probe.ray());
                ray.t_max = query.limit();
                if constexpr (Q::sought == Sought::any) {
                    return kernels->any_hit(scene, ray) ? query.found() : Flow::go_on;
                } else {
                    const auto hit = kernels->closest_hit(scene, ray);
                    return hit ? query.offer({hit.t, hit.u, hit.v, hit.element, instance}) : Flow::go_on;
                }
            }
        }
        detail::RayInside<I, Q> inside(placed, instance, probe, query);
        placed.index().ask(inside);
        return inside.flow();
    }
    template <class Inside>
    static Flow walk(const PlacedIndex<I>& placed, Inside inside) {
        placed.index().structure().walk(placed.primitives(), inside, uncounted);
        return inside.flow();
    }
    static constexpr NoVisits uncounted{};

    std::span<const PlacedIndex<I>> all_;
    const KernelInstance* for_kernels_ = nullptr;
    double error_ = 0, error_by_origin_ = 0;
};

/// Instances as primitives: `build<Bvh>(InstanceSet{...})` is a BVH whose leaves are grids, if the indexes
/// are grids. Any structure may hold any; all indexes of one set are of one type.
///
///   const auto grid = build<Grid>(mesh);
///   const InstanceSet scene{Instance(grid), Instance(grid, Transform<3>::translation({4, 0, 0}))};
///   const auto index = build<Bvh>(scene);
///
/// A hit is the test of the ray in the object's space; it names the instance and the element of its index,
/// and equal t goes to the lowest (instance, element). A ray whose direction is shorter in that space than
/// `shortest_direction` (2^-98, in double 2^-965) hits nothing there. Closest points and overlaps are those
/// of the primitives' shapes in the world, corners transformed and rounded to T; so they are right under any
/// transform. Spheres and types of one's own have such shapes only under similarities (placed.h). Visits
/// count the instances, not what is looked at inside.
///
/// Rays against instances of triangles of float in a WideBvh go to the kernels
/// (structures/bvh/wide/kernels.h), from any structure; where that is a WideBvh too, on both levels.
///
/// Memory: about 600 bytes an instance in space, and 128 more where the kernels know its index.
template <class I>
class InstanceSet {
public:
    using Scalar = typename I::Scalar;
    static constexpr int dimension = I::dimension;
    static_assert(!Instanced<typename I::Primitives>, "two levels: an instance is of an index of primitives");

    /// Throws InputError for an index that holds nothing.
    explicit InstanceSet(std::span<const Instance<I>> instances) {
        for (const auto& instance : instances) {
            if (instance.index->bounds().empty())
                throw InputError("instance " + std::to_string(placed_.size()) +
                                 " is of an index that holds no primitives: leave it out");
            placed_.emplace_back(instance);
            error_ = std::max(error_, placed_.back().ray_error());
            error_by_origin_ = std::max(error_by_origin_, placed_.back().ray_error_by_origin());
            if constexpr (I::by_kernels)
                for_kernels_.push_back(instance.index->kernel_instance(instance.transform.back(),
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
    std::vector<typename I::KernelInstance> for_kernels_;
    double error_ = 0, error_by_origin_ = 0;
};

}  // namespace hedgerow
