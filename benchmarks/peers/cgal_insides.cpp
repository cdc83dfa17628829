/// CGAL as a peer for sides of points.
#include "peers/insides.h"

#include <vector>

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/orient_polygon_soup.h>
#include <CGAL/Polygon_mesh_processing/polygon_soup_to_polygon_mesh.h>
#include <CGAL/Polygon_mesh_processing/repair_polygon_soup.h>
#include <CGAL/Side_of_triangle_mesh.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/version_macros.h>

namespace hedgerow {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using SurfaceMesh = CGAL::Surface_mesh<Kernel::Point_3>;

class CgalInsides final : public InsidePeer {
public:
    explicit CgalInsides(SurfaceMesh surface) : surface_(std::move(surface)), side_(surface_) {}

    std::string name() const override { return "CGAL " CGAL_VERSION_STR; }
    std::size_t sides(std::span<const Vec3f> points, std::span<int> sides) const override {
        std::size_t inside = 0;
        for (std::size_t i = 0; i < points.size(); ++i) {
            const auto& p = points[i];
            const auto side = side_(Kernel::Point_3(double(p[0]), double(p[1]), double(p[2])));
            sides[i] = side == CGAL::ON_BOUNDED_SIDE ? 1 : (side == CGAL::ON_BOUNDARY ? 0 : -1);
            inside += sides[i] == 1;
        }
        return inside;
    }

private:
    SurfaceMesh surface_;
    CGAL::Side_of_triangle_mesh<SurfaceMesh, Kernel> side_;
};

}  // namespace

std::unique_ptr<InsidePeer> cgal_insides(const TriangleMesh<float>& mesh) {
    namespace pmp = CGAL::Polygon_mesh_processing;
    std::vector<Kernel::Point_3> points;
    for (const auto& v : mesh.vertices) points.emplace_back(double(v[0]), double(v[1]), double(v[2]));
    std::vector<std::vector<std::size_t>> faces;
    for (const auto& t : mesh.triangles) faces.push_back({t[0], t[1], t[2]});
    pmp::repair_polygon_soup(points, faces);
    pmp::orient_polygon_soup(points, faces);
    SurfaceMesh surface;
    pmp::polygon_soup_to_polygon_mesh(points, faces, surface);
    if (!CGAL::is_closed(surface)) return nullptr;
    return std::make_unique<CgalInsides>(std::move(surface));
}

}  // namespace hedgerow
