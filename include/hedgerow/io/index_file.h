/// Indexes to and from files, which are mapped: loading builds nothing and copies nothing.
#pragma once

#include <filesystem>
#include <string_view>

#include <hedgerow/index.h>
#include <hedgerow/parallel/progress.h>

namespace hedgerow {

/// What is saved: triangles in the engine, as `build(mesh)` makes it.
template <std::floating_point T>
using MeshIndex = Index<WideBvh<T, 3>, TriangleMeshView<T>>;

/// What of a file is looked at before its index is used.
enum class Verify {
    /// The header and the file's length, in microseconds; the rest is read as queries come to it. For files
    /// that you trust: **damage goes unseen, and queries may answer anything or read outside of the file**.
    header,
    /// All of it, against its checksums. No accident goes unseen; a file that was made to deceive does.
    checksums,
    /// And what a build promises: every link leads to a node, every box holds what is below it, every
    /// triangle stands in one leaf. No file does harm.
    contents
};

struct LoadIndexOptions {
    Verify verify = Verify::contents;
    /// Whether the file is mapped. If not (and where the system cannot map), it is read into memory of its
    /// own, on huge pages: then what becomes of the file is of no matter.
    bool map = true;
};

/// Writes an index and its mesh: a file that is complete in itself, and the same bytes for the same index.
/// The format is of this processor's byte order (docs/design/009-index-file.md).
///
/// Written under another name beside `path` and then renamed, so there never is half a file, and indexes that
/// were loaded from an earlier one are not disturbed. T is float or double. O(n) time; beyond the index 1 MiB
/// of memory. `progress` is told of the bytes that are written. Throws OutputError if the path cannot be
/// written (the disk is full, say), and Cancelled if `progress` is cancelled.
template <std::floating_point T>
void save_index(const std::filesystem::path& path, const MeshIndex<T>& index, const Progress& progress = {});

/// The index of a file that `save_index` wrote. It answers every query with the bits of the one that was
/// saved, owns its mapping, and may outlive the file's name. A `refit` changes its memory, never the file.
///
/// While it lives the file must not be changed in place: what was mapped would change with it, and a read
/// beyond a new end is fatal (SIGBUS). Replacing or deleting it is harmless.
///
/// O(1) time where only the header is verified, else O(n), over the executor but for the tree. Throws
/// InputError, naming the file, the place, what is wrong and what to do, for a file of another version, byte
/// order or scalar type, that is cut short or longer than it says, or in which any bit has changed (as far as
/// it is verified).
template <std::floating_point T>
MeshIndex<T> load_index(const std::filesystem::path& path, const LoadIndexOptions& options = {},
                        Executor& executor = serial_executor());

/// What a file's header says.
struct IndexFileInfo {
    int version;
    /// "float" or "double".
    std::string_view scalar;
    /// With the width that it has.
    WideOptions options;
    std::size_t triangles, vertices;
    /// Inner nodes, and leaves.
    std::size_t nodes, leaves;
    /// Levels, leaves counted.
    int depth;
    /// Whether the triangles have ids that are not their positions.
    bool faces;
    Box3d bounds;
    /// Of nodes, items and triangles in blocks: what an Index has beyond its primitives. And of the file.
    std::uint64_t index_bytes, file_bytes;
};
/// Reads that, and the file's length, alone. Throws InputError as load_index does of a header.
IndexFileInfo index_file_info(const std::filesystem::path& path);

/// Whether a path ends in `.hedgerow`, as these files are called, in upper or lower case.
bool names_index_file(const std::filesystem::path& path);

}  // namespace hedgerow
