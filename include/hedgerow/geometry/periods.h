/// Space that repeats along some axes, and distances in it.
#pragma once

#include <cmath>

#include <hedgerow/geometry/distance.h>

namespace hedgerow {

/// The length after which space repeats along each axis; 0 where it does not.
template <int D>
using Periods = Vec<double, D>;

/// Periods of the plane, or of space, as those of space: the third is 0 in the plane.
template <int D>
Periods<3> periods_in_space(const Periods<D>& periods) {
    Periods<3> all;
    for (int k = 0; k < D; ++k) all[k] = periods[k];
    return all;
}

/// The difference of two coordinates to the nearest image: exact, once the difference itself is rounded. A
/// period of 0 leaves it as it is.
inline double nearest_image(double difference, double period) {
    // Differences of up to two periods lose one of them exactly (Sterbenz).
    if (!(period > 0) || !(std::abs(difference) > period / 2)) return difference;
    if (std::abs(difference) <= 1.5 * period) return difference - std::copysign(period, difference);
    return std::remainder(difference, period);
}

/// The squared distance from a point to the nearest image of another: as `closest_point` measures it, in
/// double and rounded once, with differences to the nearest image.
template <std::floating_point T, int D>
T image_distance2(const Vec<T, D>& p, const Vec<T, D>& q, const Periods<D>& periods) {
    Vec<double, D> away = Vec<double, D>(p) - Vec<double, D>(q);
    for (int k = 0; k < D; ++k) away[k] = nearest_image(away[k], periods[k]);
    return rounded_to<T>(length2(away));
}

}  // namespace hedgerow
