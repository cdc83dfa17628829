/// Finds the data that a glTF file's URIs name, if they may name them.
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
std::filesystem::path file_of_uri(std::string_view uri, const std::filesystem::path& scene,
                                  const std::string& name);

}  // namespace hedgerow::detail
