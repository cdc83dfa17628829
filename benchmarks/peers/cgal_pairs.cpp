/// The only file that includes CGAL.
#include "peers/pairs.h"

#include <memory>

#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/AABB_triangle_primitive.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/orient_polygon_soup.h>
#include <CGAL/Polygon_mesh_processing/polygon_soup_to_polygon_mesh.h>
#include <CGAL/Polygon_mesh_processing/self_intersections.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/box_intersection_d.h>

namespace hedgerow::measure {

namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using SurfaceMesh = CGAL::Surface_mesh<Kernel::Point_3>;
using Soup = std::vector<Kernel::Triangle_3>;
using Primitive = CGAL::AABB_triangle_primitive<Kernel, Soup::const_iterator>;
using Tree = CGAL::AABB_tree<CGAL::AABB_traits<Kernel, Primitive>>;

std::vector<Kernel::Point_3> points_of(const TriangleMesh<float>& mesh) {
    std::vector<Kernel::Point_3> points;
    for (const auto& v : mesh.vertices) points.emplace_back(v[0], v[1], v[2]);
    return points;
}
/// A mesh of half-edges. Faces are turned, and vertices doubled, where half-edges need that.
SurfaceMesh surface_of(const TriangleMesh<float>& mesh) {
    namespace pmp = CGAL::Polygon_mesh_processing;
    auto points = points_of(mesh);
    std::vector<std::vector<std::size_t>> faces;
    for (const auto& t : mesh.triangles)
        if (t[0] != t[1] && t[1] != t[2] && t[2] != t[0]) faces.push_back({t[0], t[1], t[2]});
    pmp::orient_polygon_soup(points, faces);
    SurfaceMesh surface;
    pmp::polygon_soup_to_polygon_mesh(points, faces, surface);
    return surface;
}
Soup soup_of(const TriangleMesh<float>& mesh) {
    const auto points = points_of(mesh);
    Soup soup;
    for (const auto& t : mesh.triangles) soup.emplace_back(points[t[0]], points[t[1]], points[t[2]]);
    return soup;
}

}  // namespace

void add_cgal_self_intersections(Contest& contest, const TriangleMesh<float>& mesh) {
    const auto surface = std::make_shared<const SurfaceMesh>(surface_of(mesh));
    contest.add("CGAL self_intersections", [surface] {
        namespace pmp = CGAL::Polygon_mesh_processing;
        std::vector<std::pair<SurfaceMesh::Face_index, SurfaceMesh::Face_index>> found;
        pmp::self_intersections<CGAL::Sequential_tag>(*surface, std::back_inserter(found));
        return found.size();
    });
}

void add_cgal_crossings(Contest& contest, const TriangleMesh<float>& a, const TriangleMesh<float>& b) {
    const auto soup_a = std::make_shared<const Soup>(soup_of(a)),
               soup_b = std::make_shared<const Soup>(soup_of(b));
    contest.add("CGAL AABB_tree", [soup_a, soup_b] {
        Tree tree(soup_a->begin(), soup_a->end());
        tree.build();
        std::vector<Primitive::Id> found;
        std::size_t pairs = 0;
        for (const auto& t : *soup_b) {
            found.clear();
            tree.all_intersected_primitives(t, std::back_inserter(found));
            pairs += found.size();
        }
        return pairs;
    });
    contest.add("CGAL box_intersection_d", [soup_a, soup_b] {
        using Box = CGAL::Box_intersection_d::Box_with_handle_d<double, 3, Soup::const_iterator>;
        const auto boxes_of = [](const Soup& soup) {
            std::vector<Box> boxes;
            boxes.reserve(soup.size());
            for (auto t = soup.begin(); t != soup.end(); ++t) boxes.emplace_back(t->bbox(), t);
            return boxes;
        };
        auto of_a = boxes_of(*soup_a), of_b = boxes_of(*soup_b);
        std::vector<std::pair<Soup::const_iterator, Soup::const_iterator>> found;
        CGAL::box_intersection_d(of_a.begin(), of_a.end(), of_b.begin(), of_b.end(),
                                 [&](const Box& s, const Box& t) {
                                     if (CGAL::do_intersect(*s.handle(), *t.handle()))
                                         found.emplace_back(s.handle(), t.handle());
                                 });
        return found.size();
    });
}

}  // namespace hedgerow::measure
