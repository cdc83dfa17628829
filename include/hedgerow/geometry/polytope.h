/// Convex polytopes: cells bounded by planes.
#pragma once

#include <algorithm>
#include <array>
#include <optional>
#include <vector>

#include <hedgerow/geometry/shapes.h>

namespace hedgerow {

/// A bounded convex polytope, stored as its faces. A face is the corners of a convex polygon, or in the plane
/// the two ends of an edge. Computed in double; a part that a cut leaves thinner than rounding may be lost,
/// so measures are estimates, and are used as such only.
template <int D>
class Polytope {
public:
    using Point = Vec<double, D>;
    using Face = std::vector<Point>;

    Polytope() = default;
    explicit Polytope(const Box<double, D>& box) {
        for (int axis = 0; axis < D; ++axis)
            for (const double side : {box.low[axis], box.high[axis]})
                faces_.push_back(face_of(box, axis, side));
    }

    bool empty() const { return faces_.empty(); }
    const std::vector<Face>& faces() const { return faces_; }
    Box<double, D> bounds() const {
        Box<double, D> box;
        for (const Face& f : faces_)
            for (const Point& p : f) box.expand(p);
        return box;
    }
    /// The surface area, or in the plane the perimeter.
    double surface() const {
        double sum = 0;
        for (const Face& f : faces_) sum += measure(f);
        return sum;
    }
    /// The volume, or in the plane the area: the sum of the pyramids over the faces, with one corner as apex.
    double volume() const {
        if (empty()) return 0;
        const Point apex = faces_[0][0];
        double sum = 0;
        for (const Face& f : faces_)
            for (std::size_t i = D - 1; i < f.size(); ++i) {
                if constexpr (D == 2)
                    sum += std::abs(dot(f[i] - apex, crosswise(f[i - 1] - apex))) / 2;
                else
                    sum += std::abs(dot(f[0] - apex, cross(f[i - 1] - apex, f[i] - apex))) / 6;
            }
        return sum;
    }
    /// The corners in counterclockwise order.
    Face corners() const requires(D == 2) {
        Face all;
        for (const Face& f : faces_) all.insert(all.end(), f.begin(), f.end());
        go_round(all, 0, 1);
        return all;
    }
    /// The section of the polytope by a plane: the corners of a convex polygon, or in the plane the ends of a
    /// segment. Fewer than D corners mean that the section is empty.
    Face section(const CutPlane<D>& plane) const {
        Face low, high, cap;
        for (const Face& f : faces_) clip(f, plane, low, high, cap);
        close(cap, plane.normal);
        return cap;
    }

    /// Cuts the polytope into its parts on the low and the high side of a plane. If the plane is along a
    /// face, up to roundings, one part is that face, seen from both sides, and the other is the whole
    /// polytope. If the plane misses the polytope, one part has no faces.
    std::pair<Polytope, Polytope> cut(const CutPlane<D>& plane) const {
        const auto [lowest, highest, rounding] = reach_over(plane);
        // The plane touches or misses the polytope.
        if (highest <= rounding) return {*this, touched(plane, rounding)};
        if (lowest >= -rounding) return {touched(plane, rounding), *this};
        // Split every face, and close both parts with the section.
        std::pair<Polytope, Polytope> sides;
        Face cap;
        for (const Face& f : faces_) {
            Face low, high;
            clip(f, plane, low, high, cap);
            if (low.size() >= D) sides.first.faces_.push_back(std::move(low));
            if (high.size() >= D) sides.second.faces_.push_back(std::move(high));
        }
        close(cap, plane.normal);
        for (Polytope* side : {&sides.first, &sides.second})
            if (!side->faces_.empty() && cap.size() >= D) side->faces_.push_back(cap);
        return sides;
    }

    /// The least and the greatest height of the polytope over a plane.
    std::pair<double, double> heights(const CutPlane<D>& plane) const {
        double lowest = std::numeric_limits<double>::infinity(), highest = -lowest;
        for (const Face& f : faces_)
            for (const Point& p : f) {
                const double h = plane.height(p);
                lowest = std::min(lowest, h), highest = std::max(highest, h);
            }
        return {lowest, highest};
    }
    /// The surfaces of the parts that `cut` would make, up to roundings, where `whole` is that of the
    /// polytope. Allocates nothing where the plane cuts the polytope.
    std::pair<double, double> surfaces(const CutPlane<D>& plane, double whole) const {
        const auto [lowest, highest, rounding] = reach_over(plane);
        if (highest <= rounding || lowest >= -rounding) {
            const auto sides = cut(plane);
            return {sides.first.surface(), sides.second.surface()};
        }
        double low = 0, cap = 0;
        std::optional<Point> apex;  // a corner of the section, which is a fan of triangles around it
        for (const Face& f : faces_) {
            // Walk around the face's part on the low side, and find where the plane meets the face.
            Point first, last, sum, ends[2];
            int corners = 0, crossings = 0;
            bool below = false;
            const auto add = [&](const Point& p) {
                if (corners == 0) first = p;
                if constexpr (D == 3)
                    if (corners > 1) sum = sum + cross(last - first, p - first);
                last = p, ++corners;
            };
            const auto meet = [&](const Point& p) { ends[std::min(crossings++, 1)] = p; };
            const std::size_t n = f.size();
            double a = plane.height(f[0]);
            for (std::size_t i = 0; i < n; ++i) {
                below = below || a < 0;
                if (a <= 0) add(f[i]);
                if (a == 0) meet(f[i]);
                if (D == 2 && i + 1 == n) break;  // an edge has no side back to its first end
                const Point& q = f[i + 1 < n ? i + 1 : 0];
                const double b = plane.height(q);
                if ((a < 0 && b > 0) || (a > 0 && b < 0)) {
                    const Point crossing = f[i] + (q - f[i]) * (a / (a - b));
                    add(crossing), meet(crossing);
                }
                a = b;
            }
            // A face that only touches the plane has no part below it.
            if (!below) continue;
            low += D == 2 ? length(last - first) : length(sum) / 2;
            if (crossings == 0) continue;
            if (!apex) apex = ends[0];
            if constexpr (D == 2)
                cap = std::max(cap, length(ends[0] - *apex));
            else if (crossings > 1)
                cap += length(cross(ends[0] - *apex, ends[1] - *apex)) / 2;
        }
        return {low + cap, whole - low + cap};
    }

private:
    /// The range of the corners' heights over a plane, 0 included, and what the heights may err by.
    std::array<double, 3> reach_over(const CutPlane<D>& plane) const {
        double lowest = 0, highest = 0, largest = 0;
        for (const Face& f : faces_)
            for (const Point& p : f) {
                const double h = plane.height(p);
                lowest = std::min(lowest, h), highest = std::max(highest, h);
                largest = std::max(largest, max_component(abs(p)));
            }
        return {lowest, highest, 0x1p-40 * product(plane.reach(), largest)};
    }
    /// The face along a plane, for a polytope on one side of it: the corners within `height` of the plane,
    /// seen from both sides. No faces if there are fewer than D corners.
    Polytope touched(const CutPlane<D>& plane, double height) const {
        Face cap;
        for (const Face& f : faces_)
            for (const Point& p : f)
                if (std::abs(plane.height(p)) <= height) cap.push_back(p);
        close(cap, plane.normal);
        Polytope flat;
        if (cap.size() >= D) flat.faces_ = {cap, cap};
        return flat;
    }
    static Face face_of(const Box<double, D>& box, int axis, double side) {
        Face face;
        constexpr int around[4] = {0, 1, 3, 2};
        for (int i = 0; i < (D == 2 ? 2 : 4); ++i) {
            Point p;
            p[axis] = side;
            for (int k = 1; k < D; ++k) {
                const int other = (axis + k) % D;
                p[other] = around[i] >> (k - 1) & 1 ? box.high[other] : box.low[other];
            }
            face.push_back(p);
        }
        return face;
    }
    static double measure(const Face& f) {
        if constexpr (D == 2) {
            return length(f[1] - f[0]);
        } else {
            Point sum;
            for (std::size_t i = 2; i < f.size(); ++i) sum = sum + cross(f[i - 1] - f[0], f[i] - f[0]);
            return length(sum) / 2;
        }
    }
    /// Splits a face at a plane. Corners on the plane go to both parts, and to the cap.
    static void clip(const Face& f, const CutPlane<D>& plane, Face& low, Face& high, Face& cap) {
        const std::size_t n = f.size();
        for (std::size_t i = 0; i < n; ++i) {
            const double a = plane.height(f[i]);
            if (a <= 0) low.push_back(f[i]);
            if (a >= 0) high.push_back(f[i]);
            if (a == 0) cap.push_back(f[i]);
            if (D == 2 && i + 1 == n) break;  // an edge has no side back to its first end
            const Point& q = f[(i + 1) % n];
            const double b = plane.height(q);
            if (!((a < 0 && b > 0) || (a > 0 && b < 0))) continue;
            // Computed from the low end, so that both faces of an edge find the same point.
            const Point crossing = a < 0 ? f[i] + (q - f[i]) * (a / (a - b)) : q + (f[i] - q) * (b / (b - a));
            for (Face* part : {&low, &high, &cap}) part->push_back(crossing);
        }
    }
    /// Sorts the corners of the cap around it, or in the plane keeps its two ends. A corner may come several
    /// times, once from each face that has it, and is kept once: otherwise cuts through one corner would
    /// double it again and again.
    static void close(Face& cap, const Point& normal) {
        if (cap.size() < D) return;
        if constexpr (D == 2) {
            const Point along = crosswise(normal);
            const auto [first, last] = std::minmax_element(
                cap.begin(), cap.end(),
                [&](const Point& p, const Point& q) { return dot(p, along) < dot(q, along); });
            cap = {*first, *last};
        } else {
            const int axis = max_axis(normal);
            go_round(cap, (axis + 1) % 3, (axis + 2) % 3);
        }
    }
    /// Sorts a convex polygon's corners counterclockwise around their middle, in the plane of axes x and y,
    /// and drops those that are repeated. Compares half planes and cross products, so no angle is computed.
    static void go_round(Face& corners, int x, int y) {
        Point center;
        for (const Point& p : corners) center = center + p / double(corners.size());
        const auto upper = [&](const Point& d) { return d[y] > 0 || (d[y] == 0 && d[x] > 0); };
        std::sort(corners.begin(), corners.end(), [&](const Point& p, const Point& q) {
            const Point a = p - center, b = q - center;
            if (upper(a) != upper(b)) return upper(a);
            return product(a[x], b[y]) - product(a[y], b[x]) > 0;
        });
        corners.erase(std::unique(corners.begin(), corners.end()), corners.end());
    }
    static Point crosswise(const Point& d) requires(D == 2) { return {-d[1], d[0]}; }

    std::vector<Face> faces_;
};

}  // namespace hedgerow
