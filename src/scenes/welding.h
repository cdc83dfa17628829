/// Meshes from quadrilaterals, with equal corners made one vertex.
#pragma once

#include <cstdint>
#include <unordered_map>

#include <hedgerow/parallel/progress.h>
#include <hedgerow/primitives/triangle_mesh.h>

namespace hedgerow::detail {

/// Collects triangles. Corners with equal coordinates (−0 equals 0) become one vertex. Shapes that must not
/// be joined need separate meshes.
class WeldedMesh {
public:
    /// Reports progress as triangles made, of about `total`; `before` of them were made elsewhere.
    explicit WeldedMesh(const Progress& progress, std::uint64_t total, std::uint64_t before = 0)
        : progress_(progress), total_(total), before_(before) {}
    /// A triangle without area is dropped.
    void add(const Vec3d& a, const Vec3d& b, const Vec3d& c);
    /// Triangles a, b, c and a, c, d.
    void add_quad(const Vec3d& a, const Vec3d& b, const Vec3d& c, const Vec3d& d);
    /// The quadrilateral a, b, c, d in across × along pieces: `across` along a-b, `along` along b-c. Two
    /// quadrilaterals that share an edge and its number of pieces share all vertices on it.
    void add_divided_quad(const std::array<Vec3d, 4>& corners, std::uint32_t across, std::uint32_t along);

    TriangleMesh<double> mesh;

private:
    std::uint32_t vertex(const Vec3d& p);

    struct Hash {
        std::size_t operator()(const Vec3d& p) const;
    };
    const Progress& progress_;
    std::uint64_t total_, before_;
    std::unordered_map<Vec3d, std::uint32_t, Hash> known_;
};

/// Appends `part` to `whole`, with its vertices moved by `offset`. Nothing is joined.
void append(TriangleMesh<double>& whole, const TriangleMesh<double>& part, const Vec3d& offset = {});

}  // namespace hedgerow::detail
