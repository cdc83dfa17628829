/// glTF 2.0 scenes (`.gltf`, `.glb`): every instance of every mesh, in the scene's coordinates. This reader
/// replaces Assimp, which damaged files can crash (docs/design/014-gltf.md).
#include <array>
#include <utility>

#include "gltf_file.h"
#include "gltf_meshes.h"
#include "gltf_nodes.h"
#include "memory.h"
#include "mesh_parts.h"
#include "readers.h"
#include "text.h"

namespace hedgerow::detail {

namespace {

/// A mesh, and the map that a node applies to it.
struct Placed {
    const GltfMesh* mesh;
    Affine<3> to_scene;
};

template <class T>
class GltfReader {
public:
    GltfReader(ByteSource& source, const std::filesystem::path& path)
        : source_(source), file_(source, path) {}

    /// The positions that points name.
    TriangleMesh<T> read_points() {
        TriangleMesh<T> mesh;
        for (const GltfPlacedNode& n : placed_nodes(file_)) {
            const auto number = file_.number(*n.node, "mesh");
            if (!number) continue;
            for (const GltfPart& part : meshes_.mesh(*number).clouds)
                for (std::uint64_t i = 0; i < part.named(); ++i) {
                    if (i % 65536 == 0) source_.expect_not_cancelled();
                    check_room(source_, mesh.vertices.size(), "points");
                    append(source_, mesh.vertices, position(part, part.name(i), n.to_scene));
                }
        }
        return mesh;
    }
    TriangleMesh<T> read() {
        for (const Placed& p : placed_meshes())
            for (const GltfPart& part : p.mesh->parts) add_part(part, p.to_scene);
        TriangleMesh<T> mesh;
        mesh.vertices = welder_.take();
        faces_.move_to(mesh);
        return mesh;
    }

private:
    /// Counts the triangles of all instances before any is made, because a few bytes can name a mesh many
    /// times.
    std::vector<Placed> placed_meshes() {
        std::vector<Placed> placed;
        std::uint64_t triangles = 0;
        for (const GltfPlacedNode& n : placed_nodes(file_)) {
            source_.expect_not_cancelled();
            const auto number = file_.number(*n.node, "mesh");
            if (!number) continue;
            placed.push_back({&meshes_.mesh(*number), n.to_scene});
            triangles += placed.back().mesh->triangles;
            check_room(source_, triangles, "triangles, all instances written out");
        }
        expect_memory(file_.name(),
                      "its " + std::to_string(triangles) + " triangles, all instances written out,",
                      triangles * sizeof(TriangleIndices));
        return placed;
    }
    void add_part(const GltfPart& part, const Affine<3>& to_scene) {
        const bool mirrored = mirrors(to_scene);  // a mirror turns fronts into backs, so turn them again
        for (std::uint64_t i = 0; i < part.triangles; ++i) {
            if (i % 65536 == 0) source_.expect_not_cancelled();
            const auto named = part.corners(i);
            std::array<std::uint32_t, 3> triangle{};
            for (std::size_t k = 0; k < 3; ++k) triangle[k] = vertex(part, named[k], to_scene);
            if (mirrored) std::swap(triangle[0], triangle[2]);
            faces_.add(triangle);
        }
    }
    std::uint32_t vertex(const GltfPart& part, std::uint64_t named, const Affine<3>& to_scene) {
        check_room(source_, welder_.size(), "vertices");
        return welder_.vertex(position(part, named, to_scene));
    }
    Vec<T, 3> position(const GltfPart& part, std::uint64_t named, const Affine<3>& to_scene) {
        if (named >= part.positions->size()) meshes_.fail_corner(faces_.face_count(), named, part);
        const Vec3d p = to_scene.point(part.positions->point(named));
        double& rounding = source_.rounding();
        return {coordinate<T>(p[0], rounding), coordinate<T>(p[1], rounding), coordinate<T>(p[2], rounding)};
    }

    ByteSource& source_;
    GltfFile file_;
    GltfMeshes meshes_{file_};
    Welder<T> welder_{source_};
    FaceList faces_{source_};
};

}  // namespace

template <class T>
TriangleMesh<T> read_gltf(ByteSource& file, const std::filesystem::path& path) {
    return GltfReader<T>(file, path).read();
}

template <class T>
TriangleMesh<T> read_gltf_points(ByteSource& file, const std::filesystem::path& path) {
    return GltfReader<T>(file, path).read_points();
}

template TriangleMesh<float> read_gltf(ByteSource&, const std::filesystem::path&);
template TriangleMesh<double> read_gltf(ByteSource&, const std::filesystem::path&);
template TriangleMesh<float> read_gltf_points(ByteSource&, const std::filesystem::path&);
template TriangleMesh<double> read_gltf_points(ByteSource&, const std::filesystem::path&);

}  // namespace hedgerow::detail
