/// The importance of groups of lights, as a plain loop that the compiler puts into vectors.
#pragma once

#include <cmath>
#include <cstddef>

#include <hedgerow/base/instruction_set.h>
#include <hedgerow/render/lighting/light_groups.h>

namespace hedgerow {

/// Writes the importances of the first `count` groups. The loop has no branch, so that its rounds become
/// lanes. Products that feed sums need no care here: the library is compiled without contraction.
template <std::size_t count>
[[gnu::always_inline]] inline void write_importances_of(const LightGroups& groups, const Vec3f& point,
                                                        const Vec3f& receiver, double* __restrict found) {
    // What cosines are raised by. Axes, cosines and sines in float err by about 1e-7.
    constexpr double slack = 1e-5;
    const double px = static_cast<double>(point[0]), py = static_cast<double>(point[1]),
                 pz = static_cast<double>(point[2]);
    const double nx = static_cast<double>(receiver[0]), ny = static_cast<double>(receiver[1]),
                 nz = static_cast<double>(receiver[2]);
    const double least_received = receiver == Vec3f() ? 1 : 0;  // without a normal
    const auto greater = [](double a, double b) { return a > b ? a : b; };
    const double *cx = groups.centre[0].data(), *cy = groups.centre[1].data(), *cz = groups.centre[2].data();
    const double *hx = groups.half[0].data(), *hy = groups.half[1].data(), *hz = groups.half[2].data();
    const double *ax = groups.normal[0].data(), *ay = groups.normal[1].data(), *az = groups.normal[2].data();
    const double *radius = groups.radius.data(), *cosine = groups.cosine.data(), *sine = groups.sine.data(),
                 *cos_emission = groups.cos_emission.data(), *back = groups.back.data(),
                 *most = groups.most_nearness.data(), *intensity = groups.intensity.data();
    for (std::size_t i = 0; i < count; ++i) {
        const double x = cx[i] - px, y = cy[i] - py, z = cz[i] - pz;
        // The greatest height of the box above the receiver's horizon.
        const double along_receiver = nx * x + ny * y + nz * z;
        const double height =
            along_receiver + (std::abs(nx) * hx[i] + std::abs(ny) * hy[i] + std::abs(nz) * hz[i]);
        const double reach = std::abs(x) + hx[i] + (std::abs(y) + hy[i]) + (std::abs(z) + hz[i]);
        const double above = height > reach * (-slack / 4) ? intensity[i] : 0.0;

        const double distance2 = x * x + y * y + z * z, inverse2 = 1 / distance2;
        const double inverse = std::sqrt(inverse2);
        const double sin_box = radius[i] * inverse,
                     cos_box = std::sqrt(greater(1 - radius[i] * radius[i] * inverse2, 0));
        // The cosine of the angle between the way and an axis, less an angle; 1 where that is larger.
        const auto cosine_less = [&](double along, double cos_less, double sin_less) {
            const double across = std::sqrt(greater(distance2 - along * along, 0));
            const double less = (along * cos_less + across * sin_less) * inverse;
            const double never = sin_less < 0 ? 1.0 : less;  // beyond π
            return along * inverse >= cos_less ? 1.0 : never;
        };
        const double along_normal = -(ax[i] * x + ay[i] * y + az[i] * z);
        const double facing = greater(along_normal, along_normal * back[i]);
        const double received = cosine_less(along_receiver, cos_box, sin_box) + slack;
        const double emitted = cosine_less(facing, cosine[i] * cos_box - sine[i] * sin_box,
                                           sine[i] * cos_box + cosine[i] * sin_box) +
                               slack;
        const double cosines = emitted > cos_emission[i] ? greater(received, least_received) * emitted : 0.0;
        // Angles are known where the point is outside of the sphere around the box.
        const double known = distance2 > radius[i] * radius[i] ? cosines : 1.0;
        const double nearness = inverse2 < most[i] ? inverse2 : most[i];
        found[i] = above * nearness * known;
    }
}
/// Computes LightGroups::importances. Two groups, as of a lamp of two triangles, take half as many lanes.
[[gnu::always_inline]] inline void write_importances(const LightGroups& groups, const Vec3f& point,
                                                     const Vec3f& receiver, double* __restrict found) {
    constexpr std::size_t all = LightGroups::width, few = all / 2;
    if (groups.count > few) return write_importances_of<all>(groups, point, receiver, found);
    write_importances_of<few>(groups, point, receiver, found);
    for (std::size_t i = few; i < all; ++i) found[i] = 0;
}

struct LightKernels {
    void (*write_importances)(const LightGroups&, const Vec3f& point, const Vec3f& receiver, double* found);
};

/// The kernels in use, or nullptr.
template <>
const LightKernels* in_use<LightKernels>();

}  // namespace hedgerow
