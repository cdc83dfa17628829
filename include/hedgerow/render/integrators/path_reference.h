/// Paths one by one, as in the textbook (Kajiya, The rendering equation, SIGGRAPH 1986; Pharr, Jakob and
/// Humphreys, Physically Based Rendering). The wavefront's pictures have these bits.
#pragma once

#include <span>

#include <hedgerow/render/integrators/path_step.h>
#include <hedgerow/render/tracer.h>

namespace hedgerow {

/// Rays of paths, one by one.
template <std::floating_point T>
class PathRays {
public:
    /// Borrows both.
    PathRays(const PathSurfaces<T>& surfaces, const Tracer<T>& tracer)
        : surfaces_(surfaces), tracer_(tracer) {}

    /// The keys decide at which hits surfaces are there that are not opaque (PathSurfaces::is_there).
    Hit<T> closest_hit(const Ray<T, 3>& ray, std::uint32_t key) const {
        Hit<T> hit;
        tracer_.closest_hits(RayArray<T, 3>(&ray, 1), {&hit, 1}, {}, filter(key));
        return hit;
    }
    bool is_blocked(const Ray<T, 3>& ray, std::uint32_t key) const {
        bool is = false;
        tracer_.any_hits(RayArray<T, 3>(&ray, 1), {&is, 1}, {}, filter(key));
        return is;
    }

private:
    typename Tracer<T>::Filter filter(std::uint32_t key) const {
        if (!surfaces_.has_holes()) return {};
        return [this, key](std::size_t, const Hit<T>& hit) { return surfaces_.is_there(hit, key); };
    }

    const PathSurfaces<T>& surfaces_;
    const Tracer<T>& tracer_;
};

template <std::floating_point T>
class PathReference {
public:
    /// Borrows all.
    PathReference(const PathWorld<T>& world, const Tracer<T>& tracer)
        : rays_(world.surfaces, tracer), steps_(world) {}

    /// The light that comes along a ray from the camera, whose direction has length 1.
    PathLight light(const Ray<T, 3>& ray, const PathSamples& samples) const {
        PathState<T> path;
        path.ray = ray;
        for (;;) {
            const Hit<T> hit = rays_.closest_hit(path.ray, samples.ray_key(path.vertex));
            PathVertex<T> vertex;
            if (!steps_.arrive(path, hit, vertex)) return path.light;
            const PointScattering<float> scattering = steps_.scattering_at(vertex);
            const VertexSamples numbers = samples.at(path.vertex);
            if (const auto shadow = steps_.look_for_light(path, vertex, scattering, numbers))
                if (!rays_.is_blocked(shadow->ray, samples.shadow_key(path.vertex)))
                    steps_.add_light(path, *shadow);
            if (!steps_.leave(path, vertex, scattering, numbers)) return path.light;
        }
    }

private:
    const PathRays<T> rays_;
    const PathSteps<T> steps_;
};

}  // namespace hedgerow
