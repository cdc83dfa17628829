/// How linear light of any brightness becomes a colour that a screen can show.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <string_view>

#include <hedgerow/geometry/vec.h>

namespace hedgerow {

/// `linear` cuts off what is brighter than white. `neutral` keeps colours up to 0.76 as they are and bends
/// brighter ones towards white (Khronos PBR Neutral, KhronosGroup/ToneMapping).
enum class Tone : std::uint8_t { linear, neutral };
inline constexpr std::array<std::string_view, 2> tone_names = {"linear", "neutral"};

/// The colour, with components from 0 to 1, of light that is not negative.
inline Vec3f toned(Tone tone, Vec3f c) {
    if (tone == Tone::linear) return min(max(c, Vec3f()), Vec3f::all(1));
    constexpr float start = 0.76f;  // of compression: 0.8 less the offset of 0.04
    const float least = std::min({c[0], c[1], c[2]});
    // Light that a surface reflects whatever its colour is taken away.
    const float offset = least < 0.08f ? least - product(6.25f, product(least, least)) : 0.04f;
    c = c - Vec3f::all(offset);
    const float peak = max_component(c);
    if (!(peak >= start)) return max(c, Vec3f());
    constexpr float room = 1 - start;
    const float bent = 1 - room * room / (peak + room - start);
    const float white = 1 - 1 / (product(0.15f, peak - bent) + 1);
    const Vec3f kept = c * (bent / peak);
    return kept + (Vec3f::all(bent) - kept) * white;
}

}  // namespace hedgerow
