/// The check of size that every saved image must pass.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

#include <hedgerow/base/error.h>

namespace hedgerow::detail {

/// Throws InputError unless width and height are positive and `count` is their product. The message calls the
/// elements `counted`.
inline void expect_pixels(const std::filesystem::path& path, int width, int height, std::size_t count,
                          std::string_view counted) {
    const std::string size = std::to_string(width) + "x" + std::to_string(height);
    if (width <= 0 || height <= 0)
        throw InputError(path.string() + ": an image of " + size + " pixels cannot be saved. Give it a size");
    if (count != static_cast<std::size_t>(width) * static_cast<std::size_t>(height))
        throw InputError(path.string() + ": an image of " + size + " has " + std::to_string(count) + " " +
                         std::string(counted) + ". Make them width times height");
}

}  // namespace hedgerow::detail
