/// A whole file in memory: mapped where it can be, else read.
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>

namespace hedgerow::detail {

/// The bytes of a file, from an address that is a multiple of 64. They live as long as any copy of `owner`.
/// Writing to them never changes the file.
struct FileBytes {
    std::shared_ptr<void> owner;
    std::byte* data = nullptr;
    std::size_t size = 0;
};

/// Maps a file, or reads it if the system cannot map. All errors are InputError.
FileBytes mapped_file(const std::filesystem::path& path);
/// Reads a file into memory of its own. All errors are InputError.
FileBytes read_file(const std::filesystem::path& path);

}  // namespace hedgerow::detail
