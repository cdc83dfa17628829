/// Checks before long work whether a file can be written.
#pragma once

#include <filesystem>

namespace hedgerow {

/// Throws OutputError if no `save_...` could write `path`: it is empty, its folder does not exist, it is a
/// folder itself, or the file or its folder is read-only. A file that nobody has permission to write is
/// read-only for every user. Creates nothing.
void check_writable(const std::filesystem::path& path);

}  // namespace hedgerow
