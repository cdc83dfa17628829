/// CGAL as a peer: a tree of boxes over triangles in double, one triangle a leaf.
#include <vector>

#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/AABB_triangle_primitive.h>
#include <CGAL/Simple_cartesian.h>
#include <CGAL/version_macros.h>

#include "points.h"

namespace hedgerow {
namespace {

using Kernel = CGAL::Simple_cartesian<double>;
using Triangles = std::vector<Kernel::Triangle_3>;
using Tree = CGAL::AABB_tree<
    CGAL::AABB_traits<Kernel, CGAL::AABB_triangle_primitive<Kernel, Triangles::const_iterator>>>;

Kernel::Point_3 cgal(const Vec3f& p) {
    return {double(p[0]), double(p[1]), double(p[2])};
}

class CgalPoints final : public PointPeer {
public:
    explicit CgalPoints(const TriangleMesh<float>& mesh) {
        for (std::size_t i = 0; i < mesh.size(); ++i) {
            const auto t = mesh.view().triangle(i);
            triangles_.push_back({cgal(t.a), cgal(t.b), cgal(t.c)});
        }
        tree_.insert(triangles_.cbegin(), triangles_.cend());
        tree_.build();
        tree_.accelerate_distance_queries();
    }
    std::string name() const override { return "CGAL " CGAL_VERSION_STR; }
    std::size_t nearest(std::span<const Vec3f> points, std::size_t,
                        std::span<float> distances2) const override {
        for (std::size_t i = 0; i < points.size(); ++i) {
            const Kernel::Point_3 p = cgal(points[i]);
            distances2[i] = float(CGAL::squared_distance(p, tree_.closest_point(p)));
        }
        return points.size();
    }

private:
    Triangles triangles_;
    Tree tree_;
};

}  // namespace

std::unique_ptr<PointPeer> cgal_points(const TriangleMesh<float>& mesh) {
    return std::make_unique<CgalPoints>(mesh);
}

}  // namespace hedgerow
