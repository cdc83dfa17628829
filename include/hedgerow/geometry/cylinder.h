/// Round cylinders with flat ends.
#pragma once

#include <hedgerow/geometry/slab.h>

namespace hedgerow {

/// The points x within `radius` of the line through `point` along `axis`, and with low <= axis·x <= high. The
/// axis has length 1 up to its rounding to T.
template <std::floating_point T>
struct Cylinder {
    using Scalar = T;
    static constexpr int dimension = 3;

    Vec<T, 3> point, axis;
    T radius, low, high;

    Slab<3> ends() const { return {Vec3d(axis), static_cast<double>(low), static_cast<double>(high)}; }
    /// The component of a vector perpendicular to the axis.
    Vec3d across(const Vec3d& v) const {
        const Vec3d a(axis);
        return v - a * (dot(a, v) / length2(a));
    }
};

}  // namespace hedgerow
