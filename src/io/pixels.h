/// The decoders of images, one per format, and what they share.
#pragma once

#include <cmath>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <hedgerow/base/error.h>
#include <hedgerow/io/texture_file.h>

#include "memory.h"

namespace hedgerow::detail {

/// The bytes of an image, what messages call it, and how many pixels it may have.
struct ImageBytes {
    std::string_view bytes;
    const std::string& name;
    PixelLimits limits;

    /// Throws InputError "NAME: WHAT".
    [[noreturn]] void fail(const std::string& what) const { throw InputError(name + ": " + what); }
};

/// Throws InputError if an image has no pixels, more than its limits allow, or more than the memory can hold
/// with `bytes_a_pixel` each. O(1).
inline void check_promised(const ImageBytes& image, std::uint64_t width, std::uint64_t height,
                           std::uint64_t bytes_a_pixel) {
    const std::string size = std::to_string(width) + "x" + std::to_string(height);
    if (width == 0 || height == 0) image.fail("promises " + size + " pixels. Write it again");
    constexpr std::uint64_t most_side = 0x7FFFFFFF;
    if (width > most_side || height > most_side || width > image.limits.most_pixels / height)
        image.fail("promises " + size + " pixels, but no more than " +
                   std::to_string(image.limits.most_pixels) +
                   " are read. Make it smaller, or raise the limit (PixelLimits::most_pixels)");
    expect_memory(image.name, "its " + size + " pixels", width * height * bytes_a_pixel);
}

/// Pixels whose samples are U and not yet set. The size is one that check_promised accepts.
template <class U>
Pixels make_pixels(const ImageBytes& image, std::uint64_t width, std::uint64_t height, int channels) {
    const auto samples_a_pixel = static_cast<std::uint64_t>(channels);
    check_promised(image, width, height, samples_a_pixel * sizeof(U));
    return {static_cast<int>(width), static_cast<int>(height), channels,
            std::vector<U>(static_cast<std::size_t>(width * height * samples_a_pixel))};
}

/// A sample that can be added and multiplied: 0 for NaN, and at most the largest half.
inline float usable(float x) {
    constexpr float most = 65504;
    if (std::isfinite(x)) return x;
    return std::isnan(x) ? 0 : std::copysign(most, x);
}

bool is_png(std::string_view bytes);
Pixels decode_png(const ImageBytes& image);
bool is_jpeg(std::string_view bytes);
Pixels decode_jpeg(const ImageBytes& image);
bool is_hdr(std::string_view bytes);
Pixels decode_hdr(const ImageBytes& image);
bool is_exr(std::string_view bytes);
/// Throws InputError for every image if this build has no OpenEXR.
Pixels decode_exr(const ImageBytes& image);

}  // namespace hedgerow::detail
