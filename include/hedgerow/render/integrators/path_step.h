/// The steps of a path: it arrives at a surface, looks for light there, and leaves. Whoever follows paths,
/// one by one or many at once, takes these steps in this order, and gets the same bits.
#pragma once

#include <cmath>
#include <cstdint>
#include <optional>
#include <utility>

#include <hedgerow/render/integrators/path_group.h>
#include <hedgerow/render/integrators/path_options.h>
#include <hedgerow/render/lighting/scene_lights.h>

namespace hedgerow {

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

    /// Adds the light that a ray meets: of the environment, or of the surface that it hits. Returns whether
    /// the path may go on from there, and sets the vertex.
    bool arrive(PathState<T>& path, const Hit<T>& hit, PathVertex<T>& vertex) const {
        const bool arrives = arrive(path, hit, vertex, [&] { return world_.surfaces.front(hit); });
        if (arrives) vertex.set_origins(path.ray);
        return arrives;
    }
    /// Arrives where `front()` returns the normal that PathSurfaces::front has at the hit. The vertex does
    /// not get the origins of rays: `scatter` sets them.
    template <class Front>
    bool arrive(PathState<T>& path, const Hit<T>& hit, PathVertex<T>& vertex, const Front& front) const {
        if (!hit) return meet_sky(path), false;
        absorb(path, static_cast<float>(hit.t));
        world_.surfaces.find(path.ray, hit, front(), vertex);
        if (max_component(vertex.emission) > 0)
            add(path, vertex.emission, weight_of_hit(path, density_of_light(path, hit)));
        if (vertex.unlit) add(path, vertex.material.base_colour, 1);
        return !vertex.unlit && path.vertex < world_.options.bounces;
    }

    /// Adds the light of the environment to a path whose ray meets nothing else.
    void meet_sky(PathState<T>& path) const {
        const EnvironmentMap* const sky = world_.lights.environment();
        if (sky) meet_sky(path, *sky, sky->place_of(Vec3f(path.ray.direction)));
    }
    /// The same of several paths, which are let go.
    void meet_sky(LeavingPaths<T>& leaving) const {
        const int count = std::exchange(leaving.count, 0);
        const EnvironmentMap* const sky = world_.lights.environment();
        if (!sky) return;
        const auto directions = each_vector<FloatLanes>(
            [&](int k) { return Vec3f(leaving.paths[k < count ? k : 0]->ray.direction); });
        const auto places = sky->place_of(directions);
        for (int k = 0; k < count; ++k) meet_sky(*leaving.paths[k], *sky, lane(places, k));
    }

    PointScattering<float> scattering_at(const PathVertex<T>& at) const { return {at, world_.compensation}; }

    /// A ray to a light, with what it brings; nothing if no light may come from there.
    std::optional<ShadowRay<T>> look_for_light(const PathState<T>& path, const PathVertex<T>& at,
                                               const PointScattering<float>& scattering,
                                               const VertexSamples& samples) const {
        if (!world_.options.light_sampling || scattering.only_specular()) return std::nullopt;
        const SampledLight light = light_at(at, samples);
        if (!light) return std::nullopt;
        const LightToEye<float> s = to_eye(carried(path), scattering, light);
        if (!s.exists) return std::nullopt;
        return shadow_ray(path, at, light.light.direction, light.light.free, s.light);
    }
    /// May come after `leave`, and comes before the path arrives anew.
    void add_light(PathState<T>& path, const ShadowRay<T>& shadow) const {
        path.light.add(shadow.light, shadow.vertex + 1);
    }

    /// Chooses where the path goes on. False: it ends.
    bool leave(PathState<T>& path, const PathVertex<T>& at, const PointScattering<float>& scattering,
               const VertexSamples& samples) const {
        CarriedLight<float> carrying = carried(path);
        const Departure<float> next = depart(carrying, at, scattering, numbers(samples));
        if (next.exists) go(path, at, next, carrying.throughput, carrying.spread);
        return next.exists;
    }
    bool leave(PathState<T>& path, const PathVertex<T>& at, const PointScattering<float>& scattering,
               const PathSamples& samples) const {
        return leave(path, at, scattering, samples.at(path.vertex));
    }

    /// Looks for light at the vertices of all paths of a group, and leaves. `shadow(k, ray)` takes the
    /// shadow ray of path k, if there is one. Returns which paths go on. The bits are those of the steps of
    /// single paths.
    template <class Shadow>
    LaneMask scatter(PathGroup<T>& group, const Shadow& shadow) const {
        group.fill();
        group.set_origins();
        const auto at = points_in_lanes([&](int k) -> const auto& { return group.vertices[k]; });
        const PointScattering<FloatLanes> scattering(at, world_.compensation);
        CarriedLight<FloatLanes> carrying = carried(group);
        if (world_.options.light_sampling) {
            const SampledLightOf<FloatLanes> lights = lights_at(group, at, !scattering.only_specular());
            const LightToEye<FloatLanes> found = to_eye(carrying, scattering, lights);
            for (int k = 0; k < group.count; ++k)
                if (found.exists[k])
                    shadow(k, shadow_ray(*group.paths[k], group.vertices[k], lane(lights.light.direction, k),
                                         lights.light.free[k], lane(found.light, k)));
        }
        const Departure<FloatLanes> next = depart(carrying, at, scattering, numbers(group));
        for (int k = 0; k < group.count; ++k)
            if (next.exists[k])
                go(*group.paths[k], group.vertices[k], lane(next, k), lane(carrying.throughput, k),
                   carrying.spread[k]);
        return next.exists;
    }

private:
    CarriedLight<float> carried(const PathState<T>& path) const {
        return {path.throughput, path.spread, PathLight::is_direct(path.vertex + 1),
                path.vertex >= world_.options.roulette_from};
    }
    CarriedLight<FloatLanes> carried(const PathGroup<T>& group) const {
        using S = CarriedLight<float>;
        const auto of = [&](int k) { return carried(*group.paths[k]); };
        return {in_lanes(of, &S::throughput), in_lanes(of, &S::spread), in_lanes(of, &S::direct),
                in_lanes(of, &S::may_end)};
    }
    static WayNumbers<float> numbers(const VertexSamples& s) {
        return {s.lobe_choice(), s.direction().x, s.direction().y, s.end()};
    }
    static WayNumbers<FloatLanes> numbers(const PathGroup<T>& group) {
        using S = WayNumbers<float>;
        const auto of = [&](int k) { return numbers(group.samples[k]); };
        return {in_lanes(of, &S::lobe), in_lanes(of, &S::u), in_lanes(of, &S::v), in_lanes(of, &S::end)};
    }

    SampledLight light_at(const PathVertex<T>& at, const VertexSamples& samples) const {
        return world_.lights.sample(Vec3f(at.before), at.side_of_light(), samples.light_choice(),
                                    samples.light_point());
    }
    SampledLightOf<FloatLanes> lights_at(const PathGroup<T>& group, const SurfacePoint<FloatLanes>& at,
                                         LaneMask asks) const {
        const auto& samples = group.samples;
        return world_.lights.sample_four(
            asks, each_vector<FloatLanes>([&](int k) { return Vec3f(group.vertices[k].before); }),
            at.side_of_light(), DoubleLanes::each([&](int k) { return samples[k].light_choice(); }),
            in_lanes([&](int k) { return samples[k].light_point(); }, &UnitPair::x),
            in_lanes([&](int k) { return samples[k].light_point(); }, &UnitPair::y));
    }
    /// What light from a source becomes that is scattered here.
    template <class F>
    LightToEye<F> to_eye(const CarriedLight<F>& path, const PointScattering<F>& scattering,
                         const SampledLightOf<F>& sampled) const {
        const LightSampleOf<F>& light = sampled.light;
        const ScatteredLightOf<F> scattered = scattering.at(light.direction);
        const F density = product(light.density, sampled.probability);
        F share = 1 / density;
        if (world_.options.material_sampling) share *= power_heuristic(density, scattered.density);
        share = select(light.single, 1 / sampled.probability, share);
        const auto all = tinted(tinted(path.throughput, scattered.value), light.radiance) * share;
        return {sampled.arrives() && max_component(scattered.value) > 0, limited(all, path.direct)};
    }
    ShadowRay<T> shadow_ray(const PathState<T>& path, const PathVertex<T>& at, const Vec3f& direction,
                            float free, const Vec3f& to_eye) const {
        Ray<T, 3> ray = ray_from(at, direction);
        ray.t_max = static_cast<T>(free);
        return {ray, to_eye, path.vertex};
    }
    static Ray<T, 3> ray_from(const PathVertex<T>& at, const Vec3f& direction) {
        return {dot(direction, at.geometric) < 0 ? at.beyond : at.before, Vec<T, 3>(direction)};
    }
    /// Chooses where paths go on, and what they carry there. Roulette and cut may end them.
    template <class F>
    Departure<F> depart(CarriedLight<F>& path, const SurfacePoint<F>& at,
                        const PointScattering<F>& scattering, const WayNumbers<F>& numbers) const {
        Departure<F> next = scattering.sample(numbers.lobe, numbers.u, numbers.v);
        path.throughput = tinted(path.throughput, next.weight) * next.shown;
        const F eta = select(at.front, at.material.ior, 1 / at.material.ior);
        path.spread = select(next.transmitted && !at.material.thin, path.spread * (eta * eta), path.spread);

        const F left = max_component(path.throughput), stays = left * path.spread;
        const MaskOf<F> sure = !path.may_end || stays >= 1;
        next.exists = next.exists && left > world_.options.least_throughput && (sure || numbers.end < stays);
        path.throughput = select(sure, path.throughput, path.throughput / stays);
        return next;
    }
    static void go(PathState<T>& path, const PathVertex<T>& at, const Departure<float>& next,
                   const Vec3f& throughput, float spread) {
        path.throughput = throughput, path.spread = spread;
        if (next.transmitted && !at.material.thin) path.absorption = at.front ? at.absorption : Vec3f();
        path.density = next.density;
        path.ray = ray_from(at, next.direction);
        path.left_at = Vec3f(at.before), path.left_normal = at.side_of_light();
        ++path.vertex;
    }

    /// Veach's heuristic for two ways to find light, with squares: the weight of the first.
    template <class F>
    static F power_heuristic(F first, F second) {
        // By the ratio, whose square may be infinite.
        const F ratio = second / first;
        return 1 / (1 + product(ratio, ratio));
    }
    void meet_sky(PathState<T>& path, const EnvironmentMap& sky, const PanoramaPlace& place) const {
        const float density = path.density == 0
                                  ? 0
                                  : product(sky.density(place),
                                            world_.lights.probability_of_sky(path.left_at, path.left_normal));
        add(path, sky.radiance(place), weight_of_hit(path, density));
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
        if (!(weight > 0)) return;
        const Vec3f light = tinted(path.throughput, radiance) * weight;
        path.light.add(limited(light, PathLight::is_direct(path.vertex)), path.vertex);
    }
    /// Indirect light counts up to a limit.
    template <class F>
    Vec<F, 3> limited(const Vec<F, 3>& light, MaskOf<F> direct) const {
        const F brightest = max_component(light), limit = world_.options.brightest_indirect;
        return select(direct || !(brightest > limit), light, light * (limit / brightest));
    }
    static void absorb(PathState<T>& path, float distance) {
        for (int k = 0; k < 3; ++k)
            if (path.absorption[k] > 0) path.throughput[k] *= exponential(-(path.absorption[k] * distance));
    }

    PathWorld<T> world_;
};

}  // namespace hedgerow
