/// Finds the files and data that a scene's file names, if it may name them.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace hedgerow::detail {

inline bool is_data_uri(std::string_view uri) {
    return uri.starts_with("data:");
}

/// The bytes of `data:...;base64,...`. Throws InputError, naming `name`, for data that are not base64.
std::string bytes_of_data_uri(std::string_view uri, const std::string& name);

/// The file that a relative URI names, in the folder of the file `scene` or below it. Throws InputError,
/// naming `name`, for schemes, absolute paths, backslashes, `..`, and links that lead out of the folder.
/// `what` is what the file would be, for the message.
std::filesystem::path file_of_uri(std::string_view uri, const std::filesystem::path& scene,
                                  const std::string& name, const std::string& what = "buffer");

/// The file that a relative path names, likewise: a name without escapes, which may have backslashes for
/// slashes.
std::filesystem::path file_beside(std::string_view path, const std::filesystem::path& scene,
                                  const std::string& name, const std::string& what);

}  // namespace hedgerow::detail
