/// The cameras and lights of glTF 2.0.
#pragma once

#include <hedgerow/looks/light.h>
#include <hedgerow/looks/model.h>

#include "gltf_file.h"
#include "gltf_nodes.h"
#include "named_once.h"

namespace hedgerow::detail {

/// The camera of a node. Throws InputError for one that does not exist, and for angles and sizes out of their
/// range, such as a field of view of 0.
FileCamera camera_of(const GltfFile& file, const GltfPlacedNode& node, std::uint64_t camera);

/// The light of a node (KHR_lights_punctual). Throws InputError for one that does not exist or is of an
/// unknown type, and for numbers out of their range.
Light light_of(const GltfFile& file, const GltfPlacedNode& node, std::uint64_t light, NamedOnce& not_shown);

}  // namespace hedgerow::detail
