/// Linear colours with opacity, and the transfer function of sRGB.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include <hedgerow/geometry/elementary.h>
#include <hedgerow/geometry/rounding.h>
#include <hedgerow/geometry/vec.h>

namespace hedgerow {

/// Linear red, green and blue with the primaries of sRGB (ITU-R BT.709), and an opacity from 0 to 1. The
/// colour is not multiplied by the opacity.
struct Rgba {
    Vec3f colour;
    float alpha = 1;

    friend constexpr bool operator==(const Rgba&, const Rgba&) = default;
    friend constexpr Rgba operator+(const Rgba& a, const Rgba& b) {
        return {a.colour + b.colour, a.alpha + b.alpha};
    }
    friend constexpr Rgba operator*(const Rgba& a, float s) { return {a.colour * s, product(a.alpha, s)}; }
};

/// Light after a surface or a body of a colour: products by component.
template <class F>
constexpr Vec<F, 3> tinted(const Vec<F, 3>& light, const Vec<F, 3>& colour) {
    return map(light, colour, [](F a, F b) { return product(a, b); });
}

/// The linear value of an encoded value from 0 to 1 (IEC 61966-2-1:1999).
inline double srgb_to_linear(double encoded) {
    return encoded <= 0.04045 ? encoded / 12.92 : power((encoded + 0.055) / 1.055, 2.4);
}
/// The encoded value of a linear value from 0 to 1, the inverse of `srgb_to_linear`.
inline double linear_to_srgb(double linear) {
    return linear <= 0.0031308 ? linear * 12.92 : product(1.055, power(linear, 1 / 2.4)) - 0.055;
}

/// The linear value of an encoded value of 8 bits: `srgb_to_linear(value / 255)`, from a table.
inline float linear_of_srgb8(std::uint8_t value) {
    static const auto table = [] {
        std::array<float, 256> linear{};
        for (std::size_t i = 0; i < linear.size(); ++i)
            linear[i] = static_cast<float>(srgb_to_linear(static_cast<double>(i) / 255));
        return linear;
    }();
    return table[value];
}

/// The encoded value of 8 bits that is nearest to a linear value, which is clamped to 0..1. 0 for NaN. Costs
/// eight steps of a binary search in a table.
inline std::uint8_t srgb8_of_linear(float linear) {
    // The least linear values whose encoded values round to 1, 2 and so on.
    static const auto least = [] {
        std::array<float, 255> table{};
        for (std::size_t i = 0; i < table.size(); ++i)
            table[i] = rounded_up<float>(srgb_to_linear((static_cast<double>(i) + 0.5) / 255));
        return table;
    }();
    std::size_t encoded = 0;
    for (std::size_t step = 128; step > 0; step /= 2)
        encoded += least[encoded + step - 1] <= linear ? step : 0;
    return static_cast<std::uint8_t>(encoded);
}

}  // namespace hedgerow
