/// Saved indexes: written once from front to back, and loaded by mapping the file.
#include <hedgerow/io/index_file.h>

#include <atomic>
#include <cstring>

#include "checksum.h"
#include "file_bytes.h"
#include "index_format.h"
#include "output_file.h"

namespace hedgerow {

namespace detail {

/// Access to the parts of an index, for saving and loading only.
struct IndexParts {
    template <class T>
    static double built_cost(const MeshIndex<T>& index) {
        return index.structure_.built_cost_;
    }
    template <class T>
    static const TriangleBlocks<T>& blocks(const MeshIndex<T>& index) {
        return index.leaves_;
    }
    template <class T>
    static MeshIndex<T> together(TriangleMeshView<T> mesh, const IndexHeader& h, WideTree<T, 3> tree,
                                 TriangleBlocks<T> blocks, std::shared_ptr<const void> owner) {
        const std::size_t count = mesh.size();
        return {std::move(mesh), WideBvh<T, 3>(h.options(), count, std::move(tree), h.built_cost),
                std::move(blocks), std::move(owner)};
    }
};

namespace {

// Saving.

template <class T>
IndexHeader header_of(const MeshIndex<T>& index) {
    const WideBvh<T, 3>& structure = index.structure();
    const WideOptions& o = structure.options();
    IndexHeader h{};
    std::memcpy(h.magic, index_magic, sizeof h.magic);
    h.byte_order = IndexHeader::this_byte_order, h.version = IndexHeader::this_version;
    h.scalar_bytes = sizeof(T);
    h.builder = static_cast<std::uint32_t>(o.builder), h.width = static_cast<std::uint32_t>(o.width);
    h.max_leaf_size = o.max_leaf_size, h.reinsertion = static_cast<std::uint32_t>(o.reinsertion);
    h.depth = static_cast<std::uint32_t>(structure.depth());
    h.traversal_cost = o.traversal_cost, h.intersection_cost = o.intersection_cost;
    h.built_cost = IndexParts::built_cost(index);
    for (int k = 0; k < 3; ++k)
        h.low[k] = double(index.bounds().low[k]), h.high[k] = double(index.bounds().high[k]);
    h.nodes = structure.tree().nodes.size(), h.leaves = structure.leaf_count();
    h.triangles = index.size(), h.vertices = index.primitives().vertex_count();
    h.faces = index.primitives().faces().size();
    h.checksum = checksum(&h, index_header_checked);
    return h;
}

/// Writes sections to a file, with their checksums.
class SectionWriter {
public:
    explicit SectionWriter(OutputFile& file) : file_(file) {}

    void bytes(const void* from, std::size_t size) {
        const char* const begin = static_cast<const char*>(from);
        // Checksum and write each piece while it is in the cache.
        for (std::size_t done = 0, n; done < size; done += n) {
            n = std::min(size - done, std::size_t(1) << 18);
            checksums_.add(begin + done, n);
            file_.write({begin + done, n});
            file_.advance(n);
        }
        written_ += size;
    }
    /// Ends a section: zeros up to the next multiple of 64 bytes.
    void align() { zeros(static_cast<std::size_t>((64 - written_ % 64) % 64)); }
    /// Writes records of `stride` bytes. The bytes after the first `used` were never set, so zeros are
    /// written for them.
    void records(const void* from, std::size_t count, std::size_t used, std::size_t stride) {
        if (used == stride) return bytes(from, count * stride);
        for (std::size_t i = 0; i < count; ++i) {
            bytes(static_cast<const char*>(from) + i * stride, used);
            zeros(stride - used);
        }
    }
    /// Writes value(0) to value(count − 1).
    template <class F>
    void values(std::size_t count, F value) {
        constexpr std::size_t at_once = 4096;
        std::vector<decltype(value(count))> some;
        for (std::size_t i = 0; i < count;) {
            for (some.clear(); i < count && some.size() < at_once; ++i) some.push_back(value(i));
            bytes(some.data(), some.size() * sizeof some[0]);
        }
    }
    /// Writes the checksums of all that was written, and then their own checksum.
    void finish() {
        const auto& all = checksums_.finish();
        const std::size_t size = all.size() * sizeof all[0];
        const std::uint64_t of_all = checksum(all.data(), size);
        file_.write({reinterpret_cast<const char*>(all.data()), size});
        file_.write({reinterpret_cast<const char*>(&of_all), sizeof of_all});
    }

private:
    void zeros(std::size_t count) {
        static constexpr char none[64] = {};
        bytes(none, count);
    }

    OutputFile& file_;
    Checksums checksums_;
    std::uint64_t written_ = 0;
};

// Loading.

/// `count` values from byte `at` of the file on, in place.
template <class E>
Stored<E> stored(const FileBytes& file, std::uint64_t at, std::uint64_t count) {
    return {file.owner, reinterpret_cast<E*>(file.data + at), static_cast<std::size_t>(count)};
}
template <class E>
Strided<E> strided(const FileBytes& file, std::uint64_t at, std::uint64_t count) {
    return {file.data + at, static_cast<std::size_t>(count)};
}
/// An index whose arrays are in the file itself.
template <class T>
MeshIndex<T> in_place(const IndexHeader& h, const IndexLayout& layout, const FileBytes& file) {
    using Line = typename WideNodes<T, 3>::Line;
    WideTree<T, 3> tree;
    const std::uint64_t lines = (layout.items - layout.nodes) / sizeof(Line);
    tree.nodes = {static_cast<int>(h.width), stored<Line>(file, layout.nodes, lines)};
    tree.items = stored<PrimitiveId>(file, layout.items, h.leaves * wide_leaf_size);
    for (int k = 0; k < 3; ++k)
        tree.bounds.low[k] = static_cast<T>(h.low[k]), tree.bounds.high[k] = static_cast<T>(h.high[k]);
    tree.depth = static_cast<int>(h.depth);
    TriangleBlocks<T> blocks(stored<TriangleBlock<T>>(file, layout.blocks, h.leaves));
    const TriangleMeshView<T> mesh(strided<Vec<T, 3>>(file, layout.vertices, h.vertices),
                                   strided<TriangleIndices>(file, layout.triangles, h.triangles),
                                   strided<std::uint32_t>(file, layout.faces, h.faces));
    return IndexParts::together<T>(mesh, h, std::move(tree), std::move(blocks), file.owner);
}

/// Throws InputError unless every checksum holds.
void check_sums(const IndexLayout& layout, const FileBytes& file, const std::filesystem::path& path,
                Executor& executor) {
    const std::byte* const sums = file.data + layout.checksums;
    const auto sum = [&](std::uint64_t i) {
        std::uint64_t value;
        std::memcpy(&value, sums + 8 * i, sizeof value);
        return value;
    };
    // Check the checksums themselves.
    const std::uint64_t count = checksum_pieces(layout.checksums), end = layout.checksums;
    if (checksum(sums, 8 * count) != sum(count))
        refuse_index(path, "the checksums from byte " + std::to_string(end) + " on are damaged");
    // Check the pieces in parallel, and keep the first that is bad.
    std::atomic<std::uint64_t> first_bad{count};
    executor.expect(end);
    executor.for_each_piece(count, 1, [&](std::size_t begin, std::size_t pieces_end) {
        for (std::uint64_t i = begin; i < pieces_end; ++i) {
            const std::uint64_t at = i * checksum_piece;
            const auto size = std::min<std::uint64_t>(checksum_piece, end - at);
            executor.advance(size);
            if (checksum(file.data + at, size) == sum(i)) continue;
            for (std::uint64_t seen = first_bad; i < seen && !first_bad.compare_exchange_weak(seen, i);) {
            }
        }
    });
    // Report where the first damage is.
    if (first_bad == count) return;
    const std::uint64_t at = first_bad * checksum_piece;
    refuse_index(path, "bytes " + std::to_string(at) + " to " +
                           std::to_string(std::min<std::uint64_t>(at + checksum_piece, end) - 1) +
                           " are damaged");
}

/// Whether the stored blocks are those that the mesh packs into.
template <class T>
bool blocks_match(const MeshIndex<T>& index, Executor& executor) {
    constexpr std::size_t at_once = 64, places = wide_leaf_size;
    const auto items = index.structure().items();
    const TriangleBlock<T>* const blocks = IndexParts::blocks(index).data();
    std::atomic<bool> match{true};
    executor.for_each_piece(items.size() / places, at_once, [&](std::size_t begin, std::size_t end) {
        for (std::size_t n; begin < end && match; begin += n) {
            n = std::min(at_once, end - begin);
            const auto packed =
                pack_blocks(index.primitives(), items.subspan(begin * places, n * places), serial_executor());
            for (std::size_t i = 0; i < n; ++i)
                if (std::memcmp(static_cast<const void*>(packed.data() + i),  // compares NaN too
                                static_cast<const void*>(blocks + begin + i), TriangleBlock<T>::used) != 0)
                    match = false;
        }
    });
    return match;
}

/// Checks what a build guarantees, so that a file with right checksums and wrong contents does no harm.
template <class T>
void check_contents(const MeshIndex<T>& index, const std::filesystem::path& path, Executor& executor) {
    Box<T, 3> bounds;
    try {
        bounds = bounds_of(index.primitives(), executor);
    } catch (const InputError& error) {
        refuse_index(path, error.what());
    }
    if (bounds != index.bounds()) refuse_index(path, "the header's bounds are not the mesh's");
    if (const std::string fault = index.validate(); !fault.empty())
        refuse_index(path, "the tree is not sound: " + fault);
    if (!blocks_match(index, executor)) refuse_index(path, "the leaves hold other triangles than the mesh");
}

}  // namespace
}  // namespace detail

template <std::floating_point T>
void save_index(const std::filesystem::path& path, const MeshIndex<T>& index, const Progress& progress) {
    const TriangleMeshView<T>& mesh = index.primitives();
    const WideTree<T, 3>& tree = index.structure().tree();
    const TriangleBlocks<T>& blocks = detail::IndexParts::blocks(index);
    const auto header = detail::header_of(index);
    using Nodes = WideNodes<T, 3>;
    using Block = TriangleBlock<T>;
    const int width = index.structure().options().width;

    // Write the sections in the order of IndexLayout.
    detail::OutputFile file(path, progress);
    file.expect(detail::layout_of(header).checksums);
    detail::SectionWriter out(file);
    out.bytes(&header, sizeof header);
    out.align();
    out.records(tree.nodes.data(), tree.nodes.size(), Nodes::used_of(width), Nodes::stride_of(width));
    out.align();
    out.bytes(tree.items.data(), tree.items.bytes());
    out.align();
    out.records(blocks.data(), blocks.size(), Block::used, sizeof(Block));
    out.align();
    out.values(mesh.vertex_count(), [&](std::size_t i) { return mesh.vertex(i); });
    out.align();
    out.values(mesh.size(), [&](std::size_t i) { return mesh.indices(i); });
    out.align();
    out.values(mesh.faces().size(), [&](std::size_t i) { return mesh.faces()[i]; });
    out.align();
    out.finish();
    file.commit();
}

template <std::floating_point T>
MeshIndex<T> load_index(const std::filesystem::path& path, const LoadIndexOptions& options, Threads threads) {
    const auto file = options.map ? detail::mapped_file(path) : detail::read_file(path);
    const auto header = detail::checked_header(file.data, file.size, file.size, path);
    if (header.scalar_bytes != sizeof(T)) {
        const std::string held = header.holds_floats() ? "float" : "double";
        throw InputError(path.string() + ": holds " + held + "s. Load it as " + held);
    }
    const auto layout = detail::layout_of(header);
    Executor& executor = threads.over(header.triangles);
    if (options.verify != Verify::header) detail::check_sums(layout, file, path, executor);
    auto index = detail::in_place<T>(header, layout, file);
    if (options.verify == Verify::contents) detail::check_contents(index, path, executor);
    return index;
}

template void save_index(const std::filesystem::path&, const MeshIndex<float>&, const Progress&);
template void save_index(const std::filesystem::path&, const MeshIndex<double>&, const Progress&);
template MeshIndex<float> load_index(const std::filesystem::path&, const LoadIndexOptions&, Threads);
template MeshIndex<double> load_index(const std::filesystem::path&, const LoadIndexOptions&, Threads);

}  // namespace hedgerow
