/// Pictures of scenes with their looks.
#pragma once

#include <hedgerow/render/model_scene.h>

#include "rendering.h"

namespace hedgerow::cli {

/// A scene with its looks, its indexes, and the options of its picture.
template <class T>
struct ShownModel {
    Model<T> model;
    double started;  // when the indexes were begun
    ModelScene<T> scene;
    Outcome outcome;
    RenderOptions options;
    Vec3f up;  // the scene's upward direction, however the camera is held

    /// Loads or generates the scene and the environment that the user names, builds indexes and places the
    /// camera. Throws InputError for files that cannot be read.
    explicit ShownModel(const RenderArguments& a);
};

/// Renders a scene with its looks, by rays through an index of two levels, or by its triangles. T is float or
/// double. Returns the exit code.
template <class T>
int render_looks(const RenderArguments& a);

/// Renders a scene by following paths of light. T is float or double. Returns the exit code.
template <class T>
int render_paths(const RenderArguments& a);

/// Throws MemoryShort if there is no memory for the light of a picture by paths, and to save it. Throws
/// UsageError as parse_size does.
void check_paths_memory(const RenderArguments& a);

/// Throws UsageError for options that no sheet of pictures has, and MemoryShort as check_picture_memory does.
void check_sheet(const RenderArguments& a);

}  // namespace hedgerow::cli
