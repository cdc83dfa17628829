/// Whatever a file holds, or a generator makes: what the tool calls a SCENE.
#pragma once

#include <filesystem>

#include <hedgerow/io/load_options.h>
#include <hedgerow/parallel/progress.h>
#include <hedgerow/scenes/generate.h>

namespace hedgerow {

/// Reads a mesh or a cloud of points, by the file's extension and, for PLY, by whether it has faces. `.npy`
/// is a cloud in 2D if its shape is (N, 2); `.csv` and `.xyz` are read in 3D. Of a saved index (`.hedgerow`)
/// it is the mesh, which must be of T. T is float or double. Throws as load_mesh, load_points and load_index
/// do.
template <class T>
Scene<T> load_scene(const std::filesystem::path& path, const LoadOptions& options = {},
                    const Progress& progress = {});

}  // namespace hedgerow
