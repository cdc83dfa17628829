/// Whether a file can be written, asked before long work.
#pragma once

#include <filesystem>

namespace hedgerow {

/// Throws OutputError if no `save_...` could write `path`: there is no such folder, it is a folder itself, or
/// the file or its folder is read-only. A file is read-only if nobody has permission to write it, whoever
/// asks. Creates nothing.
void check_writable(const std::filesystem::path& path);

}  // namespace hedgerow
