/// CGAL's Hausdorff distance within a bound (Kang, Kim, Yoon and Kim's method:
/// CGAL::Polygon_mesh_processing).
#include "peers/hausdorff.h"

#include <cmath>
#include <memory>
#include <vector>

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/distance.h>
#include <CGAL/Polygon_mesh_processing/orient_polygon_soup.h>
#include <CGAL/Polygon_mesh_processing/polygon_soup_to_polygon_mesh.h>
#include <CGAL/Surface_mesh.h>

namespace hedgerow::measure {

namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using SurfaceMesh = CGAL::Surface_mesh<Kernel::Point_3>;

/// A mesh of half-edges. Faces are turned, and vertices doubled, where half-edges need that; triangles
/// without area are left out, which CGAL does not take.
SurfaceMesh surface_of(const TriangleMesh<float>& mesh) {
    namespace pmp = CGAL::Polygon_mesh_processing;
    std::vector<Kernel::Point_3> points;
    for (const auto& v : mesh.vertices) points.emplace_back(v[0], v[1], v[2]);
    std::vector<std::vector<std::size_t>> faces;
    for (const auto& t : mesh.triangles)
        if (!CGAL::collinear(points[t[0]], points[t[1]], points[t[2]])) faces.push_back({t[0], t[1], t[2]});
    pmp::orient_polygon_soup(points, faces);
    SurfaceMesh surface;
    pmp::polygon_soup_to_polygon_mesh(points, faces, surface);
    return surface;
}

}  // namespace

void add_cgal_hausdorff(Contest& contest, const TriangleMesh<float>& a, const TriangleMesh<float>& b,
                        double error) {
    const auto surface_a = std::make_shared<const SurfaceMesh>(surface_of(a)),
               surface_b = std::make_shared<const SurfaceMesh>(surface_of(b));
    contest.add("CGAL bounded_error", [surface_a, surface_b, error] {
        namespace pmp = CGAL::Polygon_mesh_processing;
        const double found =
            pmp::bounded_error_Hausdorff_distance<CGAL::Sequential_tag>(*surface_a, *surface_b, error);
        return static_cast<std::size_t>(std::llround(found / error * 1e6));
    });
}

}  // namespace hedgerow::measure
