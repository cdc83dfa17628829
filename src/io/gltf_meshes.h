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
enum class GltfMode : std::uint64_t { points = 0, triangles = 4, strip = 5, fan = 6 };

/// A primitive of triangles or of points.
struct GltfPart {
    const GltfFile::Json* primitive;
    GltfMode mode;
    const GltfAccessor* positions;
    const GltfAccessor* indices;  // null: the positions are the corners, in their order
    std::uint64_t triangles;

    /// How many positions are named, and the one that is named at place i. It may be out of range.
    std::uint64_t named() const { return (indices != nullptr ? *indices : *positions).size(); }
    std::uint64_t name(std::uint64_t i) const {
        return indices != nullptr ? static_cast<std::uint64_t>(indices->value(i, 0)) : i;
    }
    /// The positions that the corners of triangle `i` name. They may be out of range.
    std::array<std::uint64_t, 3> corners(std::uint64_t i) const;
};

/// The parts of a mesh that have triangles, the number of these triangles, and the parts that are points.
struct GltfMesh {
    std::vector<GltfPart> parts, clouds;
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
    /// Decodes a primitive whose positions only a compressed buffer view has.
    void decompress_if_needed(const GltfFile::Json& primitive, std::uint64_t positions);
    GltfPart read_part(const GltfFile::Json& primitive, GltfMode mode, const GltfAccessor& positions);

    GltfFile& file_;
    std::map<std::uint64_t, GltfMesh> meshes_;
    std::map<std::pair<std::uint64_t, int>, GltfAccessor> accessors_;  // by number and components
};

}  // namespace hedgerow::detail
