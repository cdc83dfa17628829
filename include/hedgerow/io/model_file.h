/// Scenes with their looks from files.
#pragma once

#include <filesystem>

#include <hedgerow/io/texture_file.h>
#include <hedgerow/looks/model.h>
#include <hedgerow/parallel/progress.h>

namespace hedgerow {

struct ModelOptions {
    /// Images of textures are decoded. Without it every texture is white, which is faster.
    bool textures = true;
    PixelLimits limits = {};  ///< of each texture
};

/// Reads a scene with its looks from a file that load_mesh reads. docs/formats.md lists what each format
/// keeps.
///
/// - `.gltf`, `.glb`: an object for each mesh, and an instance for each node that has one. Corners of an
///   object at equal positions are joined. An instance whose map cannot be inverted becomes an object of its
///   own, in the scene's coordinates and without normals. Materials, textures, cameras and
///   lights are kept, with the extensions KHR_materials_transmission, ior, volume, emissive_strength, unlit
///   specular and pbrSpecularGlossiness, KHR_texture_transform and KHR_lights_punctual.
/// - `.obj`: one object, with the materials of its `.mtl` files.
/// - `.ply`: one object, with normals, colours and texture coordinates.
/// - `.off`: one object, with normals, colours and texture coordinates.
/// - `.stl`: one object without looks.
///
/// Triangles are those of load_mesh in the same order, if the instances are written out in their order. (With
/// T = float, positions of glTF that no float holds are rounded in the object's space and in the scene's.) A
/// mesh without looks takes no more memory than load_mesh gives it.
///
/// A texture that cannot be read, or whose file is outside of the folder of the scene, gives a warning in
/// the model. A colour is then magenta, and other properties lack the texture. An `.mtl` file or a material
/// that is missing gives a warning, too, and the surface is grey. Values at corners that are not finite are
/// left out with a warning. What a file says and the model lacks is listed in `not_shown`.
///
/// `progress` counts the bytes of the file, not those of its textures. T is float or double.
///
/// Throws InputError as load_mesh does, and for faults of what it does not read: ordinals out of range,
/// numbers in materials, cameras and lights that are no numbers or out of their range, and a glTF extension
/// that the file requires and that is not among those above. Throws Cancelled if `progress` is cancelled.
template <class T = float>
Model<T> load_model(const std::filesystem::path& path, const ModelOptions& options = {},
                    const Progress& progress = {});

}  // namespace hedgerow
