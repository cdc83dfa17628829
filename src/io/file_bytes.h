/// A whole file in memory: mapped where it can be, else read.
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>

namespace hedgerow::detail {

/// The bytes begin at a multiple of 64, and live as long as one of its owners. They may be written to: that
/// never changes the file.
struct FileBytes {
    std::shared_ptr<void> owner;
    std::byte* data = nullptr;
    std::size_t size = 0;
};

/// All errors are InputError.
FileBytes mapped_file(const std::filesystem::path& path);
FileBytes read_file(const std::filesystem::path& path);

}  // namespace hedgerow::detail
