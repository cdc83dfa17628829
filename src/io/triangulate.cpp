/// Ear clipping with exact signs.
#include "triangulate.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <queue>
#include <tuple>
#include <vector>

#include <hedgerow/geometry/overlap.h>

#include "corner_tree.h"
#include "memory.h"

namespace hedgerow::detail {

namespace {

/// 1 if a, b, c turn to the left, −1 to the right, 0 on one line. Exact.
int turn(const Point& a, const Point& b, const Point& c) {
    return Edge<2>(a, b).turn(c, 0, 1);
}

/// Whether p comes before q: in x, or in y if x is the same.
bool before(const Point& p, const Point& q) {
    return p[0] < q[0] || (p[0] == q[0] && p[1] < q[1]);
}

/// A first-in-first-out list of corners.
class Queue {
public:
    void push(Corner i) { corners_.push_back(i); }
    bool empty() const { return first_ == corners_.size(); }
    Corner pop() { return corners_[first_++]; }

private:
    std::vector<Corner> corners_;
    std::size_t first_ = 0;
};

/// Divides a counterclockwise polygon into triangles by cutting its ears.
class EarClipper {
public:
    /// About the most bytes that a corner takes: links, the tree, and candidates and queues that grow.
    static constexpr std::uint64_t bytes_a_corner = 192;

    /// Checks now and then whether the reading of `file` was cancelled.
    EarClipper(const ByteSource& file, const std::vector<Point>& points)
        : file_(file),
          points_(points),
          size_(points.size()),
          next_(size_),
          previous_(size_),
          kind_(size_, Kind::outward),
          tree_(points) {
        for (std::size_t i = 0; i < size_; ++i) {
            next_[i] = static_cast<Corner>((i + 1) % size_);
            previous_[i] = static_cast<Corner>((i + size_ - 1) % size_);
        }
    }

    /// Calls triangle(a, b, c) points.size() − 2 times.
    template <class F>
    void run(F triangle) {
        // Put the corners that do not turn inwards into the tree, and sort all corners into queues.
        for (Corner i = 0; i < size_; ++i) tree_.set(i, turn_at(i) <= 0);
        for (Corner i = 0; i < size_; ++i) sort(i);
        // Cut one corner after the other.
        std::size_t left = size_;
        Corner last = 0;
        for (; left > 3; --left) {
            look();
            const auto i = choose();
            if (!i) break;
            triangle(previous_[*i], *i, next_[*i]);
            last = next_[*i];
            cut(*i);
        }
        // Three corners that are left are a triangle. More are left if none turns inwards: they become a fan.
        for (Corner i = next_[last]; next_[i] != last; i = next_[i]) triangle(last, i, next_[i]);
    }

private:
    /// A corner on the line between its neighbours is flat; one where the boundary turns back, or does not
    /// move, is a spike.
    enum class Kind : std::uint8_t { inward, blocked, flat, spike, outward, gone };
    /// The sides of a corner's triangle. They begin at the corner before it, at itself, and at the corner
    /// after it.
    using Sides = std::array<Edge<2>, 3>;
    /// A corner that turns inwards, with its neighbours at that time. Cutting it leaves an edge between them.
    /// The candidate with the shortest such edge comes first, and is tested for an ear only then: slivers
    /// that reach across the polygon would be tested against much of its boundary.
    struct Candidate {
        double length2;
        Corner corner, previous, next;
        bool operator<(const Candidate& other) const {  // for the heap: the first candidate is the largest
            return std::tie(other.length2, other.corner) < std::tie(length2, corner);
        }
    };

    void look() {
        if (++looks_ % 4096 == 0) file_.expect_not_cancelled();
    }

    int turn_at(Corner i) const { return turn(points_[previous_[i]], points_[i], points_[next_[i]]); }

    /// Finds the kind of a corner and puts the corner into the queue of that kind.
    void sort(Corner i) {
        const int t = turn_at(i);
        const Corner p = previous_[i], n = next_[i];
        kind_[i] = t > 0 ? Kind::inward : t < 0 ? Kind::outward : is_between(i) ? Kind::flat : Kind::spike;
        if (t > 0) candidates_.push({length2(points_[n] - points_[p]), i, p, n});
        if (kind_[i] == Kind::flat) flat_.push(i);
        if (kind_[i] == Kind::spike) spikes_.push(i);
    }
    /// Removes a corner, and sorts its neighbours again.
    void cut(Corner i) {
        const Corner p = previous_[i], n = next_[i];
        next_[p] = n, previous_[n] = p;
        kind_[i] = Kind::gone;
        tree_.set(i, false);
        for (const Corner k : {p, n}) tree_.set(k, turn_at(k) <= 0);
        for (const Corner k : {p, n}) sort(k);
    }

    /// Whether a corner on one line with its neighbours is between them.
    bool is_between(Corner i) const {
        const Point &a = points_[previous_[i]], &b = points_[i], &c = points_[next_[i]];
        return (before(a, b) && before(b, c)) || (before(c, b) && before(b, a));
    }

    /// The corner to cut next. Spikes have no area and come first, then ears. Flat corners come after ears,
    /// because an ear beside a flat corner has an area. Blocked corners come last.
    std::optional<Corner> choose() {
        if (const auto spike = front(spikes_, Kind::spike)) return spike;
        while (!candidates_.empty()) {
            const Candidate c = candidates_.top();
            candidates_.pop();
            if (kind_[c.corner] != Kind::inward || previous_[c.corner] != c.previous ||
                next_[c.corner] != c.next)
                continue;  // outdated: the corner was sorted again
            if (!is_blocked(c.corner)) return c.corner;
            kind_[c.corner] = Kind::blocked;
            blocked_.push(c.corner);
        }
        if (const auto flat = front(flat_, Kind::flat)) return flat;
        return freed();
    }
    /// Takes corners from a queue up to the first that is still of the queue's kind.
    std::optional<Corner> front(Queue& queue, Kind kind) const {
        while (!queue.empty())
            if (const Corner i = queue.pop(); kind_[i] == kind) return i;
        return std::nullopt;
    }
    /// A blocked corner that has become an ear, or else any blocked corner. Only boundaries that touch or
    /// cross themselves lead here, so at most 8n corners are tested again.
    std::optional<Corner> freed() {
        std::vector<Corner> still;
        std::optional<Corner> found;
        while (!found && looked_again_ < 8 * size_) {
            const auto i = front(blocked_, Kind::blocked);
            if (!i) break;
            ++looked_again_;
            if (is_blocked(*i))
                still.push_back(*i);
            else
                found = i;
        }
        for (const Corner i : still) blocked_.push(i);
        return found ? found : front(blocked_, Kind::blocked);
    }

    /// Whether the boundary enters the triangle that corner b makes with its neighbours: b is then no ear.
    bool is_blocked(Corner b) {
        const Corner a = previous_[b], c = next_[b];
        const Sides sides{{{points_[a], points_[b]}, {points_[b], points_[c]}, {points_[c], points_[a]}}};
        Box<double, 2> around;
        around.expand(points_[a]).expand(points_[b]).expand(points_[c]);
        const auto enters = [&](const Box<double, 2>& box) {
            look();
            return overlap(box, around) && std::none_of(sides.begin(), sides.end(), [&](const auto& side) {
                       return side.beyond(box, 0, 1, 1);
                   });
        };
        return tree_.any(enters, [&](Corner q) { return q != a && q != b && q != c && blocks(q, sides); });
    }
    /// Whether the boundary enters the triangle at q. The triangle's first two sides are edges of the
    /// polygon: the boundary may touch them and pass by. The third side is to become an edge, and must be
    /// free.
    bool blocks(Corner q, const Sides& sides) const {
        std::array<int, 3> at{};
        for (std::size_t k = 0; k < 3; ++k)
            if ((at[k] = sides[k].turn(points_[q], 0, 1)) < 0) return false;
        if (at[0] > 0 && at[1] > 0) return true;
        const auto comes_in = [&](const Point& neighbour) {
            for (std::size_t k = 0; k < 3; ++k)
                if (at[k] == 0 && sides[k].turn(neighbour, 0, 1) <= 0) return false;
            return true;
        };
        return comes_in(points_[previous_[q]]) || comes_in(points_[next_[q]]);
    }

    const ByteSource& file_;
    const std::vector<Point>& points_;
    std::size_t size_, looks_ = 0, looked_again_ = 0;
    std::vector<Corner> next_, previous_;
    std::vector<Kind> kind_;
    CornerTree tree_;
    std::priority_queue<Candidate> candidates_;
    Queue spikes_, flat_, blocked_;
};

/// Whether every corner turns to the left and the boundary goes around once. It goes around once if x (y
/// where x is the same) rises along one run of edges and falls along one.
bool is_convex(const std::vector<Point>& points) {
    const std::size_t n = points.size();
    const auto rises = [&](std::size_t i) { return before(points[i % n], points[(i + 1) % n]); };
    int changes = 0;
    for (std::size_t i = 0; i < n; ++i) {
        if (turn(points[i], points[(i + 1) % n], points[(i + 2) % n]) <= 0) return false;
        changes += rises(i) != rises(i + 1);
    }
    return changes == 2;
}

/// Newell's normal: twice the areas of the polygon's projections along the axes (Sutherland et al. 1974).
Vec3d newell_normal(const std::vector<Vec3d>& corners) {
    Vec3d normal;
    for (std::size_t i = 2; i < corners.size(); ++i)
        normal = normal + cross(corners[i - 1] - corners[0], corners[i] - corners[0]);
    return normal;
}

/// The polygon seen along the axis in which its normal is longest, counterclockwise. Nothing if it has no
/// normal or a coordinate is not finite or too large. Scales `corners`.
std::optional<std::vector<Point>> projected(std::vector<Vec3d>& corners) {
    // Scale the corners, so that products neither over- nor underflow.
    double largest = 0;
    for (const Vec3d& p : corners)
        for (int k = 0; k < 3; ++k) {
            if (!(std::abs(p[k]) <= largest_coordinate<double>)) return std::nullopt;
            largest = std::max(largest, std::abs(p[k]));
        }
    const double scale = scale_to_one(largest);
    for (Vec3d& p : corners) p = p * scale;
    // Drop the axis in which the normal is longest.
    const Vec3d normal = newell_normal(corners);
    int axis = 0;
    for (int k = 1; k < 3; ++k)
        if (std::abs(normal[k]) > std::abs(normal[axis])) axis = k;
    if (normal[axis] == 0) return std::nullopt;
    const int x = (axis + (normal[axis] > 0 ? 1 : 2)) % 3, y = 3 - axis - x;
    std::vector<Point> points;
    points.reserve(corners.size());
    for (const Vec3d& p : corners) points.push_back({p[x], p[y]});
    return points;
}

/// The corners of a polygon, in their order, from a fan of triangles from the first.
std::vector<std::uint32_t> corners_of_fan(std::span<const TriangleIndices> fan) {
    std::vector<std::uint32_t> names{fan[0][0], fan[0][1]};
    names.reserve(fan.size() + 2);
    for (const TriangleIndices& t : fan) names.push_back(t[2]);
    return names;
}

}  // namespace

template <class T>
void fill_polygon(const ByteSource& file, std::span<TriangleIndices> fan, std::span<const Vec<T, 3>> vertices,
                  std::span<const std::span<TriangleIndices>> alike) {
    const std::size_t size = fan.size() + 2;
    const auto expect_room = [&](std::uint64_t bytes_a_corner) {
        constexpr std::size_t unasked = 1u << 16;  // corners; the few MB for fewer are not checked
        if (size >= unasked)
            expect_memory(file.name(), "the " + std::to_string(size) + " corners of one of its faces",
                          size * bytes_a_corner);
    };
    // Collect the corners of the polygon from the fan.
    expect_room(sizeof(std::uint32_t) + sizeof(Vec3d) + sizeof(Point));
    const std::vector<std::uint32_t> names = corners_of_fan(fan);
    std::vector<Vec3d> corners;
    corners.reserve(size);
    for (const std::uint32_t v : names) {
        if (v >= vertices.size()) return;
        corners.push_back(Vec3d(vertices[v]));
    }
    // Keep the fan of a polygon that is convex or has no normal, and replace any other.
    const auto points = projected(corners);
    if (!points || is_convex(*points)) return;
    expect_room(EarClipper::bytes_a_corner);
    std::vector<TriangleIndices> ears;
    ears.reserve(fan.size());
    EarClipper(file, *points).run([&](Corner a, Corner b, Corner c) { ears.push_back({a, b, c}); });
    const auto replace = [&](std::span<TriangleIndices> to, const std::vector<std::uint32_t>& by) {
        for (std::size_t i = 0; i < ears.size(); ++i)
            to[i] = {by[ears[i][0]], by[ears[i][1]], by[ears[i][2]]};
    };
    replace(fan, names);
    for (const std::span<TriangleIndices> other : alike) replace(other, corners_of_fan(other));
}

template void fill_polygon(const ByteSource&, std::span<TriangleIndices>, std::span<const Vec3f>,
                           std::span<const std::span<TriangleIndices>>);
template void fill_polygon(const ByteSource&, std::span<TriangleIndices>, std::span<const Vec3d>,
                           std::span<const std::span<TriangleIndices>>);

}  // namespace hedgerow::detail
