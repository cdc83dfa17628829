/// CGAL's sides of points, if CGAL was found when the build was configured; else null.
#pragma once

#include <memory>
#include <span>

#include <hedgerow/primitives/triangle_mesh.h>

namespace hedgerow {

/// Tells on which side of a closed mesh points are.
class InsidePeer {
public:
    virtual ~InsidePeer() = default;
    virtual std::string name() const = 0;
    /// Writes 1 for each point inside, 0 on and −1 outside of the mesh. Returns how many are inside.
    virtual std::size_t sides(std::span<const Vec3f> points, std::span<int> sides) const = 0;
};

/// CGAL's Side_of_triangle_mesh over a Surface_mesh with exact predicates. Null if the mesh is not closed.
std::unique_ptr<InsidePeer> cgal_insides(const TriangleMesh<float>& mesh);

#if !HEDGEROW_HAS_CGAL
inline std::unique_ptr<InsidePeer> cgal_insides(const TriangleMesh<float>&) {
    return nullptr;
}
#endif

}  // namespace hedgerow
