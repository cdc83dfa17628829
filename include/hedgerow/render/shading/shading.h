/// The shadings: how the hit of a sample becomes a colour or a number.
#pragma once

#include <array>
#include <optional>
#include <string_view>

#include <hedgerow/geometry/elementary.h>
#include <hedgerow/geometry/vec.h>
#include <hedgerow/render/camera/camera.h>

namespace hedgerow {

/// How a picture is coloured. The last three show measurements in a heat map: nodes, leaves and primitives
/// visited (steps), primitives tested (tests), nanoseconds (time). For times each ray is timed three times,
/// and the least counts.
/// `diffuse` shows all surfaces alike, grey and matte; `colour` shows the looks of a model.
enum class Shading { normals, depth, diffuse, colour, steps, tests, time };
inline constexpr std::array<std::string_view, 7> shading_names = {"normals", "depth", "diffuse", "colour",
                                                                  "steps",   "tests", "time"};

/// Whether the shading shows a measurement.
constexpr bool counted(Shading s) {
    return s >= Shading::steps;
}
/// Whether the shading casts rays to the light.
constexpr bool is_lit(Shading s) {
    return s == Shading::diffuse || s == Shading::colour;
}
/// Whether the shading counts the visits of rays.
constexpr bool counts_visits(Shading s) {
    return s == Shading::steps || s == Shading::tests;
}
/// The shading of this name; nothing for a name that there is not.
constexpr std::optional<Shading> named_shading(std::string_view name) {
    for (std::size_t i = 0; i < shading_names.size(); ++i)
        if (shading_names[i] == name) return static_cast<Shading>(i);
    return std::nullopt;
}

/// Colours, as linear light, of grey surfaces; lit by a sky and a distant light.
class PlainShading {
public:
    /// The share of light that the grey surface reflects.
    static constexpr float grey = 0.62f;

    /// `diagonal` is that of the scene's box: depths are shown in proportion to it.
    PlainShading(const Camera& camera, float diagonal)
        : up_(camera.up), light_(light_of(camera)), diagonal_(diagonal) {}

    Vec3f background() const { return {0.28f, 0.36f, 0.48f}; }
    /// `t` is a distance: directions have length 1.
    Vec3f depth(float t) const { return Vec3f::all(exponential(-1.5f * t / (diagonal_ + 1e-30f))); }
    Vec3f normal(const Vec3f& n) const { return (n + Vec3f(1, 1, 1)) * 0.5f; }
    /// The light of the sky on a surface with this normal.
    Vec3f sky(const Vec3f& n) const {
        return Vec3f(0.20f, 0.24f, 0.32f) * (0.6f + product(0.4f, dot(n, up_))) * grey;
    }
    /// The direction towards the distant light, and its light on a surface that faces it by this cosine and
    /// is not in shadow.
    const Vec3f& to_light() const { return light_; }
    Vec3f direct(float facing) const { return Vec3f(0.85f, 0.80f, 0.70f) * facing * grey; }

private:
    static Vec3f light_of(const Camera& c) {
        if (length2(c.light) > 0) return normalized(c.light);
        const Vec3f forward = normalized(c.target - c.eye);
        return normalized(c.up + cross(forward, c.up) * 0.5f - forward * 0.35f);
    }

    Vec3f up_, light_;
    float diagonal_;
};

}  // namespace hedgerow
