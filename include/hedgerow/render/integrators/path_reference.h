/// Paths one by one, as in the textbook (Kajiya, The rendering equation, SIGGRAPH 1986; Pharr, Jakob and
/// Humphreys, Physically Based Rendering). The wavefront's pictures have these bits.
#pragma once

#include <span>

#include <hedgerow/render/integrators/path_step.h>
#include <hedgerow/render/tracer.h>

namespace hedgerow {

template <std::floating_point T>
class PathReference {
public:
    /// Borrows all.
    PathReference(const PathWorld<T>& world, const Tracer<T>& tracer)
        : world_(world), tracer_(tracer), steps_(world) {}

    /// The light that comes along a ray from the camera, whose direction has length 1.
    Vec3f light(const Ray<T, 3>& ray, const PathSamples& samples) const {
        PathState<T> path;
        path.ray = ray;
        for (;;) {
            const Hit<T> hit = closest_hit(path.ray, samples.ray_key(path.vertex));
            const auto vertex = steps_.arrive(path, hit);
            if (!vertex) return path.light;
            const Scattering scattering = steps_.scattering_at(*vertex);
            if (const auto shadow = steps_.look_for_light(path, *vertex, scattering, samples))
                if (!is_blocked(shadow->ray, samples.shadow_key(path.vertex)))
                    steps_.add_light(path, *shadow);
            if (!steps_.leave(path, *vertex, scattering, samples)) return path.light;
        }
    }

private:
    using Filter = typename Tracer<T>::Filter;

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
    Filter filter(std::uint32_t key) const {
        if (!world_.surfaces.has_holes()) return {};
        return [this, key](std::size_t, const Hit<T>& hit) { return world_.surfaces.is_there(hit, key); };
    }

    const PathWorld<T> world_;
    const Tracer<T>& tracer_;
    const PathSteps<T> steps_;
};

}  // namespace hedgerow
