/// Elementary functions in single precision, in float operations alone, so that they can be written for
/// lanes without change. Those with a type F take FloatLanes, too. Included by elementary.h, which states the
/// method.
#pragma once

#include <cmath>
#include <limits>

#include <hedgerow/geometry/elementary_parts.h>
#include <hedgerow/geometry/number_lanes.h>
#include <hedgerow/geometry/rounding.h>

namespace hedgerow {

/// The sine and the cosine of one angle.
template <class T>
struct SineCosine {
    T sine, cosine;
};

/// The sine and cosine of 2πu, within 2 units in the last place for every u: the reduction is exact. NaN for
/// an infinite u. Of lanes, |u| must be below 2³¹.
template <class F>
SineCosine<F> sine_cosine_of_turns(F u) {
    const F turns = magnitude(u), fraction = turns - floored(turns);
    // The fraction is n quarters and a rest of at most an eighth.
    const F n = floored(4 * fraction + 0.5f), rest = fraction - n / 4, z = product(rest, rest);
    const F to_sine = detail::polynomial(z, F(-0x1.4abbbep+5f), F(0x1.465facp+6f), F(-0x1.2db59cp+6f));
    const F to_cosine =
        detail::polynomial(z, F(-0x1.3bd3ccp+4f), F(0x1.03c1b0p+6f), F(-0x1.55b2b6p+6f), F(0x1.d4f7fap+5f));
    // The factor 2π has two parts, of which the second is added with the polynomial.
    const F s = product(rest, F(0x1.921fb6p+2f)) + product(rest, product(z, to_sine) - 0x1.777a5cp-23f);
    const F c = 1 + product(z, to_cosine);
    const auto first = equal(n, 1), second = equal(n, 2), third = equal(n, 3);  // 0 and 4 are one quarter
    const F sine = select(first || third, c, s), cosine = select(first || third, s, c);
    const F of_turns = select(second || third, 0 - sine, sine);
    const auto is_finite = fraction < 1;
    return {select(is_finite, select(has_minus(u), -of_turns, of_turns), fraction),
            select(is_finite, select(first || second, 0 - cosine, cosine), fraction)};
}

/// e to the power x, within 2 units in the last place; infinity above 88.8, 0 below −104.
inline float exponential(float x) {
    if (x != x) return x;
    if (x > 89) return std::numeric_limits<float>::infinity();
    if (x < -105) return 0;
    const float k = std::floor(product(x, 0x1.715476p+0f) + 0.5f);
    // The first part of log(2) has 15 bits, so that its product with k is exact.
    const float r = (x - product(k, 0x1.62e4p-1f)) - product(k, 0x1.7f7d1cp-20f);
    const float p = detail::polynomial(r, 0x1.fffffcp-2f, 0x1.55548cp-3f, 0x1.55585ap-5f, 0x1.123d72p-7f,
                                       0x1.6ab8f2p-10f);
    return detail::times_power_of_two(1 + (r + product(product(r, r), p)), static_cast<int>(k));
}

/// The angle of the point (x, y), from −π to π, within 2 units in the last place. Signed zeros and infinities
/// are treated as the C library treats them: the angle of (0, 0) is 0.
inline float arc_tangent(float y, float x) {
    if (x != x || y != y) return x + y;
    constexpr float infinity = std::numeric_limits<float>::infinity();
    const float up = std::abs(y), along = std::abs(x);
    float least = up < along ? up : along, most = up < along ? along : up;
    if (most == 0 || least == infinity) {
        least = least == 0 ? 0.f : 1.f, most = 1;
    } else if (most == infinity) {
        least = 0, most = 1;
    }
    const float scale = most > 0x1p100f ? 0.25f : most < 0x1p-60f ? 0x1p60f : 1.f;
    least = product(least, scale), most = product(most, scale);
    // atan(q) = atan(c) + atan((q − c) / (1 + c·q)), where c is 0, 1/2 or 1.
    const bool far = least > product(0.35f, most), farther = least > product(0.75f, most);
    const float c = farther ? 1.f : far ? 0.5f : 0.f;
    const float begin = farther ? 0x1.921fb6p-1f : far ? 0x1.dac670p-2f : 0.f;
    const float begin_low = farther ? -0x1.777a5cp-26f : far ? 0x1.586ed4p-28f : 0.f;
    const float t = (least - product(c, most)) / (most + product(c, least)), z = product(t, t);
    const float p = detail::polynomial(z, -0x1.55550cp-2f, 0x1.996b32p-3f, -0x1.1ff6d4p-3f, 0x1.68589ap-4f);
    const float eighth = begin + (begin_low + (t + product(product(t, z), p)));
    // Add the angle to, or subtract it from, the multiple of π/2 nearest to the result.
    const bool steep = up > along, backward = std::signbit(x);
    const float base = steep ? 0x1.921fb6p+0f : backward ? 0x1.921fb6p+1f : 0.f;
    const float base_low = steep ? -0x1.777a5cp-25f : backward ? -0x1.777a5cp-24f : 0.f;
    const float angle = base + (base_low + (steep != backward ? -eighth : eighth));
    return std::copysign(angle, y);
}

}  // namespace hedgerow
