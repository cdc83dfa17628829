/// Rays, prepared for the kernels.
#if defined(HEDGEROW_ENGINE_RAYS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef HEDGEROW_ENGINE_RAYS_INL_H
#undef HEDGEROW_ENGINE_RAYS_INL_H
#else
#define HEDGEROW_ENGINE_RAYS_INL_H
#endif

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>

#include <hwy/highway.h>

#include <hedgerow/engine/kernels.h>

HWY_BEFORE_NAMESPACE();
namespace hedgerow::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

// A ray, prepared for the kernels. x, y and z are the ray's own axes here, z the longest. Where a ray enters
// a box is measured along z: s = t·|d_z|. No inverse is infinite, since a direction that is all but parallel
// to a plane is taken as 2^-60 out of parallel, far less than its error. Boxes are conservative as in
// RayProbe, whose docstring has the bound e. Here a plane's s is plane · inverse − (o ± e) · inverse, which
// errs by 3u·M + 2u·|o| at most, fused or not.
struct alignas(64) WideRay {
    float inverse[4], enter_at[4], leave_at[4];  // by the scene's axes, like near_row; the fourth is unused
    std::uint32_t near_row[4];                   // bytes from a node to its near planes
    float origin[4], shear[4];                   // by the ray's axes; only x and y of the shear are used
    float s_min, s_limit;                        // the interval to search, a little wider than that of t
    float z, z_length;                           // of the direction: z and |z|
    float s_low;                                 // s_min before it is raised to 0; allows for underflow of t
    float t_min, t_limit;
    // The nearest hit so far, whose t is t_limit. `element` is none before the first hit.
    float u, v;
    std::uint32_t element;
    std::uint32_t row[3];  // floats from a block to its corners, by the ray's axes
    bool usable;
};

// How much wider the interval of s is than that of t: a share for two roundings, and an amount for
// underflow.
inline constexpr float wider = 0x1p-22f, underflow = 0x1p-126f;

HWY_INLINE float s_limit_of(float t, float z_length) {
    return t * z_length * (1 + wider) + underflow * (1 + z_length);
}
template <class F>
HWY_INLINE hn::Vec<F> s_limit_of(F f, hn::Vec<F> t, hn::Vec<F> z_length) {
    return hn::MulAdd(hn::Mul(t, z_length), hn::Set(f, 1 + wider),
                      hn::Mul(hn::Set(f, underflow), hn::Add(hn::Set(f, 1.0f), z_length)));
}

// The e of RayProbe, where M is `reach` and |o| is `far_off`. The subnormal steps (`room`) are always added
// here, and `more` to e.
template <class F>
HWY_INLINE hn::Vec<F> slack_of(F f, hn::Vec<F> reach, hn::Vec<F> far_off, hn::Vec<F> room_and_more) {
    return hn::MulAdd(hn::Set(f, 16 * unit_roundoff<float>), reach,
                      hn::MulAdd(hn::Set(f, 4 * unit_roundoff<float>), far_off, room_and_more));
}
// The direction with 0 for subnormal components.
template <class F>
HWY_INLINE hn::Vec<F> usable_direction(F f, hn::Vec<F> given) {
    return hn::IfThenZeroElse(hn::Lt(hn::Abs(given), hn::Set(f, std::numeric_limits<float>::min())), given);
}
// s for each unit along an axis. A direction that is all but parallel to the axis' planes counts as 2^-60
// out of parallel.
template <class F>
HWY_INLINE hn::Vec<F> inverse_of(F f, hn::Vec<F> longest, hn::Vec<F> length, hn::Vec<F> direction) {
    return hn::CopySign(hn::Min(hn::Div(longest, length), hn::Set(f, 0x1p60f)), direction);
}

// For each longest axis: which axes of the scene are the ray's x, y and z.
alignas(16) inline constexpr std::int32_t turned[3][4] = {{1, 2, 0, 3}, {2, 0, 1, 3}, {0, 1, 2, 3}};

// Prepares a ray for nodes of W children. The numbers that t, u and v come from are computed as in
// WatertightRay, with axes in lanes. Only the first three lanes of the origin and the direction count.
// `more` is added to e, as in RayProbe.
template <int W>
HWY_INLINE void prepare(hn::Vec<hn::FixedTag<float, 4>> origin, hn::Vec<hn::FixedTag<float, 4>> direction,
                        float asked_t_min, float t_max, const Box<float, 3>& scene, float more,
                        WideRay& ray) {
    constexpr hn::FixedTag<float, 4> f;
    constexpr hn::FixedTag<std::int32_t, 4> i32;
    constexpr hn::FixedTag<std::uint32_t, 4> u32;
    const auto all = [&](float x) { return hn::Set(f, x); };
    const auto axes = hn::FirstN(f, 3);
    static_assert(sizeof scene == 6 * sizeof(float));
    // The scene's corners, the origin and the direction, with axes in lanes.
    const float* const corners = reinterpret_cast<const float*>(&scene);
    const auto low = hn::LoadU(f, corners), high = hn::Shuffle0321(hn::LoadU(f, corners + 2));
    const auto o = hn::IfThenElseZero(axes, origin);
    const auto given = hn::IfThenElseZero(axes, direction);
    const auto d = usable_direction(f, given);
    const auto length = hn::Abs(d), distance = hn::Abs(o);
    const auto longest = hn::MaxOfLanes(f, length);
    const float z_length = hn::GetLane(longest);
    const float t_min = asked_t_min < 0 ? 0.0f : asked_t_min;
    // Usable: finite numbers within bounds, a direction that is not 0 and an interval that is not empty.
    ray.usable = hn::AllTrue(f, hn::And(hn::Le(length, all(std::numeric_limits<float>::max())),
                                        hn::Le(distance, all(largest_coordinate<float>)))) &&
                 z_length > 0 && t_min <= t_max;

    // The error e over the scene.
    const auto reach = hn::MaxOfLanes(
        f, hn::IfThenElseZero(axes, hn::Max(hn::Abs(hn::Sub(low, o)), hn::Abs(hn::Sub(high, o)))));
    const auto far_off = hn::MaxOfLanes(f, distance);
    const float room = underflow * (1 + z_length);
    const auto slack = slack_of(f, reach, far_off, all(room + more));
    // Slabs: the planes of boxes, widened by e, and the rows in which the near ones are.
    const auto inverse = inverse_of(f, longest, length, d);
    const auto outward = hn::CopySign(slack, d);
    hn::Store(inverse, f, ray.inverse);
    hn::Store(hn::Mul(hn::Add(o, outward), inverse), f, ray.enter_at);
    hn::Store(hn::Mul(hn::Sub(o, outward), inverse), f, ray.leave_at);
    const auto down = hn::ShiftRight<31>(hn::BitCast(i32, d));  // −1 or 0
    const auto row = hn::Sub(hn::ShiftLeft<1>(hn::Iota(i32, 0)), down);
    hn::Store(hn::BitCast(u32, hn::ShiftLeft<std::countr_zero(4u * W)>(row)), u32, ray.near_row);

    // The first of the longest components. If none equals the longest (NaN), z: that ray is not usable.
    const auto is_longest = hn::Or(hn::Eq(length, longest), hn::Not(hn::FirstN(f, 2)));
    const std::int32_t* const turn = turned[hn::FindKnownFirstTrue(f, is_longest)];
    const auto order = hn::SetTableIndices(f, turn);
    const auto along = hn::TableLookupLanes(d, order);
    ray.z = hn::GetLane(hn::Shuffle1032(along));
    hn::Store(hn::TableLookupLanes(o, order), f, ray.origin);
    hn::Store(hn::Div(along, all(ray.z)), f, ray.shear);
    // An axis of a block is 3 corners of 8 triangles: 24 floats.
    for (int k = 0; k < 3; ++k) ray.row[k] = 24 * static_cast<std::uint32_t>(turn[k]);

    // The interval of s, and no hit yet.
    ray.s_low = t_min * z_length * (1 - wider) - room;
    ray.s_min = ray.s_low > 0 ? ray.s_low : 0.0f;
    ray.s_limit = s_limit_of(t_max, z_length);
    ray.z_length = z_length;
    ray.t_min = t_min, ray.t_limit = t_max;
    ray.u = ray.v = 0;
    ray.element = Hit<float>::none;
}

// Prepares a ray in memory: the 8 numbers of a Ray, at any address.
template <int W>
HWY_INLINE void prepare(const std::byte* ray_at, const Box<float, 3>& scene, float more, WideRay& ray) {
    constexpr hn::FixedTag<float, 4> f;
    const float* const words = reinterpret_cast<const float*>(ray_at);
    float t_min, t_max;
    std::memcpy(&t_min, ray_at + 6 * sizeof(float), sizeof t_min);
    std::memcpy(&t_max, ray_at + 7 * sizeof(float), sizeof t_max);
    prepare<W>(hn::LoadU(f, words), hn::LoadU(f, words + 3), t_min, t_max, scene, more, ray);
}

}  // namespace hedgerow::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
