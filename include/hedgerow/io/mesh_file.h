/// Triangle meshes from and to files.
#pragma once

#include <filesystem>
#include <string>

#include <hedgerow/base/strided.h>
#include <hedgerow/io/load_options.h>
#include <hedgerow/parallel/progress.h>
#include <hedgerow/primitives/triangle_mesh.h>

namespace hedgerow {

/// Reads a mesh. The extension, in upper or lower case, names the format:
///
/// - `.ply` (ascii, little and big endian; faces and triangle strips), `.stl` (ascii and binary), `.obj`,
///   `.off` (text and binary). Numbers are rounded once, from the file's value to T, so doubles are kept; the
///   report of LoadOptions says how far others were moved. Constant memory beyond the mesh, except for a
///   table of the vertices of STL and for large concave polygons.
/// - `.gltf`, `.glb`: glTF 2.0, with every instance of every mesh written out in the scene's coordinates.
///   Transforms are computed in double and rounded once to T. Only triangles are read; skins, morph targets
///   and animations are not applied. Buffers must be in the file itself or in its folder. The whole file is
///   held in memory.
///
/// Each extension may have `.gz` after it. Counts that a file declares are checked against its size and the
/// memory that is left.
///
/// A face with n > 3 corners becomes n − 2 triangles. They are a fan from its first corner if the face is
/// convex. Otherwise they come from ear clipping, which fills a concave polygon and nothing outside it.
/// `faces` then holds for each triangle the ordinal of its face in the file (from 0); it is empty if every
/// face is a triangle. A polygon that crosses itself becomes some triangles between its corners. A face with
/// fewer than three corners makes no triangle but is counted.
///
/// STL has no shared vertices, and glTF splits them for normals and textures. Both readers join corners at
/// equal positions (−0 equals 0), so closed surfaces are closed meshes. Normals, colours, textures and other
/// properties are not read; load_model reads them.
///
/// Text may begin with a byte order mark, and its lines end in any of \n, \r\n and \r. A \ at the end of a
/// line of OBJ joins the next one to a list of numbers, and to nothing else (a comment, a name).
///
/// `progress` counts the bytes of the file, about every 256 KiB. T is float or double. O(size of the file)
/// time, but a concave polygon of n corners takes O(n log n) if it is an ordinary outline, O(n²) at worst.
///
/// Throws InputError, naming the file, the place, the fault and a remedy, for every fault of the file,
/// including those that validate.h lists. Throws Cancelled if `progress` is cancelled.
template <class T = float>
TriangleMesh<T> load_mesh(const std::filesystem::path& path, const LoadOptions& options = {},
                          const Progress& progress = {});

/// The looks that `save_mesh` writes beside triangles. Each may be empty.
struct SavedLooks {
    Strided<Vec3f> normals;  ///< one a vertex, for `.ply` and `.obj`
    /// The name of an MTL file and of a material in it, which all triangles get; for `.obj`. The file is not
    /// written.
    std::string material_file, material;
};

/// Writes a mesh as `.ply` (binary, little endian), `.stl` (binary; **float, whatever T is**), `.obj` or
/// `.off` (the shortest decimals that read back to the same T). Triangles keep their order; `faces` is not
/// written. The file is written under another name beside `path` and then renamed, so there is never half a
/// file. `report`, if not null, gets how far coordinates were moved, as floats of `.stl` move doubles.
///
/// `progress` counts the vertices and triangles written. Throws InputError if the extension is none of these,
/// if a triangle names a vertex that does not exist, if there are more triangles than `.stl` can count
/// (2^32 − 1), if a coordinate is too large for its floats, if the number of normals is not that of the
/// vertices, or if the format does not have the looks. Throws OutputError if the path cannot be
/// written (the disk is full, say), and Cancelled if `progress` is cancelled. T is float or double.
/// O(vertices + triangles).
template <class T>
void save_mesh(const std::filesystem::path& path, const TriangleMesh<T>& mesh, const Progress& progress = {},
               RoundingReport* report = nullptr, const SavedLooks& looks = {});

}  // namespace hedgerow
