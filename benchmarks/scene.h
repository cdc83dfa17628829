/// The scenes of the benchmarks.
#pragma once

#include <string>

#include <hedgerow/io/mesh_file.h>
#include <hedgerow/scenes/generate.h>

namespace hedgerow {

/// Loads a mesh file, or generates gen:NAME[:SIZE].
inline TriangleMesh<float> scene(const std::string& name) {
    if (name.starts_with("gen:"))
        return std::get<TriangleMesh<float>>(generate<float>(parse_scene_spec(name)));
    return load_mesh<float>(name);
}

}  // namespace hedgerow
