/// Chooses the reader of a model by the extension, and checks what it gives.
#include <hedgerow/io/model_file.h>

#include <hedgerow/base/error.h>
#include <hedgerow/io/mesh_file.h>
#include <hedgerow/io/validate.h>

#include "memory.h"
#include "model_readers.h"
#include "readers.h"

namespace hedgerow {

namespace detail {
namespace {

/// A mesh without looks, in a format that has none.
template <class T>
Model<T> bare_model(const std::filesystem::path& path, const Progress& progress) {
    Model<T> model = model_of(path, load_mesh<T>(path, {}, progress));
    model.materials.emplace_back();
    return model;
}

template <class T>
Model<T> read_any_model(const std::filesystem::path& path, const ModelOptions& options,
                        const Progress& progress) {
    const std::string format = format_of(path);
    Model<T> (*read)(const ModelContext&) = nullptr;
    if (format == ".ply") read = read_ply_model<T>;
    if (format == ".obj") read = read_obj_model<T>;
    if (format == ".off") read = read_off_model<T>;
    if (format == ".gltf" || format == ".glb") read = read_gltf_model<T>;
    if (read == nullptr) return bare_model<T>(path, progress);
    ByteSource file(path, progress);
    NamedOnce not_shown, warnings;
    TextureShelf textures(options, progress, warnings);
    Model<T> model = read({file, path, not_shown, warnings, textures});
    model.textures = textures.take();
    model.not_shown = not_shown.take();
    for (const std::string& told : file.take_warnings()) warnings.add(told);
    model.warnings = warnings.take();
    return model;
}

/// Throws InputError for a mesh that load_mesh would refuse, and for an instance that is beyond the largest
/// coordinate.
template <class T>
void validate(const Model<T>& model, const std::filesystem::path& path) {
    const std::string name = path.string();
    if (model.objects.empty()) validate_mesh(TriangleMesh<T>(), name);
    std::vector<Box<double, 3>> bounds;
    for (const Object<T>& object : model.objects) {
        validate_mesh(object.mesh, model.objects.size() > 1 ? name + ", object '" + object.name + "'" : name);
        Box<double, 3>& box = bounds.emplace_back();
        for (const auto& v : object.mesh.vertices) box.expand(Vec3d(v));
    }
    for (const PlacedObject& placed : model.instances) {
        const Box<double, 3> box = placed.to_world.there().box(bounds[placed.object]);
        for (int k = 0; k < 3; ++k)
            if (!(std::max(-box.low[k], box.high[k]) <= largest_coordinate<T>))
                throw InputError(name + ": the instance '" + placed.name + "' of object '" +
                                 model.objects[placed.object].name +
                                 "' has coordinates that are too large. Scale the scene down");
    }
}

}  // namespace
}  // namespace detail

template <class T>
Model<T> load_model(const std::filesystem::path& path, const ModelOptions& options,
                    const Progress& progress) {
    return detail::within_memory(path, [&] {
        Model<T> model = detail::read_any_model<T>(path, options, progress);
        detail::validate(model, path);
        return model;
    });
}

template Model<float> load_model(const std::filesystem::path&, const ModelOptions&, const Progress&);
template Model<double> load_model(const std::filesystem::path&, const ModelOptions&, const Progress&);

}  // namespace hedgerow
