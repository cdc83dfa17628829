/// The lights of a model: surfaces that emit, the file's lights and the environment.
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <vector>

#include <hedgerow/parallel/executor.h>
#include <hedgerow/render/lighting/default_sky.h>
#include <hedgerow/render/lighting/light_tree.h>
#include <hedgerow/render/model_scene.h>
#include <hedgerow/render/sampling/path_samples.h>

namespace hedgerow {

struct SceneLightsOptions {
    /// Where the zenith of the sky is that a scene without lights gets.
    Vec3f up{0, 1, 0};
    /// Whether a scene without lights gets a sky.
    bool default_sky = true;
    /// Whether directions to the environment leave those out that surfaces find well (EnvironmentMapOptions).
    /// Light sampling alone needs all.
    bool compensates = true;
};

/// Light from one of the lights, and the probability with which that was chosen; or from four, of F =
/// FloatLanes.
template <class F>
struct SampledLightOf {
    LightSampleOf<F> light;
    F probability = 0;

    /// Whether light arrives.
    MaskOf<F> arrives() const { return probability > 0 && light.arrives(); }
    explicit operator bool() const requires std::same_as<F, float> { return arrives(); }
};
using SampledLight = SampledLightOf<float>;

/// Chooses lights by a tree over them. Borrows the lookups. Const use is thread-safe.
template <std::floating_point T>
class SceneLights {
public:
    /// Lists the lights of a model: O(triangles of emissive objects, of each of their instances). Throws as
    /// Emitters and EnvironmentMap do.
    explicit SceneLights(const ModelScene<T>& scene, const SceneLightsOptions& options = {},
                         Executor& executor = serial_executor())
        : lookups_(scene.lookups()) {
        const Model<T>& model = lookups_.model();
        for (std::uint32_t i = 0; i < scene.instances().size(); ++i) add_surfaces(i);
        for (const Light& light : model.lights) note(emitters_.add(light), {});
        const EnvironmentMapOptions of_map{.compensates = options.compensates};
        if (model.environment)
            note(emitters_.add(EnvironmentMap(*model.environment, of_map)), {});
        else if (emitters_.empty() && options.default_sky)
            note(emitters_.add(EnvironmentMap(default_sky(options.up), of_map)), {}), has_default_sky_ = true;
        const auto& box = scene.bounds();
        tree_ = LightTree(emitters_, Box3f{Vec3f(box.low), Vec3f(box.high)}, executor);
    }
    SceneLights(const SceneLights&) = delete;
    SceneLights& operator=(const SceneLights&) = delete;

    const Emitters& emitters() const { return emitters_; }
    const EnvironmentMap* environment() const { return emitters_.environment(); }
    /// Whether the scene has no lights of its own.
    bool has_default_sky() const { return has_default_sky_; }

    /// Light that may arrive at a point, of a light that is chosen by a number in [0, 1). The normal has
    /// length 1, and light comes from its side; 0: from all sides. O(log lights).
    SampledLight sample(const Vec3f& point, const Vec3f& normal, double choice, const UnitPair& place) const {
        const LightChoice chosen = tree_.choose(point, normal, choice);
        if (!chosen) return {};
        SampledLight s{emitters_.sample(chosen.emitter, point, place.x, place.y), chosen.probability};
        if (varies(chosen.emitter) && s) s.light.radiance = emission(chosen.emitter, s.light.weights);
        return s;
    }
    /// The same at the four points where someone asks; no light at the others. (u, v): the places.
    SampledLightOf<FloatLanes> sample_four(LaneMask asks, const Vec<FloatLanes, 3>& point,
                                           const Vec<FloatLanes, 3>& normal, const DoubleLanes& choice,
                                           FloatLanes u, FloatLanes v) const {
        LightChoice chosen[FloatLanes::count];
        for (int k = 0; k < FloatLanes::count; ++k)
            if (asks[k]) chosen[k] = tree_.choose(lane(point, k), lane(normal, k), choice[k]);
        SampledLightOf<FloatLanes> s{
            emitters_.sample_four([&](int k) { return chosen[k].emitter; }, point, u, v),
            FloatLanes::each([&](int k) { return chosen[k].probability; })};
        const LaneMask vary =
            s.arrives() && LaneMask::each([&](int k) { return chosen[k] && varies(chosen[k].emitter); });
        if (any(vary)) {
            const auto looked_up = each_vector<FloatLanes>([&](int k) {
                return vary[k] ? emission(chosen[k].emitter, {s.light.weights[0][k], s.light.weights[1][k]})
                               : Vec3f();
            });
            s.light.radiance = select(vary, looked_up, s.light.radiance);
        }
        return s;
    }
    /// The density per solid angle with which `sample` finds the place that a ray from the point has hit; 0
    /// if no light is there. The direction has length 1. O(log lights).
    float density_of_hit(const Vec3f& point, const Vec3f& normal, const Vec3f& direction,
                         const Hit<T>& hit) const {
        const std::uint32_t emitter = emitter_at(hit);
        if (emitter == no_emitter) return 0;
        const float density = emitters_.density_toward(emitter, direction, static_cast<float>(hit.t));
        return density > 0 ? product(density, tree_.probability(point, normal, emitter)) : 0;
    }
    /// The probability with which `sample` chooses the environment at a point; 0 if there is none. O(log
    /// lights).
    float probability_of_sky(const Vec3f& point, const Vec3f& normal) const {
        return sky_ == no_emitter ? 0 : tree_.probability(point, normal, sky_);
    }

private:
    /// What an emitter is in the model, if it is a surface whose emission a texture varies.
    struct Source {
        bool varies = false, turned = false;  // turned: corners are in the order c, b, a
        std::uint32_t instance = 0, element = 0;
    };

    /// Whether a texture varies the emission of an emitter, and the emission by the weights of its corners.
    bool varies(std::uint32_t emitter) const { return sources_[emitter].varies; }
    Vec3f emission(std::uint32_t emitter, const Vec2f& weights) const {
        const Source& from = sources_[emitter];
        Hit<T> hit;
        hit.instance = from.instance, hit.element = from.element;
        hit.u = static_cast<T>(weights[0]);
        hit.v = static_cast<T>(from.turned ? std::max(0.0f, 1 - weights[0] - weights[1]) : weights[1]);
        return lookups_.emission(hit, {});
    }
    void note(std::uint32_t emitter, const Source& source) {
        if (emitter == no_emitter) return;
        sources_.push_back(source);
        if (std::holds_alternative<EnvironmentEmitter>(emitters_[emitter])) sky_ = emitter;
    }
    void add_surfaces(std::uint32_t instance) {
        Hit<T> hit;
        hit.instance = instance, hit.element = 0;
        const Object<T>& object = lookups_.object(hit);
        const auto& materials = lookups_.model().materials;
        const auto emits = [&](std::size_t i) {
            const Material& m = materials[object.material_of(i)];
            // Whatever is not black: the emitters refuse what is no light.
            return m.emission * m.emission_strength != Vec3f() && !m.unlit;
        };
        firsts_.push_back(no_emitter);
        bool any = false;
        for (std::size_t i = 0; i < object.mesh.size() && !any; ++i) any = emits(i);
        if (!any) return;
        firsts_.back() = static_cast<std::uint32_t>(of_triangles_.size());
        for (std::uint32_t i = 0; i < object.mesh.size(); ++i) {
            hit.element = i;
            of_triangles_.push_back(emits(i) ? add_triangle(hit) : no_emitter);
        }
    }
    std::uint32_t add_triangle(const Hit<T>& hit) {
        const PlacedObject& placed = lookups_.placed(hit);
        const Material& m = lookups_.material(hit);
        const auto triangle = lookups_.object(hit).mesh.view().triangle(hit.element);
        const auto there = [&](const Vec<T, 3>& p) { return Vec3f(placed.to_world.there().point(Vec3d(p))); };
        EmissiveTriangle emissive{there(triangle.a), there(triangle.b), there(triangle.c),
                                  m.emission * m.emission_strength, m.double_sided};
        if (placed.mirrors()) std::swap(emissive.a, emissive.c);
        const bool varies = bool(m.emission_texture);
        if (varies) emissive.radiance = tinted(emissive.radiance, lookups_.mean_of(m.emission_texture));
        const std::uint32_t emitter =
            emitters_.add(emissive, m.name.empty() ? lookups_.object(hit).name : m.name);
        note(emitter, {varies, placed.mirrors(), hit.instance, hit.element});
        return emitter;
    }
    std::uint32_t emitter_at(const Hit<T>& hit) const {
        const std::uint32_t first = firsts_[hit.instance];
        return first == no_emitter ? no_emitter : of_triangles_[first + hit.element];
    }

    const ModelLookups<T>& lookups_;
    Emitters emitters_;
    std::vector<Source> sources_;  // by emitter
    std::vector<std::uint32_t> firsts_,
        of_triangles_;  // by instance where its triangles begin; their emitters
    std::uint32_t sky_ = no_emitter;
    bool has_default_sky_ = false;
    LightTree tree_{Emitters()};
};

}  // namespace hedgerow
