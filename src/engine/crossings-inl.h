/// The crossings of a ray along an axis with triangles (queries/signed_crossings.h): floats decide of eight
/// triangles at once whether they are crossed, and those in doubt are tested exactly.
#if defined(HEDGEROW_ENGINE_CROSSINGS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef HEDGEROW_ENGINE_CROSSINGS_INL_H
#undef HEDGEROW_ENGINE_CROSSINGS_INL_H
#else
#define HEDGEROW_ENGINE_CROSSINGS_INL_H
#endif

#include <bit>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>

#include <hwy/highway.h>

#include <hedgerow/engine/kernels.h>

#include "compiled.h"
#include "search-inl.h"

HWY_BEFORE_NAMESPACE();
namespace hedgerow::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

// The boxes that a closed box overlaps, by comparisons alone.
template <int W, class T>
class Overlapped {
public:
    using F = Floats<W>;

    HWY_INLINE explicit Overlapped(const Box<T, 3>& box)
        : low_(all_lanes(d, box.low)), high_(all_lanes(d, box.high)) {}

    HWY_INLINE hn::Mask<F> enter(const std::byte* node, int part, hn::Vec<F>& at) const {
        at = hn::Zero(F());
        if constexpr (std::is_same_v<T, float>) {
            return overlapped(reinterpret_cast<const float*>(node) +
                              part * static_cast<int>(hn::MaxLanes(F())));
        } else {
            const auto apart = in_floats<W, T>(
                node, part, [&](const T* rows) __attribute__((always_inline)) {
                    return hn::IfThenElse(overlapped(rows), hn::Zero(d), hn::Set(d, T(1)));
                });
            return hn::Eq(apart, hn::Zero(F()));
        }
    }

private:
    using D = LanesOf<W, T>;
    static constexpr D d{};

    HWY_INLINE hn::Mask<D> overlapped(const T* rows) const {
        const auto within = [&](int axis, auto low, auto high) __attribute__((always_inline)) {
            return hn::And(hn::Le(hn::Load(d, rows + 2 * axis * W), high),
                           hn::Ge(hn::Load(d, rows + (2 * axis + 1) * W), low));
        };
        return hn::And(hn::And(within(0, low_.x, high_.x), within(1, low_.y, high_.y)),
                       within(2, low_.z, high_.z));
    }

    Coordinates<D> low_, high_;
};

// Which triangles of a block, in the lanes of D, are surely crossed, and which are in doubt.
//
// With the corners' coordinates h along the ray and u, v across it, all from its origin, the ray's line turns
// about an edge as uᵢvⱼ − vᵢuⱼ, and det = Σ hᵢ·(the turn of the edge across from i) has the sign of the turns
// where the line meets the triangle ahead of the origin, and the other sign behind it.
//
// Roundings, with the unit roundoff ε: differences have relative errors of ε, a turn one of 4ε of its
// products' magnitudes to first order, and det one of 8ε of the sum over |hᵢ| times these. The filters take
// twice as much. What underflows is less than the share of `underflow` in these bounds; where products
// overflow, bounds are infinite or NaN, and nothing is sure.
template <class D>
class CrossedTriangles {
public:
    using T = hn::TFromD<D>;
    using V = hn::Vec<D>;
    using Mask = hn::Mask<D>;

    HWY_INLINE CrossedTriangles(D d, const TriangleBlock<T>& block, int at, const RayInBounds<T, 3>& asked) {
        const AxisRay<3>& ray = asked.ray;
        const Vec<T, 3>& origin = asked.origin();
        const auto corner = [&](int c) __attribute__((always_inline)) {
            const auto row = [&](int axis) __attribute__((always_inline)) {
                return hn::Sub(hn::Load(d, block.corner[axis][c] + at), hn::Set(d, origin[axis]));
            };
            return Coordinates<D>{hn::Mul(row(ray.axis), hn::Set(d, static_cast<T>(ray.direction))),
                                  row(ray.u()), row(ray.v())};
        };
        const Coordinates<D> a = corner(0), b = corner(1), c = corner(2);
        const Turn bc(d, b, c), ca(d, c, a), ab(d, a, b);
        const Mask left = hn::And(hn::And(bc.left, ca.left), ab.left);
        const Mask right = hn::And(hn::And(bc.right, ca.right), ab.right);
        const Mask beside =
            hn::And(hn::Or(hn::Or(bc.left, ca.left), ab.left), hn::Or(hn::Or(bc.right, ca.right), ab.right));
        const V det = hn::MulAdd(a.x, bc.sum, hn::MulAdd(b.x, ca.sum, hn::Mul(c.x, ab.sum)));
        const V size = hn::MulAdd(hn::Abs(a.x), bc.size,
                                  hn::MulAdd(hn::Abs(b.x), ca.size, hn::Mul(hn::Abs(c.x), ab.size)));
        const V error = hn::MulAdd(hn::Set(d, 16 * unit_roundoff<T>), size, hn::Set(d, underflow));
        const Mask above = hn::Gt(det, error), below = hn::Lt(det, hn::Neg(error));
        const Mask behind = hn::Lt(hn::Max(hn::Max(a.x, b.x), c.x), hn::Zero(d));
        front = hn::And(left, above), back = hn::And(right, below);
        const Mask missed =
            hn::Or(hn::Or(beside, behind), hn::Or(hn::And(left, below), hn::And(right, above)));
        const Mask there = hn::Eq(a.x, a.x);
        doubtful = hn::AndNot(hn::Or(missed, hn::Or(front, back)), there);
    }

    // Crossed, and counterclockwise (`front`) or clockwise seen against the axis.
    Mask front, back, doubtful;

private:
    static constexpr T underflow = std::is_same_v<T, float> ? T(0x1p-100) : T(0x1p-950L);

    // How the ray's line turns about an edge from p to q, and on which side it surely passes.
    struct Turn {
        V sum, size;
        Mask left, right;

        HWY_INLINE Turn(D d, const Coordinates<D>& p, const Coordinates<D>& q) {
            const V other = hn::Mul(p.z, q.y);
            sum = hn::MulSub(p.y, q.z, other);
            size = hn::Add(hn::MulAdd(hn::Abs(p.y), hn::Abs(q.z), hn::Set(d, underflow)), hn::Abs(other));
            const V error = hn::Mul(hn::Set(d, 8 * unit_roundoff<T>), size);
            left = hn::Gt(sum, error), right = hn::Lt(sum, hn::Neg(error));
        }
    };
};

// The search for what a ray crosses.
template <class S>
class CrossedByRay {
public:
    using Scene = S;
    using T = typename Scene::Scalar;
    static constexpr Wanted wanted = Wanted::any;
    struct Shared {
        const TriangleBlock<T>* blocks;
        bool past_surface;
    };

    CrossedByRay() = default;
    HWY_INLINE CrossedByRay(const RayInBounds<T, 3>& asked, CrossingCount& count)
        : asked_(&asked), count_(&count) {}

    HWY_INLINE bool ended() const { return ended_; }
    template <int W>
    HWY_INLINE auto slabs() const {
        return Overlapped<W, T>(asked_->box);
    }
    template <bool alone>
    HWY_INLINE void test(const Shared& shared, std::uint32_t leaf) {
        using D = hn::CappedTag<T, 8>;
        constexpr D d;
        const TriangleBlock<T>& block = shared.blocks[leaf];
        for (int at = 0; at < 8; at += static_cast<int>(hn::MaxLanes(d))) {
            const CrossedTriangles<D> crossed(d, block, at, *asked_);
            const auto front = hn::CountTrue(d, crossed.front), back = hn::CountTrue(d, crossed.back);
            winding_ += static_cast<int>(front) - static_cast<int>(back);
            crossings_ += static_cast<std::uint32_t>(front + back);
            for (unsigned left = bits_of(d, crossed.doubtful); left != 0; left &= left - 1)
                test_exactly(shared, block, at + std::countr_zero(left));
        }
    }
    HWY_INLINE void end(const Shared&) {
        count_->winding += asked_->ray.direction * winding_;
        count_->crossings += crossings_;
    }

private:
    HWY_NOINLINE void test_exactly(const Shared& shared, const TriangleBlock<T>& block, int place) {
        const AxisCrossing found = detail::crossing_of(asked_->ray, block, place);
        if (found.on) {
            count_->on = true;
            ended_ |= !shared.past_surface;
        } else if (found.sign != 0) {
            count_->add(found.sign);
        }
    }

    const RayInBounds<T, 3>* asked_ = nullptr;
    CrossingCount* count_ = nullptr;
    int winding_ = 0;  // seen along the axis
    std::uint32_t crossings_ = 0;
    bool ended_ = false;
};

template <int W, class Scene, class T>
CrossingCount crossings_of_one(const Scene& scene, const RayInBounds<T, 3>& asked, bool past_surface) {
    using Search = CrossedByRay<Scene>;
    CrossingCount count;
    typename Search::Shared shared{scene.blocks, past_surface};
    Search search(asked, count);
    search_through<W>(scene, search, shared);
    return count;
}
template <int W, class Scene, class T>
void crossings_of_many(const Scene& scene, std::span<const RayInBounds<T, 3>> rays, bool past_surface,
                       CrossingCount* counts) {
    using Search = CrossedByRay<Scene>;
    for (std::size_t i = 0; i < rays.size(); ++i) counts[i] = {};
    if (scene.tree.empty()) return;
    typename Search::Shared shared{scene.blocks, past_surface};
    Flights<W, Search>(scene, shared)
        .make(
            rays.size(), [&](std::size_t i, int)
                             __attribute__((always_inline)) { return Search(rays[i], counts[i]); });
}

}  // namespace hedgerow::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
