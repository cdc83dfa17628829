/// Hausdorff distances of meshes and clouds, within bounds that are certain.
///
/// The directed distance from A to B is that of the point of A that is farthest from B. Any point of A gives
/// a lower bound. Upper bounds hold for whole triangles of A: the one with the greatest is divided, and
/// triangles are dropped whose bound cannot change the answer (Tang, Lee and Kim 2009; Kang et al. 2018;
/// Sacht and Jacobson 2024). Closest points come in batches (ask/points.h), so whatever answers these fast
/// makes this fast.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include <hedgerow/ask/points.h>
#include <hedgerow/queries/crossings.h>

namespace hedgerow {

/// When to stop: the interval may be as wide as the larger of `absolute`, a length, and `relative` times the
/// lower bound. It is never narrowed below the rounding of coordinates (see Hausdorff).
struct HausdorffOptions {
    double absolute = 0;
    double relative = 1e-3;
    /// Parts of triangles that may wait to be divided, beyond the triangles themselves; they take up to 160
    /// bytes each. If there would be more, the interval is returned as wide as it is then.
    std::size_t most_parts = std::size_t(1) << 22;
};

/// The distance lies in [lower, upper]. The witnesses are a point of one set that is at least `lower` away
/// from all of the other, and the other's point closest to it, with the positions of their primitives.
/// `point_a` is on A always; `from_b` says that it is the point on B that is far away.
///
/// Both bounds allow for all roundings: those of a distance, and those of points where a triangle was
/// divided, which are rounded to T as queries are. So the interval can be as wide as 2⁻¹⁹ of the distance
/// plus 2⁻²⁰ of the largest coordinate (in double 2⁻⁴⁵ and 2⁻⁴²), whatever tolerance is asked for.
template <std::floating_point T, int D>
struct Hausdorff {
    T lower = 0, upper = 0;
    PrimitiveId element_a = no_primitive, element_b = no_primitive;
    Vec<T, D> point_a = {}, point_b = {};
    bool from_b = false;

    /// False where there are no witnesses: a set is empty.
    explicit operator bool() const { return element_a != no_primitive; }
    friend bool operator==(const Hausdorff&, const Hausdorff&) = default;
};

/// Sets from which there is a directed distance to a set B: points to whatever has closest points, and
/// triangles to triangles and points.
template <class A, class B>
concept FarFrom = std::same_as<typename A::Scalar, typename B::Scalar> && A::dimension == B::dimension &&
                  ((PointSet<A> && HasClosestPoint<B>) ||
                   (TriangleSet<A> && (TriangleSet<B> || PointSet<B>)));

namespace detail {

/// What the distances of closest points err by: a part of the distance, and a length that stands for what
/// sums of coordinates up to `reach` and underflow cost. `rounding` is that of a point.
template <std::floating_point T>
struct DistanceError {
    static constexpr double relative = std::is_same_v<T, float> ? 0x1p-22 : 0x1p-48;
    double absolute, rounding;

    explicit DistanceError(double reach)
        : absolute(product(0x1p-45, reach) + (std::is_same_v<T, float> ? 0x1p-74 : 0x1p-536)),
          rounding(2 * static_cast<double>(unit_roundoff<T>) * reach) {}
    double below(double distance) const { return std::max(0.0, product(distance, 1 - relative) - absolute); }
    double above(double distance) const { return product(distance, 1 + relative) + absolute; }
    /// The width of the narrowest interval around a distance: where points need not be rounded, and where
    /// they are.
    double of(double distance) const { return 4 * (product(distance, relative) + absolute); }
    double of_rounded(double distance) const { return of(distance) + 4 * rounding; }
};

/// The corners of A's primitives: a mesh's vertices once each, though several triangles share them.
template <class A>
struct Corners {
    const A& set;

    static constexpr bool shared = requires(const A& a) {
        a.vertex(a.vertex_count());
        a.indices(a.size())[0];
    };
    static constexpr std::size_t per_element = PointSet<A> ? 1 : 3;
    std::size_t size() const {
        if constexpr (shared)
            return set.vertex_count();
        else
            return per_element * set.size();
    }
    /// The number of an element's corner k.
    std::size_t number(std::size_t element, std::size_t k) const {
        if constexpr (shared)
            return set.indices(element)[k];
        else
            return per_element * element + k;
    }
    Vec<typename A::Scalar, A::dimension> operator[](std::size_t i) const {
        if constexpr (shared)
            return set.vertex(i);
        else if constexpr (PointSet<A>)
            return set.point(i);
        else
            return corner(set.triangle(i / 3), static_cast<int>(i % 3));
    }
};

/// A triangle of A, or a part of one.
struct TrianglePart {
    Vec3d corner[3];
    double distance[3];      // at least those of the corners to B
    PrimitiveId nearest[3];  // the elements of B closest to the corners
    PrimitiveId others[2];   // and to points that were asked for before, the latest first
    PrimitiveId element;     // of A
    double bound;            // at least the distance of any point of the part to B
    double at;               // where to divide the edge from corner `edge` to the next, from 0 to 1
    std::uint8_t edge, age;  // how many cuts ago the longest edge was halved
    bool asked_middle;

    Vec3d centroid() const { return (corner[0] + corner[1] + corner[2]) / 3.0; }
    Vec3d cut() const { return corner[edge] + (corner[(edge + 1) % 3] - corner[edge]) * at; }
    void remember(PrimitiveId element_of_b) {
        if (std::find(others, std::end(others), element_of_b) != std::end(others)) return;
        std::copy_backward(others, std::end(others) - 1, std::end(others));
        others[0] = element_of_b;
    }
    void move_corner(int k, const Vec3d& to, double above, PrimitiveId element_of_b) {
        remember(nearest[k]);
        corner[k] = to, distance[k] = above, nearest[k] = element_of_b;
    }
};

/// A point of a triangle that is about the closest to p (Ericson 2005, 5.1.5). However its place in the
/// triangle is rounded, the distance to it is no less than that to the triangle, but for the rounding of
/// coordinates. `scale` is a power of two that brings coordinates to about 1.
inline Vec3d point_near(const Vec3d& p, const Triangle<double, 3>& t, double scale) {
    const Vec3d whole_ab = t.b - t.a, whole_ac = t.c - t.a;
    const Vec3d ab = whole_ab * scale, ac = whole_ac * scale;
    const double both = product(length2(ab), length2(ac)), turned = dot(ab, ac);
    if (!(both - product(turned, turned) > 0x1p-30 * both)) return closest_point(p, t).point;  // a sliver
    const Vec3d ap = (p - t.a) * scale, bp = (p - t.b) * scale, cp = (p - t.c) * scale;
    const double d1 = dot(ab, ap), d2 = dot(ac, ap);
    if (d1 <= 0 && d2 <= 0) return t.a;
    const double d3 = dot(ab, bp), d4 = dot(ac, bp);
    if (d3 >= 0 && d4 <= d3) return t.b;
    const double d5 = dot(ab, cp), d6 = dot(ac, cp);
    if (d6 >= 0 && d5 <= d6) return t.c;
    const auto on_edge = [](const Vec3d& from, const Vec3d& along, double part, double rest) {
        return from + along * (part / (part + rest));
    };
    const double vc = product(d1, d4) - product(d3, d2);
    if (vc <= 0 && d1 >= 0 && d3 <= 0) return on_edge(t.a, whole_ab, d1, -d3);
    const double vb = product(d5, d2) - product(d1, d6);
    if (vb <= 0 && d2 >= 0 && d6 <= 0) return on_edge(t.a, whole_ac, d2, -d6);
    const double va = product(d3, d6) - product(d5, d4);
    if (va <= 0 && d4 >= d3 && d5 >= d6) return on_edge(t.b, t.c - t.b, d4 - d3, d5 - d6);
    const double sum = va + vb + vc, v = std::min(1.0, std::max(0.0, vb / sum));
    return t.a + whole_ab * v + whole_ac * std::min(1 - v, std::max(0.0, vc / sum));
}

/// The directed distance from index A to index B, if it is above `at_least`.
template <class IA, class IB>
class DirectedHausdorff {
public:
    using A = typename IA::Primitives;
    using B = typename IB::Primitives;
    using T = typename A::Scalar;
    static constexpr int dimension = A::dimension;
    using Point = Vec<T, dimension>;
    using Result = Hausdorff<T, dimension>;

    DirectedHausdorff(const IA& a, const IB& b, const HausdorffOptions& options, Executor& executor,
                      double at_least)
        : a_(a),
          b_(b),
          options_(options),
          threads_(executor),
          scale_(scale_to_one(std::max(reach(a.bounds()), reach(b.bounds())))),
          error_(std::max(reach(a.bounds()), reach(b.bounds()))),
          lower_(at_least) {}

    Result run() {
        ask_corners();
        if constexpr (TriangleSet<A>) {
            settle();
            make_parts();
            const std::size_t most = parts_.size() + options_.most_parts;
            while (settle(), !parts_.empty() && parts_.size() <= most) refine();
            for (const auto& part : parts_) upper_ = std::max(upper_, part.bound);
        }
        best_.lower = rounded_down<T>(lower_);
        best_.upper = rounded_up<T>(std::max(lower_, upper_));
        return best_;
    }

private:
    using Parts = std::vector<TrianglePart>;
    static constexpr std::size_t batch = 1 << 16;  // of corners
    static constexpr std::size_t row = 8;          // of corners
    static constexpr int most_near = 3 + std::extent_v<decltype(TrianglePart::others)>;
    static constexpr int most_cuts = 6;
    static constexpr std::size_t parts_a_round = 4096;  // the more, the fuller batches; the fewer, the fewer

    static double reach(const Box<T, dimension>& box) {
        return static_cast<double>(std::max(T(0), max_component(max(abs(box.low), abs(box.high)))));
    }
    bool holds(PrimitiveId element) const {
        if constexpr (requires { a_.structure().holds(element); }) return a_.structure().holds(element);
        return true;
    }
    double distance(const Near<T, dimension>& near) const {
        return std::sqrt(static_cast<double>(near.distance2));
    }
    /// How far a point of A is from B at least, if the query was rounded to a point that is `away`.
    void see(const Point& query, double away, PrimitiveId element, const Near<T, dimension>& near) {
        const double far = error_.below(distance(near)) - away;
        if (!(far > lower_ || (far == lower_ && !best_))) return;
        lower_ = far;
        best_.element_a = element, best_.point_a = query;
        best_.element_b = near.element, best_.point_b = near.point;
    }
    void ask(const std::vector<Point>& points) {
        near_.resize(points.size());
        closest_points(b_, Strided<Point>(points), std::span(near_), threads_);
    }

    /// Asks for the corners of A: first for the first of each row, since corners that follow each other are
    /// mostly near, then for those that may be farther from B than the farthest so far.
    void ask_corners() {
        const Corners<A> corners{a_.primitives()};
        std::vector<PrimitiveId> element(corners.size(), no_primitive);
        for (std::size_t i = 0; i < a_.size(); ++i)
            if (const auto id = static_cast<PrimitiveId>(i); holds(id))
                for (std::size_t k = 0; k < corners.per_element; ++k)
                    if (PrimitiveId& of = element[corners.number(i, k)]; of == no_primitive) of = id;
        corners_.resize(corners.size());
        std::vector<std::size_t> asked;
        std::vector<Point> points;
        const auto ask_all = [&] {
            ask(points);
            for (std::size_t j = 0; j < points.size(); ++j) {
                see(points[j], 0, element[asked[j]], near_[j]);
                corners_[asked[j]] = {error_.above(distance(near_[j])), near_[j].element};
            }
            asked.clear(), points.clear();
        };
        const auto add = [&](std::size_t i) {
            asked.push_back(i), points.push_back(corners[i]);
            if (points.size() == batch) ask_all();
        };
        for (std::size_t i = 0; i < corners.size(); i += row)
            if (element[i] != no_primitive) add(i);
        ask_all();
        for (std::size_t i = 0; i < corners.size(); ++i) {
            if (element[i] == no_primitive || i % row == 0) continue;
            const std::size_t first = i - i % row;
            if (element[first] != no_primitive) {
                const double gap =
                    length(Vec<double, dimension>(corners[i]) - Vec<double, dimension>(corners[first]));
                corners_[i] = {corners_[first].distance + gap, corners_[first].nearest};
                // Leave room for the triangles around the corner.
                if (corners_[i].distance + (PointSet<A> ? 0 : gap) <= lower_) continue;
            }
            add(i);
        }
        ask_all();
        if constexpr (PointSet<A>)
            for (std::size_t i = 0; i < corners.size(); ++i)
                if (element[i] != no_primitive) upper_ = std::max(upper_, corners_[i].distance);
    }

    /// Makes a part of each triangle whose bound is above the lower bound.
    void make_parts() {
        const Corners<A> corners{a_.primitives()};
        constexpr std::size_t block = 4096;
        std::vector<Parts> lists((a_.size() + block - 1) / block);
        std::vector<double> greatest(lists.size(), 0);  // of the bounds of triangles that are dropped
        threads_.for_each_piece(lists.size(), 1, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin * block; i < std::min(a_.size(), end * block); ++i) {
                const auto id = static_cast<PrimitiveId>(i);
                if (!holds(id)) continue;
                TrianglePart part;
                part.element = id;
                std::fill(part.others, std::end(part.others), no_primitive);
                part.asked_middle = false;
                part.age = 0;
                part.bound = std::numeric_limits<double>::infinity();
                for (std::size_t k = 0; k < 3; ++k) {
                    const auto& c = corners_[corners.number(i, k)];
                    part.corner[k] = Vec3d(corners[corners.number(i, k)]);
                    part.distance[k] = c.distance, part.nearest[k] = c.nearest;
                }
                bound(part);
                if (part.bound > enough_)
                    lists[i / block].push_back(part);
                else
                    greatest[i / block] = std::max(greatest[i / block], part.bound);
            }
        });
        for (const auto& list : lists) parts_.insert(parts_.end(), list.begin(), list.end());
        for (const double bound : greatest) upper_ = std::max(upper_, bound);
        corners_ = {};
    }

    /// Drops the parts that are within the tolerance.
    void settle() {
        wanted_ =
            lower_ + std::max({options_.absolute, product(options_.relative, lower_), error_.of(lower_)});
        enough_ = std::max(wanted_, lower_ + error_.of_rounded(lower_));
        std::erase_if(parts_, [&](const TrianglePart& part) {
            if (part.bound > enough_) return false;
            upper_ = std::max(upper_, part.bound);
            return true;
        });
    }

    /// Takes the parts of the greatest bounds. Asks for the closest point of the centroid, or, where that is
    /// known, divides the part in two.
    void refine() {
        const std::size_t count = std::min(parts_a_round, parts_.size()), first = parts_.size() - count;
        std::nth_element(parts_.begin(), parts_.begin() + static_cast<std::ptrdiff_t>(first), parts_.end(),
                         [](const TrianglePart& s, const TrianglePart& t) { return s.bound < t.bound; });

        // Ask for a point of each.
        std::vector<Vec3d> exact;
        std::vector<Point> points;
        for (std::size_t i = first; i < parts_.size(); ++i) {
            exact.push_back(parts_[i].asked_middle ? parts_[i].cut() : parts_[i].centroid());
            points.emplace_back(exact.back());
        }
        ask(points);
        for (std::size_t i = 0; i < count; ++i)
            see(points[i], length(exact[i] - Vec3d(points[i])), parts_[first + i].element, near_[i]);

        // Make two of each part that is divided.
        for (std::size_t i = 0; i < count; ++i) {
            TrianglePart& part = parts_[first + i];
            // The element that is closest to the rounded point may be closer to the point itself.
            const double above =
                std::min(error_.above(distance(near_[i])) + length(exact[i] - Vec3d(points[i])),
                         distance_to(shape(near_[i].element), exact[i]));
            if (std::exchange(part.asked_middle, !part.asked_middle)) {
                part.age = part.age == 2 ? 0 : part.age + 1;
                TrianglePart other = part;
                part.move_corner(part.edge, exact[i], above, near_[i].element);
                other.move_corner((part.edge + 1) % 3, exact[i], above, near_[i].element);
                parts_.push_back(other);
            } else {
                part.remember(near_[i].element);
                double farthest = 0;
                for (const auto& c : part.corner) farthest = std::max(farthest, length(c - exact[i]));
                part.bound = std::min(part.bound, above + farthest);
            }
        }
        threads_.for_each_piece(parts_.size() - first, 256, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) bound(parts_[first + i]);
        });
    }

    /// An element of B, and how far a point is from it at most.
    using Shape = std::conditional_t<TriangleSet<B>, Triangle<double, 3>, Vec3d>;
    Shape shape(PrimitiveId element) const {
        if constexpr (TriangleSet<B>) {
            const auto t = b_.primitives().triangle(element);
            return Triangle<double, 3>{Vec3d(t.a), Vec3d(t.b), Vec3d(t.c)};
        } else {
            return Vec3d(b_.primitives().point(element));
        }
    }
    double distance_to(const Triangle<double, 3>& t, const Vec3d& p) const {
        return error_.above(length(p - point_near(p, t, scale_)));
    }
    double distance_to(const Vec3d& q, const Vec3d& p) const { return error_.above(length(p - q)); }

    /// Lowers the bound of a part, until it is low enough or nothing is left to try.
    void bound(TrianglePart& part) const {
        const auto& c = part.corner;
        const auto& d = part.distance;
        // No point of the part is farther from a corner than the corner's longer edge, nor from the nearest
        // corner than the part's circumradius, or half the longest edge of an obtuse part.
        const double edge2[3] = {length2(c[1] - c[0]), length2(c[2] - c[1]), length2(c[0] - c[2])};
        const int longest = static_cast<int>(std::max_element(edge2, edge2 + 3) - edge2);
        const double x2 = edge2[(longest + 1) % 3], y2 = edge2[(longest + 2) % 3], z2 = edge2[longest];
        const double turned = x2 + y2 - z2 + product(z2, 0x1p-48);  // |x|·|y|·cos, doubled and rounded up
        const double sine = product(x2, y2) - product(turned, turned) / 4;  // (|x|·|y|·sin)²
        double radius2 = z2 / 4;
        if (turned > 0)
            radius2 = sine > 0x1p-900 ? std::min(z2 / 3, product(radius2, product(x2, y2) / sine)) : z2 / 3;
        double least = std::max({d[0], d[1], d[2]}) + std::sqrt(radius2);
        for (int k = 0; k < 3; ++k)
            least = std::min(least, d[k] + std::sqrt(std::max(edge2[k], edge2[(k + 2) % 3])));
        part.bound = std::min(part.bound, product(least, 1 + 0x1p-40));
        part.edge = static_cast<std::uint8_t>(longest);
        part.at = 0.5;
        if (part.bound <= wanted_) return;

        // Compare with the elements of B that are near.
        NearShapes near;
        Apart3 apart;
        PrimitiveId tried[most_near];
        const auto add = [&](PrimitiveId element) {
            if (element == no_primitive || std::count(tried, tried + near.count, element) != 0) return;
            near.shape[near.count] = shape(element);
            for (int k = 0; k < 3; ++k)
                apart.to[near.count][k] =
                    element == part.nearest[k] ? d[k] : distance_to(near.shape[near.count], c[k]);
            tried[near.count++] = element;
        };
        for (const PrimitiveId element : part.nearest) add(element);
        for (const PrimitiveId element : part.others) add(element);
        for (int k = 0; k < 3; ++k) apart.corner[k] = c[k];
        part.bound = std::min(part.bound, bound_by(near, apart, most_cuts));
        if (part.bound <= wanted_ || part.age == 2) return;
        if (const Cut cut = cut_between(near, apart)) part.edge = cut.edge, part.at = cut.at;
    }

    /// Elements of B, and how far the corners of a part are from them at most.
    struct NearShapes {
        Shape shape[most_near];
        int count = 0;
    };
    struct Apart3 {
        Vec3d corner[3];
        double to[most_near][3];
    };
    struct Cut {
        std::uint8_t edge = 3;
        double at = 0.5;
        explicit operator bool() const { return edge < 3; }
    };
    /// Where to cut an edge whose ends are nearest to two elements: at a point that is about as near to both.
    /// After two cuts, such elements have the parts to themselves if they are in one plane. The edge whose
    /// ends are clearest.
    Cut cut_between(const NearShapes& near, const Apart3& apart) const {
        int nearest[3] = {};
        for (int k = 0; k < 3; ++k)
            for (int i = 1; i < near.count; ++i)
                if (apart.to[i][k] < apart.to[nearest[k]][k]) nearest[k] = i;
        Cut cut;
        double clearest = 0;
        for (int k = 0; k < 3; ++k) {
            const int next = (k + 1) % 3, i = nearest[k], j = nearest[next];
            const double noise = error_.of(apart.to[i][k] + apart.to[j][next]) / 4;
            const double here = apart.to[j][k] - apart.to[i][k],
                         there = apart.to[i][next] - apart.to[j][next];
            if (std::min(here, there) <= std::max(noise, clearest)) continue;
            clearest = std::min(here, there);
            cut.edge = static_cast<std::uint8_t>(k);
        }
        if (!cut) return cut;

        const double slack = (wanted_ - lower_) / 4;
        // Find the place on the edge by false position (the Illinois rule), as well as the tolerance asks
        // for.
        const int from = cut.edge, to = (from + 1) % 3, i = nearest[from], j = nearest[to];
        double low = 0, high = 1, here = measure(apart.to[j][from]) - measure(apart.to[i][from]);
        double there = measure(apart.to[i][to]) - measure(apart.to[j][to]);
        for (int tries = 0, side = 0; tries < 5; ++tries) {
            cut.at = low + product(high - low, here / (here + there));
            const Vec3d p = point_on(apart, cut);
            const double of_i = distance_to(near.shape[i], p), of_j = distance_to(near.shape[j], p);
            if (std::abs(of_j - of_i) <= slack || std::min(of_i, of_j) > wanted_ + slack) break;
            const double ahead = measure(of_j) - measure(of_i);
            if (ahead > 0) {
                low = cut.at, here = ahead;
                if (side == 1) there /= 2;
                side = 1;
            } else {
                high = cut.at, there = -ahead;
                if (side == -1) here /= 2;
                side = -1;
            }
        }
        return cut;
    }
    static Vec3d point_on(const Apart3& apart, const Cut& cut) {
        return apart.corner[cut.edge] + (apart.corner[(cut.edge + 1) % 3] - apart.corner[cut.edge]) * cut.at;
    }
    /// What is straight along an edge: the squared distances of points, and the distances of triangles where
    /// these are in one plane.
    static double measure(double distance) { return PointSet<B> ? product(distance, distance) : distance; }
    /// A bound by elements of B alone: of one, which is convex, a corner of the part is the farthest. Where
    /// none is near all corners, the part is cut, up to `cuts` times.
    double bound_by(const NearShapes& near, const Apart3& apart, int cuts) const {
        double least = std::numeric_limits<double>::infinity();
        for (int i = 0; i < near.count; ++i)
            least = std::min(least, std::max({apart.to[i][0], apart.to[i][1], apart.to[i][2]}));
        if (least <= wanted_ || cuts == 0) return least;
        const Cut cut = cut_between(near, apart);
        if (!cut) return least;
        const int from = cut.edge, to = (from + 1) % 3;
        Apart3 first = apart, second = apart;
        const Vec3d p = point_on(apart, cut);
        first.corner[from] = second.corner[to] = p;
        double nearest = std::numeric_limits<double>::infinity();
        for (int i = 0; i < near.count; ++i) {
            first.to[i][from] = second.to[i][to] = distance_to(near.shape[i], p);
            nearest = std::min(nearest, first.to[i][from]);
        }
        if (nearest > wanted_) return least;
        const double of_first = bound_by(near, first, cuts - 1);
        if (of_first > wanted_) return least;
        return std::min(least, std::max(of_first, bound_by(near, second, cuts - 1)));
    }

    struct Corner {
        double distance;
        PrimitiveId nearest;
    };
    const IA& a_;
    const IB& b_;
    const HausdorffOptions& options_;
    IeeeExecutor threads_;
    double scale_;
    DistanceError<T> error_;
    double lower_, wanted_ = 0, enough_ = 0, upper_ = 0;
    Result best_;
    std::vector<Corner> corners_;
    Parts parts_;
    std::vector<Near<T, dimension>> near_;
};

inline void expect_tolerances(const HausdorffOptions& options) {
    if (!(options.absolute >= 0) || !(options.relative >= 0))
        throw UsageError("the tolerances of a Hausdorff distance are not negative");
}
template <class IA, class IB>
auto directed_hausdorff(const IA& a, const IB& b, const HausdorffOptions& options, Executor& executor,
                        double at_least) {
    using Result = typename DirectedHausdorff<IA, IB>::Result;
    constexpr auto infinity = std::numeric_limits<typename IA::Scalar>::infinity();
    if (a.bounds().empty()) return Result{};
    if (b.bounds().empty()) return Result{.lower = infinity, .upper = infinity};
    return in_ieee_mode([&] { return DirectedHausdorff<IA, IB>(a, b, options, executor, at_least).run(); });
}

}  // namespace detail

/// The directed (one-sided) Hausdorff distance from A to B: how far the points of A are from B at most, not
/// only its corners. Triangles to triangles or points, in space; points to whatever has closest points.
///
/// A may be any index, since only its primitives are read: `build<BruteForce>(mesh)` costs least. The
/// distance from an empty set is 0, and that from any other to an empty set is infinite. Throws UsageError
/// for tolerances that are negative or NaN.
///
/// Costs a closest point for each vertex of A, and for some of its triangles a dozen or more, by how alike
/// the sets are and how narrow the tolerance is. Takes 24 bytes for each vertex, and up to 160 for each
/// triangle that may be the farthest. Large sets are asked on all cores, unless an executor is given
/// (Threads); the result is the same.
template <class SA, class A, class SB, class B>
requires FarFrom<A, B> Hausdorff<typename A::Scalar, A::dimension> directed_hausdorff_distance(
    const Index<SA, A>& a, const Index<SB, B>& b, const HausdorffOptions& options = {},
    Threads threads = {}) {
    detail::expect_tolerances(options);
    return detail::directed_hausdorff(a, b, options, threads.over(a.size()), 0);
}

/// The (symmetric) Hausdorff distance: the greater of the directed ones. It is 0 for two empty sets, and
/// infinite if one is empty.
template <class SA, class A, class SB, class B>
requires(FarFrom<A, B>&& FarFrom<B, A>) Hausdorff<typename A::Scalar, A::dimension> hausdorff_distance(
    const Index<SA, A>& a, const Index<SB, B>& b, const HausdorffOptions& options = {},
    Threads threads = {}) {
    detail::expect_tolerances(options);
    Executor& executor = threads.over(std::max(a.size(), b.size()));
    auto result = detail::directed_hausdorff(a, b, options, executor, 0);
    // What is no farther than the distance found is of no interest in the other direction.
    const auto back = detail::directed_hausdorff(b, a, options, executor, static_cast<double>(result.lower));
    if (back && back.lower > result.lower) {
        const auto upper = std::max(result.upper, back.upper);
        result = {back.lower, upper, back.element_b, back.element_a, back.point_b, back.point_a, true};
    }
    result.upper = std::max(result.upper, back.upper);
    result.lower = std::max(result.lower, back.lower);
    return result;
}

}  // namespace hedgerow
