/// Saves indexes of triangles and of points to files, and loads them. Files are mapped: loading builds
/// nothing and copies nothing.
#pragma once

#include <filesystem>
#include <string_view>

#include <hedgerow/mesh_index.h>
#include <hedgerow/parallel/progress.h>
#include <hedgerow/primitives/point_cloud.h>

namespace hedgerow {

/// Which parts of a file are checked before its index is used.
enum class Verify {
    /// The header and the file's length, in microseconds. The rest is read when queries touch it. For files
    /// that you trust: **damage goes unnoticed, and queries may return anything or read outside of the
    /// file**.
    header,
    /// The whole file, against its checksums. No accidental damage goes unnoticed; a file that was made to
    /// deceive does.
    checksums,
    /// The checksums, and what a build guarantees: every link leads to a node, every box contains what is
    /// below it, every triangle is in one leaf. No file does harm.
    contents
};

/// The index of points that `build(cloud)` returns.
template <std::floating_point T, int D>
using PointIndex = Index<WideBvh<T, D>, PointCloudView<T, D>>;

struct LoadIndexOptions {
    Verify verify = Verify::contents;
    /// Whether the file is mapped. If not, or if the system cannot map, the file is read into memory of its
    /// own, on huge pages. Later changes to the file then do not matter.
    bool map = true;
};

/// Writes an index and its mesh, or its points. The file is complete in itself, and the same index gives the
/// same bytes. The format uses this processor's byte order (docs/design/009-index-file.md).
///
/// The file is written under another name beside `path` and then renamed, so there is never half a file, and
/// indexes that were loaded from an earlier one are not disturbed. T is float or double. O(n) time; 1 MiB of
/// memory beyond the index. `progress` counts the bytes written. Throws OutputError if the path cannot be
/// written (the disk is full, say), and Cancelled if `progress` is cancelled.
template <std::floating_point T>
void save_index(const std::filesystem::path& path, const MeshIndex<T>& index, const Progress& progress = {});
template <std::floating_point T, int D>
void save_index(const std::filesystem::path& path, const PointIndex<T, D>& index,
                const Progress& progress = {});

/// Loads an index that `save_index` wrote. It answers every query with the same bits as the saved index. It
/// owns its mapping, so deleting or replacing the file is harmless. A `refit` changes the index's memory,
/// never the file.
///
/// The file must not be changed in place while the index lives: mapped memory changes with the file, and a
/// read beyond a new end is fatal (SIGBUS).
///
/// O(1) time if the file is mapped and only its header is verified, else O(n), in parallel except for the
/// check of the tree. Throws InputError, naming the file, the place, the fault and a remedy, for a file that
/// has another version, byte order or scalar type, is shorter or longer than its header says, or has any bit
/// changed (as far as it is verified).
template <std::floating_point T>
MeshIndex<T> load_index(const std::filesystem::path& path, const LoadIndexOptions& options = {},
                        Threads threads = {});
/// Loads an index of points as `load_index` does one of triangles. Either throws InputError for a file of the
/// other kind or dimension. D is 2 or 3.
template <std::floating_point T, int D>
PointIndex<T, D> load_point_index(const std::filesystem::path& path, const LoadIndexOptions& options = {},
                                  Threads threads = {});

/// The contents of a file's header.
struct IndexFileInfo {
    int version;
    /// "float" or "double".
    std::string_view scalar;
    /// The options of the build, with the width that was chosen.
    WideOptions options;
    int dimension;
    /// Whether the primitives are points. Else they are triangles.
    bool holds_points;
    /// Numbers of triangles and their vertices, or of points; 0 for what the file does not hold.
    std::size_t triangles, points, vertices;
    /// Numbers of inner nodes and of leaves.
    std::size_t nodes, leaves;
    /// Number of levels, leaves included.
    int depth;
    /// Whether the file has an id for each triangle. Without them, ids are positions.
    bool faces;
    Box3d bounds;
    /// Bytes of nodes, items and triangle blocks (all that an Index has beyond its primitives), and of the
    /// file.
    std::uint64_t index_bytes, file_bytes;
};
/// Reads the header of a file and checks the file's length. Throws InputError as load_index does for a
/// header.
IndexFileInfo index_file_info(const std::filesystem::path& path);

/// Whether a path has the extension of saved indexes, `.hedgerow`, in upper or lower case (`.gz` may follow).
bool names_index_file(const std::filesystem::path& path);

}  // namespace hedgerow
