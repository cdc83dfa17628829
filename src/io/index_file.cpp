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
    template <class I>
    static double built_cost(const I& index) {
        return index.structure_.built_cost_;
    }
    template <class I>
    static const auto& blocks(const I& index) {
        return index.leaves_;
    }
    template <class View, class Blocks>
    static auto together(View view, const IndexHeader& h,
                         WideTree<typename View::Scalar, View::dimension> tree, Blocks blocks,
                         std::shared_ptr<const void> owner) {
        using S = WideBvh<typename View::Scalar, View::dimension>;
        const std::size_t count = view.size();
        return Index<S, View>(std::move(view), S(h.options(), count, std::move(tree), h.built_cost),
                              std::move(blocks), std::move(owner));
    }
};

namespace {

// Saving.

template <class P>
inline constexpr bool is_cloud = PointSet<P>;

template <class I>
IndexHeader header_of(const I& index) {
    constexpr int D = I::dimension;
    constexpr bool points = is_cloud<typename I::Primitives>;
    const auto& structure = index.structure();
    const WideOptions& o = structure.options();
    IndexHeader h{};
    std::memcpy(h.magic, index_magic, sizeof h.magic);
    h.byte_order = IndexHeader::this_byte_order, h.version = IndexHeader::this_version;
    h.scalar_bytes = sizeof(typename I::Scalar);
    h.builder = static_cast<std::uint32_t>(o.builder), h.width = static_cast<std::uint32_t>(o.width);
    h.max_leaf_size = o.max_leaf_size, h.reinsertion = static_cast<std::uint32_t>(o.reinsertion);
    h.depth = static_cast<std::uint32_t>(structure.depth());
    h.kind = points ? IndexHeader::of_points : IndexHeader::of_triangles, h.dimension = D;
    h.traversal_cost = o.traversal_cost, h.intersection_cost = o.intersection_cost;
    h.built_cost = IndexParts::built_cost(index);
    for (int k = 0; k < D; ++k)
        h.low[k] = double(index.bounds().low[k]), h.high[k] = double(index.bounds().high[k]);
    h.nodes = structure.tree().nodes.size(), h.leaves = structure.leaf_count();
    if constexpr (points) {
        h.vertices = index.size();
    } else {
        h.triangles = index.size(), h.vertices = index.primitives().vertex_count();
        h.faces = index.primitives().faces().size();
    }
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
    return Strided<E>::in_bytes(file.data + at, static_cast<std::size_t>(count));
}
/// An index whose arrays are in the file itself. `View` is that of its primitives.
template <class View>
auto in_place(const IndexHeader& h, const IndexLayout& layout, const FileBytes& file) {
    using T = typename View::Scalar;
    constexpr int D = View::dimension;
    using Line = typename WideNodes<T, D>::Line;
    WideTree<T, D> tree;
    const std::uint64_t lines = (layout.items - layout.nodes) / sizeof(Line);
    tree.nodes = {static_cast<int>(h.width), stored<Line>(file, layout.nodes, lines)};
    tree.items = stored<PrimitiveId>(file, layout.items, h.leaves * wide_leaf_size);
    for (int k = 0; k < D; ++k)
        tree.bounds.low[k] = static_cast<T>(h.low[k]), tree.bounds.high[k] = static_cast<T>(h.high[k]);
    tree.depth = static_cast<int>(h.depth);
    const auto vertices = strided<Vec<T, D>>(file, layout.vertices, h.vertices);
    if constexpr (is_cloud<View>) {
        PointBlocks<T, D> blocks(stored<PointBlock<T, D>>(file, layout.blocks, h.leaves));
        return IndexParts::together(View(vertices), h, std::move(tree), std::move(blocks), file.owner);
    } else {
        TriangleBlocks<T> blocks(stored<TriangleBlock<T>>(file, layout.blocks, h.leaves));
        const View mesh(vertices, strided<TriangleIndices>(file, layout.triangles, h.triangles),
                        strided<std::uint32_t>(file, layout.faces, h.faces));
        return IndexParts::together(mesh, h, std::move(tree), std::move(blocks), file.owner);
    }
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

/// Whether the stored blocks are those that the primitives pack into.
template <class I>
bool blocks_match(const I& index, Executor& executor) {
    constexpr std::size_t at_once = 64, places = wide_leaf_size;
    const auto items = index.structure().items();
    const auto* const blocks = IndexParts::blocks(index).data();
    using Block = std::remove_cvref_t<decltype(*blocks)>;
    std::atomic<bool> match{true};
    executor.for_each_piece(items.size() / places, at_once, [&](std::size_t begin, std::size_t end) {
        for (std::size_t n; begin < end && match; begin += n) {
            n = std::min(at_once, end - begin);
            const auto packed =
                pack_blocks(index.primitives(), items.subspan(begin * places, n * places), serial_executor());
            for (std::size_t i = 0; i < n; ++i)
                if (std::memcmp(static_cast<const void*>(packed.data() + i),  // compares NaN too
                                static_cast<const void*>(blocks + begin + i), Block::used) != 0)
                    match = false;
        }
    });
    return match;
}

/// Checks what a build guarantees, so that a file with right checksums and wrong contents does no harm.
template <class I>
void check_contents(const I& index, const std::filesystem::path& path, Executor& executor) {
    typename I::BoxType bounds;
    try {
        bounds = bounds_of(index.primitives(), executor);
    } catch (const InputError& error) {
        refuse_index(path, error.what());
    }
    constexpr bool points = is_cloud<typename I::Primitives>;
    if (bounds != index.bounds())
        refuse_index(path, std::string("the header's bounds are not the ") + (points ? "points'" : "mesh's"));
    if (const std::string fault = index.validate(); !fault.empty())
        refuse_index(path, "the tree is not sound: " + fault);
    if (!blocks_match(index, executor))
        refuse_index(path, points ? "the leaves hold other points than the cloud"
                                  : "the leaves hold other triangles than the mesh");
}

template <class I>
void save(const std::filesystem::path& path, const I& index, const Progress& progress) {
    const auto& set = index.primitives();
    const auto& tree = index.structure().tree();
    const auto& blocks = IndexParts::blocks(index);
    const auto header = header_of(index);
    using Nodes = WideNodes<typename I::Scalar, I::dimension>;
    using Block = std::remove_cvref_t<decltype(*blocks.data())>;
    const int width = index.structure().options().width;

    // Write the sections in the order of IndexLayout.
    OutputFile file(path, progress);
    file.expect(layout_of(header).checksums);
    SectionWriter out(file);
    out.bytes(&header, sizeof header);
    out.align();
    out.records(tree.nodes.data(), tree.nodes.size(), Nodes::used_of(width), Nodes::stride_of(width));
    out.align();
    out.bytes(tree.items.data(), tree.items.bytes());
    out.align();
    out.records(blocks.data(), blocks.size(), Block::used, sizeof(Block));
    out.align();
    if constexpr (is_cloud<typename I::Primitives>) {
        out.values(set.size(), [&](std::size_t i) { return set.point(i); });
        out.align();
    } else {
        out.values(set.vertex_count(), [&](std::size_t i) { return set.vertex(i); });
        out.align();
        out.values(set.size(), [&](std::size_t i) { return set.indices(i); });
        out.align();
        out.values(set.faces().size(), [&](std::size_t i) { return set.faces()[i]; });
        out.align();
    }
    out.finish();
    file.commit();
}

/// Throws InputError unless a file holds primitives of this view, in its scalar.
template <class View>
void expect_held(const IndexHeader& h, const std::filesystem::path& path) {
    if (h.scalar_bytes != sizeof(typename View::Scalar)) {
        const std::string held = h.holds_floats() ? "float" : "double";
        throw InputError(path.string() + ": holds " + held + "s. Load it as " + held);
    }
    if (h.holds_points() && !is_cloud<View>)
        throw InputError(path.string() +
                         ": holds points, and triangles are asked for. Name an index of a mesh");
    if (!h.holds_points() && is_cloud<View>)
        throw InputError(path.string() +
                         ": holds triangles, and points are asked for. Name an index of points");
    if (static_cast<int>(h.dimension) != View::dimension)
        throw InputError(path.string() + ": holds points in " + (h.dimension == 2 ? "the plane" : "space") +
                         ". Load it as such");
}

template <class View>
auto load(const std::filesystem::path& path, const LoadIndexOptions& options, Threads threads) {
    const auto file = options.map ? mapped_file(path) : read_file(path);
    const auto header = checked_header(file.data, file.size, file.size, path);
    expect_held<View>(header, path);
    const auto layout = layout_of(header);
    Executor& executor = threads.over(header.primitives());
    if (options.verify != Verify::header) check_sums(layout, file, path, executor);
    auto index = in_place<View>(header, layout, file);
    if (options.verify == Verify::contents) check_contents(index, path, executor);
    return index;
}

}  // namespace
}  // namespace detail

template <std::floating_point T>
void save_index(const std::filesystem::path& path, const MeshIndex<T>& index, const Progress& progress) {
    detail::save(path, index, progress);
}
template <std::floating_point T, int D>
void save_index(const std::filesystem::path& path, const PointIndex<T, D>& index, const Progress& progress) {
    detail::save(path, index, progress);
}
template <std::floating_point T>
MeshIndex<T> load_index(const std::filesystem::path& path, const LoadIndexOptions& options, Threads threads) {
    return detail::load<TriangleMeshView<T>>(path, options, threads);
}
template <std::floating_point T, int D>
PointIndex<T, D> load_point_index(const std::filesystem::path& path, const LoadIndexOptions& options,
                                  Threads threads) {
    return detail::load<PointCloudView<T, D>>(path, options, threads);
}

template void save_index(const std::filesystem::path&, const MeshIndex<float>&, const Progress&);
template void save_index(const std::filesystem::path&, const MeshIndex<double>&, const Progress&);
template MeshIndex<float> load_index(const std::filesystem::path&, const LoadIndexOptions&, Threads);
template MeshIndex<double> load_index(const std::filesystem::path&, const LoadIndexOptions&, Threads);

template void save_index(const std::filesystem::path&, const PointIndex<float, 2>&, const Progress&);
template PointIndex<float, 2> load_point_index(const std::filesystem::path&, const LoadIndexOptions&,
                                               Threads);
template void save_index(const std::filesystem::path&, const PointIndex<float, 3>&, const Progress&);
template PointIndex<float, 3> load_point_index(const std::filesystem::path&, const LoadIndexOptions&,
                                               Threads);
template void save_index(const std::filesystem::path&, const PointIndex<double, 2>&, const Progress&);
template PointIndex<double, 2> load_point_index(const std::filesystem::path&, const LoadIndexOptions&,
                                                Threads);
template void save_index(const std::filesystem::path&, const PointIndex<double, 3>&, const Progress&);
template PointIndex<double, 3> load_point_index(const std::filesystem::path&, const LoadIndexOptions&,
                                                Threads);

}  // namespace hedgerow
