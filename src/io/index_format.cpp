#include "index_format.h"

#include <cmath>
#include <cstring>
#include <fstream>

#include "byte_source.h"
#include "checksum.h"
#include "readers.h"

namespace hedgerow {

namespace detail {

namespace {

constexpr std::uint64_t most_leaves = std::uint64_t(1) << 28, most_triangles = std::uint64_t(1) << 31,
                        most_vertices = std::uint64_t(1) << 32;

/// Whether the counts agree with each other as in every index, and are so small that no sum of sizes
/// overflows.
bool sound_counts(const IndexHeader& h) {
    const std::uint64_t primitives = h.primitives();
    const bool empty = primitives == 0, of_points = h.holds_points() && h.triangles == 0 && h.faces == 0;
    return (of_points ? h.dimension == 2 || h.dimension == 3
                      : h.kind == IndexHeader::of_triangles && h.dimension == 3) &&
           primitives <= most_triangles && h.vertices <= most_vertices && h.leaves <= most_leaves &&
           h.leaves <= primitives && h.leaves * wide_leaf_size >= primitives && h.nodes <= h.leaves &&
           (h.nodes == 0) == empty && (h.faces == 0 || h.faces == h.triangles) &&
           h.depth <= static_cast<std::uint32_t>(bvh_max_depth) && (h.depth == 0) == empty;
}
bool sound_box(const IndexHeader& h) {
    bool good = true;
    for (int k = 0; k < 3; ++k) good = good && h.low[k] <= h.high[k] && std::isfinite(h.high[k] - h.low[k]);
    return good || h.primitives() == 0;
}
/// Throws InputError unless the options are known and valid. The message names a field, and fields have the
/// same names in IndexHeader and WideOptions.
void check_options(const IndexHeader& h, const std::filesystem::path& path) {
    if (h.builder >= std::size(wide_builders) || h.width == 0)
        refuse_index(path, "the header names options that there are not");
    try {
        static_cast<void>(resolved(h.options()));
    } catch (const InputError& error) {
        refuse_index(path, std::string("the header's option ") + error.what());
    }
}
/// Bytes of a node and of a block of the leaves.
template <class T>
std::pair<std::uint64_t, std::uint64_t> sizes_of(const IndexHeader& h, int width) {
    if (!h.holds_points()) return {WideNodes<T, 3>::stride_of(width), sizeof(TriangleBlock<T>)};
    if (h.dimension == 3) return {WideNodes<T, 3>::stride_of(width), sizeof(PointBlock<T, 3>)};
    return {WideNodes<T, 2>::stride_of(width), sizeof(PointBlock<T, 2>)};
}
/// Checks the kind, the byte order and the version of a file. This comes before the checksum, because the
/// version decides where the checksum is.
void check_kind(const IndexHeader& h, std::size_t known, const std::filesystem::path& path) {
    const auto has = [&](std::size_t end) { return known >= end; };
    if (std::memcmp(h.magic, index_magic, std::min(known, sizeof h.magic)) != 0)
        refuse_index(path, "is no saved index, or its first bytes are damaged");
    constexpr std::uint32_t swapped = 0x04030201;
    if (has(offsetof(IndexHeader, version)) && h.byte_order == swapped)
        refuse_index(path, "was saved on a processor of the other byte order");
    if (has(offsetof(IndexHeader, scalar_bytes)) && h.byte_order == IndexHeader::this_byte_order &&
        h.version != IndexHeader::this_version)
        refuse_index(path, "is of version " + std::to_string(h.version) +
                               " of the format, and this is version " +
                               std::to_string(IndexHeader::this_version));
    if (!has(sizeof h)) refuse_index(path, "the file was cut off within its header");
}

}  // namespace

void refuse_index(const std::filesystem::path& path, const std::string& what) {
    throw InputError(path.string() + ": " + what + ". Build the index and save it again");
}

WideOptions IndexHeader::options() const {
    WideOptions o;
    o.builder = static_cast<WideBuilder>(builder);
    o.width = static_cast<int>(width);
    o.max_leaf_size = max_leaf_size;
    o.traversal_cost = traversal_cost, o.intersection_cost = intersection_cost;
    o.reinsertion = static_cast<int>(reinsertion);
    return o;
}

IndexLayout layout_of(const IndexHeader& h) {
    const int width = static_cast<int>(h.width);
    const bool floats = h.holds_floats();
    const auto [node, block] = floats ? sizes_of<float>(h, width) : sizes_of<double>(h, width);
    std::uint64_t at = 0;
    const auto end_of = [&](std::uint64_t bytes) { return at = (at + bytes + 63) / 64 * 64; };
    IndexLayout layout{};
    layout.nodes = end_of(sizeof h);
    layout.items = end_of(h.nodes * node);
    layout.blocks = end_of(h.leaves * wide_leaf_size * sizeof(PrimitiveId));
    layout.vertices = end_of(h.leaves * block);
    layout.triangles = end_of(h.vertices * h.dimension * h.scalar_bytes);
    layout.faces = end_of(h.triangles * sizeof(TriangleIndices));
    layout.checksums = end_of(h.faces * sizeof(std::uint32_t));
    layout.file_bytes = at + 8 * (checksum_pieces(at) + 1);
    return layout;
}

IndexHeader checked_header(const std::byte* start, std::size_t size, std::uint64_t file_bytes,
                           const std::filesystem::path& path) {
    IndexHeader h{};
    const std::size_t known = std::min(size, sizeof h);
    std::memcpy(&h, start, known);
    check_kind(h, known, path);
    if (h.byte_order != IndexHeader::this_byte_order || h.checksum != checksum(&h, index_header_checked))
        refuse_index(path, "the header (bytes 0 to 175) is damaged");
    if (h.scalar_bytes != sizeof(float) && h.scalar_bytes != sizeof(double))
        refuse_index(path, "the header names a scalar of " + std::to_string(h.scalar_bytes) + " bytes");
    check_options(h, path);
    if (!sound_counts(h) || !sound_box(h)) refuse_index(path, "the header contradicts itself");
    const std::uint64_t expected = layout_of(h).file_bytes;
    if (file_bytes != expected)
        refuse_index(path,
                     std::string(file_bytes < expected ? "the file was cut off" : "the file is too long") +
                         ": it has " + std::to_string(file_bytes) + " bytes, and its header says " +
                         std::to_string(expected));
    return h;
}

}  // namespace detail

IndexFileInfo index_file_info(const std::filesystem::path& path) {
    detail::check_readable(path);
    std::byte start[sizeof(detail::IndexHeader)];
    std::ifstream file(path, std::ios::binary);
    file.read(reinterpret_cast<char*>(start), sizeof start);
    if (file.bad() || !file.is_open())
        throw InputError(path.string() + ": cannot be read. Check its permissions");
    const auto size = static_cast<std::size_t>(file.gcount());
    const auto h = detail::checked_header(start, size, std::filesystem::file_size(path), path);
    const auto layout = detail::layout_of(h);
    return {.version = static_cast<int>(h.version),
            .scalar = h.holds_floats() ? "float" : "double",
            .options = h.options(),
            .dimension = static_cast<int>(h.dimension),
            .holds_points = h.holds_points(),
            .triangles = static_cast<std::size_t>(h.triangles),
            .points = static_cast<std::size_t>(h.holds_points() ? h.vertices : 0),
            .vertices = static_cast<std::size_t>(h.holds_points() ? 0 : h.vertices),
            .nodes = static_cast<std::size_t>(h.nodes),
            .leaves = static_cast<std::size_t>(h.leaves),
            .depth = static_cast<int>(h.depth),
            .faces = h.faces > 0,
            .bounds = {Vec3d(h.low[0], h.low[1], h.low[2]), Vec3d(h.high[0], h.high[1], h.high[2])},
            .index_bytes = layout.vertices - layout.nodes,
            .file_bytes = layout.file_bytes};
}

bool names_index_file(const std::filesystem::path& path) {
    return detail::format_of(path) == ".hedgerow";
}

}  // namespace hedgerow
