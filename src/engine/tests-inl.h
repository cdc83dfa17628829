/// A ray against the boxes of a node, and against the triangles of a leaf.
#if defined(HEDGEROW_ENGINE_TESTS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef HEDGEROW_ENGINE_TESTS_INL_H
#undef HEDGEROW_ENGINE_TESTS_INL_H
#else
#define HEDGEROW_ENGINE_TESTS_INL_H
#endif

#include <cstdint>
#include <limits>
#include <type_traits>

#include <hwy/highway.h>

#include <hedgerow/engine/kernels.h>

#include "boxes-inl.h"
#include "rays-inl.h"

HWY_BEFORE_NAMESPACE();
namespace hedgerow::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

// The numbers of a ray that the test of boxes needs, each in all lanes. The axes have names, since g++ keeps
// arrays of vectors in memory.
template <int W>
struct Slabs {
    using V = hn::Vec<Floats<W>>;

    struct Axis {
        V inverse, enter_at, leave_at;
        std::size_t near_row;

        HWY_INLINE Axis(const WideRay& ray, int k)
            : inverse(hn::Set(Floats<W>(), ray.inverse[k])),
              enter_at(hn::Set(Floats<W>(), ray.enter_at[k])),
              leave_at(hn::Set(Floats<W>(), ray.leave_at[k])),
              near_row(ray.near_row[k]) {}
    };
    Axis x, y, z;
    V s_min, s_limit;

    HWY_INLINE explicit Slabs(const WideRay& ray)
        : x(ray, 0),
          y(ray, 1),
          z(ray, 2),
          s_min(hn::Set(Floats<W>(), ray.s_min)),
          s_limit(hn::Set(Floats<W>(), ray.s_limit)) {}

    // Which boxes of a part of a node's row the ray enters, and at which s.
    HWY_INLINE hn::Mask<Floats<W>> enter(const std::byte* node, int part, V& entry) const {
        const auto near_s = [&](const Axis& axis) __attribute__((always_inline)) {
            return hn::MulSub(row_of<W>(node, axis.near_row, part), axis.inverse, axis.enter_at);
        };
        const auto far_s = [&](const Axis& axis) __attribute__((always_inline)) {
            return hn::MulSub(row_of<W>(node, axis.near_row ^ (4 * W), part), axis.inverse, axis.leave_at);
        };
        const V exit = hn::Min(hn::Min(far_s(x), far_s(y)), hn::Min(far_s(z), s_limit));
        entry = hn::Max(hn::Max(near_s(x), near_s(y)), hn::Max(near_s(z), s_min));
        return hn::Le(entry, exit);
    }
};

// Corners of triangles in the sheared space of a ray. The lanes are triangles as one ray sees them, one
// triangle as several rays see it, or pairs of a triangle and a ray.
template <class F>
struct ShearedCorners {
    using V = hn::Vec<F>;
    V x[3], y[3], z[3];

    // `from_origin(k, c)` is corner c minus the ray's origin, along the ray's axis k.
    template <class FromOrigin>
    HWY_INLINE ShearedCorners(FromOrigin from_origin, V shear_x, V shear_y) {
        for (int c = 0; c < 3; ++c) {
            z[c] = from_origin(2, c);
            x[c] = hn::Sub(from_origin(0, c), hn::Mul(shear_x, z[c]));
            y[c] = hn::Sub(from_origin(1, c), hn::Mul(shear_y, z[c]));
        }
    }
    // A filter, in two halves. A rounded difference of rounded products has the right sign or is 0. A
    // triangle lies between its corners, so one that does not reach into the interval is not hit in it.
    // Places that are not filled are NaN and fail every comparison.
    HWY_INLINE hn::Mask<F> may_meet(F f, V direction_z, V s_low, V s_limit) const {
        const Range s = along(f, direction_z);
        return hn::And(around(f), hn::And(hn::Le(s.least, s_limit), hn::Ge(s.most, s_low)));
    }
    // First half of `may_meet`: whether the ray may pass between the edges.
    HWY_INLINE hn::Mask<F> around(F f) const {
        const Range side = sides(f);
        return hn::Or(hn::Ge(side.least, hn::Zero(f)), hn::Le(side.most, hn::Zero(f)));
    }
    // Whether the exact test would find a meeting within [t_min, t_max]: for sure where no rounded difference
    // is 0, and where the whole triangle lies in the interval. `z_length` is |direction_z|.
    HWY_INLINE hn::Mask<F> surely_meets(F f, V direction_z, V z_length, V t_min, V t_max) const {
        const Range side = sides(f), s = along(f, direction_z);
        const auto between = hn::Or(hn::Gt(side.least, hn::Zero(f)), hn::Lt(side.most, hn::Zero(f)));
        // The interval of s is narrowed by as much as `may_meet` widens it.
        const V room = hn::Mul(hn::Set(f, underflow), hn::Add(hn::Set(f, 1.0f), z_length));
        const V last = hn::Min(t_max, hn::Set(f, std::numeric_limits<float>::max()));
        const V low = hn::MulAdd(hn::Mul(t_min, z_length), hn::Set(f, 1 + wider), room);
        const V high = hn::MulSub(hn::Mul(last, z_length), hn::Set(f, 1 - wider), room);
        return hn::And(between, hn::And(hn::Ge(s.least, low), hn::Le(s.most, high)));
    }

private:
    struct Range {
        V least, most;
    };
    static HWY_INLINE Range range_of(V a, V b, V c) {
        return {hn::Min(a, hn::Min(b, c)), hn::Max(a, hn::Max(b, c))};
    }
    // The sides of the edges on which the ray passes.
    HWY_INLINE Range sides(F) const {
        const auto edge = [&](int p, int q) { return hn::Sub(hn::Mul(x[p], y[q]), hn::Mul(y[p], x[q])); };
        return range_of(edge(2, 1), edge(0, 2), edge(1, 0));
    }
    // The s of the corners.
    HWY_INLINE Range along(F f, V direction_z) const {
        const V sign = hn::And(direction_z, hn::Set(f, -0.0f));
        return range_of(hn::Xor(z[0], sign), hn::Xor(z[1], sign), hn::Xor(z[2], sign));
    }
};

// Results of the exact test: t, u and v in the lanes where the ray's line meets the triangle.
struct alignas(64) Meetings {
    float t[16], u[16], v[16];
};

// Does what meet_exactly (geometry/entry.h) does, in the lanes of d: the same operations in the same order.
// Returns the lanes that are met, a bit each.
template <class D, class V, class W>
HWY_INLINE unsigned meet_exactly_in(D d, const V (&x)[3], const V (&y)[3], const V (&z)[3], W direction_z,
                                    Meetings& m, int at) {
    const hn::Rebind<float, D> f;
    W X[3], Y[3], Z[3];
    for (int c = 0; c < 3; ++c)
        X[c] = hn::PromoteTo(d, x[c]), Y[c] = hn::PromoteTo(d, y[c]), Z[c] = hn::PromoteTo(d, z[c]);
    const auto edge = [&](int p, int q) { return hn::Sub(hn::Mul(X[p], Y[q]), hn::Mul(Y[p], X[q])); };
    const W u = edge(2, 1), v = edge(0, 2), w = edge(1, 0), zero = hn::Zero(d);
    const auto none_below = hn::Ge(hn::Min(u, hn::Min(v, w)), zero);
    const auto none_above = hn::Le(hn::Max(u, hn::Max(v, w)), zero);
    const W det = hn::Add(hn::Add(u, v), w);
    const auto met = hn::AndNot(hn::Eq(det, zero), hn::Or(none_below, none_above));
    const W wa = hn::Div(u, det), wb = hn::Div(v, det), wc = hn::Div(w, det);
    const W height = hn::Add(hn::Add(hn::Mul(wa, Z[0]), hn::Mul(wb, Z[1])), hn::Mul(wc, Z[2]));
    hn::StoreU(hn::DemoteTo(f, hn::Div(height, direction_z)), f, m.t + at);
    hn::StoreU(hn::DemoteTo(f, wb), f, m.u + at);
    hn::StoreU(hn::DemoteTo(f, wc), f, m.v + at);
    return bits_of(d, met);
}
// The candidates that are met, tested as many at once as a vector has doubles. `direction_z(d, i)` is the
// direction's z in the lanes from i on.
template <class F, class DirectionZ>
HWY_INLINE unsigned meet_exactly_among(F f, const ShearedCorners<F>& corners, unsigned candidates,
                                       DirectionZ direction_z, Meetings& m) {
    constexpr int lanes = static_cast<int>(hn::MaxLanes(f));
    constexpr hn::CappedTag<double, lanes> d;
    constexpr int exact_lanes = static_cast<int>(hn::MaxLanes(d));
    // One vector of doubles has all lanes.
    if constexpr (exact_lanes == lanes) {
        return candidates & meet_exactly_in(d, corners.x, corners.y, corners.z, direction_z(d, 0), m, 0);
    } else {
        // Several vectors: store the corners, and test each part that has candidates.
        constexpr hn::Rebind<float, hn::CappedTag<double, lanes>> part;
        alignas(64) float rows[3][3][lanes];
        for (int c = 0; c < 3; ++c) {
            hn::Store(corners.x[c], f, rows[0][c]);
            hn::Store(corners.y[c], f, rows[1][c]);
            hn::Store(corners.z[c], f, rows[2][c]);
        }
        unsigned met = 0;
        for (int i = 0; i < lanes; i += exact_lanes) {
            if ((candidates >> i & ((1u << exact_lanes) - 1)) == 0) continue;
            hn::Vec<std::remove_const_t<decltype(part)>> at[3][3];
            for (int k = 0; k < 3; ++k)
                for (int c = 0; c < 3; ++c) at[k][c] = hn::Load(part, rows[k][c] + i);
            met |= meet_exactly_in(d, at[0], at[1], at[2], direction_z(d, i), m, i) << i;
        }
        return candidates & met;
    }
}

HWY_INLINE Hit<float> hit_of(const WideScene& scene, float t, float u, float v, std::uint32_t element) {
    if (element == Hit<float>::none) return {};
    const std::uint32_t id = scene.faces.empty() ? element : scene.faces[element];
    return {t, u, v, id, scene.geometry, scene.instance, element};
}

// Whether the filter of the call keeps what is about to become the hit of a ray.
HWY_INLINE bool kept(const WideScene& scene, std::size_t ray, float t, float u, float v,
                     std::uint32_t element) {
    return scene.filter.keeps(scene.filter.filter, scene.first_ray + ray, hit_of(scene, t, u, v, element));
}

// Whether a meeting at t replaces the ray's hit so far: t is in the interval, and less than that of the hit
// (or equal, with a lower id).
HWY_INLINE bool nearer(float t, std::uint32_t id, float t_min, float t_limit, std::uint32_t element) {
    return t >= t_min && t <= std::numeric_limits<float>::max() &&
           (t < t_limit || (t == t_limit && id < element));
}

// Tests the triangles of a block. A triangle that is hit nearer than the ray's hit so far (or as near, with
// a lower number) becomes the hit, if `keeps(t, u, v, id)`. True if there was one. Where any hit is wanted,
// the hit may lack its t, u and v.
template <Wanted wanted, class Keeps>
HWY_INLINE bool test_block(const TriangleBlock<float>& block, WideRay& ray, Keeps keeps) {
    using F = Floats<8>;
    constexpr F f;
    constexpr int lanes = static_cast<int>(hn::MaxLanes(f));
    const float* const rows = &block.corner[0][0][0];
    bool found = false;
    for (int at = 0; at < 8; at += lanes) {
        // Filter in floats.
        const auto from_origin = [&](int k, int c) {
            return hn::Sub(hn::Load(f, rows + ray.row[k] + 8 * c + at), hn::Set(f, ray.origin[k]));
        };
        const ShearedCorners<F> corners(from_origin, hn::Set(f, ray.shear[0]), hn::Set(f, ray.shear[1]));
        unsigned candidates = bits_of(
            f, corners.may_meet(f, hn::Set(f, ray.z), hn::Set(f, ray.s_low), hn::Set(f, ray.s_limit)));
        if (candidates == 0) continue;
        // Any hit: one that is sure needs no exact test.
        if constexpr (wanted == Wanted::any) {
            const unsigned sure =
                bits_of(f, corners.surely_meets(f, hn::Set(f, ray.z), hn::Set(f, ray.z_length),
                                                hn::Set(f, ray.t_min), hn::Set(f, ray.t_limit)));
            if (sure != 0) {
                ray.element = block.id[at + std::countr_zero(sure)];
                return true;
            }
        }
        // Test the candidates exactly, and keep the nearest.
        Meetings m;
        const auto z = [&](auto d, int) { return hn::Set(d, static_cast<double>(ray.z)); };
        candidates = meet_exactly_among(f, corners, candidates, z, m);
        for (; candidates != 0; candidates &= candidates - 1) {
            const int i = std::countr_zero(candidates);
            const float t = m.t[i];
            const std::uint32_t id = block.id[at + i];
            if (!nearer(t, id, ray.t_min, ray.t_limit, ray.element)) continue;
            if (!keeps(t, m.u[i], m.v[i], id)) continue;
            ray.t_limit = t;
            ray.u = m.u[i], ray.v = m.v[i];
            ray.element = id;
            found = true;
        }
    }
    if (found) ray.s_limit = s_limit_of(ray.t_limit, ray.z_length);
    return found;
}
template <Wanted wanted>
HWY_INLINE bool test_block(const TriangleBlock<float>& block, WideRay& ray) {
    return test_block<wanted>(block, ray, [](float, float, float, std::uint32_t) { return true; });
}
// `test_block` with the filter of the call, which wants to know what is hit. It is not inlined, since a call
// inside the other would cost registers.
[[gnu::cold]] HWY_NOINLINE inline bool test_block_filtered(const WideScene& scene, std::uint32_t leaf,
                                                           WideRay& ray, std::size_t number) {
    return test_block<Wanted::closest>(
        scene.blocks[leaf], ray,
        [&](float t, float u, float v, std::uint32_t id) { return kept(scene, number, t, u, v, id); });
}
// Tests the triangles of a leaf for ray `number`, with the filter of the call if there is one.
template <Wanted wanted>
HWY_INLINE bool test_triangles(const WideScene& scene, std::uint32_t leaf, WideRay& ray, std::size_t number) {
    if (scene.filter.keeps != nullptr) [[unlikely]]
        return test_block_filtered(scene, leaf, ray, number);
    return test_block<wanted>(scene.blocks[leaf], ray);
}

HWY_INLINE Hit<float> hit_of(const WideScene& scene, const WideRay& ray) {
    return hit_of(scene, ray.t_limit, ray.u, ray.v, ray.element);
}

}  // namespace hedgerow::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
