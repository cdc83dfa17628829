/// Flat geometry for pictures: a flat scene as it is, or a plane section of a scene in space.
#pragma once

#include <optional>
#include <unordered_map>
#include <vector>

#include <hedgerow/primitives/point_cloud.h>
#include <hedgerow/primitives/segment_set.h>
#include <hedgerow/primitives/sphere_set.h>
#include <hedgerow/primitives/triangle_mesh.h>
#include <hedgerow/walks/outline.h>

namespace hedgerow::cli {

using Corners = std::vector<Vec2d>;

/// A primitive as it is drawn: a dot (one point), a line, a polygon, or a circle.
struct FlatPrimitive {
    PrimitiveId id;
    Corners points;
    double radius = 0;
};

/// The plane of a picture. `flat` maps a point to the plane, `part` is the polygon of a cell in it, `limits`
/// restricts an outline, and `add` appends what the plane has of primitive i, if anything.
template <int D>
struct Section;
/// The section of a flat scene: the whole scene.
template <>
struct Section<2> {
    Vec2d flat(const Vec2d& p) const { return p; }
    Corners part(const OutlineCell<2>& cell) const { return cell.region().corners(); }
    OutlineLimits<2> limits(int levels) const {
        OutlineLimits<2> l;
        l.levels = levels;
        return l;
    }
    template <class T>
    void add(const PointCloud<T, 2>& cloud, std::size_t i, double, std::vector<FlatPrimitive>& all) const {
        all.push_back({static_cast<PrimitiveId>(i), {Vec2d(cloud.points[i])}});
    }
    template <class T>
    void add(const SegmentSet<T>& set, std::size_t i, double, std::vector<FlatPrimitive>& all) const {
        all.push_back({static_cast<PrimitiveId>(i), {Vec2d(set.segments[i].a), Vec2d(set.segments[i].b)}});
    }
};
/// A plane through the point `origin` of space. `right` and `up` are perpendicular and of length 1, and are
/// the x and y axes of the picture.
template <>
struct Section<3> {
    Vec3d origin, right, up;
    /// Outlines list the cells that overlap this box. By default it is all of space. For a plane
    /// perpendicular to an axis it can be the plane itself.
    Box3d within = OutlineLimits<3>().within;

    CutPlane<3> plane() const {
        const Vec3d normal = cross(right, up);
        return {normal, dot(normal, origin), 0};
    }
    Vec2d flat(const Vec3d& p) const { return {dot(p - origin, right), dot(p - origin, up)}; }
    Corners flat(const std::vector<Vec3d>& points) const {
        Corners all;
        for (const auto& p : points) all.push_back(flat(p));
        return all;
    }
    /// The polygon of a cell in the plane. Empty if the cell does not reach the plane.
    Corners part(const OutlineCell<3>& cell) const {
        const CutPlane<3> cut = plane();
        if (std::abs(cut.height(cell.box.center())) > dot(abs(cut.normal), cell.box.extent())) return {};
        const auto corners = cell.region().section(cut);
        return corners.size() < 3 ? Corners() : flat(corners);
    }
    OutlineLimits<3> limits(int levels) const { return {levels, within}; }

    template <class T>
    void add(const TriangleMesh<T>& mesh, std::size_t i, double, std::vector<FlatPrimitive>& all) const {
        const auto tri = mesh.view().triangle(i);
        const Vec3d corner[3] = {Vec3d(tri.a), Vec3d(tri.b), Vec3d(tri.c)};
        const CutPlane<3> cut = plane();
        std::vector<Vec3d> points;
        for (int k = 0; k < 3; ++k) {
            const Vec3d &p = corner[k], &q = corner[(k + 1) % 3];
            const double a = cut.height(p), b = cut.height(q);
            if (a == 0) points.push_back(p);
            if ((a < 0 && b > 0) || (a > 0 && b < 0)) points.push_back(p + (q - p) * (a / (a - b)));
        }
        if (points.size() >= 2) all.push_back({static_cast<PrimitiveId>(i), flat(points)});
    }
    template <class T>
    void add(const SphereSet<T, 3>& set, std::size_t i, double, std::vector<FlatPrimitive>& all) const {
        const auto& s = set.spheres[i];
        const double away = plane().height(Vec3d(s.center)), r = static_cast<double>(s.radius);
        if (std::abs(away) <= r)
            all.push_back({static_cast<PrimitiveId>(i),
                           {flat(Vec3d(s.center))},
                           std::sqrt(product(r, r) - product(away, away))});
    }
    /// Appends a point if it is at most `near` from the plane.
    template <class T>
    void add(const PointCloud<T, 3>& cloud, std::size_t i, double near,
             std::vector<FlatPrimitive>& all) const {
        const Vec3d p(cloud.points[i]);
        if (std::abs(plane().height(p)) <= near) all.push_back({static_cast<PrimitiveId>(i), {flat(p)}});
    }
};

/// The parts of all primitives in a section. Points of space are drawn up to a distance of `near` from the
/// plane. O(n).
template <class P, int D>
std::vector<FlatPrimitive> flat_primitives(const P& set, const Section<D>& section, double near) {
    std::vector<FlatPrimitive> all;
    for (std::size_t i = 0; i < set.size(); ++i) section.add(set, i, near, all);
    return all;
}

/// A cell as it is drawn: a polygon.
struct FlatCell {
    NodeId id;
    int level;
    bool leaf;
    std::size_t items;
    Corners corners;
};

/// A structure as it is drawn. `shared` are the intersections of the boxes of siblings. `overlap` is the
/// volume (in a flat scene the area) of these intersections as a share of the parent's volume: the mean over
/// the inner nodes with box-shaped children and a volume above 0.
struct FlatStructure {
    std::vector<FlatCell> cells;
    std::vector<Corners> shared;
    std::optional<double> overlap;  // empty until add_shared computes it
};

template <int D>
FlatStructure flat_structure(const std::vector<OutlineCell<D>>& cells, const Section<D>& section) {
    FlatStructure flat;
    for (const auto& c : cells)
        if (auto corners = section.part(c); !corners.empty())
            flat.cells.push_back({c.id, c.level, c.leaf, c.items.size(), std::move(corners)});
    return flat;
}

/// Appends the intersections of siblings in the section to `shared`, and sets `overlap`. Only children that
/// are boxes count. O(cells + pairs of siblings).
template <int D>
void add_shared(const std::vector<OutlineCell<D>>& cells, const Section<D>& section, FlatStructure& flat) {
    const auto volume = [](const Box<double, D>& b) {
        double v = b.empty() ? 0 : 1;
        for (int k = 0; k < D; ++k) v *= b.empty() ? 1 : b.extent()[k];
        return v;
    };
    // Collect the box-shaped children of each parent.
    std::unordered_map<NodeId, std::vector<const OutlineCell<D>*>> children;
    for (const auto& c : cells)
        if (c.level > 1 && c.shape.empty()) children[c.parent].push_back(&c);
    // Intersect each pair of siblings, and sum up their shares of the parents.
    std::size_t parents = 0;
    double overlap = 0;
    for (const auto& p : cells) {
        const auto found = children.find(p.id);
        if (p.leaf || found == children.end() || volume(p.box) == 0) continue;
        ++parents;
        for (std::size_t i = 0; i < found->second.size(); ++i)
            for (std::size_t k = 0; k < i; ++k) {
                OutlineCell<D> both;
                both.box = intersection(found->second[i]->box, found->second[k]->box);
                if (volume(both.box) == 0) continue;
                overlap += volume(both.box) / volume(p.box);
                if (auto corners = section.part(both); !corners.empty())
                    flat.shared.push_back(std::move(corners));
            }
    }
    flat.overlap = parents > 0 ? overlap / static_cast<double>(parents) : 0;
}

}  // namespace hedgerow::cli
