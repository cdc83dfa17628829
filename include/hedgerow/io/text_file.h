/// Text files.
#pragma once

#include <filesystem>
#include <string_view>

namespace hedgerow {

/// Writes `text` to a file under another name beside `path`, and then renames it. Throws OutputError if the
/// path cannot be written.
void save_text(const std::filesystem::path& path, std::string_view text);

}  // namespace hedgerow
