/// KHR_draco_mesh_compression: meshes of glTF that are compressed by Draco.
#pragma once

#include "gltf_file.h"

namespace hedgerow::detail {

/// Whether this build has Draco's library.
bool draco_supported();

/// Decodes a primitive, whose extension says where the compressed bytes are. Gives the file the elements of
/// the accessors that the primitive names, as each declares them. Throws InputError for bytes that are
/// damaged or hold other numbers of elements, and where the library is missing.
void decompress(GltfFile& file, const GltfFile::Json& primitive, const GltfFile::Json& extension);

}  // namespace hedgerow::detail
