/// One ray against instances: it walks the tree of instances, and for the instances of a leaf the trees of
/// their triangles.
#if defined(HEDGEROW_ENGINE_INSTANCES_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef HEDGEROW_ENGINE_INSTANCES_INL_H
#undef HEDGEROW_ENGINE_INSTANCES_INL_H
#else
#define HEDGEROW_ENGINE_INSTANCES_INL_H
#endif

#include <bit>
#include <cmath>
#include <cstddef>

#include <hwy/highway.h>

#include <hedgerow/instances/placed_index.h>

#include "single-inl.h"
#include "width-inl.h"

HWY_BEFORE_NAMESPACE();
namespace hedgerow::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

using Floats4 = hn::FixedTag<float, 4>;

// Transforms a point or a direction from the world into an instance's space, as PlacedIndex::inside does:
// each component is computed in double and rounded once. The fourth lane is of no use.
template <bool is_point>
HWY_INLINE hn::Vec<Floats4> way_back(const WideInstance& placed, const double (&v)[3]) {
    constexpr hn::CappedTag<double, 4> d;
    constexpr hn::Rebind<float, hn::CappedTag<double, 4>> narrow;
    constexpr std::size_t lanes = hn::MaxLanes(d);
    static_assert(offsetof(WideInstance, back) == 0);
    const double* const columns = reinterpret_cast<const double*>(&placed);
    // The components from `at` on: the columns times v, and for a point the shift.
    const auto part = [&](std::size_t at) {
        // The lane after the third component loads the next column, or what is no number. Zero it.
        const auto column = [&](std::size_t c) {
            return hn::IfThenElseZero(hn::FirstN(d, 3 - at), hn::LoadU(d, columns + 3 * c + at));
        };
        auto sum = hn::Mul(column(0), hn::Set(d, v[0]));
        for (std::size_t c = 1; c < 3; ++c) sum = hn::Add(sum, hn::Mul(column(c), hn::Set(d, v[c])));
        if constexpr (is_point) sum = hn::Add(sum, column(3));
        return hn::DemoteTo(narrow, sum);
    };
    // Four doubles fit in one vector, or take two.
    if constexpr (lanes == 4)
        return part(0);
    else
        return hn::Combine(Floats4(), part(2), part(0));
}

// The float before t > 0. For t = 0 it returns -1, since no t >= 0 is less.
HWY_INLINE float just_below(float t) {
    return t > 0 ? std::bit_cast<float>(std::bit_cast<std::uint32_t>(t) - 1) : -1.0f;
}

template <Wanted wanted>
class InstanceLeaves {
public:
    HWY_INLINE InstanceLeaves(const WideInstances& scene, const Ray<float, 3>& asked, WideRay& ray)
        : scene_(scene), ray_(ray) {
        for (int k = 0; k < 3; ++k) {  // subnormal directions count as 0, as in RayProbe
            const float d = asked.direction[k];
            origin_[k] = static_cast<double>(asked.origin[k]);
            direction_[k] = std::abs(d) < std::numeric_limits<float>::min() ? 0.0 : static_cast<double>(d);
        }
    }
    /// Tests the instances of a leaf. True if the ray hits one of them.
    bool test(std::uint32_t leaf) {
        const PrimitiveId* const ids = scene_.tree.items.data() + std::size_t(wide_leaf_size) * leaf;
        bool found = false;
        for (std::uint32_t i = 0; i < wide_leaf_size && ids[i] != no_primitive; ++i) {
            const HitFilter& filter = scene_.filter;
            if (filter.enters != nullptr && !filter.enters(filter.filter, scene_.all[ids[i]].mask)) continue;
            if (!look_into(ids[i])) continue;
            if constexpr (wanted == Wanted::any) return true;
            found = true;
        }
        if (found) ray_.s_limit = s_limit_of(ray_.t_limit, ray_.z_length);
        return found;
    }
    HWY_INLINE Hit<float> hit() const {
        return ray_.element == Hit<float>::none ? Hit<float>() : hit_of(inside(nearest_), ray_);
    }

private:
    HWY_INLINE WideScene inside(std::uint32_t instance) const {
        const WideInstance& placed = scene_.all[instance];
        return {*placed.tree, placed.triangles->data(), *placed.faces, scene_.filter, 0,
                instance,     placed.geometry};
    }
    /// Searches an instance for a hit. Equal t goes to the lowest instance, so an instance after the nearest
    /// so far has to be nearer.
    HWY_INLINE bool look_into(std::uint32_t instance) {
        const bool only_nearer = ray_.element != Hit<float>::none && instance > nearest_;
        const float limit = only_nearer ? just_below(ray_.t_limit) : ray_.t_limit;
        const WideScene scene = inside(instance);
        WideRay ray;
        const bool hit = by_width<Inside>(scene, this, instance, limit, &ray);
        if (!hit) return false;
        ray_.t_limit = ray.t_limit;
        ray_.u = ray.u, ray_.v = ray.v;
        ray_.element = ray.element;
        nearest_ = instance;
        return true;
    }
    template <int W>
    struct Inside {
        static HWY_INLINE bool answer(const WideScene& scene, const InstanceLeaves* leaves,
                                      std::uint32_t instance, float limit, WideRay* ray) {
            const WideInstance& placed = leaves->scene_.all[instance];
            prepare<W>(way_back<true>(placed, leaves->origin_), way_back<false>(placed, leaves->direction_),
                       leaves->ray_.t_min, limit, scene.tree.bounds, 0.0f, *ray);
            // PlacedIndex::inside drops directions below the same bound. An index that has since been moved
            // from has no tree.
            if (!ray->usable || ray->z_length < shortest_direction<float> || scene.tree.empty()) return false;
            return trace_one<W, wanted>(scene, *ray);
        }
    };

    const WideInstances& scene_;
    WideRay& ray_;
    double origin_[3], direction_[3];
    std::uint32_t nearest_ = 0;
};

template <int W, Wanted wanted>
HWY_INLINE auto cast_one_among_instances(const WideInstances& scene, const Ray<float, 3>& asked) {
    WideRay ray;
    prepare<W>(reinterpret_cast<const std::byte*>(&asked), scene.tree.bounds, scene.error, ray);
    InstanceLeaves<wanted> leaves(scene, asked, ray);
    const auto test = [&](std::uint32_t leaf) { return leaves.test(leaf); };
    const bool hit = ray.usable && !scene.tree.empty() &&
                     walk<W, wanted>(scene.tree, RayAsker<W, decltype(test)>(ray, test));
    if constexpr (wanted == Wanted::closest)
        return leaves.hit();
    else
        return hit;
}

}  // namespace hedgerow::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
