/// The directional albedo of rough surfaces, by quadrature: what share of light from one direction leaves at
/// all, if light between the microfacets is lost that would meet a second one.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <hedgerow/render/scattering/fresnel.h>
#include <hedgerow/render/scattering/ggx.h>

namespace hedgerow {

/// A place between two of `count` places that divide [0, 1] evenly.
struct BetweenPlaces {
    std::size_t low;
    float share;  ///< of the next place

    BetweenPlaces(float x, std::size_t count) {
        const float at = (x > 0 ? std::min(x, 1.0f) : 0.0f) * static_cast<float>(count - 1);
        low = std::min(static_cast<std::size_t>(at), count - 2);
        share = at - static_cast<float>(low);
    }
    float mix(float a, float b) const { return a + product(b - a, share); }
};

/// Where an AlbedoTable has its places of roughness: even in its square root, or in itself.
enum class RoughnessPlaces : std::uint8_t { even_in_root, even };

/// An albedo by the cosine of the direction and by roughness, linear between places. Places of the cosine are
/// even in its square root, because albedos bend most at grazing directions.
template <std::size_t roughnesses, std::size_t cosines,
          RoughnessPlaces places = RoughnessPlaces::even_in_root>
class AlbedoTable {
public:
    static constexpr std::size_t rows = roughnesses, columns = cosines;

    /// f(r, c) is called for each place, and returns its albedo.
    template <class F>
    void fill(F f) {
        for (std::size_t r = 0; r < roughnesses; ++r) {
            for (std::size_t c = 0; c < cosines; ++c) at_[r][c] = f(r, c);
            average_[r] = average(at_[r]);
        }
    }
    static float roughness(std::size_t r) {
        const float at = place(r, rows);
        return places == RoughnessPlaces::even ? at : product(at, at);
    }
    static float cosine(std::size_t c) { return product(place(c, columns), place(c, columns)); }

    float at(float roughness, float cosine) const {
        const BetweenPlaces r = row(roughness), c(root(cosine), cosines);
        const auto of_row = [&](const Row& row) { return c.mix(row[c.low], row[c.low + 1]); };
        return r.mix(of_row(at_[r.low]), of_row(at_[r.low + 1]));
    }
    /// The mean over all directions, weighted by the cosine, of what `at` returns.
    float average(float roughness) const {
        const BetweenPlaces r = row(roughness);
        return r.mix(average_[r.low], average_[r.low + 1]);
    }

private:
    using Row = std::array<float, cosines>;
    static BetweenPlaces row(float roughness) {
        return {places == RoughnessPlaces::even ? roughness : root(roughness), roughnesses};
    }
    static float root(float x) { return std::sqrt(std::max(x, 0.0f)); }
    static float place(std::size_t k, std::size_t count) {
        return static_cast<float>(k) / static_cast<float>(count - 1);
    }
    /// ∫ 2μ E dμ = ∫ 4x³ E dx for μ = x², with E linear in x on each part.
    static float average(const Row& row) {
        double sum = 0;
        for (std::size_t c = 0; c + 1 < cosines; ++c) {
            const double a = static_cast<double>(c), b = a + 1, a4 = a * a * a * a,
                         b4 = b * b * b * b;  // exact, as are their fifth powers
            const double cubes = b4 - a4, fourths = product(b4 * b - a4 * a, 0.8);  // ∫4x³, ∫4x⁴
            sum += product(product(b, cubes) - fourths, static_cast<double>(row[c]));
            sum += product(fourths - product(a, cubes), static_cast<double>(row[c + 1]));
        }
        const double last = static_cast<double>(cosines - 1);
        return rounded_to<float>(sum / (last * last * last * last));
    }

    std::array<Row, roughnesses> at_{};
    std::array<float, roughnesses> average_{};
};

/// A quadrature over the microfacets that a direction sees. Each is there for an equal share of what is
/// seen, but for a weight. The surface is symmetric, so that half a turn suffices.
class VisibleMirrors {
public:
    /// A roughness of 0 leaves one mirror. Others have places in so many turns and heights.
    VisibleMirrors(float roughness, float cosine, int turns = 16, int heights = 24)
        : o_(std::sqrt(std::max(1 - product(cosine, cosine), 0.0f)), 0, cosine),
          ggx_(product(roughness, roughness)) {
        if (!(roughness > 0)) {
            mirrors_.push_back(of_normal({0, 0, 1}, 1));
            return;
        }
        // Losses come from the steepest mirrors, which are few: 1 − v = t² puts more places among them. The
        // places of a row lie at different heights of their cells, and those of a column too, so that neither
        // share their errors.
        for (int j = 0; j < heights; ++j)
            for (int k = 0; k < turns; ++k) {
                const float t = (static_cast<float>(j) + within_cell(k, turns)) / static_cast<float>(heights);
                const float u =
                    (static_cast<float>(k) + within_cell(j, heights)) / static_cast<float>(2 * turns);
                const Vec3f h = ggx_.visible_normal(o_, u, 1 - product(t, t));
                mirrors_.push_back(of_normal(h, 2 * t / static_cast<float>(turns * heights)));
            }
    }

    /// The albedo of mirrors that reflect everything.
    float white() const {
        return sum([](const Mirror& m) { return m.sent_back; });
    }
    /// The albedo of mirrors with a Schlick reflectance of (1 − cos)⁵.
    float grazing() const {
        return sum([](const Mirror& m) { return product(m.sent_back, fifth_power(1 - m.cosine)); });
    }
    /// The albedo of glass: of reflected and refracted light together. `eta` is the index of refraction
    /// beyond the surface over that before it, and not 1.
    float glass(float eta) const {
        return sum([&](const Mirror& m) {
            const float share = dielectric_reflectance(m.cosine, eta);
            const float back = product(share, m.sent_back);
            if (!(share < 1)) return back;
            const float down = -refracted(o_, m.normal, eta)[2];
            return down > 0 ? back + product(1 - share, unshadowed(down)) : back;
        });
    }

private:
    struct Mirror {
        Vec3f normal;
        float cosine, weight;
        float sent_back;  ///< the share of reflected light that no other mirror is in the way of
    };

    /// The k-th of `count` even places in (0, 1), out of order. 7 divides no count.
    static float within_cell(int k, int count) {
        return (static_cast<float>(7 * k % count) + 0.5f) / static_cast<float>(count);
    }
    Mirror of_normal(const Vec3f& h, float weight) const {
        const float up = reflected(o_, h)[2];
        return {h, std::clamp(dot(o_, h), 0.0f, 1.0f), weight, up > 0 ? unshadowed(up) : 0.0f};
    }
    /// A direction that grazes a smooth surface is not shadowed.
    float unshadowed(float i) const {
        return o_[2] + ggx_.slant(o_[2]) > 0 ? ggx_.unshadowed(o_[2], i) : 1.0f;
    }
    template <class F>
    float sum(F f) const {
        double all = 0;
        for (const Mirror& m : mirrors_) all += static_cast<double>(product(m.weight, f(m)));
        return std::min(rounded_to<float>(all), 1.0f);
    }

    Vec3f o_;
    Ggx ggx_;
    std::vector<Mirror> mirrors_;
};

}  // namespace hedgerow
