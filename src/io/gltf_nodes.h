/// Where the nodes of a glTF scene place what they have.
#pragma once

#include <cstdint>
#include <vector>

#include <hedgerow/geometry/transform.h>

#include "gltf_file.h"

namespace hedgerow::detail {

/// A node and the map from its space to the scene's, which may be singular.
struct GltfPlacedNode {
    const GltfFile::Json* node;
    Affine<3> to_scene;
};

/// Whether a map turns fronts into backs.
bool mirrors(const Affine<3>& map);

/// The nodes of the default scene (else of the first scene; without scenes, all nodes) that have a mesh, a
/// camera or an extension. A node comes before its children, and children are in their order. Throws
/// InputError for a node that is reached twice: nodes of glTF are strict trees, so no walk runs in circles.
std::vector<GltfPlacedNode> placed_nodes(const GltfFile& file);

}  // namespace hedgerow::detail
