/// Packets: 64 rays that go the same way. Intervals of the numbers that slabs are computed from give the
/// children that any ray may enter, once for all rays (Boulos, Wald, Benthin, RT 2008; Reshetov, Soupikov,
/// Hurley, SIGGRAPH 2005). When such a child is popped, its box is tested with each ray. It is opened if a
/// ray enters it; if it is a leaf, the rays that enter it are tested.
#if defined(HEDGEROW_ENGINE_PACKET_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef HEDGEROW_ENGINE_PACKET_INL_H
#undef HEDGEROW_ENGINE_PACKET_INL_H
#else
#define HEDGEROW_ENGINE_PACKET_INL_H
#endif

#include <bit>

#include <hwy/highway.h>

#include "packet_hits-inl.h"
#include "prefetch-inl.h"
#include "stack-inl.h"

HWY_BEFORE_NAMESPACE();
namespace hedgerow::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

template <int W, Wanted wanted>
class Packet {
public:
    static constexpr int size = PacketRays::size;

    explicit Packet(const WideScene& scene) : scene_(scene), prefetch_(scene) {}

    /// Reads rays: see PacketRays::look.
    HWY_INLINE std::uint32_t look(const RayArray<float, 3>& rays, std::size_t first, std::size_t row) {
        return rays_.look(rays, first, row);
    }
    const PacketRays& rays() const { return rays_; }
    PacketHits<wanted>& hits() { return rays_; }
    /// Answers the rays that go this way.
    template <class Answer>
    HWY_INLINE void answer(std::uint32_t way, Answer* answers) {
        rays_.prepare(way, scene_.tree.bounds);
        rays_.clear_hits();
        trace([&](Stack & stack) __attribute__((always_inline)) { open_root(stack); });
        for (int row = 0; row < size; row += static_cast<int>(block_side)) {
            Answer* const to = answers + rays_.number(row);
            for (int c = 0; c < static_cast<int>(block_side); ++c)
                if (rays_.ways[row + c] == way) to[c] = answer_of<Answer>(row + c);
        }
    }

    /// The walk of prepared rays. `start(stack)` opens the root, or pushes up to `most` children to begin
    /// with, the nearest last, each as the place in its node (node · W + child).
    using Stack = WalkStack<W, wanted>;
    template <int most = 0, class Start>
    HWY_INLINE void trace(Start start) {
        for (int k = 0; k < 3; ++k) near_row_[k] = static_cast<std::size_t>(2 * k + rays_.down[k]) * 4 * W;
        constexpr int room = Stack::room(bvh_max_depth + 1) + most;
        typename Stack::Place places[room];
        Stack stack(places, 0, 0);
        stack.clear();
        start(stack);
        for (std::uint32_t place = stack.pop(); place != Stack::end; place = stack.pop()) {
            // The popped child, and the box that bounds it.
            const std::byte* const node = scene_.tree.nodes.at(place / W);
            const int child = static_cast<int>(place % W);
            const std::uint32_t word = children_of<W>(node)[child];
            const bool is_leaf = (word & WideChild::leaf_bit) != 0;
            // Skip the child if no ray enters it.
            const std::uint64_t active = entering(node, child);
            ++counts_.boxes;
            if (active == 0) continue;
            counts_.rays += static_cast<std::size_t>(std::popcount(active));
            // An inner node: push its children.
            if (!is_leaf) {
                open(stack, word);
                continue;
            }
            ++counts_.visits;
            // A leaf: test the rays that enter it. After a hit, drop children beyond the greatest limit, or
            // end where all rays have their answers.
            if (!rays_.test_leaf(scene_, scene_.blocks[word & ~WideChild::leaf_bit], active)) continue;
            rays_.take_last();
            if constexpr (wanted == Wanted::closest)
                stack.sweep(rays_.s_last);
            else if (rays_.s_last < 0)
                return;
        }
    }
    HWY_INLINE void open_root(Stack& stack) { open(stack, 0); }

    /// Boxes that were tested since the last `count_anew`, rays that entered them, and nodes and leaves that
    /// were opened.
    struct Counts {
        std::size_t boxes = 0, rays = 0, visits = 0;
    };
    const Counts& counts() const { return counts_; }
    void count_anew() { counts_ = {}; }

private:
    using Rays = PacketHits<wanted>;
    using V = PacketRays::V;
    using M = PacketRays::M;
    static constexpr PacketRays::F f{};

    template <class Answer>
    HWY_INLINE Answer answer_of(int i) const {
        if constexpr (wanted == Wanted::any)
            return rays_.element[i] != Hit<float>::none;
        else
            return hit_of(scene_, rays_.t_limit[i], rays_.u[i], rays_.v[i], rays_.element[i]);
    }

    /// The children that some ray may enter, and for each the s at which, by the intervals, the first ray
    /// does.
    HWY_INLINE Boxes<W> boxes_of(const std::byte* node) const {
        using B = Floats<W>;
        constexpr B b;
        Boxes<W> boxes;
        for (int p = 0; p < Boxes<W>::parts; ++p) {
            hn::Vec<B> near_s[3], far_s[3];
            for (int k = 0; k < 3; ++k) {
                near_s[k] = rays_.earliest(b, k, row_of<W>(node, near_row_[k], p));
                far_s[k] = rays_.latest(b, k, row_of<W>(node, near_row_[k] ^ (4 * W), p));
            }
            boxes.entry[p] =
                hn::Max(hn::Max(near_s[0], near_s[1]), hn::Max(near_s[2], hn::Set(b, rays_.s_first)));
            boxes.entered[p] = hn::Le(boxes.entry[p], hn::Min(hn::Min(far_s[0], far_s[1]),
                                                              hn::Min(far_s[2], hn::Set(b, rays_.s_last))));
        }
        return boxes;
    }
    /// Which rays enter child i of a node, a bit each.
    HWY_INLINE std::uint64_t entering(const std::byte* node, int i) const {
        std::uint64_t active = 0;
        for (int at = 0; at < size; at += PacketRays::lanes) {
            V near_s[3], far_s[3];
            for (int k = 0; k < 3; ++k) {
                const float* const near_row = reinterpret_cast<const float*>(node + near_row_[k]);
                const float* const far_row = reinterpret_cast<const float*>(node + (near_row_[k] ^ (4 * W)));
                const V inverse = hn::Load(f, rays_.inverse[k] + at);
                near_s[k] = hn::MulSub(hn::Set(f, near_row[i]), inverse, hn::Load(f, rays_.enter_at[k] + at));
                far_s[k] = hn::MulSub(hn::Set(f, far_row[i]), inverse, hn::Load(f, rays_.leave_at[k] + at));
            }
            const M entered = hn::Le(
                hn::Max(hn::Max(near_s[0], near_s[1]), hn::Max(near_s[2], hn::Load(f, rays_.s_min + at))),
                hn::Min(hn::Min(far_s[0], far_s[1]), hn::Min(far_s[2], hn::Load(f, rays_.s_limit + at))));
            active |= std::uint64_t(bits_of(f, entered)) << at;
        }
        return active;
    }

    /// Pushes the children of a node that some ray may enter. The stack stores the node and the child's
    /// place in it, not the child, so that the child's box is found at the pop.
    HWY_INLINE void open(Stack& stack, std::uint32_t number) {
        ++counts_.visits;
        const std::byte* const node = scene_.tree.nodes.at(number);
        const Boxes<W> boxes = boxes_of(node);
        for (unsigned left = boxes.bits(); left != 0; left &= left - 1)
            prefetch_(children_of<W>(node)[std::countr_zero(left)]);
        alignas(64) std::uint32_t places[W];
        for (std::uint32_t i = 0; i < W; ++i) places[i] = number * W + i;
        stack.push(boxes, places);
    }
    const WideScene& scene_;
    const Prefetch<W> prefetch_;
    Rays rays_;
    std::size_t near_row_[3];
    Counts counts_;
};

}  // namespace hedgerow::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
