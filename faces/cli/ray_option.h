/// The rays of --ray and --fan, and the plane of their picture.
#pragma once

#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include <hedgerow/base/error.h>
#include <hedgerow/geometry/elementary.h>
#include <hedgerow/geometry/ray.h>

#include "draw.h"
#include "flat.h"

namespace hedgerow::cli {

/// Cells that no ray visits are drawn too, in the background, if a structure has at most this many cells.
inline constexpr std::size_t most_behind = 20'000;

inline constexpr double degree = std::numbers::pi / 180;

template <class T>
Section<2> section_along(const Ray<T, 2>&, const Upright&) {
    return {};
}
/// The plane through the ray and the scene's upward direction. If these are less than 26° apart (a cosine
/// above 0.9), another axis replaces the upward direction.
template <class T>
Section<3> section_along(const Ray<T, 3>& ray, const Upright& upright) {
    Section<3> section;
    section.origin = Vec3d(ray.origin);
    section.right = normalized(Vec3d(ray.direction));
    Vec3d up;
    up[upright.axis] = 1;
    if (std::abs(dot(up, section.right)) > 0.9) up = {up[2], up[0], up[1]};
    section.up = normalized(up - section.right * dot(up, section.right));
    return section;
}

/// The ray of --ray. Throws InputError unless it has 2·D numbers, and UsageError for a direction of length 0
/// or numbers that are not finite.
template <class T, int D>
Ray<T, D> ray_of(const DrawArguments& a) {
    if (a.ray.size() != 2 * D)
        throw InputError(
            fmt::format("--ray has {} numbers: {} are needed, the origin's and the direction's, as {}",
                        a.ray.size(), 2 * D, D == 2 ? "-1,0.5,1,0.1" : "-1,0.5,0.5,1,0.1,0"));
    Ray<T, D> ray;
    for (int k = 0; k < D; ++k) {
        ray.origin[k] = static_cast<T>(a.ray[static_cast<std::size_t>(k)]);
        ray.direction[k] = static_cast<T>(a.ray[std::size_t(k) + std::size_t(D)]);
    }
    if (!(length(Vec<double, D>(ray.direction)) > 0) || !finite(ray.origin) || !finite(ray.direction))
        throw UsageError("--ray: the direction must be finite and not zero, the origin finite");
    return ray;
}

/// The direction of a ray, turned by an angle in the plane of the picture, counterclockwise.
template <class T>
Vec2d turned(const Ray<T, 2>& ray, const Section<2>&, double angle) {
    const Vec2d along = normalized(Vec2d(ray.direction)), beside(-along[1], along[0]);
    return along * cosine(angle) + beside * sine(angle);
}
template <class T>
Vec3d turned(const Ray<T, 3>&, const Section<3>& section, double angle) {
    return section.right * cosine(angle) + section.up * sine(angle);
}
/// The rays of --fan: spread evenly over --angle, with the ray of --ray in the middle, the rightmost first.
template <class T, int D>
std::vector<Ray<T, D>> fan_of(const DrawArguments& a, const Ray<T, D>& middle, const Section<D>& section) {
    std::vector<Ray<T, D>> rays;
    for (int i = 0; i < a.fan; ++i) {
        const double share = double(i) / (a.fan - 1) - 0.5;
        rays.push_back({middle.origin, Vec<T, D>(turned(middle, section, share * a.angle * degree))});
    }
    return rays;
}

}  // namespace hedgerow::cli
