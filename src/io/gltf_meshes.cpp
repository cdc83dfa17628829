#include "gltf_meshes.h"

#include <string>

#include "gltf_draco.h"

namespace hedgerow::detail {

namespace {

using Json = GltfFile::Json;

std::uint64_t triangle_count(GltfMode mode, std::uint64_t corners) {
    if (mode == GltfMode::points) return 0;
    return mode == GltfMode::triangles ? corners / 3 : corners < 3 ? 0 : corners - 2;
}

/// The corners of triangle i, as ordinals among the primitive's indices.
std::array<std::uint64_t, 3> corners_of(GltfMode mode, std::uint64_t i) {
    if (mode == GltfMode::triangles) return {3 * i, 3 * i + 1, 3 * i + 2};
    if (mode == GltfMode::fan) return {0, i + 1, i + 2};
    return i % 2 == 0 ? std::array{i, i + 1, i + 2} : std::array{i + 1, i, i + 2};
}

}  // namespace

std::array<std::uint64_t, 3> GltfPart::corners(std::uint64_t i) const {
    std::array<std::uint64_t, 3> named = corners_of(mode, i);
    for (std::uint64_t& corner : named) corner = name(corner);
    return named;
}

const GltfMesh& GltfMeshes::mesh(std::uint64_t number) {
    const auto [found, is_new] = meshes_.try_emplace(number);
    if (is_new) found->second = read_mesh(number);
    return found->second;
}

const GltfAccessor& GltfMeshes::accessor(std::uint64_t number, int components) {
    return accessors_.try_emplace({number, components}, file_, number, components).first->second;
}

void GltfMeshes::fail_corner(std::uint64_t face, std::uint64_t named, const GltfPart& part) const {
    file_.fail("face " + std::to_string(face) + " names vertex " + std::to_string(named) +
               ", but its mesh has only " + std::to_string(part.positions->size()));
}

GltfMesh GltfMeshes::read_mesh(std::uint64_t number) {
    const Json& object = file_.object("meshes", number);
    const std::string name = "mesh " + std::to_string(number);
    const auto primitives = object.find("primitives");
    if (primitives == object.end() || !primitives->is_array()) file_.fail(name + " has no 'primitives'");
    GltfMesh mesh;
    for (const Json& primitive : *primitives) {
        // Check the primitive and find its positions.
        if (!primitive.is_object()) file_.fail("a primitive of " + name + " is no object");
        const std::uint64_t mode = file_.number_or(primitive, "mode", 4);
        if (mode > 6) file_.fail("a primitive has mode " + std::to_string(mode) + ", but modes are 0 to 6");
        const auto attributes = primitive.find("attributes");
        if (attributes == primitive.end() || !attributes->is_object())
            file_.fail("a primitive of " + name + " has no 'attributes'");
        const auto positions = file_.number(*attributes, "POSITION");
        if ((mode > 0 && mode < 4) || !positions) continue;  // lines, or nothing to draw
        decompress_if_needed(primitive, *positions);
        // Keep the parts that have triangles or points.
        const GltfPart part = read_part(primitive, static_cast<GltfMode>(mode), accessor(*positions, 3));
        if (part.mode == GltfMode::points) mesh.clouds.push_back(part);
        if (part.triangles == 0) continue;
        mesh.parts.push_back(part);
        mesh.triangles += part.triangles;
    }
    return mesh;
}

void GltfMeshes::decompress_if_needed(const Json& primitive, std::uint64_t positions) {
    const Json* const draco = file_.extension(primitive, "KHR_draco_mesh_compression");
    if (draco == nullptr || file_.object("accessors", positions).contains("bufferView")) return;
    if (file_.given(positions).empty()) decompress(file_, primitive, *draco);
}

GltfPart GltfMeshes::read_part(const Json& primitive, GltfMode mode, const GltfAccessor& positions) {
    const auto number = file_.number(primitive, "indices");
    const GltfAccessor* const indices = number ? &accessor(*number, 1) : nullptr;
    if (indices != nullptr && !indices->has_ordinals())
        file_.fail("the indices of a primitive are of a type that indices cannot have");
    const std::uint64_t corners = (indices != nullptr ? *indices : positions).size();
    if (mode == GltfMode::triangles && corners % 3 != 0)
        file_.fail("a primitive of triangles has " + std::to_string(corners) +
                   " corners, which is no multiple of 3");
    return {&primitive, mode, &positions, indices, triangle_count(mode, corners)};
}

}  // namespace hedgerow::detail
