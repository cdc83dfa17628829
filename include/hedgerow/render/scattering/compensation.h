/// Gives back the light that a rough surface loses between its microfacets, by a lobe that is added (Kulla
/// and Conty, Revisiting physically based shading at Imageworks, SIGGRAPH 2017). The lobe is a product of
/// what is lost at both directions, so that it is reciprocal.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include <hedgerow/render/scattering/albedo_table.h>

namespace hedgerow {

/// What leaves a rough surface after one reflection, for two reflectances of the microfacets.
struct GgxAlbedo {
    float white = 1;    ///< for 1
    float grazing = 0;  ///< for (1 − cos)⁵

    static GgxAlbedo of_mirror(float cosine) { return {1, fifth_power(1 - cosine)}; }
    static GgxAlbedo of_mirror_average() { return {1, 1.0f / 21}; }
    Vec3f with(const SchlickFresnel& fresnel) const { return fresnel.of_bend(grazing, white); }
};

/// Tables of albedos, 70 KB. The constructor computes them, in about 0.2 s with one thread; one object serves
/// all materials. Const use is thread-safe. Cosines and the roughness (the square root of α) are in [0, 1].
class Compensation {
public:
    Compensation() {
        // Both tables have the same places, and the second one is filled in the order of the first.
        std::vector<float> grazing;
        white_.fill([&](std::size_t r, std::size_t c) {
            const VisibleMirrors mirrors(GgxTable::roughness(r), GgxTable::cosine(c));
            grazing.push_back(mirrors.grazing());
            return mirrors.white();
        });
        grazing_.fill([&](std::size_t r, std::size_t c) { return grazing[r * GgxTable::columns + c]; });
        const auto of_glass = mirrors_of_glass();
        for (std::size_t k = 0; k < indices; ++k) {
            // An index of exactly 1 has no half vectors. The limit is meant.
            const float root = product(static_cast<float>(k), index_step);
            const float f = std::max(product(root, root), 0x1p-11f), eta = (1 + f) / (1 - f);
            into_[k].fill([&](std::size_t r, std::size_t c) { return of_glass[r][c].glass(eta); });
            out_[k].fill([&](std::size_t r, std::size_t c) { return of_glass[r][c].glass(1 / eta); });
            refracted_[k] = 1 - mean_reflectance(eta);
        }
    }

    GgxAlbedo ggx(float roughness, float cosine) const {
        return {white_.at(roughness, cosine), grazing_.at(roughness, cosine)};
    }
    GgxAlbedo ggx_average(float roughness) const {
        return {white_.average(roughness), grazing_.average(roughness)};
    }
    /// The albedo of glass from one side: of reflected and refracted light. `eta` is the index of refraction
    /// beyond the surface over that before it. Indices beyond 3.74, and below its reciprocal, have the
    /// albedos of these.
    float glass(float roughness, float cosine, float eta) const {
        const BetweenPlaces k = place(eta);
        const auto& side = eta < 1 ? out_ : into_;
        return k.mix(side[k.low].at(roughness, cosine), side[k.low + 1].at(roughness, cosine));
    }
    float glass_average(float roughness, float eta) const {
        const BetweenPlaces k = place(eta);
        const auto& side = eta < 1 ? out_ : into_;
        return k.mix(side[k.low].average(roughness), side[k.low + 1].average(roughness));
    }
    /// The share of light from all directions that a smooth surface of glass refracts. From the denser side
    /// that share is less by the square of the index.
    float refracted_average(float eta) const {
        const BetweenPlaces k = place(eta);
        const float into = k.mix(refracted_[k.low], refracted_[k.low + 1]);
        return eta < 1 ? product(into, product(eta, eta)) : into;
    }

private:
    /// Indices are even in √((η − 1)/(η + 1)), because the critical angle moves most for indices close to 1.
    /// One of them is 1.5, and the last one is 3.74.
    static constexpr std::size_t indices = 18;
    static constexpr float index_step = 0.04472136f;

    using GgxTable = AlbedoTable<32, 48>;
    using GlassTable = AlbedoTable<16, 24>;

    /// The mirrors that are seen at each place of a table, by roughness and cosine.
    static std::vector<std::vector<VisibleMirrors>> mirrors_of_glass() {
        std::vector<std::vector<VisibleMirrors>> all(GlassTable::rows);
        for (std::size_t r = 0; r < GlassTable::rows; ++r)
            for (std::size_t c = 0; c < GlassTable::columns; ++c)
                all[r].emplace_back(GlassTable::roughness(r), GlassTable::cosine(c));
        return all;
    }
    static BetweenPlaces place(float eta) {
        const float dense = eta < 1 ? 1 / eta : eta;
        return {std::sqrt((dense - 1) / (dense + 1)) / (index_step * (indices - 1)), indices};
    }
    static float mean_reflectance(float eta) {
        constexpr int steps = 512;
        double sum = 0;
        for (int k = 0; k < steps; ++k) {
            const float c = (static_cast<float>(k) + 0.5f) / steps;
            sum += static_cast<double>(product(2 * c, dielectric_reflectance(c, eta)));
        }
        return rounded_to<float>(sum / steps);
    }

    GgxTable white_, grazing_;
    std::array<GlassTable, indices> into_, out_;
    std::array<float, indices> refracted_{};
};

}  // namespace hedgerow
