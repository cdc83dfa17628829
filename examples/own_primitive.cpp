// A primitive type of your own in every structure: capsules (a segment with a radius), here a tree's
// branches.
//
// A primitive set needs `Scalar`, `dimension`, `size()` and `bounds(i)`, and a member for each kind of query
// that it answers (primitives/concepts.h): `meet` for rays, `closest_point` for distances, `overlaps` for
// boxes. It needs no registration and no base class, and its members are inlined into the queries.
#include <cstdio>
#include <span>
#include <vector>

#include <hedgerow/hedgerow.h>

using namespace hedgerow;

struct Capsule {
    Vec3f a, b;
    float radius;
};

/// An index keeps a copy of the set that it was built over. This set only refers to the caller's array, so
/// the copy is cheap.
struct Capsules {
    using Scalar = float;
    static constexpr int dimension = 3;
    std::span<const Capsule> all;

    std::size_t size() const { return all.size(); }
    Box3f bounds(std::size_t i) const {
        const auto& [a, b, radius] = all[i];
        return merged(Sphere<float, 3>{a, radius}.bounds(), Sphere<float, 3>{b, radius}.bounds());
    }
    /// Returns the least t in the ray's interval at which the ray hits the surface. A capsule is convex, so a
    /// line is inside it from the first entry into one of its parts (two balls and a cylinder) to the last
    /// exit from one.
    std::optional<Meeting<float>> meet(std::size_t i, const Ray3f& ray) const {
        const auto& [a, b, radius] = all[i];
        Interval<float> in{std::numeric_limits<float>::infinity(), -std::numeric_limits<float>::infinity()};
        const auto add = [&](const std::optional<Interval<float>>& part) {
            if (part) in = {std::min(in.entry, part->entry), std::max(in.exit, part->exit)};
        };
        add(meet_line(ray.origin, ray.direction, Sphere<float, 3>{a, radius}));
        add(meet_line(ray.origin, ray.direction, Sphere<float, 3>{b, radius}));
        add(meet_cylinder(ray, all[i]));
        for (const float t : {in.entry, in.exit})
            if (ray.t_min <= t && t <= ray.t_max && in.entry <= in.exit) return Meeting<float>{t, 0, 0};
        return std::nullopt;
    }
    /// Returns the closest point of the solid capsule. The point is within the bounds, as structures require.
    Vec3f closest_point(std::size_t i, const Vec3f& p) const {
        const auto& [a, b, radius] = all[i];
        const Vec3f on_axis = hedgerow::closest_point(p, Segment<float, 3>{a, b}).point;
        const float away = length(p - on_axis);
        return away <= radius ? clamped(p, bounds(i))
                              : clamped(on_axis + (p - on_axis) * (radius / away), bounds(i));
    }
    // There is no `overlaps`, since this program has no box queries. `overlapping(index, box, found)` would
    // not compile.

private:
    /// The interval in which the ray's line is inside the cylinder between the ends. The cylinder's caps are
    /// inside the balls.
    static std::optional<Interval<float>> meet_cylinder(const Ray3f& ray, const Capsule& c) {
        const Vec3d axis(c.b - c.a), from(ray.origin - c.a), d(ray.direction);
        const double l2 = length2(axis), r = static_cast<double>(c.radius);
        if (l2 == 0) return std::nullopt;
        // Write the height above a, in units of the axis, and the distance vector across it as linear
        // functions of t.
        const double height = dot(from, axis) / l2, rise = dot(d, axis) / l2;
        const Vec3d across = from - axis * height, drift = d - axis * rise;
        const double speed2 = length2(drift);
        if (speed2 == 0) return std::nullopt;  // along the axis: the balls suffice
        const double nearest = -dot(across, drift) / speed2;
        // Intersect with the infinite cylinder. `product` keeps compilers from fusing the difference.
        const double room = product(r, r) - length2(across + drift * nearest);
        if (room < 0) return std::nullopt;
        double entry = nearest - std::sqrt(room / speed2), exit = nearest + std::sqrt(room / speed2);
        // Cut the interval off at the two ends.
        if (rise == 0 && (height < 0 || height > 1)) return std::nullopt;
        if (rise != 0) {
            const double low = -height / rise, high = (1 - height) / rise;
            entry = std::max(entry, std::min(low, high)), exit = std::min(exit, std::max(low, high));
        }
        if (entry > exit) return std::nullopt;
        return Interval<float>{static_cast<float>(entry), static_cast<float>(exit)};
    }
};

void grow(std::vector<Capsule>& tree, const Vec3f& from, const Vec3f& along, float radius) {
    const Vec3f to = from + along;
    tree.push_back({from, to, radius});
    if (radius < 0.012f) return;
    const Vec3f side = normalized(cross(along, Vec3f(0.6f, 0.1f, 0.8f))) * length(along);
    const Vec3f other = normalized(cross(along, side)) * length(along);
    for (const Vec3f& turn : {side, other * 0.8f - side * 0.5f, -other * 0.8f - side * 0.5f})
        grow(tree, to, along * 0.6f + turn * 0.45f, radius * 0.62f);
}

int main() {
    std::vector<Capsule> tree;
    grow(tree, Vec3f(0, 0, 0), Vec3f(0.05f, 0, 1), 0.12f);
    const Capsules capsules{tree};
    const auto bvh = build<Bvh>(capsules);
    const auto kdtree = build<KdTree>(capsules);
    const auto grid = build<Grid>(capsules);

    // Print a picture by depth, seen along +y. All structures give the same answers, to the last bit.
    int wrong = 0, hits = 0;
    const Box3f box = bvh.bounds();
    const Vec3f extent = box.extent();
    for (int row = 0; row < 28; ++row) {
        for (int column = 0; column < 64; ++column) {
            const Vec3f at(box.low[0] + extent[0] * (static_cast<float>(column) + 0.5f) / 64, box.low[1] - 1,
                           box.high[2] - extent[2] * (static_cast<float>(row) + 0.5f) / 28);
            const auto hit = closest_hit(bvh, Ray3f{at, {0, 1, 0}});
            wrong += hit != closest_hit(kdtree, Ray3f{at, {0, 1, 0}});
            wrong += hit != closest_hit(grid, Ray3f{at, {0, 1, 0}});
            const auto near = closest_point(bvh, at);
            wrong += near != closest_point(kdtree, at) || near != closest_point(grid, at);
            hits += bool(hit);
            std::putchar(hit ? "@%#*+=-:."[static_cast<int>((hit.t - 1) / extent[1] * 8.99f)] : ' ');
        }
        std::putchar('\n');
    }
    std::printf("%zu branches, %d of %d rays hit, %d answers differ\n", tree.size(), hits, 28 * 64, wrong);
    return wrong == 0 && hits > 0 ? 0 : 1;
}
