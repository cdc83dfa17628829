/// The sky of a scene that has no light.
#pragma once

#include <cmath>
#include <memory>

#include <hedgerow/geometry/elementary.h>
#include <hedgerow/looks/light.h>

namespace hedgerow {

namespace detail {

/// The radiance of the sky from a direction, of length 1, whose y is the height.
inline Vec3f sky_radiance(const Vec3f& direction) {
    const Vec3f zenith(0.35f, 0.5f, 0.8f), horizon(0.95f, 1.0f, 1.05f), ground(0.28f, 0.26f, 0.24f);
    const float height = direction[1];
    if (height < 0) {
        // The ground is lighter toward the horizon.
        const float near = product(1 + height, 1 + height);
        return ground + ground * product(near, near);
    }
    const float low = product(1 - height, product(1 - height, 1 - height));
    Vec3f sky = zenith + (horizon - zenith) * low;
    // The soft sun: the 32nd power of the cosine of the angle to its middle.
    float shine = dot(direction, Vec3f(0.48f, 0.6f, 0.64f));
    if (shine <= 0) return sky;
    for (int i = 0; i < 5; ++i) shine = product(shine, shine);
    return sky + Vec3f(14, 11.5f, 7) * shine;
}

}  // namespace detail

/// The rotation that puts an environment upright in the world: its zenith +y goes to `up`, of any length. For
/// up = +y all axes stay, and for up = +z the middle of the panorama, −z, goes to +y. A vector that is 0 or
/// not finite counts as +y.
inline Rows<3> upright_environment(const Vec3f& up) {
    const Vec3d y = finite(up) && length2(Vec3d(up)) > 0 ? normalized(Vec3d(up)) : Vec3d(0, 1, 0);
    const Vec3d z = std::abs(y[2]) < 0.9 ? normalized(Vec3d(0, 0, 1) - y * y[2])
                                         : normalized(Vec3d(0, -1, 0) + y * y[1]) * (y[2] < 0 ? -1.0 : 1.0);
    const Vec3d x = cross(y, z);
    // The columns are the images of the axes.
    Rows<3> to_world;
    for (int k = 0; k < 3; ++k) to_world[static_cast<std::size_t>(k)] = Vec3d(x[k], y[k], z[k]);
    return to_world;
}

/// A simple sky for scenes without lights: blue at the zenith, brighter at the horizon, with a soft sun 37
/// degrees above it, about 24 degrees wide, and a dim ground below. A horizontal matte white surface shows a
/// radiance of about 1 under it. Its zenith lies at `up` (upright_environment). The panorama has 64×32 texels
/// and the same bits everywhere.
inline Environment default_sky(const Vec3f& up = {0, 1, 0}) {
    constexpr int width = 64, height = 32;
    Pixels pixels{width, height, 3, {}};
    std::vector<float> samples;
    samples.reserve(std::size_t{3} * width * height);
    for (int y = 0; y < height; ++y) {
        const auto [sin_theta, cos_theta] =
            sine_cosine_of_turns((static_cast<float>(y) + 0.5f) / static_cast<float>(2 * height));
        for (int x = 0; x < width; ++x) {
            const auto [sine, cosine] =
                sine_cosine_of_turns((static_cast<float>(x) + 0.5f) / static_cast<float>(width));
            const Vec3f direction(-product(sin_theta, sine), cos_theta, product(sin_theta, cosine));
            const Vec3f value = detail::sky_radiance(direction);
            samples.insert(samples.end(), {value[0], value[1], value[2]});
        }
    }
    pixels.samples = std::move(samples);
    Environment sky;
    sky.panorama.name = "default sky";
    sky.panorama.pixels = std::make_shared<const Pixels>(std::move(pixels));
    sky.to_world = upright_environment(up);
    return sky;
}

}  // namespace hedgerow
