/// Colours: a heat map, a colour bar with its scale, and digits to label it.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>

#include <hedgerow/geometry/vec.h>
#include <hedgerow/io/image.h>

namespace hedgerow {

/// Linear light to sRGB bytes.
inline Image::Pixel srgb(const Vec3f& linear) {
    Image::Pixel p;
    for (int k = 0; k < 3; ++k) {
        const float x = std::clamp(linear[k], 0.f, 1.f);
        const float s = x <= 0.0031308f ? 12.92f * x : 1.055f * std::pow(x, 1 / 2.4f) - 0.055f;
        p[static_cast<std::size_t>(k)] = static_cast<std::uint8_t>(std::lround(s * 255));
    }
    return p;
}

/// 0 to 1 from dark violet by blue, green and yellow to red: brightness rises most of the way.
inline Image::Pixel heat(float x) {
    static constexpr float stops[6][3] = {{20, 8, 45},    {52, 62, 160},  {26, 155, 150},
                                          {120, 205, 70}, {250, 205, 50}, {235, 60, 40}};
    const float at = std::clamp(x, 0.f, 1.f) * 5;
    const int i = std::min(4, static_cast<int>(at));
    const float f = at - static_cast<float>(i);
    Image::Pixel p;
    for (int k = 0; k < 3; ++k)
        p[static_cast<std::size_t>(k)] =
            static_cast<std::uint8_t>(std::lround(stops[i][k] * (1 - f) + stops[i + 1][k] * f));
    return p;
}

/// Digits of 3×5 dots, `scale` pixels a dot; draws what fits.
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

/// A bar along the right edge, from 0 at its foot to `most` at its head, labelled at quarters.
inline void draw_colour_bar(Image& image, std::uint64_t most) {
    const int scale = std::max(1, image.height / 256), wide = 6 * scale;
    const int label = (static_cast<int>(std::to_string(most).size()) * 4 + 1) * scale;
    if (image.width < 3 * (wide + label) || image.height < 40) return;
    const int left = image.width - label - wide - 2 * scale, top = image.height / 8,
              bottom = image.height - top;
    for (int y = top - 6 * scale; y < bottom + 6 * scale; ++y)
        for (int x = left - 2 * scale; x < image.width; ++x) image.at(x, y) = {12, 12, 16};
    for (int y = top; y < bottom; ++y)
        for (int x = left; x < left + wide; ++x)
            image.at(x, y) = heat(static_cast<float>(bottom - 1 - y) / static_cast<float>(bottom - top - 1));
    for (int q = 0; q <= 4; ++q)
        draw_number(image, left + wide + scale, bottom - (bottom - top) * q / 4 - 2 * scale,
                    most * static_cast<std::uint64_t>(q) / 4, scale);
}

}  // namespace hedgerow
