/// Where the samples of a pixel lie, so that each weighs the same (Ernst, Stamminger and Greiner, Filter
/// importance sampling, RT 2006).
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <string_view>

#include <hedgerow/geometry/elementary.h>
#include <hedgerow/geometry/vec.h>

namespace hedgerow {

/// The pixel's square; or a Gaussian about its middle with a standard deviation of half a pixel, up to three
/// of them, which leaves less of steps and moiré.
enum class PixelFilter : std::uint8_t { box, gaussian };
inline constexpr std::array<std::string_view, 2> pixel_filter_names = {"box", "gaussian"};

/// The place of a sample from the upper left corner of its pixel, in pixels, by two numbers in [0, 1). O(1).
inline Vec2f place_in_pixel(PixelFilter filter, float u, float v) {
    if (filter == PixelFilter::box) return {u, v};
    constexpr double deviation = 0.5, inside = 0.98889100346175773;  // 1 − exp(−3²/2)
    const double radius = deviation * std::sqrt(-2 * logarithm(1 - product(inside, static_cast<double>(u))));
    const auto [sine, cosine] = sine_cosine_of_turns(v);
    const auto r = static_cast<float>(radius);
    return {0.5f + product(r, cosine), 0.5f + product(r, sine)};
}

}  // namespace hedgerow
