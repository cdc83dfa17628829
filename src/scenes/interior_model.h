/// Shapes that rooms and furniture are made of.
#pragma once

#include <cstdint>
#include <initializer_list>
#include <vector>

#include <hedgerow/primitives/triangle_mesh.h>

namespace hedgerow::detail {

/// Where a thing stands: its origin, and the direction of its x axis in the plan (length 1). z stays up.
struct Pose {
    Vec3d at;
    Vec2d along{1, 0};

    Vec3d operator()(const Vec3d& p) const {
        return at + Vec3d(product(along[0], p[0]) - product(along[1], p[1]),
                          product(along[1], p[0]) + product(along[0], p[1]), p[2]);
    }
    /// A pose relative to this one: moved by p, then turned.
    Pose operator()(const Vec3d& p, const Vec2d& turn) const {
        const Vec3d a = Pose{{}, along}({turn[0], turn[1], 0});
        return {(*this)(p), {a[0], a[1]}};
    }
};
/// Directions in the plan.
inline constexpr Vec2d east(1, 0), north(0, 1), west(-1, 0), south(0, -1);

enum class Axis { x, y, z };

/// A polyline in the plane across an axis; counterclockwise if closed. Across x it is in (y, z), across y in
/// (z, x), across z in (x, y).
struct Outline {
    std::vector<Vec2d> points;
    bool closed = true;
};
/// A rectangle around 0 with half extents a and b.
inline Outline rectangle(double a, double b) {
    return {{{a, b}, {-a, b}, {-a, -b}, {a, -b}}};
}
/// Pairs of a scale of the outline and a place along the axis. At scale 0 the outline is a point.
using Section = std::vector<Vec2d>;

/// A hole in a wall: from low to high, along the wall and upward.
struct Opening {
    Vec2d low, high;
};

/// A mesh to which things are added. A higher level divides curved things more finely.
class Model {
public:
    explicit Model(std::uint64_t level);

    TriangleMesh<double> mesh;

    /// A circle, of 8 points at level 0.
    Outline disc(double radius) const;
    /// A rectangle of half extents a and b with round corners.
    Outline rounded(double a, double b, double radius) const;
    /// The uniform quadratic B-spline from the first to the last of the controls. A control given twice is a
    /// corner.
    std::vector<Vec2d> curve(const std::vector<Vec2d>& controls) const;

    /// Twelve triangles.
    void box(const Pose& pose, const Vec3d& low, const Vec3d& high);
    /// A box whose base has its middle at `foot`.
    void block(const Pose& pose, const Vec3d& foot, const Vec3d& size);
    /// Moves the outline along the axis through `base`, scaled as the section says. If the section runs up
    /// the axis, the outside is to the right of the outline, seen from the tip of the axis.
    void loft(const Pose& pose, const Vec3d& base, Axis axis, const Outline& outline, const Section& section);
    /// A straight bar of `length` along an axis, from `base` on, with closed ends.
    void bar(const Pose& pose, const Vec3d& base, Axis axis, const Outline& outline, double length);
    /// A sheet along a curve in (x, z), `width` wide at its foot and pointed at its end.
    void leaf(const Pose& pose, const std::vector<Vec2d>& curve, double width);
    /// A wall along x from the pose's origin, with half its thickness on either side, and without top and
    /// foot. Openings are in order along the wall, with some wall between them. `with_ends` closes the wall's
    /// ends.
    void wall(const Pose& pose, double length, double height, double thickness,
              const std::vector<Opening>& openings, bool with_ends);

private:
    std::uint32_t vertex(const Pose& pose, const Vec3d& p);
    void quad(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d);

    std::uint64_t pieces_;
    std::vector<Vec2d> circle_;
};

}  // namespace hedgerow::detail
