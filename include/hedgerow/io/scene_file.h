/// Loads a file of any kind as a Scene, the type that generators also return: what the tool calls a SCENE.
#pragma once

#include <filesystem>

#include <hedgerow/io/load_options.h>
#include <hedgerow/parallel/progress.h>
#include <hedgerow/scenes/generate.h>

namespace hedgerow {

/// Reads a mesh or a point cloud. The extension decides which, and for PLY, OBJ, OFF and glTF whether the
/// file has faces. `.npy` is a cloud in 2D if its shape is (N, 2); `.csv` and `.xyz` are read in 3D. A saved
/// index (`.hedgerow`) gives its mesh or its points, whose scalar type must be T. T is float or double.
/// Throws as load_mesh, load_points and load_index do.
template <class T>
Scene<T> load_scene(const std::filesystem::path& path, const LoadOptions& options = {},
                    const Progress& progress = {});

}  // namespace hedgerow
