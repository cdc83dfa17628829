#include "interior_model.h"

#include <algorithm>
#include <array>

#include "circle.h"

namespace hedgerow::detail {
namespace {

/// The point at `across` in the plane across an axis and at `along` on the axis, as x, y, z.
Vec3d on_axis(Axis axis, const Vec2d& across, double along) {
    if (axis == Axis::x) return {along, across[0], across[1]};
    if (axis == Axis::y) return {across[1], along, across[0]};
    return {across[0], across[1], along};
}

}  // namespace

/// Levels divide circles and curves more finely by turns, so that a level has few triangles more than the one
/// before.
Model::Model(std::uint64_t level) : pieces_(1 + (level + 1) / 2), circle_(circle(1 + level / 2)) {}

Outline Model::disc(double radius) const {
    Outline o;
    for (const Vec2d& p : circle_) o.points.push_back(p * radius);
    return o;
}

Outline Model::rounded(double a, double b, double radius) const {
    const std::size_t quarter = circle_.size() / 4;
    Outline o;
    for (std::size_t i = 0; i < 4; ++i) {
        const Vec2d corner(i == 0 || i == 3 ? a - radius : radius - a, i < 2 ? b - radius : radius - b);
        for (std::size_t k = 0; k <= quarter; ++k)
            o.points.push_back(corner + circle_[(i * quarter + k) % circle_.size()] * radius);
    }
    return o;
}

std::vector<Vec2d> Model::curve(const std::vector<Vec2d>& controls) const {
    std::vector<Vec2d> points;
    const auto add = [&](const Vec2d& p) {
        if (points.empty() || !(points.back() == p)) points.push_back(p);
    };
    add(controls.front());
    for (std::size_t i = 1; i + 1 < controls.size(); ++i) {
        const Vec2d from = (controls[i - 1] + controls[i]) / 2.0, to = (controls[i] + controls[i + 1]) / 2.0;
        for (std::uint64_t k = 0; k <= pieces_; ++k) {
            const double t = static_cast<double>(k) / static_cast<double>(pieces_), s = 1 - t;
            add((from * s + controls[i] * t) * s + (controls[i] * s + to * t) * t);  // de Casteljau
        }
    }
    add(controls.back());
    return points;
}

std::uint32_t Model::vertex(const Pose& pose, const Vec3d& p) {
    mesh.vertices.push_back(pose(p));
    return static_cast<std::uint32_t>(mesh.vertices.size() - 1);
}
void Model::quad(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
    mesh.triangles.push_back({a, b, c});
    mesh.triangles.push_back({a, c, d});
}

void Model::box(const Pose& pose, const Vec3d& low, const Vec3d& high) {
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    for (int i = 0; i < 8; ++i)
        vertex(pose, {i & 1 ? high[0] : low[0], i & 2 ? high[1] : low[1], i & 4 ? high[2] : low[2]});
    constexpr std::uint32_t sides[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                                           {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
    for (const auto& s : sides) quad(first + s[0], first + s[1], first + s[2], first + s[3]);
}
void Model::block(const Pose& pose, const Vec3d& foot, const Vec3d& size) {
    const Vec3d half(size[0] / 2, size[1] / 2, 0);
    box(pose, foot - half, foot + half + Vec3d(0, 0, size[2]));
}

void Model::loft(const Pose& pose, const Vec3d& base, Axis axis, const Outline& outline,
                 const Section& section) {
    const auto n = static_cast<std::uint32_t>(outline.points.size());
    const std::uint32_t sides = outline.closed ? n : n - 1;
    std::uint32_t last = 0;
    for (std::size_t row = 0; row < section.size(); ++row) {
        const auto [scale, along] = std::pair(section[row][0], section[row][1]);
        const bool point = scale == 0, after_point = row > 0 && section[row - 1][0] == 0;
        const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
        // Add the row's vertices: a single one if the outline is a point.
        for (std::uint32_t i = 0; i < (point ? 1 : n); ++i)
            vertex(pose, base + on_axis(axis, outline.points[i] * scale, along));
        // Join the row to the one before.
        for (std::uint32_t i = 0; row > 0 && i < sides; ++i) {
            const std::uint32_t next = i + 1 < n ? i + 1 : 0;
            if (after_point)
                mesh.triangles.push_back({last, first + next, first + i});
            else if (point)
                mesh.triangles.push_back({last + i, last + next, first});
            else
                quad(last + i, last + next, first + next, first + i);
        }
        last = first;
    }
}
void Model::bar(const Pose& pose, const Vec3d& base, Axis axis, const Outline& outline, double length) {
    loft(pose, base, axis, outline, {{0, 0}, {1, 0}, {1, length}, {0, length}});
}

void Model::leaf(const Pose& pose, const std::vector<Vec2d>& curve, double width) {
    std::uint32_t left = 0, right = 0;
    const auto n = static_cast<double>(curve.size() - 1);
    for (std::size_t i = 0; i < curve.size(); ++i) {
        // Widest a quarter of the way.
        const double t = static_cast<double>(i) / n;
        const double half = width / 2 * (1 - t) * (1 + 2 * t);
        const Vec3d at(curve[i][0], 0, curve[i][1]);
        if (i + 1 == curve.size()) {
            mesh.triangles.push_back({left, right, vertex(pose, at)});
            break;
        }
        const std::uint32_t l = vertex(pose, at + Vec3d(0, half, 0)),
                            r = vertex(pose, at - Vec3d(0, half, 0));
        if (i > 0) quad(left, right, r, l);
        left = l, right = r;
    }
}

void Model::wall(const Pose& pose, double length, double height, double thickness,
                 const std::vector<Opening>& openings, bool with_ends) {
    // Divide the wall by a lattice through the sides of all openings.
    std::vector<double> x = {0, length}, z = {0, height};
    for (const Opening& o : openings)
        x.insert(x.end(), {o.low[0], o.high[0]}), z.insert(z.end(), {o.low[1], o.high[1]});
    for (auto* all : {&x, &z}) {
        std::sort(all->begin(), all->end());
        all->erase(std::unique(all->begin(), all->end()), all->end());
    }
    const std::size_t columns = x.size() - 1, rows = z.size() - 1;
    const auto solid = [&](std::size_t i, std::size_t k) {
        return std::none_of(openings.begin(), openings.end(), [&](const Opening& o) {
            return o.low[0] <= x[i] && x[i] < o.high[0] && o.low[1] <= z[k] && z[k] < o.high[1];
        });
    };
    // Make each vertex when it is first used.
    constexpr std::uint32_t none = ~std::uint32_t{0};
    std::vector<std::uint32_t> known(2 * x.size() * z.size(), none);
    // The lattice has corners on the front (y < 0) and on the back.
    struct LatticeCorner {
        std::size_t i, k, back;
    };
    const auto known_or_new = [&](const LatticeCorner& c) {
        std::uint32_t& id = known[(c.i * z.size() + c.k) * 2 + c.back];
        if (id == none) id = vertex(pose, {x[c.i], c.back ? thickness / 2 : -thickness / 2, z[c.k]});
        return id;
    };
    // New vertices are made from the last corner to the first, by every compiler.
    const auto face = [&](const std::array<LatticeCorner, 4>& corners) {
        std::array<std::uint32_t, 4> id{};
        for (std::size_t c = 4; c-- > 0;) id[c] = known_or_new(corners[c]);
        quad(id[0], id[1], id[2], id[3]);
    };
    // Add the front and the back of each solid cell, and its sides that border on no solid cell.
    for (std::size_t i = 0; i < columns; ++i)
        for (std::size_t k = 0; k < rows; ++k) {
            if (!solid(i, k)) continue;
            face({{{i, k, 0}, {i + 1, k, 0}, {i + 1, k + 1, 0}, {i, k + 1, 0}}});
            face({{{i + 1, k, 1}, {i, k, 1}, {i, k + 1, 1}, {i + 1, k + 1, 1}}});
            // The wall's ends and the sides of its openings.
            if (i == 0 ? with_ends : !solid(i - 1, k))
                face({{{i, k, 1}, {i, k, 0}, {i, k + 1, 0}, {i, k + 1, 1}}});
            if (i + 1 == columns ? with_ends : !solid(i + 1, k))
                face({{{i + 1, k, 0}, {i + 1, k, 1}, {i + 1, k + 1, 1}, {i + 1, k + 1, 0}}});
            if (k > 0 && !solid(i, k - 1)) face({{{i, k, 1}, {i + 1, k, 1}, {i + 1, k, 0}, {i, k, 0}}});
            if (k + 1 < rows && !solid(i, k + 1))
                face({{{i, k + 1, 0}, {i + 1, k + 1, 0}, {i + 1, k + 1, 1}, {i, k + 1, 1}}});
        }
}

}  // namespace hedgerow::detail
