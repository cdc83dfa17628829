/// The distances of a point: to the boxes of a node, and bounds of those to the triangles of a leaf.
#if defined(HEDGEROW_ENGINE_DISTANCES_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef HEDGEROW_ENGINE_DISTANCES_INL_H
#undef HEDGEROW_ENGINE_DISTANCES_INL_H
#else
#define HEDGEROW_ENGINE_DISTANCES_INL_H
#endif

#include <bit>
#include <cstddef>
#include <cstdint>
#include <type_traits>

#include <hwy/highway.h>

#include <hedgerow/engine/kernels.h>

#include "boxes-inl.h"
#include "coordinates-inl.h"

HWY_BEFORE_NAMESPACE();
namespace hedgerow::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

// Lanes of T for as many numbers of a row as a vector of floats takes, or for a half of these.
template <int W, class T>
using LanesOf = hn::CappedTag<T, static_cast<int>(hn::MaxLanes(Floats<W>()))>;
// What `some(rows)` computes for the lanes of T from part of a node's rows on, as floats.
template <int W, class T, class Some>
HWY_INLINE hn::Vec<Floats<W>> in_floats(const std::byte* node, int part, Some some) {
    constexpr Floats<W> f;
    constexpr LanesOf<W, T> d;
    constexpr int lanes = static_cast<int>(hn::MaxLanes(f)), some_lanes = static_cast<int>(hn::MaxLanes(d));
    constexpr hn::Rebind<float, LanesOf<W, T>> half;
    const T* const rows = reinterpret_cast<const T*>(node) + part * lanes;
    if constexpr (std::is_same_v<T, float>)
        return some(rows);
    else if constexpr (some_lanes == lanes)
        return hn::DemoteTo(f, some(rows));
    else
        return hn::Combine(f, hn::DemoteTo(half, some(rows + some_lanes)), hn::DemoteTo(half, some(rows)));
}

// A point and the squared distance to which it looks. Boxes are entered at their squared distance, which is
// that of PointProbe but for roundings.
template <int W, class T = float>
class Reach {
public:
    using F = Floats<W>;

    HWY_INLINE Reach(const Vec<T, 3>& p, float limit2) : p_(all_lanes(d, p)), limit2_(hn::Set(F(), limit2)) {}

    HWY_INLINE hn::Mask<F> enter(const std::byte* node, int part, hn::Vec<F>& distance2) const {
        distance2 = in_floats<W, T>(
            node, part, [&](const T* rows) __attribute__((always_inline)) {
                const auto outside = [&](int axis, auto at) __attribute__((always_inline)) {
                    const auto below = hn::Sub(hn::Load(d, rows + 2 * axis * W), at);
                    const auto above = hn::Sub(at, hn::Load(d, rows + (2 * axis + 1) * W));
                    return hn::Max(hn::Max(below, above), hn::Zero(d));
                };
                const Coordinates<D> away{outside(0, p_.x), outside(1, p_.y), outside(2, p_.z)};
                return dot(away, away);
            });
        return hn::Le(distance2, limit2_);
    }

private:
    using D = LanesOf<W, T>;
    static constexpr D d{};

    Coordinates<D> p_;
    hn::Vec<F> limit2_;
};

// Bounds of the squared distances from a point to the triangles of a block, in the lanes of F.
//
// Any point f of the triangle bounds its distance d from both sides: with r = p − f, |r| is at least d, and a
// plane across r that has the whole triangle behind it is at most d away, r·(p − corner) / |r| for the corner
// that makes it least. If f is the closest point, both are d. So f may be found in any way, and errors of its
// computation, large ones in slivers, only move the bounds apart.
//
// Roundings: x = p − a, ab and ac have relative errors of ε a component, r of 5ε·(|x| + |ab| + |ac|), and so
// have the products with r for each |r|. With S² = x² + ab² + ac² both bounds err by less than E = 32ε·S. To
// spare roots they are squared: (d + E)² is at most (1 + η)·d² + (1 + 1/η)·E², whatever d is, where η is
// 2^-16 for floats and 2^-32 for doubles. What underflows is less than 2^-120 (2^-960) of a squared distance.
// Where squares of floats come near to overflow E is infinite; bounds that are infinite or NaN exclude
// nothing.
template <class F>
class TriangleDistances {
public:
    using V = hn::Vec<F>;
    using T = hn::TFromD<F>;

    HWY_INLINE TriangleDistances(F f, const TriangleBlock<T>& block, int at, const Coordinates<F>& p) {
        const auto corner = [&](int c) __attribute__((always_inline)) {
            const auto row = [&](int axis) __attribute__((always_inline)) {
                return hn::Load(f, block.corner[axis][c] + at);
            };
            return Coordinates<F>{row(0), row(1), row(2)};
        };
        const Coordinates<F> a = corner(0), x = minus(p, a), ab = minus(corner(1), a),
                             ac = minus(corner(2), a);
        there_ = hn::Eq(a.x, a.x);
        const V abab = dot(ab, ab), acac = dot(ac, ac);
        // 16·S² overflows before any other square does.
        const V scale = hn::Mul(hn::Set(f, 16), hn::Add(hn::Add(abab, acac), dot(x, x)));
        const V error = hn::MulAdd(hn::Set(f, share_of_scale), scale, hn::Set(f, underflow));
        const auto [v, w] = foot(f, x, ab, ac, abab, acac);
        const Coordinates<F> r = minus(minus(x, v, ab), w, ac);
        const V length2 = dot(r, r), zero = hn::Zero(f);
        most_ = hn::MulAdd(length2, hn::Set(f, 1 + eta), error);
        const V ahead = hn::Max(hn::Max(dot(r, ab), dot(r, ac)), zero);
        const V height = hn::Max(hn::Sub(dot(r, x), ahead), zero);
        const V least = hn::Mul(height, hn::Div(height, hn::Max(length2, hn::Set(f, underflow))));
        least_ = hn::Mul(hn::Sub(least, error), hn::Set(f, 1 - T(0x1.1p0) * eta));
    }
    // The least of the upper bounds, in all lanes; infinite if there is none.
    HWY_INLINE V least_most(F f) const {
        const V none = hn::Set(f, std::numeric_limits<T>::infinity());
        return hn::MinOfLanes(f, hn::IfThenElse(there_, most_, none));
    }
    // The triangles that may be within a squared distance.
    HWY_INLINE hn::Mask<F> within(V distance2) const { return hn::AndNot(hn::Gt(least_, distance2), there_); }
    // A lower bound of each squared distance.
    HWY_INLINE V least() const { return least_; }

private:
    static constexpr bool single = std::is_same_v<T, float>;
    static constexpr T eta = single ? T(0x1p-16) : T(0x1p-32);
    static constexpr T share_of_scale = single ? T(0x1.01p-26) : T(0x1.01p-68);  // (1 + 1/η)·(32ε)² / 16
    static constexpr T underflow = single ? T(0x1p-120) : T(0x1p-960);

    struct Foot {
        V v, w;
    };
    // About the closest point of the triangle, as a + v·ab + w·ac: the region of the plane in which the foot
    // of the perpendicular lies says whether that is the foot, or the nearest point of an edge (Ericson 2005,
    // section 5.1.5). In any case a point of the triangle: v and w are clamped.
    static HWY_INLINE Foot foot(F f, const Coordinates<F>& x, const Coordinates<F>& ab,
                                const Coordinates<F>& ac, V abab, V acac) {
        const V zero = hn::Zero(f), one = hn::Set(f, 1);
        const V abac = dot(ab, ac), abx = dot(ab, x), acx = dot(ac, x);
        // The perpendicular's foot, as multiples of the determinant: negative v beyond the line through a and
        // c, negative w beyond that through a and b, and v + w > det beyond that through b and c.
        const V det = hn::NegMulAdd(abac, abac, hn::Mul(abab, acac));
        V v = hn::NegMulAdd(abac, acx, hn::Mul(acac, abx));
        V w = hn::NegMulAdd(abac, abx, hn::Mul(abab, acx));
        const auto beyond_ab = hn::Lt(w, zero), beyond_ac = hn::Lt(v, zero);
        const auto beyond_bc = hn::Gt(hn::Add(v, w), det);
        // How far x lies from b towards c, and from c towards b, as multiples of bc².
        const V from_b = hn::Sub(hn::Sub(acx, abac), hn::Sub(abx, abab));
        const V from_c = hn::Sub(hn::Sub(abx, abac), hn::Sub(acx, acac));
        // Beyond two lines, the edge is the one along which the foot is not outside their common corner.
        const auto on_ac = hn::AndNot(hn::And(beyond_ab, hn::Le(acx, zero)), beyond_ac);
        const auto on_bc = hn::AndNot(
            hn::Or(hn::And(beyond_ab, hn::Le(from_b, zero)), hn::And(beyond_ac, hn::Le(from_c, zero))),
            beyond_bc);
        V whole = hn::IfThenElse(beyond_ab, abab, det);
        v = hn::IfThenElse(beyond_ab, abx, v), w = hn::IfThenZeroElse(beyond_ab, w);
        whole = hn::IfThenElse(on_ac, acac, whole);
        v = hn::IfThenZeroElse(on_ac, v), w = hn::IfThenElse(on_ac, acx, w);
        whole = hn::IfThenElse(on_bc, hn::Add(from_b, from_c), whole);
        v = hn::IfThenElse(on_bc, from_c, v), w = hn::IfThenElse(on_bc, from_b, w);
        const V share = hn::Div(one, whole);
        v = hn::Min(hn::Max(hn::Mul(v, share), zero), one);
        return {v, hn::Min(hn::Max(hn::Mul(w, share), zero), hn::Sub(one, v))};
    }

    hn::Mask<F> there_;
    V least_, most_;
};

// The lower bounds of TriangleDistances as floats, and which triangles may be within a squared distance. The
// nearest float never puts two numbers in the wrong order.
template <class D>
struct FloatBounds {
    using F = hn::Rebind<float, D>;

    hn::Vec<F> least;
    hn::Mask<F> within;

    HWY_INLINE FloatBounds(const TriangleDistances<D>& distances,
                           hn::Vec<D> distance2) requires(std::is_same_v<D, F>)
        : least(distances.least()), within(distances.within(distance2)) {}
    HWY_INLINE FloatBounds(const TriangleDistances<D>& distances,
                           hn::Vec<D> distance2) requires(!std::is_same_v<D, F>) {
        constexpr D d;
        constexpr F f;
        // What is not within has a NaN's place taken by infinity, which is within nothing.
        const auto infinite = hn::Set(d, std::numeric_limits<double>::infinity());
        least = hn::DemoteTo(f, hn::IfThenElse(distances.within(distance2), distances.least(), infinite));
        within = hn::Not(hn::Eq(least, hn::Set(f, std::numeric_limits<float>::infinity())));
    }
};

// The squared distances of the points of a block, or of other rows of coordinates `at` each axis, from `from`
// on, in the lanes of D, which are doubles.
template <class D, class Rows>
HWY_INLINE hn::Vec<D> distances2_in_double(D d, const Rows& rows, int from, const Vec<double, 3>& p) {
    constexpr hn::Rebind<float, D> part;
    const auto row = [&](int axis) __attribute__((always_inline)) {
        return hn::PromoteTo(d, hn::Load(part, rows.at[axis] + from));
    };
    const auto away = minus<D>(all_lanes(d, p), {row(0), row(1), row(2)});
    return product(away, away);
}
// The same from `at` on in the lanes of F: computed in double and rounded once, as by `closest_point`
// (geometry/distance.h).
template <class F, class Rows>
HWY_INLINE hn::Vec<F> distances2_of(F f, const Rows& rows, int at, const Vec<double, 3>& p) {
    constexpr hn::CappedTag<double, static_cast<int>(hn::MaxLanes(f))> d;
    constexpr hn::Rebind<float, std::remove_const_t<decltype(d)>> part;
    const auto some = [&](int from) __attribute__((always_inline)) {
        return hn::DemoteTo(part, distances2_in_double(d, rows, from, p));
    };
    if constexpr (hn::MaxLanes(d) == hn::MaxLanes(f))
        return some(at);
    else
        return hn::Combine(f, some(at + static_cast<int>(hn::MaxLanes(d))), some(at));
}
// Calls take(key, place) for the points of a block that are within a squared distance.
template <class Take>
HWY_INLINE void for_each_within(const PointBlock<float, 3>& block, const Vec<float, 3>& p, float distance2,
                                Take take) {
    constexpr Floats<8> f;
    constexpr int lanes = static_cast<int>(hn::MaxLanes(f));
    for (int at = 0; at < 8; at += lanes) {
        const auto distances2 = distances2_of(f, block, at, Vec<double, 3>(p));
        unsigned near = bits_of(f, hn::Le(distances2, hn::Set(f, distance2)));
        if (near == 0) continue;
        alignas(64) float all[lanes];
        hn::Store(distances2, f, all);
        for (; near != 0; near &= near - 1) {
            const int i = std::countr_zero(near);
            take(key_of(all[i], block.id[at + i]), at + i);
        }
    }
}

}  // namespace hedgerow::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
