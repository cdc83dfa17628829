/// Bundles: 64 rays that go all ways, for any hit. They share the walk, not the direction: the boxes of a
/// node are tested with all rays that are there, as long as many are. Such rays are bounded by their length
/// alone (rays for ambient light start near each other and end soon), so a child is passed over for all of
/// them where its box lies outside of the box around the rays from their origins to their ends.
#if defined(HEDGEROW_ENGINE_BUNDLE_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef HEDGEROW_ENGINE_BUNDLE_INL_H
#undef HEDGEROW_ENGINE_BUNDLE_INL_H
#else
#define HEDGEROW_ENGINE_BUNDLE_INL_H
#endif

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

#include <hwy/highway.h>

#include <hedgerow/structures/bvh/build_tree.h>

#include "packet_rays-inl.h"
#include "prefetch-inl.h"
#include "reader-inl.h"
#include "tests-inl.h"

HWY_BEFORE_NAMESPACE();
namespace hedgerow::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

template <int W>
class Bundle {
public:
    explicit Bundle(const WideScene& scene) : scene_(scene), prefetch_(scene) {}

    /// Answers the rays that `looked` has read from `rays`, whatever their ways.
    HWY_NOINLINE void answer(const PacketRays& looked, const RayArray<float, 3>& rays, bool* answers) {
        RayReader asked(rays);
        for (int i = 0; i < size; ++i) take(i, asked.at(looked.number(i)));
        take_reach(looked);
        trace(looked);
        for (int i = 0; i < size; ++i) answers[looked.number(i)] = ray_[i].element != Hit<float>::none;
    }

    /// Nodes that were opened since the last `count_anew`, and rays that entered them.
    struct Counts {
        std::size_t boxes = 0, rays = 0;
    };
    const Counts& counts() const { return counts_; }
    void count_anew() { counts_ = {}; }

private:
    static constexpr int size = PacketRays::size, lanes = PacketRays::lanes;
    /// So few rays or fewer are tested one by one, each with all boxes of a node.
    static constexpr int few = 20;
    using V = PacketRays::V;
    static constexpr PacketRays::F f{};

    /// Prepares a ray, and copies what the test of boxes needs.
    HWY_INLINE void take(int i, const std::byte* ray_at) {
        WideRay& ray = ray_[i];
        prepare<W>(ray_at, scene_.tree.bounds, 0.0f, ray);
        for (int k = 0; k < 3; ++k) {
            inverse_[k][i] = ray.inverse[k];
            enter_at_[k][i] = ray.enter_at[k], leave_at_[k][i] = ray.leave_at[k];
        }
        s_min_[i] = ray.s_min, s_limit_[i] = ray.s_limit;
    }
    /// Computes the box around all rays, in the scene. It is wider than they are by twice the error e of
    /// RayProbe: once for the test of triangles, and more than what is rounded here.
    HWY_INLINE void take_reach(const PacketRays& looked) {
        const Box<float, 3>& scene = scene_.tree.bounds;
        Box<float, 3> origins;
        for (int k = 0; k < 3; ++k) {
            V least = hn::Set(f, std::numeric_limits<float>::infinity()), most = hn::Neg(least);
            V first = least, last = most;  // of the origins
            for (int p = 0; p < PacketRays::parts; ++p) {
                const V origin = hn::Load(f, looked.numbers[p][k]);
                const V direction = hn::Load(f, looked.numbers[p][3 + k]);
                const V way = hn::IfThenZeroElse(hn::Eq(direction, hn::Zero(f)),
                                                 hn::Mul(direction, hn::Load(f, looked.numbers[p][7])));
                const V end = hn::Add(origin, way);
                first = hn::Min(first, origin), last = hn::Max(last, origin);
                least = hn::Min(least, end), most = hn::Max(most, end);
            }
            origins.low[k] = hn::GetLane(hn::MinOfLanes(f, first));
            origins.high[k] = hn::GetLane(hn::MaxOfLanes(f, last));
            reach_.low[k] = hn::GetLane(hn::MinOfLanes(f, hn::Min(first, least)));
            reach_.high[k] = hn::GetLane(hn::MaxOfLanes(f, hn::Max(last, most)));
        }
        float reach = 0, far_off = 0;
        for (int k = 0; k < 3; ++k) {
            reach = std::max({reach, scene.high[k] - origins.low[k], origins.high[k] - scene.low[k]});
            far_off = std::max({far_off, std::abs(origins.low[k]), std::abs(origins.high[k])});
        }
        constexpr hn::CappedTag<float, 1> one;
        const float e =
            hn::GetLane(slack_of(one, hn::Set(one, reach), hn::Set(one, far_off), hn::Set(one, underflow)));
        for (int k = 0; k < 3; ++k) {
            reach_.low[k] = std::max(reach_.low[k] - 2 * e, scene.low[k]);
            reach_.high[k] = std::min(reach_.high[k] + 2 * e, scene.high[k]);
        }
    }

    /// The children whose boxes overlap the box around all rays, a bit each. None is an empty place.
    HWY_INLINE unsigned within_reach(const std::byte* node) const {
        using B = Boxes<W>;
        unsigned all = 0;
        for (int p = 0; p < B::parts; ++p) {
            auto overlap = hn::Eq(hn::Zero(B::f), hn::Zero(B::f));
            for (std::size_t k = 0; k < 3; ++k) {
                const auto low = row_of<W>(node, 2 * k * 4 * W, p),
                           high = row_of<W>(node, (2 * k + 1) * 4 * W, p);
                overlap = hn::And(overlap, hn::And(hn::Le(low, hn::Set(B::f, reach_.high[int(k)])),
                                                   hn::Ge(high, hn::Set(B::f, reach_.low[int(k)]))));
            }
            all |= bits_of(B::f, overlap) << (p * B::lanes);
        }
        return all;
    }
    /// Which of the active rays enter child i of a node, a bit each.
    HWY_INLINE std::uint64_t entering(const std::byte* node, int i, std::uint64_t active) const {
        constexpr std::uint64_t every = (std::uint64_t(1) << lanes) - 1;
        const float* const planes = reinterpret_cast<const float*>(node) + i;
        std::uint64_t entered = 0;
        for (int at = 0; at < size; at += lanes) {
            if ((active >> at & every) == 0) continue;
            V entry = hn::Load(f, s_min_ + at), exit = hn::Load(f, s_limit_ + at);
            for (int k = 0; k < 3; ++k) {
                const V inverse = hn::Load(f, inverse_[k] + at);
                const V a = hn::Mul(hn::Set(f, planes[2 * k * W]), inverse);
                const V b = hn::Mul(hn::Set(f, planes[(2 * k + 1) * W]), inverse);
                entry = hn::Max(entry, hn::Sub(hn::Min(a, b), hn::Load(f, enter_at_[k] + at)));
                exit = hn::Min(exit, hn::Sub(hn::Max(a, b), hn::Load(f, leave_at_[k] + at)));
            }
            entered |= std::uint64_t(bits_of(f, hn::Le(entry, exit))) << at;
        }
        return entered & active;
    }

    /// A child that waits, and the rays that enter it.
    struct Place {
        std::uint64_t active;
        std::uint32_t word;
    };
    /// Opens a node: pushes the children that active rays enter. The last child comes on top, as in
    /// `WalkStack::push` for any hit.
    HWY_INLINE Place* open(Place* top, std::uint32_t number, std::uint64_t active) {
        const std::byte* const node = scene_.tree.nodes.at(number);
        const std::uint32_t* const children = children_of<W>(node);
        const int count = std::popcount(active);
        ++counts_.boxes, counts_.rays += static_cast<std::size_t>(count);
        std::uint64_t entered[W] = {};
        unsigned left = 0;
        if (count <= few) {
            for (; active != 0; active &= active - 1) {
                const int r = std::countr_zero(active);
                unsigned boxes = Boxes<W>(node, Slabs<W>(ray_[r])).bits();
                for (left |= boxes; boxes != 0; boxes &= boxes - 1)
                    entered[std::countr_zero(boxes)] |= std::uint64_t(1) << r;
            }
        } else {
            left = within_reach(node);
            for (unsigned boxes = left; boxes != 0; boxes &= boxes - 1) {
                const int i = std::countr_zero(boxes);
                entered[i] = entering(node, i, active);
            }
        }
        for (; left != 0; left &= left - 1) {
            const int i = std::countr_zero(left);
            *top = {entered[i], children[i]};
            prefetch_(children[i]);
            top += entered[i] != 0;
        }
        return top;
    }
    HWY_INLINE void trace(const PacketRays& looked) {
        Place places[bvh_max_depth * (W - 1) + W + 1];
        Place* top = places;
        *top++ = {~std::uint64_t(0), 0};
        std::uint64_t unanswered = ~std::uint64_t(0);
        while (top != places && unanswered != 0) {
            const Place place = *--top;
            std::uint64_t active = place.active & unanswered;
            if (active == 0) continue;
            if ((place.word & WideChild::leaf_bit) == 0) {
                top = open(top, place.word, active);
                continue;
            }
            for (; active != 0; active &= active - 1) {
                const int i = std::countr_zero(active);
                if (test_triangles<Wanted::any>(scene_, place.word & ~WideChild::leaf_bit, ray_[i],
                                                looked.number(i)))
                    unanswered ^= std::uint64_t(1) << i;
            }
        }
    }

    const WideScene& scene_;
    const Prefetch<W> prefetch_;
    WideRay ray_[size];
    alignas(64) float inverse_[3][size], enter_at_[3][size], leave_at_[3][size], s_min_[size], s_limit_[size];
    Box<float, 3> reach_;
    Counts counts_;
};

}  // namespace hedgerow::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
