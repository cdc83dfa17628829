/// The lights of a scene as one flat list, as a path tracer samples them.
#pragma once

#include <cstdint>
#include <limits>
#include <numbers>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include <hedgerow/base/error.h>
#include <hedgerow/geometry/elementary.h>
#include <hedgerow/looks/light.h>
#include <hedgerow/render/lighting/environment_map.h>
#include <hedgerow/render/lighting/light_bounds.h>
#include <hedgerow/render/lighting/light_shapes.h>

namespace hedgerow {

/// The ordinal of an emitter that does not exist.
inline constexpr std::uint32_t no_emitter = 0xFFFFFFFFu;

/// Stands in the list for the environment.
struct EnvironmentEmitter {};

using Emitter = std::variant<EmissiveTriangle, PointEmitter, SpotEmitter, SunEmitter, EnvironmentEmitter>;

/// All sources of light, numbered in the order in which they were added. Const use is thread-safe.
class Emitters {
public:
    /// Each adds a source and returns its ordinal, or `no_emitter` if the source is dropped because no light
    /// comes from it: a triangle without area (counted by `without_area`), or whatever emits nothing (counted
    /// by `dark`). They throw InputError for positions that are not finite, for emission that is not finite
    /// or negative, for a direction of length 0, and for angles of a spot that break
    /// 0 <= inner < outer <= π/2. The error says which light it is by its name, or by the number of lights
    /// before it if it has none. O(1), amortized.
    std::uint32_t add(const EmissiveTriangle& triangle, std::string_view name = {}) {
        expect(finite(triangle.a) && finite(triangle.b) && finite(triangle.c), name,
               "position must be finite");
        if (is_dark(triangle.radiance, name)) return no_emitter;
        if (!(length2(triangle.normal()) > 0)) return ++without_area_, no_emitter;
        return append(triangle);
    }
    std::uint32_t add(const PointLight& light) {
        expect(finite(Vec3f(light.position)), light.name, "position must be finite");
        if (is_dark(light.intensity, light.name)) return no_emitter;
        return append(PointEmitter{Vec3f(light.position), light.intensity});
    }
    std::uint32_t add(const SpotLight& light) {
        expect(finite(Vec3f(light.position)), light.name, "position must be finite");
        // π/2 in float is above π/2.
        expect(0 <= light.inner && light.inner < light.outer && light.outer <= 1.5707964, light.name,
               "angles must satisfy 0 <= inner < outer <= π/2");
        const Vec3f axis = unit(light.direction, light.name);
        if (is_dark(light.intensity, light.name)) return no_emitter;
        return append(SpotEmitter{Vec3f(light.position), axis, light.intensity, light.inner, light.outer,
                                  cosine(light.inner), cosine(light.outer)});
    }
    std::uint32_t add(const DirectionalLight& light) {
        const Vec3f toward = -unit(light.direction, light.name);
        if (is_dark(light.illuminance, light.name)) return no_emitter;
        return append(SunEmitter{toward, light.illuminance});
    }
    std::uint32_t add(const Light& light) {
        return std::visit([&](const auto& l) { return add(l); }, light);
    }
    /// Adds the environment. Throws InputError if there is one already.
    std::uint32_t add(EnvironmentMap map) {
        if (environment_) throw InputError("a scene has one environment at most: leave the others out");
        if (!map.lit()) return ++dark_, no_emitter;
        environment_ = std::move(map);
        return append(EnvironmentEmitter{});
    }

    std::size_t size() const { return emitters_.size(); }
    bool empty() const { return emitters_.empty(); }
    const Emitter& operator[](std::size_t i) const { return emitters_[i]; }
    /// The environment; null if there is none that gives light.
    const EnvironmentMap* environment() const { return environment_ ? &*environment_ : nullptr; }
    /// How many sources were dropped: triangles without area, and sources that emit nothing.
    std::size_t without_area() const { return without_area_; }
    std::size_t dark() const { return dark_; }

    /// Samples the light that arrives at a point from emitter i, by two numbers in [0, 1). O(1), and O(log
    /// cells) for the environment.
    LightSample sample(std::size_t i, const Vec3f& point, float u, float v) const {
        if (const auto* triangle = std::get_if<EmissiveTriangle>(&emitters_[i]))
            return triangle->sample(point, u, v);
        if (const auto* light = std::get_if<PointEmitter>(&emitters_[i])) return light->sample(point);
        if (const auto* light = std::get_if<SpotEmitter>(&emitters_[i])) return light->sample(point);
        if (const auto* light = std::get_if<SunEmitter>(&emitters_[i])) return light->sample();
        return from_environment(environment_->sample(u, v));
    }
    /// The same at four points, of the emitters which(0) to which(3); no light for those that are
    /// `no_emitter`. Triangles are sampled side by side, and so is the environment.
    template <class Which>
    LightSampleOf<FloatLanes> sample_four(const Which& which, const Vec<FloatLanes, 3>& point, FloatLanes u,
                                          FloatLanes v) const {
        const auto emitter = [&](int k) { return which(k) == no_emitter ? nullptr : &emitters_[which(k)]; };
        const LaneMask triangles = lanes_of<EmissiveTriangle>(emitter),
                       skies = lanes_of<EnvironmentEmitter>(emitter);
        LightSampleOf<FloatLanes> s;
        if (any(triangles))
            s = select(triangles, triangles_in_lanes(emitter, triangles).sample(point, u, v), s);
        if (any(skies)) s = select(skies, from_environment(environment_->sample(u, v)), s);
        for (int k = 0; k < FloatLanes::count; ++k)
            if (emitter(k) && !triangles[k] && !skies[k])
                s = select(LaneMask::each([k](int i) { return i == k; }),
                           in_all_lanes(sample(which(k), lane(point, k), u[k], v[k])), s);
        return s;
    }
    /// The density per solid angle with which `sample` chooses a direction that a ray, not sampled from
    /// emitter i, has met it by. The direction has length 1; the distance is to the hit, and does not matter
    /// for the environment. 0 for point, spot and sun, which no ray meets.
    float density_toward(std::size_t i, const Vec3f& direction, float distance) const {
        if (const auto* triangle = std::get_if<EmissiveTriangle>(&emitters_[i]))
            return triangle->density_toward(direction, distance);
        return std::holds_alternative<EnvironmentEmitter>(emitters_[i]) ? environment_->density(direction)
                                                                        : 0.0f;
    }
    /// The radiance that a ray of this direction meets at emitter i. 0 for point, spot and sun.
    Vec3f radiance_toward(std::size_t i, const Vec3f& direction) const {
        if (const auto* triangle = std::get_if<EmissiveTriangle>(&emitters_[i]))
            return triangle->radiance_toward(direction);
        return std::holds_alternative<EnvironmentEmitter>(emitters_[i]) ? environment_->radiance(direction)
                                                                        : Vec3f();
    }

    /// Whether emitter i has a position. The sun and the environment have none.
    bool has_position(std::size_t i) const { return emitters_[i].index() < 3; }
    /// Bounds of an emitter that has a position.
    LightBounds bounds(std::size_t i) const {
        LightBounds b;
        b.cos_emission = 0;
        if (const auto* triangle = std::get_if<EmissiveTriangle>(&emitters_[i])) {
            b.box = triangle->bounds();
            b.normals.axis = Vec3f(normalized(triangle->normal()));
            b.both_sides = triangle->both_sides;
            b.intensity = product(triangle->area(), detail::brightness(triangle->radiance));
        } else if (const auto* point = std::get_if<PointEmitter>(&emitters_[i])) {
            b.box.expand(point->position);
            b.normals = NormalCone::all();
            b.intensity = detail::brightness(point->intensity);
        } else if (const auto* spot = std::get_if<SpotEmitter>(&emitters_[i])) {
            b.box.expand(spot->position);
            b.normals = {spot->axis, rounded_to<float>(spot->cos_inner),
                         rounded_to<float>(sine(spot->inner))};
            b.cos_emission = std::max(0.0f, rounded_to<float>(cosine(spot->outer - spot->inner)));
            b.intensity = detail::brightness(spot->intensity);
        }
        return b;
    }
    /// The flux of emitter i, all colours averaged; that of the sun and the environment is what a scene
    /// within a sphere of this radius receives.
    double power(std::size_t i, double radius) const {
        // Rounded, so that no sum of powers fuses with a product.
        return rounded(unrounded_power(i, product(pi, product(radius, radius))));
    }

private:
    static constexpr double pi = std::numbers::pi;

    /// The power; that of the sun and the environment is what a disc of this area receives.
    double unrounded_power(std::size_t i, double disc) const {
        if (const auto* triangle = std::get_if<EmissiveTriangle>(&emitters_[i]))
            return (triangle->both_sides ? 2 : 1) * pi * triangle->area() *
                   detail::brightness(triangle->radiance);
        if (const auto* point = std::get_if<PointEmitter>(&emitters_[i]))
            return 4 * pi * detail::brightness(point->intensity);
        if (const auto* spot = std::get_if<SpotEmitter>(&emitters_[i]))
            // The square of a linear fall has the mean 1/3 between the cosines.
            return 2 * pi * detail::brightness(spot->intensity) *
                   ((1 - spot->cos_inner) + (spot->cos_inner - spot->cos_outer) / 3);
        if (const auto* sun = std::get_if<SunEmitter>(&emitters_[i]))
            return disc * detail::brightness(sun->illuminance);
        return 4 * pi * disc * detail::brightness(environment_->mean());
    }
    template <class F>
    static LightSampleOf<F> from_environment(const EnvironmentSampleOf<F>& s) {
        constexpr float infinity = std::numeric_limits<float>::infinity();
        return {s.direction, infinity, infinity, s.radiance, s.density, MaskOf<F>(false), {}};
    }
    /// Which of four emitters are of a kind.
    template <class Kind, class Of>
    static LaneMask lanes_of(const Of& emitter) {
        return LaneMask::each([&](int k) { return emitter(k) && std::holds_alternative<Kind>(*emitter(k)); });
    }
    /// The triangles of four emitters; of those that are none, some triangle.
    template <class Of>
    static EmissiveTriangleOf<FloatLanes> triangles_in_lanes(const Of& emitter, LaneMask are) {
        using S = EmissiveTriangle;
        int some = 0;
        while (!are[some]) ++some;
        const auto triangle = [&](int k) -> const S& {
            return *std::get_if<EmissiveTriangle>(emitter(are[k] ? k : some));
        };
        return {in_lanes(triangle, &S::a), in_lanes(triangle, &S::b), in_lanes(triangle, &S::c),
                in_lanes(triangle, &S::radiance), in_lanes(triangle, &S::both_sides)};
    }
    void expect(bool sound, std::string_view name, const char* what) const {
        if (sound) return;
        const std::string which =
            name.empty() ? std::to_string(emitters_.size()) : "'" + std::string(name) + "'";
        throw InputError("light " + which + ": its " + what);
    }
    /// Counts emission of 0. Refuses emission that is no light.
    bool is_dark(const Vec3f& emission, std::string_view name) {
        expect(finite(emission) && emission[0] >= 0 && emission[1] >= 0 && emission[2] >= 0, name,
               "emission must be finite and not negative in all colours");
        if (emission != Vec3f()) return false;
        ++dark_;
        return true;
    }
    Vec3f unit(const Vec3d& direction, std::string_view name) const {
        const Vec3f d(normalized(direction));
        expect(finite(d) && length2(d) > 0.5f, name, "direction must be finite and longer than 0");
        return d;
    }
    std::uint32_t append(const Emitter& emitter) {
        if (emitters_.size() >= no_emitter) throw InputError("there are too many lights for one list");
        emitters_.push_back(emitter);
        return static_cast<std::uint32_t>(emitters_.size() - 1);
    }

    std::vector<Emitter> emitters_;
    std::optional<EnvironmentMap> environment_;
    std::size_t without_area_ = 0, dark_ = 0;
};

}  // namespace hedgerow
