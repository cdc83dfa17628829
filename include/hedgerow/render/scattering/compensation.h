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
template <class F>
struct GgxAlbedo {
    F white = 1;    ///< for 1
    F grazing = 0;  ///< for (1 − cos)⁵

    static GgxAlbedo of_mirror(F cosine) { return {1, fifth_power(1 - cosine)}; }
    static GgxAlbedo of_mirror_average() { return {1, 1.0f / 21}; }
    Vec<F, 3> with(const SchlickFresnelOf<F>& fresnel) const { return fresnel.of_bend(grazing, white); }
};

/// Tables of albedos, 100 KB. The constructor computes them, in about 0.3 s with one thread; one object
/// serves all materials. Const use is thread-safe. Cosines and the roughness (the square root of α) are in
/// [0, 1].
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

    template <class F>
    GgxAlbedo<F> ggx(F roughness, F cosine) const {
        const auto in = [&](const GgxTable& table) {
            return each_lane<F>([&](int k) { return table.at(lane(roughness, k), lane(cosine, k)); });
        };
        return {in(white_), in(grazing_)};
    }
    template <class F>
    GgxAlbedo<F> ggx_average(F roughness) const {
        const auto in = [&](const GgxTable& table) {
            return each_lane<F>([&](int k) { return table.average(lane(roughness, k)); });
        };
        return {in(white_), in(grazing_)};
    }
    /// The albedo of glass from one side: of reflected and refracted light. `eta` is the index of refraction
    /// beyond the surface over that before it. Indices beyond 3.74, and below its reciprocal, have the
    /// albedos of these.
    template <class F>
    F glass(F roughness, F cosine, F eta) const {
        return each_lane<F>([&](int k) {
            return of_index(lane(eta, k), [&](const GlassTable& table) {
                return table.at(lane(roughness, k), lane(cosine, k));
            });
        });
    }
    template <class F>
    F glass_average(F roughness, F eta) const {
        return each_lane<F>([&](int k) {
            return of_index(lane(eta, k),
                            [&](const GlassTable& table) { return table.average(lane(roughness, k)); });
        });
    }
    /// The share of light from all directions that a smooth surface of glass refracts. From the denser side
    /// that share is less by the square of the index.
    template <class F>
    F refracted_average(F eta) const {
        return each_lane<F>([&](int k) {
            const float e = lane(eta, k);
            const BetweenPlaces at = place(e);
            const float into = at.mix(refracted_[at.low], refracted_[at.low + 1]);
            return e < 1 ? product(into, product(e, e)) : into;
        });
    }

private:
    /// Indices are even in √((η − 1)/(η + 1)), because the critical angle moves most for indices close to 1.
    /// One of them is 1.5, and the last one is 3.74.
    static constexpr std::size_t indices = 18;
    static constexpr float index_step = 0.04472136f;

    using GgxTable = AlbedoTable<32, 48>;
    /// Light within glass meets its surface several times, so errors add up. Most of them come from between
    /// the rows, where roughness is about ½.
    using GlassTable = AlbedoTable<24, 24, RoughnessPlaces::even>;

    /// The mirrors that are seen at each place of a table, by roughness and cosine.
    static std::vector<std::vector<VisibleMirrors>> mirrors_of_glass() {
        std::vector<std::vector<VisibleMirrors>> all(GlassTable::rows);
        for (std::size_t r = 0; r < GlassTable::rows; ++r)
            for (std::size_t c = 0; c < GlassTable::columns; ++c)
                all[r].emplace_back(GlassTable::roughness(r), GlassTable::cosine(c));
        return all;
    }
    /// What f returns for the tables of an index, linear between them.
    template <class Of>
    float of_index(float eta, Of f) const {
        const BetweenPlaces k = place(eta);
        const auto& side = eta < 1 ? out_ : into_;
        return k.mix(f(side[k.low]), f(side[k.low + 1]));
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
