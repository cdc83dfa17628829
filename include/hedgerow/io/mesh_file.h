/// Triangle meshes from and to files.
#pragma once

#include <filesystem>

#include <hedgerow/io/load_options.h>
#include <hedgerow/parallel/progress.h>
#include <hedgerow/primitives/triangle_mesh.h>

namespace hedgerow {

/// Reads a mesh. The extension, in upper or lower case, says how:
///
/// - `.ply`, `.stl`, `.obj`, `.off` in every variant (PLY ascii, little and big endian; STL ascii and
///   binary). Numbers are rounded once, from what the file holds to T, so doubles are kept. Memory beyond the
///   mesh itself is constant.
/// - `.gltf`, `.glb`: glTF 2.0, every instance of every mesh written out in the scene's coordinates.
///   Transforms are in double, rounded once to T. Triangles alone are read; skins, morph targets and
///   animations are not applied. Buffers lie in the file itself or in its folder. The file is held whole.
///
/// Each may have `.gz` behind it. No count in a file is believed: what it declares is held against its size
/// and the memory that is left.
///
/// Faces with more than three corners become as many triangles as they have corners, less two: fans from
/// their first corner if they are convex, else what ear clipping makes of them, so that a concave polygon is
/// filled and nothing beside it. `faces` then holds each triangle's ordinal of the face in the file (from 0);
/// it is empty if every face is a triangle. A polygon that crosses itself becomes some triangles between its
/// corners. A face with fewer than three corners makes no triangle but is counted. STL has no shared
/// vertices, and glTF splits them for normals and textures: of both, corners at equal positions (−0 being 0)
/// are joined, so closed surfaces are closed meshes. Normals, colours, textures and other properties are not
/// read.
///
/// `progress` is told of the bytes of the file, about every 256 KiB. T is float or double. O(size of the
/// file) time, but for a concave polygon of n corners O(n log n) if it is drawn as outlines are, O(n²) at
/// worst.
///
/// Throws InputError, naming the file, the place, what is wrong and what to do, for whatever is wrong with
/// the file: see also validate.h for what every mesh is held against. Throws Cancelled if `progress` is
/// cancelled.
template <class T = float>
TriangleMesh<T> load_mesh(const std::filesystem::path& path, const LoadOptions& options = {},
                          const Progress& progress = {});

/// Writes a mesh as `.ply` (binary, little endian), `.stl` (binary; **float, whatever T is**), `.obj` or
/// `.off` (the shortest decimals that read back to the same T). Triangles are written in their order; `faces`
/// is not. The file is written under another name beside `path` and then renamed, so there never is half a
/// file.
///
/// `progress` is told of the vertices and triangles that are written. Throws InputError if the extension is
/// none of these or a triangle names a vertex that does not exist, OutputError if the path cannot be written
/// (the disk is full, say), and Cancelled if `progress` is cancelled. T is float or double. O(vertices +
/// triangles).
template <class T>
void save_mesh(const std::filesystem::path& path, const TriangleMesh<T>& mesh, const Progress& progress = {});

}  // namespace hedgerow
