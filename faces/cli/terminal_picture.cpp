#include "terminal_picture.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

#include <sys/ioctl.h>
#include <unistd.h>

#include <fmt/format.h>

namespace hedgerow::cli {

namespace {

/// The mean colour of the pixels from the first place up to the second one.
Image::Pixel mean_of(const Image& image, int left, int top, int right, int bottom) {
    std::array<std::uint64_t, 3> sum{};
    for (int y = top; y < bottom; ++y)
        for (int x = left; x < right; ++x)
            for (std::size_t k = 0; k < 3; ++k) sum[k] += image.at(x, y)[k];
    const auto count = static_cast<std::uint64_t>(right - left) * static_cast<std::uint64_t>(bottom - top);
    Image::Pixel mean;
    for (std::size_t k = 0; k < 3; ++k) mean[k] = static_cast<std::uint8_t>(sum[k] / count);
    return mean;
}

}  // namespace

std::string terminal_picture(const Image& image, int columns, int rows) {
    // Characters are about twice as high as wide, so that their halves are squares.
    const double scale =
        std::min({1.0, double(columns) / double(image.width), 2.0 * double(rows) / double(image.height)});
    const int width = std::max(1, static_cast<int>(image.width * scale)),
              height = std::max(1, static_cast<int>(image.height * scale));
    const auto colour_at = [&](int x, int y) {
        const auto from = [](int i, int all, int parts) {
            return static_cast<int>(std::int64_t{i} * all / parts);
        };
        return mean_of(image, from(x, image.width, width), from(y, image.height, height),
                       from(x + 1, image.width, width), from(y + 1, image.height, height));
    };
    std::string text;
    for (int y = 0; y < height; y += 2) {
        for (int x = 0; x < width; ++x) {
            const auto [r, g, b] = colour_at(x, y);
            text += fmt::format("\033[38;2;{};{};{}m", r, g, b);
            if (y + 1 < height) {
                const auto [r2, g2, b2] = colour_at(x, y + 1);
                text += fmt::format("\033[48;2;{};{};{}m", r2, g2, b2);
            }
            text += "▀";
        }
        text += "\033[0m\n";
    }
    return text;
}

TerminalSize terminal_size() {
    winsize size{};
    if (ioctl(STDERR_FILENO, TIOCGWINSZ, &size) != 0 || size.ws_col == 0 || size.ws_row == 0) return {};
    return {size.ws_col, size.ws_row};
}

}  // namespace hedgerow::cli
