/// The layout of a saved index in its file.
///
///   Header
///   sections, each from a multiple of 64 bytes on: nodes, items, blocks, vertices, triangles, faces; an
///   index of points has none of the last two, and its vertices are the points the checksum of every MiB of
///   all that is before it, the header included the checksum of those checksums
///
/// Numbers are in the byte order of the processor that saved the index. The places of sections and the length
/// of the file follow from the header's counts and are not stored, so nothing can contradict them. Bytes
/// between sections are 0, and so are the bytes of nodes and blocks that belong to no field. A change to any
/// of this, or to the meaning of nodes and blocks, is another version.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

#include <hedgerow/io/index_file.h>

namespace hedgerow::detail {

struct IndexHeader {
    static constexpr std::uint32_t this_version = 3, this_byte_order = 0x01020304;

    char magic[16];
    std::uint32_t byte_order, version, scalar_bytes;
    std::uint32_t builder, width, max_leaf_size, reinsertion, depth;
    std::uint32_t kind, dimension;  // kind: of_triangles or of_points
    double traversal_cost, intersection_cost;
    double built_cost;  // of the tree before its first refit; negative: no refit yet
    double low[3], high[3];
    std::uint64_t nodes, leaves, triangles, vertices, faces;  // the vertices of a cloud are its points
    std::uint64_t checksum;                                   // of all fields before it

    static constexpr std::uint32_t of_triangles = 0, of_points = 1;

    bool holds_floats() const { return scalar_bytes == sizeof(float); }
    bool holds_points() const { return kind == of_points; }
    std::uint64_t primitives() const { return holds_points() ? vertices : triangles; }
    WideOptions options() const;
};
static_assert(sizeof(IndexHeader) == 176);
inline constexpr std::size_t index_header_checked = offsetof(IndexHeader, checksum);
inline constexpr char index_magic[16] = "hedgerow index\n";

/// The byte where each section and the checksums begin, and the length of the file.
struct IndexLayout {
    std::uint64_t nodes, items, blocks, vertices, triangles, faces, checksums;
    std::uint64_t file_bytes;
};
/// The layout that a checked header implies.
IndexLayout layout_of(const IndexHeader& header);

/// The header of a file of `file_bytes` bytes, whose first `size` are at `start`. Throws InputError unless
/// the header is sound and the file is as long as the header implies.
IndexHeader checked_header(const std::byte* start, std::size_t size, std::uint64_t file_bytes,
                           const std::filesystem::path& path);

/// Throws InputError "NAME: WHAT. Build the index and save it again".
[[noreturn]] void refuse_index(const std::filesystem::path& path, const std::string& what);

}  // namespace hedgerow::detail
