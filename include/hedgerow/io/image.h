/// 8-bit RGB images, and PNG files.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <vector>

#include <hedgerow/io/notes.h>
#include <hedgerow/parallel/progress.h>

namespace hedgerow {

/// Pixels in rows from the top, left to right; red, green, blue in sRGB.
struct Image {
    using Pixel = std::array<std::uint8_t, 3>;

    int width = 0, height = 0;
    std::vector<Pixel> pixels;

    Image() = default;
    /// All pixels of one colour. Sizes are > 0.
    Image(int w, int h, const Pixel& colour = {})
        : width(w), height(h), pixels(static_cast<std::size_t>(w) * static_cast<std::size_t>(h), colour) {}

    Pixel& at(int x, int y) { return pixels[index(x, y)]; }
    const Pixel& at(int x, int y) const { return pixels[index(x, y)]; }

    friend bool operator==(const Image&, const Image&) = default;

private:
    std::size_t index(int x, int y) const {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
    }
};

/// Copies an image into another with its upper left corner at (x, y). Copies only what fits.
inline void paste(const Image& from, Image& into, int x, int y) {
    for (int row = std::max(0, -y); row < std::min(from.height, into.height - y); ++row)
        for (int column = std::max(0, -x); column < std::min(from.width, into.width - x); ++column)
            into.at(x + column, y + row) = from.at(column, row);
}

/// Writes a PNG file under another name beside `path`, and then renames it. Throws InputError if the image
/// has no pixels or does not have width × height of them, or for a note that cannot be kept, and OutputError
/// if the path cannot be written. Throws Cancelled if `progress`, which counts pixels, is cancelled; a file
/// that was there before is kept.
void save_png(const std::filesystem::path& path, const Image& image, const Progress& progress = {},
              const Notes& notes = {});

/// Reads any PNG as 8-bit RGB: greys and palettes become RGB, 16 bits become 8, and transparent pixels are
/// laid over black. Throws InputError if the file is not a PNG, is damaged, or declares more pixels than a
/// file of its size can hold.
Image load_png(const std::filesystem::path& path);

}  // namespace hedgerow
