/// Colours: a heat map, a colour bar with its scale, and digits to label it.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include <hedgerow/geometry/elementary.h>
#include <hedgerow/geometry/vec.h>
#include <hedgerow/io/image.h>
#include <hedgerow/looks/colour.h>

namespace hedgerow {

/// Converts linear light to sRGB bytes. Components are clamped to 0..1.
inline Image::Pixel srgb(const Vec3f& linear) {
    Image::Pixel p;
    for (int k = 0; k < 3; ++k) p[static_cast<std::size_t>(k)] = srgb8_of_linear(linear[k]);
    return p;
}

/// The colour of x in a heat map: from dark violet at 0 by blue, green and yellow to red at 1. Brightness
/// rises most of the way. x is clamped.
inline Image::Pixel heat(float x) {
    static constexpr float stops[6][3] = {{20, 8, 45},    {52, 62, 160},  {26, 155, 150},
                                          {120, 205, 70}, {250, 205, 50}, {235, 60, 40}};
    const float at = std::clamp(x, 0.f, 1.f) * 5;
    const int i = std::min(4, static_cast<int>(at));
    const float f = at - static_cast<float>(i);
    Image::Pixel p;
    for (int k = 0; k < 3; ++k)
        p[static_cast<std::size_t>(k)] =
            static_cast<std::uint8_t>(std::lround(product(stops[i][k], 1 - f) + product(stops[i + 1][k], f)));
    return p;
}

/// Draws a number in white digits of 3×5 dots, `scale` pixels a dot, with its upper left corner at (x, y).
/// Draws only what fits.
inline void draw_number(Image& image, int x, int y, std::uint64_t number, int scale) {
    static constexpr std::uint16_t digits[10] = {0x7B6F, 0x2C97, 0x73E7, 0x73CF, 0x5BC9,
                                                 0x79CF, 0x79EF, 0x7292, 0x7BEF, 0x7BCF};
    for (const char c : std::to_string(number)) {
        for (int dot = 0; dot < 15; ++dot) {
            if (!(digits[c - '0'] >> (14 - dot) & 1)) continue;
            for (int dy = 0; dy < scale; ++dy)
                for (int dx = 0; dx < scale; ++dx) {
                    const int px = x + (dot % 3) * scale + dx, py = y + (dot / 3) * scale + dy;
                    if (px >= 0 && py >= 0 && px < image.width && py < image.height)
                        image.at(px, py) = {255, 255, 255};
                }
        }
        x += 4 * scale;
    }
}

/// A scale of colours for numbers from 0 to `most`, linear in the number or in the logarithm of 1 + the
/// number.
struct ColourScale {
    std::uint64_t most;
    bool logarithmic = false;

    /// The position of a number on the scale: 0 to 1, and more beyond its end.
    float at(float number) const {
        const float end = static_cast<float>(most);
        if (!(end > 0)) return 0;
        if (!logarithmic) return number / end;
        return static_cast<float>(logarithm(1 + double(number)) / logarithm(1 + double(end)));
    }
    /// The numbers to label the scale with: its quarters, or both ends and the powers of ten between. Powers
    /// close to the end are left out.
    std::vector<std::uint64_t> labels() const {
        if (!logarithmic) return {0, most / 4, most / 2, most * 3 / 4, most};
        std::vector<std::uint64_t> all = {0};
        for (std::uint64_t ten = 1; ten < most; ten *= 10) {
            if (at(static_cast<float>(ten)) < 0.95f) all.push_back(ten);
            if (ten > most / 10) break;
        }
        all.push_back(most);
        return all;
    }
};

namespace detail {
inline int bar_unit(const Image& image) {
    return std::max(1, image.height / 256);
}
}  // namespace detail

/// The column where the background of the bar begins; the image's width if there is no room for a bar. `most`
/// sets the width of the labels.
inline int colour_bar_left(const Image& image, std::uint64_t most) {
    const int unit = detail::bar_unit(image);
    const int label = (static_cast<int>(std::to_string(most).size()) * 4 + 1) * unit, wide = 6 * unit;
    if (image.width < 3 * (wide + label) || image.height < 8 * wide) return image.width;
    return image.width - label - wide - 4 * unit;
}
/// Draws a labelled bar along the right edge, from 0 at the bottom to the scale's most at the top. Draws
/// nothing without room.
inline void draw_colour_bar(Image& image, const ColourScale& scale) {
    const int unit = detail::bar_unit(image), ground = colour_bar_left(image, scale.most);
    if (ground == image.width) return;
    const int left = ground + 2 * unit, wide = 6 * unit, top = image.height / 8, bottom = image.height - top;
    // Fill the background.
    for (int y = top - 6 * unit; y < bottom + 6 * unit; ++y)
        for (int x = ground; x < image.width; ++x) image.at(x, y) = {12, 12, 16};
    // Draw the colours.
    for (int y = top; y < bottom; ++y)
        for (int x = left; x < left + wide; ++x)
            image.at(x, y) = heat(static_cast<float>(bottom - 1 - y) / static_cast<float>(bottom - top - 1));
    // Draw the labels beside the bar.
    for (const std::uint64_t number : scale.labels()) {
        const float high = scale.at(static_cast<float>(number)) * static_cast<float>(bottom - top);
        draw_number(image, left + wide + unit, bottom - static_cast<int>(high) - 2 * unit, number, unit);
    }
}

}  // namespace hedgerow
