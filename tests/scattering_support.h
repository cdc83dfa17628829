/// Materials at a point, and sums over directions, for tests of what surfaces do to light.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <memory>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include <hedgerow/render/scattering/scattering.h>

namespace hedgerow::scatterings {

inline const Compensation& tables() {
    static const auto computed = std::make_unique<const Compensation>();
    return *computed;
}

/// A direction whose cosine to z is given, in the plane of x and z turned by `turns`.
inline Vec3f direction(double cosine, double turns = 0.1) {
    const double sine = std::sqrt(std::max(0.0, 1 - cosine * cosine)), angle = 2 * std::numbers::pi * turns;
    return Vec3f(Vec3d(sine * std::cos(angle), sine * std::sin(angle), cosine));
}

struct Surface {
    std::string name;
    SurfaceMaterial material;
    bool inside = false;
    bool compensated = true;

    Scattering at(const Vec3f& o) const { return at(o, inside); }
    Scattering at(const Vec3f& o, bool within) const {
        return {material, o, within, compensated ? &tables() : nullptr};
    }
    friend std::ostream& operator<<(std::ostream& out, const Surface& s) { return out << s.name; }
    /// The index on the other side over that on the side of o.
    float eta() const { return SurfaceParts(material, inside).eta; }
};

inline SurfaceMaterial matte(Vec3f colour) {
    SurfaceMaterial m;
    m.base_colour = colour;
    return m;
}
inline SurfaceMaterial metal(float roughness, Vec3f colour = {0.9f, 0.6f, 0.2f}) {
    SurfaceMaterial m = matte(colour);
    m.metallic = 1, m.roughness = roughness;
    return m;
}
inline SurfaceMaterial coated(float roughness, Vec3f colour = {0.9f, 0.6f, 0.2f}) {
    SurfaceMaterial m = matte(colour);
    m.specular = 1, m.roughness = roughness;
    return m;
}
inline SurfaceMaterial glass(float roughness, float ior = 1.5f, Vec3f colour = Vec3f::all(1)) {
    SurfaceMaterial m = coated(roughness, colour);
    m.transmission = 1, m.thin = false, m.ior = ior;
    return m;
}
inline SurfaceMaterial thin(float roughness, Vec3f colour = {0.9f, 0.6f, 0.2f}) {
    SurfaceMaterial m = glass(roughness, 1.5f, colour);
    m.thin = true;
    return m;
}
/// Some of everything.
inline SurfaceMaterial mixed(float roughness) {
    SurfaceMaterial m = glass(roughness, 1.4f, {0.9f, 0.6f, 0.2f});
    m.metallic = 0.3f, m.transmission = 0.6f, m.specular = 0.8f, m.specular_colour = {1, 0.5f, 2};
    return m;
}

inline std::vector<Surface> surfaces() {
    std::vector<Surface> all{{"matte", matte({0.9f, 0.6f, 0.2f})}};
    for (const float r : {0.05f, 0.2f, 0.5f, 1.0f}) {
        const std::string name = " of roughness " + std::to_string(r);
        all.push_back({"metal" + name, metal(r)});
        all.push_back({"coat" + name, coated(r)});
        all.push_back({"glass from outside" + name, glass(r)});
        all.push_back({"glass from inside" + name, glass(r), true});
        all.push_back({"thin glass" + name, thin(r)});
        all.push_back({"some of everything" + name, mixed(r)});
        all.push_back({"some of everything from inside" + name, mixed(r), true});
    }
    all.push_back({"smooth coat", coated(0)});
    all.push_back({"smooth mixture", mixed(0)});
    SurfaceMaterial matched = mixed(0.4f);
    matched.ior = 1.00001f;
    all.push_back({"metal beside an index of 1", matched});
    for (std::size_t k = 0, count = all.size(); k < count; ++k) {
        if (all[k].material.roughness < 0.3f) continue;
        all.push_back(all[k]);
        all.back().compensated = false;
        all.back().name += ", once";
    }
    return all;
}

/// Points of the unit cube that lie evenly (Roberts, The unreasonable effectiveness of quasirandom sequences,
/// 2018).
inline std::array<float, 3> even_point(int k) {
    const double g = 1.2207440846057596;
    std::array<float, 3> p;
    double step = 1;
    for (float& x : p) {
        step /= g;
        const double at = 0.5 + product(step, static_cast<double>(k + 1));
        x = std::min(static_cast<float>(at - std::floor(at)), 0x1.fffffep-1f);
    }
    return p;
}
/// The light that goes on from o, of white light from everywhere: the sum of the weights of samples, without
/// the factor of radiance.
inline Vec3d albedo(const Surface& s, const Vec3f& o, int samples) {
    const Scattering scattering = s.at(o);
    const double eta2 = static_cast<double>(s.eta()) * static_cast<double>(s.eta());
    Vec3d sum;
    for (int k = 0; k < samples; ++k) {
        const auto [choice, u, v] = even_point(k);
        if (const auto to = scattering.sample(choice, u, v))
            sum += Vec3d(to.weight) * (to.transmitted ? eta2 : 1.0);
    }
    return sum / static_cast<double>(samples);
}

/// Polar coordinates of the sphere around a direction, finer close to it. Both are in [0, 1].
class Chart {
public:
    Chart(const Vec3f& middle, double width)
        : z_(normalized(Vec3d(middle))), width_(width), growth_(std::log(1 + std::numbers::pi / width)) {
        x_ = normalized(cross(std::abs(z_[0]) < 0.5 ? Vec3d(1, 0, 0) : Vec3d(0, 1, 0), z_));
        y_ = cross(z_, x_);
    }
    Vec3f at(double t, double turn) const {
        const double angle = theta(t), around = 2 * std::numbers::pi * turn;
        return Vec3f(z_ * std::cos(angle) +
                     (x_ * std::cos(around) + y_ * std::sin(around)) * std::sin(angle));
    }
    /// Solid angle per unit of t and of turn.
    double area(double t) const {
        return 2 * std::numbers::pi * std::sin(theta(t)) * (theta(t) + width_) * growth_;
    }
    std::array<double, 2> of(const Vec3f& direction) const {
        const Vec3d d(direction);
        const double angle = std::atan2(length(cross(z_, d)), dot(z_, d));
        const double turn = std::atan2(dot(y_, d), dot(x_, d)) / (2 * std::numbers::pi);
        return {std::log(1 + angle / width_) / growth_, turn - std::floor(turn)};
    }

private:
    double theta(double t) const { return width_ * (std::exp(growth_ * t) - 1); }
    Vec3d x_, y_, z_;
    double width_, growth_;
};

/// One chart for each side of a surface, around where a smooth one would send the light.
inline std::array<Chart, 2> charts(const Surface& s, const Vec3f& o) {
    const double width = std::max(0.003, static_cast<double>(s.material.roughness * s.material.roughness));
    const Vec3f below = refracted(o, Vec3f(0, 0, 1), s.eta());
    return {Chart({-o[0], -o[1], o[2]}, width), Chart(below, width)};
}

/// The probability that χ² with that many degrees of freedom exceeds x (Wilson and Hilferty 1931).
inline double chi2_exceeds(double x, int degrees) {
    const double n = 9.0 * degrees / 2, cube = std::cbrt(x / degrees);
    return std::erfc((cube - (1 - 1 / n)) / std::sqrt(2 / n)) / 2;
}

}  // namespace hedgerow::scatterings
