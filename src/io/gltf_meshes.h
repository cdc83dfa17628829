/// The triangles of glTF meshes, as their primitives describe them.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include "gltf_accessor.h"
#include "gltf_file.h"

namespace hedgerow::detail {

/// How the indices of a primitive make triangles. The values are glTF's.
enum class GltfMode : std::uint64_t { triangles = 4, strip = 5, fan = 6 };

/// A primitive of triangles.
struct GltfPart {
    const GltfFile::Json* primitive;
    GltfMode mode;
    const GltfAccessor* positions;
    const GltfAccessor* indices;  // null: the positions are the corners, in their order
    std::uint64_t triangles;

    /// The positions that the corners of triangle `i` name. They may be out of range.
    std::array<std::uint64_t, 3> corners(std::uint64_t i) const;
};

/// The parts of a mesh that have triangles, and the number of these triangles.
struct GltfMesh {
    std::vector<GltfPart> parts;
    std::uint64_t triangles = 0;
};

/// Meshes and accessors of a file, each read from the JSON once, however often it is named. All faults of the
/// file are InputError.
class GltfMeshes {
public:
    explicit GltfMeshes(GltfFile& file) : file_(file) {}

    const GltfMesh& mesh(std::uint64_t number);
    /// An accessor of so many components, which must be its type.
    const GltfAccessor& accessor(std::uint64_t number, int components);
    /// Throws InputError: a corner of face `face` names position `named`, but there are fewer.
    [[noreturn]] void fail_corner(std::uint64_t face, std::uint64_t named, const GltfPart& part) const;

private:
    GltfMesh read_mesh(std::uint64_t number);
    GltfPart read_part(const GltfFile::Json& primitive, GltfMode mode, const GltfAccessor& positions);

    GltfFile& file_;
    std::map<std::uint64_t, GltfMesh> meshes_;
    std::map<std::pair<std::uint64_t, int>, GltfAccessor> accessors_;  // by number and components
};

}  // namespace hedgerow::detail
