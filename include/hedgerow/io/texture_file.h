/// Pixels from image files.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

#include <hedgerow/looks/light.h>
#include <hedgerow/looks/texture.h>

namespace hedgerow {

struct PixelLimits {
    /// An image that promises more pixels is refused before memory is taken for it. The default is 2^28, an
    /// image of 16384 × 16384.
    std::uint64_t most_pixels = std::uint64_t(1) << 28;
};

/// Decodes an image. Its first bytes decide the format:
///
/// - PNG: 8 or 16 bits, grey or colour, each with or without opacity. Palettes become colours, and fewer bits
///   become 8. Samples are as the file has them; chunks of colour profiles and gamma are ignored, as glTF
///   wants.
/// - JPEG: 8 bits, grey or colour, baseline and progressive. The orientation in EXIF is ignored.
/// - Radiance HDR (RGBE, not XYZE): floats, mantissa · 2^(exponent − 136), divided by the file's exposures.
///   Both kinds of run-length encoding, and all orientations.
/// - OpenEXR: floats of R, G and B, or of Y, and of A; one part with scan lines or tiles. The picture is the
///   display window. Colours of an image with opacity are premultiplied in the file and are divided by it.
///
/// A NaN in the last two becomes 0; an infinite value becomes the largest half, 65504, with its sign.
///
/// Throws InputError, naming `name`, if the bytes are none of these, are damaged or end early, or if the
/// image promises more pixels than the limits, the memory or (PNG) bytes of this number allow. O(pixels).
Pixels decode_pixels(std::string_view bytes, const std::string& name, const PixelLimits& limits = {});

/// Decodes an image file. Throws InputError if the file cannot be read, and as decode_pixels does.
Pixels load_pixels(const std::filesystem::path& path, const PixelLimits& limits = {});

/// Light from all around by the panorama in an image file. Whole numbers are colours in sRGB, floats are
/// radiances. Throws as load_pixels does.
Environment load_environment(const std::filesystem::path& path, const PixelLimits& limits = {});

}  // namespace hedgerow
