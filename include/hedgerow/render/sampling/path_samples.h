/// The random numbers of a path: each a function of (seed, pixel, sample, dimension), so that a picture does
/// not depend on the order in which its paths are followed.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include <hedgerow/render/sampling/sobol.h>
#include <hedgerow/scenes/random.h>

namespace hedgerow {

/// How the samples of a pixel are spread: evenly, with each pair of dimensions a scrambled Sobol sequence, or
/// independently.
enum class Sampler : std::uint8_t { sobol, independent };
inline constexpr std::array<std::string_view, 2> sampler_names = {"sobol", "independent"};

/// A point in the unit square, [0, 1)². Multiples of 2⁻²⁴.
struct UnitPair {
    float x, y;
};

/// The samples of one pixel. A pixel's sequence may be taken in parts by number of the sample, in any order.
class PixelSequence {
public:
    /// `pixel` is its number in the picture. Sequences of one pixel with other `stream`s are independent.
    PixelSequence(Sampler sampler, std::uint64_t seed, std::uint64_t pixel, std::uint32_t stream = 0)
        : seed_(static_cast<std::uint32_t>(scattered(scattered(seed + 0x9E3779B97F4A7C15u) + pixel) >> 32) ^
                scattered32(stream)),
          sampler_(sampler) {}

    /// Pair `dimension` of a sample. O(1): integers alone.
    UnitPair pair(std::uint32_t sample, std::uint32_t dimension) const {
        return unit(fractions(sample, dimension));
    }
    /// The pair with all its bits.
    FractionPair fractions(std::uint32_t sample, std::uint32_t dimension) const {
        return fractions(sampler_, seed_, sample, dimension);
    }
    /// The pair of a sequence whose `seed()` is known.
    [[gnu::always_inline]] static constexpr FractionPair fractions(Sampler sampler, std::uint32_t seed,
                                                                   std::uint32_t sample,
                                                                   std::uint32_t dimension) {
        const std::uint32_t of_pair = scattered32(seed + scattered32(dimension));
        if (sampler == Sampler::sobol) return sobol_pair(sample, of_pair);
        const std::uint32_t x = scattered32(of_pair + scattered32(sample));
        return {x, scattered32(x + 0x9E3779B9u)};
    }
    std::uint32_t seed() const { return seed_; }
    Sampler sampler() const { return sampler_; }
    /// The first 24 bits of a fraction.
    static constexpr float unit(std::uint32_t fraction) {
        return static_cast<float>(fraction >> 8) * 0x1p-24f;
    }
    static constexpr UnitPair unit(const FractionPair& p) { return {unit(p.x), unit(p.y)}; }

private:
    std::uint32_t seed_;
    Sampler sampler_;
};

/// The numbers that a path takes at the camera: `count` pairs. A camera without a lens takes the first alone.
struct CameraSamples {
    static constexpr std::uint32_t count = 2;

    FractionPair pairs[count];

    UnitPair in_pixel() const { return PixelSequence::unit(pairs[0]); }
    UnitPair on_lens() const { return PixelSequence::unit(pairs[1]); }
};

/// The numbers that a path takes at a vertex: `count` pairs.
struct VertexSamples {
    static constexpr std::uint32_t count = 4;

    FractionPair pairs[count];

    UnitPair light_point() const { return PixelSequence::unit(pairs[0]); }
    UnitPair direction() const { return PixelSequence::unit(pairs[1]); }
    /// The number that chooses a light, with 32 bits, since there may be many; and one that chooses a lobe.
    double light_choice() const { return static_cast<double>(pairs[2].x) * 0x1p-32; }
    float lobe_choice() const { return PixelSequence::unit(pairs[2].y); }
    /// The number that decides whether the path goes on.
    float end() const { return PixelSequence::unit(pairs[3].x); }
};

/// The numbers of one path, in the order in which it takes them: those of the camera, then those of each
/// vertex.
class PathSamples {
public:
    PathSamples(const PixelSequence& pixel, std::uint32_t sample) : pixel_(pixel), sample_(sample) {}

    const PixelSequence& pixel() const { return pixel_; }
    std::uint32_t sample() const { return sample_; }

    CameraSamples at_camera() const { return from<CameraSamples>(0); }
    /// Vertex 0 is the first hit of the camera's ray.
    VertexSamples at(std::uint32_t vertex) const { return from<VertexSamples>(dimension(vertex)); }
    /// 32 random bits for the ray to a vertex and for the one to the light there.
    std::uint32_t ray_key(std::uint32_t vertex) const {
        return pixel_.fractions(sample_, dimension(vertex) + 3).y;
    }
    std::uint32_t shadow_key(std::uint32_t vertex) const {
        return scattered32(ray_key(vertex) + 0x9E3779B9u);
    }
    /// The dimension of the first pair of a vertex.
    static constexpr std::uint32_t dimension(std::uint32_t vertex) {
        return CameraSamples::count + VertexSamples::count * vertex;
    }

private:
    template <class Samples>
    Samples from(std::uint32_t first) const {
        Samples s;
        for (std::uint32_t k = 0; k < Samples::count; ++k) s.pairs[k] = pixel_.fractions(sample_, first + k);
        return s;
    }

    PixelSequence pixel_;
    std::uint32_t sample_;
};

}  // namespace hedgerow
