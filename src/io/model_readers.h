/// The readers of models, one per format. Their meshes are not yet validated.
#pragma once

#include <filesystem>

#include <hedgerow/io/model_file.h>

#include "byte_source.h"
#include "named_once.h"
#include "texture_shelf.h"

namespace hedgerow::detail {

/// What all readers of models need, and the lists that they fill.
struct ModelContext {
    ByteSource& file;
    const std::filesystem::path& path;
    NamedOnce& not_shown;
    NamedOnce& warnings;
    TextureShelf& textures;
};

template <class T>
Model<T> read_obj_model(const ModelContext& context);
template <class T>
Model<T> read_off_model(const ModelContext& context);
template <class T>
Model<T> read_ply_model(const ModelContext& context);
template <class T>
Model<T> read_gltf_model(const ModelContext& context);

/// A model of one mesh, named after the file, where it is.
template <class T>
Model<T> model_of(const std::filesystem::path& path, TriangleMesh<T> mesh) {
    Model<T> model;
    model.instances.push_back({path.stem().string(), 0, {}});
    Object<T>& object = model.objects.emplace_back();
    object.name = path.stem().string();
    object.mesh = std::move(mesh);
    return model;
}

}  // namespace hedgerow::detail
