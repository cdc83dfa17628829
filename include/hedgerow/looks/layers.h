/// Images with named channels of numbers.
#pragma once

#include <cstdint>
#include <string>
#include <variant>
#include <vector>

#include <hedgerow/base/strided.h>

namespace hedgerow {

/// One value per pixel, in rows from the top, each from left to right. Borrows the caller's array.
struct Channel {
    /// A name such as "R", or "normal.X" for X of the layer "normal": 1 to 255 bytes, none of them 0.
    std::string name;
    std::variant<Strided<float>, Strided<std::uint32_t>> values;
};

/// Channels of width × height pixels each. Viewers show R, G and B, as linear light with the primaries of
/// sRGB.
struct Layers {
    int width = 0, height = 0;
    std::vector<Channel> channels;
};

}  // namespace hedgerow
