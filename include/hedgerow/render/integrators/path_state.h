/// A path on its way, and the rays that look for its light.
#pragma once

#include <concepts>
#include <cstdint>

#include <hedgerow/probes/ray.h>

namespace hedgerow {

/// The light that a path brings to the eye.
struct PathLight {
    Vec3f all;
    /// The part that is scattered at most once between its source and the eye. The rest is indirect.
    Vec3f direct;

    static constexpr bool is_direct(std::uint32_t scatterings) { return scatterings <= 1; }
    /// Adds light that is scattered so often.
    void add(const Vec3f& light, std::uint32_t scatterings) {
        all = all + light;
        if (is_direct(scatterings)) direct = direct + light;
    }
};

/// A path between two vertices. Directions have length 1.
template <std::floating_point T>
struct PathState {
    Ray<T, 3> ray;
    Vec3f throughput = Vec3f::all(1);  ///< the share of light that gets to the eye
    PathLight light;                   ///< that has been found
    Vec3f absorption;                  ///< of the body that the ray is in
    /// The density of the ray's direction where it left a surface; 0 for the camera and for directions that a
    /// surface has a single one of. Light that it meets is then found in no other way.
    float density = 0;
    Vec3f left_at, left_normal;  ///< where that was, for the density of light sampling
    float spread = 1;          ///< of radiance by refraction: the product of η² over the path's boundaries
    std::uint32_t vertex = 0;  ///< the number of the next vertex
};

/// A ray that brings light to the eye, unless something is in its way.
template <std::floating_point T>
struct ShadowRay {
    Ray<T, 3> ray;
    Vec3f light;
    std::uint32_t vertex = 0;  ///< the number of the vertex where the ray begins
};

}  // namespace hedgerow
