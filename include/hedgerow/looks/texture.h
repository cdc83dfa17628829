/// Images that vary a colour or a number over a surface.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <type_traits>
#include <variant>
#include <vector>

#include <hedgerow/geometry/vec.h>
#include <hedgerow/looks/colour.h>

namespace hedgerow {

/// The samples of an image as its file has them: rows from the top, each from left to right, and `channels`
/// samples a pixel. One channel is grey, two are grey and opacity, three are red, green and blue, and four
/// are these and opacity. Whole numbers stand for 0 to 1; floats stand for themselves.
struct Pixels {
    int width = 0, height = 0, channels = 0;
    std::variant<std::vector<std::uint8_t>, std::vector<std::uint16_t>, std::vector<float>> samples;

    bool is_float() const { return samples.index() == 2; }
};

/// How whole numbers encode a colour. Opacities and floats are linear in any case.
enum class ColourSpace : std::uint8_t { linear, srgb };
/// Which texel lies at a coordinate beyond 0 to 1.
enum class Wrap : std::uint8_t { repeat, mirror, clamp };
enum class TextureFilter : std::uint8_t { nearest, bilinear };

/// An image with the way to look it up. The texture coordinate (0, 0) is the top left corner of the image,
/// and (1, 1) is the bottom right corner, as in glTF. Textures may share pixels.
struct Texture {
    std::string name;  ///< what the file calls the image, for messages
    /// Null or without pixels: every lookup is white.
    std::shared_ptr<const Pixels> pixels;
    ColourSpace space = ColourSpace::linear;
    Wrap wrap_s = Wrap::repeat, wrap_t = Wrap::repeat;
    TextureFilter filter = TextureFilter::bilinear;

    /// The linear value of a texel, which exists. O(1).
    Rgba texel(int x, int y) const;
    /// Calls `use(texel)`, where `texel(x, y)` returns the linear value of a texel, and returns its result.
    /// Several texels cost less so than one by one.
    template <class Use>
    auto with_texels(const Use& use) const;
    /// The linear value at a texture coordinate. The filter `bilinear` interpolates linear values between
    /// the centres of four texels. A coordinate that is not finite counts as 0. O(1).
    Rgba at(const Vec2f& coordinate) const { return at(coordinate, {}); }
    /// The mean of the filter `nearest` over a rectangle around a coordinate whose sides are at most 1, in
    /// texels. Other filters interpolate, which is the mean over 1 by 1. O(1).
    Rgba at(const Vec2f& coordinate, const Vec2f& sides) const;
};

namespace detail {

/// A sample as a linear number. `encoded`: it is a part of an sRGB colour.
inline float linear_sample(std::uint8_t x, bool encoded) {
    return encoded ? linear_of_srgb8(x) : static_cast<float>(x) / 255;
}
inline float linear_sample(std::uint16_t x, bool encoded) {
    const double value = static_cast<double>(x) / 65535;
    return static_cast<float>(encoded ? srgb_to_linear(value) : value);
}
inline float linear_sample(float x, bool) {
    return x;
}

/// The column (or row) of `size` that stands for any column.
inline int wrapped(std::int64_t i, int size, Wrap wrap) {
    if (i >= 0 && i < size) return static_cast<int>(i);
    if (wrap == Wrap::clamp) return i < 0 ? 0 : size - 1;
    const std::int64_t period = wrap == Wrap::mirror ? 2 * static_cast<std::int64_t>(size) : size;
    // Many processors divide 32 bits in half the time of 64.
    const bool is_short = i == static_cast<std::int32_t>(i) && period == static_cast<std::int32_t>(period);
    const std::int64_t left =
        is_short ? static_cast<std::int32_t>(i) % static_cast<std::int32_t>(period) : i % period;
    const std::int64_t rest = left < 0 ? left + period : left;
    return static_cast<int>(rest < size ? rest : period - 1 - rest);
}
/// The greatest whole number up to x, for |x| up to 2^53.
inline std::int64_t whole_part(double x) {
    const auto toward_zero = static_cast<std::int64_t>(x);
    return toward_zero - (static_cast<double>(toward_zero) > x ? 1 : 0);
}

/// A coordinate in texels, within 2^51 so that it and its neighbours have halves.
inline double in_texels(float coordinate, int size) {
    const double x = std::isfinite(coordinate) ? static_cast<double>(coordinate) * size : 0.0;
    return x > 0x1p51 ? 0x1p51 : x < -0x1p51 ? -0x1p51 : x;
}

/// The mean of the texels around a place over a rectangle about it. All lengths are in texels, sides at most
/// 1; longer ones count as 1. With sides of 1 it interpolates between the centres of four texels. The centre
/// of texel i is i + 1/2. `column(i)` and `row(j)` say which texels stand for those of any whole numbers, and
/// `texel(column, row)` returns the value of one.
template <class Column, class Row, class Texel>
auto bilinear(double x, double y, const Vec2f& sides, const Column& column, const Row& row,
              const Texel& texel) {
    const std::int64_t left = whole_part(x - 0.5), top = whole_part(y - 0.5);
    // The share of a side that lies beyond the border between two texels.
    const auto beyond = [](double from_border, float side) {
        const auto inside = static_cast<float>(from_border);
        return side >= 1 ? inside + 0.5f : std::clamp(inside / std::max(side, 1e-6f) + 0.5f, 0.0f, 1.0f);
    };
    const float right_share = beyond(x - 1 - static_cast<double>(left), sides[0]),
                bottom_share = beyond(y - 1 - static_cast<double>(top), sides[1]);
    const auto between = [](const auto& a, const auto& b, float share) {
        return a * (1 - share) + b * share;
    };
    const auto before = column(left), after = column(left + 1);
    const auto in_row = [&](const auto& r) {
        return between(texel(before, r), texel(after, r), right_share);
    };
    return between(in_row(row(top)), in_row(row(top + 1)), bottom_share);
}

}  // namespace detail

template <class Use>
auto Texture::with_texels(const Use& use) const {
    const auto width = static_cast<std::size_t>(pixels->width),
               channels = static_cast<std::size_t>(pixels->channels);
    const bool encoded = space == ColourSpace::srgb;
    return std::visit(
        [&](const auto& samples) {
            return use([=, all = samples.data()](int x, int y) {
                const auto* const first =
                    all + (static_cast<std::size_t>(y) * width + static_cast<std::size_t>(x)) * channels;
                const auto colour = [&](int k) { return detail::linear_sample(first[k], encoded); };
                Rgba value{channels < 3 ? Vec3f::all(colour(0)) : Vec3f(colour(0), colour(1), colour(2)), 1};
                if (channels % 2 == 0) value.alpha = detail::linear_sample(first[channels - 1], false);
                return value;
            });
        },
        pixels->samples);
}

inline Rgba Texture::texel(int x, int y) const {
    return with_texels([&](const auto& texel) { return texel(x, y); });
}

inline Rgba Texture::at(const Vec2f& coordinate, const Vec2f& sides) const {
    if (!pixels || pixels->width <= 0 || pixels->height <= 0) return {Vec3f::all(1), 1};
    const int width = pixels->width, height = pixels->height;
    const double x = detail::in_texels(coordinate[0], width), y = detail::in_texels(coordinate[1], height);
    const bool nearest = filter == TextureFilter::nearest;
    return with_texels([&](const auto& texel) {
        const auto column = [&](std::int64_t i) { return detail::wrapped(i, width, wrap_s); };
        const auto row = [&](std::int64_t i) { return detail::wrapped(i, height, wrap_t); };
        if (nearest && sides == Vec2f())
            return texel(column(detail::whole_part(x)), row(detail::whole_part(y)));
        return detail::bilinear(x, y, nearest ? sides : Vec2f(1, 1), column, row, texel);
    });
}

}  // namespace hedgerow
