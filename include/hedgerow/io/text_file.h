/// Text files.
#pragma once

#include <filesystem>
#include <string_view>

namespace hedgerow {

/// Writes all of `text`, by way of a file beside `path` that is then renamed. Throws OutputError if the path
/// cannot be written.
void save_text(const std::filesystem::path& path, std::string_view text);

}  // namespace hedgerow
