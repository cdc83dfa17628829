/// The steps of a path: it arrives at a surface, looks for light there, and leaves. Whoever follows paths,
/// one by one or many at once, takes these steps in this order, and gets the same bits.
#pragma once

#include <cmath>
#include <cstdint>
#include <optional>

#include <hedgerow/render/integrators/path_options.h>
#include <hedgerow/render/integrators/path_vertex.h>
#include <hedgerow/render/lighting/scene_lights.h>

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

/// What paths go through, and how.
template <std::floating_point T>
struct PathWorld {
    const PathSurfaces<T>& surfaces;
    const SceneLights<T>& lights;
    const PathOptions& options;
    const Compensation* compensation;  ///< null: none
};

template <std::floating_point T>
class PathSteps {
public:
    explicit PathSteps(const PathWorld<T>& world) : world_(world) {}

    /// Adds the light that a ray meets: of the environment, or of the surface that it hits. Returns the
    /// vertex if the path may go on from there.
    std::optional<PathVertex<T>> arrive(PathState<T>& path, const Hit<T>& hit) const {
        return arrive(path, hit, [&] { return world_.surfaces.front(hit); });
    }
    /// Arrives where `front()` returns the normal that PathSurfaces::front has at the hit.
    template <class Front>
    std::optional<PathVertex<T>> arrive(PathState<T>& path, const Hit<T>& hit, const Front& front) const {
        if (!hit) {
            meet_sky(path);
            return std::nullopt;
        }
        absorb(path, static_cast<float>(hit.t));
        PathVertex<T> vertex = world_.surfaces.at(path.ray, hit, front());
        if (max_component(vertex.emission) > 0)
            add(path, vertex.emission, weight_of_hit(path, density_of_light(path, hit)));
        if (vertex.unlit) add(path, vertex.material.base_colour, 1);
        if (vertex.unlit || path.vertex >= world_.options.bounces) return std::nullopt;
        return vertex;
    }

    Scattering scattering_at(const PathVertex<T>& at) const {
        return {at.material, at.shading.to_local(at.toward_origin), !at.front, world_.compensation};
    }

    /// A ray to a light, with what it brings; nothing if no light may come from there.
    std::optional<ShadowRay<T>> look_for_light(const PathState<T>& path, const PathVertex<T>& at,
                                               const Scattering& scattering,
                                               const VertexSamples& samples) const {
        if (!world_.options.light_sampling || scattering.only_specular()) return std::nullopt;
        const Vec3f point(at.before);
        const SampledLight sampled =
            world_.lights.sample(point, side_of_light(at), samples.light_choice(), samples.light_point());
        if (!sampled) return std::nullopt;
        const LightSample& light = sampled.light;
        const ScatteredLight scattered = scattered_by_horizon(at, scattering, light.direction);
        if (!(max_component(scattered.value) > 0)) return std::nullopt;
        const float density = product(light.density, sampled.probability);
        float share = 1 / sampled.probability;
        if (!light.single) {
            share = 1 / density;
            if (world_.options.material_sampling) share *= power_heuristic(density, scattered.density);
        }
        ShadowRay<T> shadow;
        shadow.light =
            limited(path, tinted(tinted(path.throughput, scattered.value), light.radiance) * share, 1);
        shadow.vertex = path.vertex;
        const bool beyond = dot(light.direction, at.geometric) < 0;
        shadow.ray = {beyond ? at.beyond : at.before, Vec<T, 3>(light.direction), T(0),
                      static_cast<T>(light.free)};
        return shadow;
    }
    /// May come after `leave`, and comes before the path arrives anew.
    void add_light(PathState<T>& path, const ShadowRay<T>& shadow) const {
        path.light.add(shadow.light, shadow.vertex + 1);
    }

    /// Chooses where the path goes on. False: it ends.
    bool leave(PathState<T>& path, const PathVertex<T>& at, const Scattering& scattering,
               const VertexSamples& samples) const {
        const UnitPair p = samples.direction();
        const auto next = scattering.sample(samples.lobe_choice(), p.x, p.y);
        if (!next) return false;
        Vec3f direction = normalized(at.shading.to_world(next->direction));
        if (!same_side(at, direction, next->direction)) return false;
        path.throughput = tinted(path.throughput, next->weight);
        if (!next->specular) path.throughput = path.throughput * shown_share(at, direction);
        if (next->transmitted && !at.material.thin) {
            const float eta = at.front ? at.material.ior : 1 / at.material.ior;
            path.spread *= eta * eta;
            path.absorption = at.front ? at.absorption : Vec3f();
        }
        path.density = next->specular ? 0 : next->density;
        const Vec3f image = at.mirrored(direction);
        const bool below = at.is_below_horizon(direction);
        if (path.density > 0 && (below || at.is_below_horizon(image)))
            path.density += scattered(at, scattering, image).density;
        if (below) direction = image;
        const bool beyond = dot(direction, at.geometric) < 0;
        path.ray = {beyond ? at.beyond : at.before, Vec<T, 3>(direction)};
        path.left_at = Vec3f(at.before), path.left_normal = side_of_light(at);
        return goes_on(path, samples);
    }
    bool leave(PathState<T>& path, const PathVertex<T>& at, const Scattering& scattering,
               const PathSamples& samples) const {
        return leave(path, at, scattering, samples.at(path.vertex));
    }

private:
    /// Veach's heuristic for two ways to find light, with squares: the weight of the first.
    static float power_heuristic(float first, float second) {
        // By the ratio, whose square may be infinite.
        const float ratio = second / first;
        return 1 / (1 + product(ratio, ratio));
    }
    /// The normal on whose side the light is that a surface scatters; 0: on both.
    static Vec3f side_of_light(const PathVertex<T>& at) {
        return at.material.transmission > 0 ? Vec3f() : at.geometric;
    }
    /// Whether a direction lies on the same side of the surface as of the plane across the shading normal.
    /// Others would let light through walls, or are reflections into the surface.
    static bool same_side(const PathVertex<T>& at, const Vec3f& direction, const Vec3f& local) {
        return (dot(direction, at.geometric) > 0) == (local[2] > 0) && local[2] != 0;
    }
    /// What the surface does with light of a direction; nothing where it must not.
    static ScatteredLight scattered(const PathVertex<T>& at, const Scattering& scattering,
                                    const Vec3f& direction) {
        const Vec3f i = at.shading.to_local(direction);
        if (!same_side(at, direction, i)) return {};
        ScatteredLight s = scattering.at(i);
        s.value = s.value * shown_share(at, direction);
        return s;
    }
    /// What it does with light that a ray of this direction meets. Directions between the smooth surface and
    /// the triangle before it are mirrored in the triangle, as if it were the surface next to the point: rays
    /// that begin below a triangle could get through a wall at its edge, and without their light a closed
    /// room would be too dark.
    static ScatteredLight scattered_by_horizon(const PathVertex<T>& at, const Scattering& scattering,
                                               const Vec3f& direction) {
        if (at.is_below_horizon(direction)) return {};
        ScatteredLight s = scattered(at, scattering, direction);
        if (const Vec3f image = at.mirrored(direction); at.is_below_horizon(image)) {
            const ScatteredLight more = scattered(at, scattering, image);
            s.value += more.value, s.density += more.density;
        }
        return s;
    }
    /// The share of light from a direction that an opaque surface shows.
    static float shown_share(const PathVertex<T>& at, const Vec3f& direction) {
        if (at.material.transmission > 0) return 1;
        return share_at_terminator(at.shading.normal(), at.geometric, direction);
    }
    void meet_sky(PathState<T>& path) const {
        const EnvironmentMap* const sky = world_.lights.environment();
        if (!sky) return;
        const Vec3f direction(path.ray.direction);
        if (path.density == 0) return add(path, sky->radiance(direction), 1);
        const EnvironmentSample from = sky->at(direction);
        const float chosen = world_.lights.probability_of_sky(path.left_at, path.left_normal);
        add(path, from.radiance, weight_of_hit(path, product(from.density, chosen)));
    }
    float density_of_light(const PathState<T>& path, const Hit<T>& hit) const {
        if (path.density == 0) return 0;
        return world_.lights.density_of_hit(path.left_at, path.left_normal, Vec3f(path.ray.direction), hit);
    }
    /// The weight of light that a ray meets, which light sampling finds with this density.
    float weight_of_hit(const PathState<T>& path, float density) const {
        const PathOptions& o = world_.options;
        if (path.density == 0 || !o.light_sampling || density == 0) return 1;
        return o.material_sampling ? power_heuristic(path.density, density) : 0;
    }
    void add(PathState<T>& path, const Vec3f& radiance, float weight) const {
        if (weight > 0)
            path.light.add(limited(path, tinted(path.throughput, radiance) * weight, 0), path.vertex);
    }
    /// Indirect light counts up to a limit. `more`: how often light is scattered at the vertex where the path
    /// is.
    Vec3f limited(const PathState<T>& path, const Vec3f& light, std::uint32_t more) const {
        const float brightest = max_component(light), limit = world_.options.brightest_indirect;
        return !PathLight::is_direct(path.vertex + more) && brightest > limit ? light * (limit / brightest)
                                                                              : light;
    }
    static void absorb(PathState<T>& path, float distance) {
        for (int k = 0; k < 3; ++k)
            if (path.absorption[k] > 0) path.throughput[k] *= exponential(-(path.absorption[k] * distance));
    }
    /// Roulette and cut, after the vertex; counts it.
    bool goes_on(PathState<T>& path, const VertexSamples& samples) const {
        const PathOptions& o = world_.options;
        const float left = max_component(path.throughput);
        const std::uint32_t vertex = path.vertex++;
        if (!(left > o.least_throughput)) return false;
        const float stays = left * path.spread;
        if (vertex < o.roulette_from || stays >= 1) return true;
        if (!(samples.end() < stays)) return false;
        path.throughput = path.throughput / stays;
        return true;
    }

    PathWorld<T> world_;
};

}  // namespace hedgerow
