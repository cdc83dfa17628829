/// How a saved index lies in its file.
///
///   Header
///   sections, each from a multiple of 64 bytes on: nodes, items, blocks, vertices, triangles, faces
///   the checksum of every MiB of what stands before it, the header included
///   the checksum of those checksums
///
/// Numbers are in the byte order of the processor that saved. Where sections begin and how long the file is
/// follows from the header's counts and stands nowhere, so that nothing can contradict them. What is between
/// sections, and in nodes and blocks what no field takes, is 0. A change to any of this, or to what nodes and
/// blocks mean, is another version.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

#include <hedgerow/io/index_file.h>

namespace hedgerow::detail {

struct IndexHeader {
    static constexpr std::uint32_t this_version = 1, this_byte_order = 0x01020304;

    char magic[16];
    std::uint32_t byte_order, version, scalar_bytes;
    std::uint32_t builder, width, max_leaf_size, reinsertion, depth;
    double traversal_cost, intersection_cost;
    double built_cost;  // of the tree before its first refit; negative: it had none
    double low[3], high[3];
    std::uint64_t nodes, leaves, triangles, vertices, faces;
    std::uint64_t checksum;  // of all before it

    bool holds_floats() const { return scalar_bytes == sizeof(float); }
    WideOptions options() const;
};
static_assert(sizeof(IndexHeader) == 168);
inline constexpr std::size_t index_header_checked = offsetof(IndexHeader, checksum);
inline constexpr char index_magic[16] = "hedgerow index\n";

/// Where each section begins, and what comes after them.
struct IndexLayout {
    std::uint64_t nodes, items, blocks, vertices, triangles, faces, checksums;
    std::uint64_t file_bytes;
};
/// Of a header that was checked.
IndexLayout layout_of(const IndexHeader& header);

/// The header at the start of a file of `file_bytes`, of which `start` has the first `size`. Throws
/// InputError unless it is sound, and the file as long as it says.
IndexHeader checked_header(const std::byte* start, std::size_t size, std::uint64_t file_bytes,
                           const std::filesystem::path& path);

/// Throws InputError "NAME: WHAT. Build the index and save it again".
[[noreturn]] void refuse_index(const std::filesystem::path& path, const std::string& what);

}  // namespace hedgerow::detail
