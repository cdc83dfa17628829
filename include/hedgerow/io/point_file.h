/// Point clouds from and to files.
#pragma once

#include <filesystem>

#include <hedgerow/io/load_options.h>
#include <hedgerow/parallel/progress.h>
#include <hedgerow/primitives/point_cloud.h>

namespace hedgerow {

/// Reads points. The extension, in upper or lower case, names the format, and may have `.gz` after it:
///
/// - `.ply`: the element `vertex`, of any PLY. In 2D `z` may be missing, and must otherwise be 0.
/// - `.npy`: an array of N × D numbers.
/// - `.csv`: one point per line, with numbers separated by semicolons, else by commas, else by white space.
///   Lines that are empty or begin with `#` or `//` are skipped. Between semicolons a number may have a
///   comma in place of its point. If the first line does not begin with a number, it must name the columns x,
///   y (and z), which are read; otherwise there must be D columns.
/// - `.xyz`: read like `.csv`, but numbers after the D coordinates are skipped (normals, colours). The first
///   line may be the number of points. Then a line of words may follow, and a word may stand before the
///   numbers of each line, as chemists have it.
/// - `.obj`, `.off`: the vertices, whatever connects them. `.gltf`, `.glb`: the primitives that are points,
///   in the scene's coordinates.
///
/// Numbers are rounded once, from the file's value to T. T is float or double, D is 2 or 3. `progress` counts
/// the bytes of the file, about every 256 KiB. O(size of the file) time.
///
/// Throws InputError, naming the file, the place, the fault and a remedy; Cancelled if `progress` is
/// cancelled.
template <class T = float, int D = 3>
PointCloud<T, D> load_points(const std::filesystem::path& path, const LoadOptions& options = {},
                             const Progress& progress = {});

/// Writes points as `.ply` (binary, little endian; z is 0 in 2D), `.npy`, `.csv` (a line of names, then the
/// shortest decimals that read back to the same T) or `.xyz` (such decimals, without names). The file is
/// written under another name beside `path` and then renamed. `progress` counts points. Throws InputError if
/// the extension is none of these, OutputError if the path cannot be written, and Cancelled if `progress` is
/// cancelled. O(points).
template <class T, int D>
void save_points(const std::filesystem::path& path, const PointCloud<T, D>& cloud,
                 const Progress& progress = {});

}  // namespace hedgerow
