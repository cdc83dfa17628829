/// Winding numbers within a promised error, by multipole expansions of the clusters of a tree.
#pragma once

#include <algorithm>
#include <numbers>
#include <vector>

#include <hedgerow/geometry/closing_angle.h>
#include <hedgerow/walks/fold.h>

namespace hedgerow {

namespace detail {

/// Half the solid angle of a triangle as seen from x is the argument of (real, volume) (Van Oosterom and
/// Strackee 1983). The volume's sign is exact where it decides about a whole turn. Corners are relative to
/// the point, scaled alike.
inline void add_half_angle(SumOfAngles& halves, const std::array<Vec3d, 3>& corners, const Vec3d& x,
                           double scale) {
    const Vec3d a = (corners[0] - x) * scale, b = (corners[1] - x) * scale, c = (corners[2] - x) * scale;
    const double la = length(a), lb = length(b), lc = length(c);
    double volume = dot(a, cross(b, c));
    const double real = product(product(la, lb), lc) + product(dot(a, b), lc) + product(dot(b, c), la) +
                        product(dot(c, a), lb);
    if (real < 0 && std::abs(volume) <= 0x1p-46 * product(product(la, lb), lc)) {
        // Seen from the front, corners turn counterclockwise, and the volume is negative.
        const int of_plane = side(corners[0], corners[1], corners[2], x);
        if (of_plane == 0) return;  // from within the triangle, half of it is on either side
        volume = with_sign(volume, -of_plane);
    }
    halves.add(real, volume);
}

}  // namespace detail

/// Triangles as seen from afar: the moments of their normals about a center, up to order 2, each in the part
/// that is symmetric in all axes, which is all that expansions read.
struct WindingMoments {
    Vec3d center;
    double area = 0;
    double radius = 0;       ///< the distance of the farthest corner from the center
    double third = 0;        ///< at least ∫|y|³, with y the offset from the center
    Vec3d normal;            ///< ∫n
    double first[6] = {};    ///< ∫n_i·y_j: xx, yy, zz, xy, yz, zx
    double second[10] = {};  ///< ∫n_i·y_j·y_k: xxx, yyy, zzz, xxy, yyz, zzx, xyy, yzz, zxx, xyz

    /// Adds a triangle. Its second moments are exact: the mean of y_j·y_k is a sum over corners.
    void add(const std::array<Vec3d, 3>& t) {
        const Vec3d p = t[0] - center, q = t[1] - center, r = t[2] - center;
        const Vec3d n = cross(q - p, r - p) * 0.5, sum = p + q + r;
        const double size = length(n);
        const auto cubed = [](const Vec3d& y) { return product(length2(y), length(y)); };
        radius = std::max({radius, length(p), length(q), length(r)});
        third += product(size, (cubed(p) + cubed(q) + cubed(r)) / 3);
        normal += n;
        const auto mean = [&](int j, int k) {
            return (product(p[j], p[k]) + product(q[j], q[k]) + product(r[j], r[k]) +
                    product(sum[j], sum[k])) /
                   12;
        };
        for (int i = 0; i < 3; ++i) {
            const int j = (i + 1) % 3;
            first[i] += product(n[i], sum[i] / 3);
            first[3 + i] += (product(n[i], sum[j]) + product(n[j], sum[i])) / 6;
            second[i] += product(n[i], mean(i, i));
            second[3 + i] += (product(n[i], mean(i, j)) * 2 + product(n[j], mean(i, i))) / 3;
            second[6 + i] += (product(n[i], mean(j, j)) + product(n[j], mean(i, j)) * 2) / 3;
        }
        second[9] += (product(n[0], mean(1, 2)) + product(n[1], mean(2, 0)) + product(n[2], mean(0, 1))) / 3;
    }
};

/// The share of a winding number that triangles have, and a bound of its error.
struct WindingTerm {
    double value, error;
};

/// The expansion of order 2 of the solid angle that triangles are seen under, over 4π. With R = center − x,
/// r = |R| and s = radius/r < 1, orders from 3 on add up to at most ∫|y|³·(4 − 3s)/(4π r⁵ (1 − s)²), since
/// |∇(ρⁿ Pₙ)| <= n·ρⁿ⁻¹. Roundings of terms and moments are bounded by 2⁻⁴⁰ of the largest term. An infinite
/// error where x is among the triangles.
inline WindingTerm expanded(const WindingMoments& m, const Vec3d& x) {
    const Vec3d R = m.center - x;
    const double r2 = length2(R), r = std::sqrt(r2), s = m.radius / r;
    if (!(s < 0.99)) return {0, std::numeric_limits<double>::infinity()};
    constexpr double turn = 4 * std::numbers::pi;
    const double per_r2 = 1 / r2;
    const Vec3d e = R / r;  // all terms are in units of the distance
    const double* const f = m.first;
    const double* const g = m.second;
    const double monopole = dot(m.normal, e);
    const auto cyclic = [&](const double* c) {
        return product(c[0], product(e[0], e[1])) + product(c[1], product(e[1], e[2])) +
               product(c[2], product(e[2], e[0]));
    };
    const double dipole = f[0] + f[1] + f[2] -
                          3 * (product(f[0], product(e[0], e[0])) + product(f[1], product(e[1], e[1])) +
                               product(f[2], product(e[2], e[2])) + 2 * cyclic(f + 3));
    // Contractions of the third-order tensor: with two axes alike, and with e three times.
    const double alike = product(e[0], g[0] + g[6] + g[5]) + product(e[1], g[3] + g[1] + g[7]) +
                         product(e[2], g[8] + g[4] + g[2]);
    const auto along = [&](int i) {
        const int j = (i + 1) % 3;
        return product(product(e[i], e[i]), product(g[i], e[i]) + 3 * product(g[3 + i], e[j])) +
               3 * product(product(g[6 + i], e[i]), product(e[j], e[j]));
    };
    const double thrice =
        along(0) + along(1) + along(2) + 6 * product(product(g[9], e[0]), product(e[1], e[2]));
    const double quadrupole = (product(15.0, thrice) - 9 * alike) / 2;
    const double value = product(per_r2, monopole + (dipole + quadrupole / r) / r) / turn;
    const double left_out = product(m.third, 4 - 3 * s) / product(product(r2, r2) * r, (1 - s) * (1 - s));
    const double rounding = product(0x1p-40, product(m.area, per_r2)) / (1 - s);
    return {value, (left_out + rounding) / turn * (1 + 0x1p-40)};
}

/// Sums winding numbers over a tree of triangles. `Tree` has each triangle in one leaf.
template <class Tree>
class WindingExpansion {
public:
    /// Moments of all nodes, each computed from its triangles themselves: O(n · depth), 200 bytes a node.
    template <class Set>
    WindingExpansion(const Tree& tree, const Set& set) : moments_(tree.node_count()) {
        const auto& bounds = tree.bounds();
        if (!bounds.empty())
            scale_ = scale_to_one(static_cast<double>(max_component(max(abs(bounds.low), abs(bounds.high)))));
        // The centers: the triangles' centroids by area, or by number where there is none.
        struct Mass {
            double area = 0, count = 0;
            Vec3d by_area, by_count;
        };
        const auto masses = fold(
            tree,
            [&](const Leaf& leaf) {
                Mass m;
                for (std::uint32_t i = leaf.first; i < leaf.first + leaf.count; ++i) {
                    const auto t = corners_of(set, leaf.ids[i]);
                    const Vec3d middle = (t[0] + t[1] + t[2]) / 3.0;
                    const double area = length(cross(t[1] - t[0], t[2] - t[0])) / 2;
                    m.area += area, m.count += 1;
                    m.by_area += middle * area, m.by_count += middle;
                }
                return m;
            },
            [](const Mass& a, const Mass& b) {
                return Mass{a.area + b.area, a.count + b.count, a.by_area + b.by_area,
                            a.by_count + b.by_count};
            });
        for (std::size_t i = 0; i < masses.size(); ++i) {
            moments_[i].area = masses[i].area;
            moments_[i].center = masses[i].area > 0 ? masses[i].by_area / masses[i].area
                                                    : masses[i].by_count / std::max(1.0, masses[i].count);
        }
        std::vector<NodeId> path;
        if (!tree.root().empty()) add_below(tree, set, tree.root(), 0, path);
    }

    /// The winding number of the triangles about a point, which errs by at most `error`. Opens the cluster of
    /// the largest bound until the sum of all bounds is within the error. Each node is looked at once.
    template <class Set, class Count>
    double winding_number(const Tree& tree, const Set& set, const Vec3d& point, double error,
                          Count& count) const {
        if (tree.root().empty()) return 0;
        const Vec3d x = point * scale_;
        const double scale = 1 / std::max(moments_[0].radius, length(moments_[0].center - x));
        static thread_local std::vector<Cluster> largest;  // a heap
        static thread_local std::vector<NodeRef> opened;
        largest.clear();
        opened.clear();
        SumOfAngles triangles;
        double whole = 0, bound = 0;
        // Take a cluster by its expansion for now, or open it at once if it can be no part of the answer.
        const auto take = [&](NodeRef node, NodeId id) {
            const WindingTerm term = expanded(moments_[id], x);
            if (!(term.error <= error)) return opened.push_back(node);
            whole += term.value, bound += term.error;
            if (term.error < error * negligible) return;
            largest.push_back({term, node});
            std::push_heap(largest.begin(), largest.end());
        };
        take(tree.root(), 0);
        while (true) {
            if (opened.empty()) {
                if (bound <= error || largest.empty()) break;
                // Take the largest bound back, and open its cluster.
                std::pop_heap(largest.begin(), largest.end());
                const Cluster& c = largest.back();
                whole -= c.term.value, bound -= c.term.error;
                opened.push_back(c.node);
                largest.pop_back();
            }
            const NodeRef node = opened.back();
            opened.pop_back();
            if (node.leaf()) {
                const Leaf leaf = tree.leaf(node);
                count.leaf(leaf.count, node.place());
                for (std::uint32_t k = leaf.first; k < leaf.first + leaf.count; ++k)
                    detail::add_half_angle(triangles, corners_of(set, leaf.ids[k]), x, scale);
                bound += leaf.count * 0x1p-45;
            } else {
                count.node(node.place());
                for (int k = 0; k < Tree::width; ++k)
                    if (const NodeRef child = tree.child(node, k); !child.empty())
                        take(child, Tree::child_id(node, k));
            }
        }
        return triangles.turns() + whole;
    }
    std::size_t bytes() const { return moments_.capacity() * sizeof(WindingMoments); }

private:
    struct Cluster {
        WindingTerm term;
        NodeRef node;

        friend bool operator<(const Cluster& a, const Cluster& b) { return a.term.error < b.term.error; }
    };
    /// Bounds below this share of the error are never taken back: all nodes of a tree of 2³² triangles
    /// together have less than the error.
    static constexpr double negligible = 0x1p-40;

    template <class Set>
    std::array<Vec3d, 3> corners_of(const Set& set, PrimitiveId id) const {
        const auto t = set.corners(id);
        return {Vec3d(t[0]) * scale_, Vec3d(t[1]) * scale_, Vec3d(t[2]) * scale_};
    }
    /// Adds the triangles below a node to it and to all nodes above, which are listed in `path`.
    template <class Set>
    void add_below(const Tree& tree, const Set& set, NodeRef node, NodeId id, std::vector<NodeId>& path) {
        path.push_back(id);
        if (node.leaf()) {
            const Leaf leaf = tree.leaf(node);
            for (std::uint32_t i = leaf.first; i < leaf.first + leaf.count; ++i) {
                const auto t = corners_of(set, leaf.ids[i]);
                for (const NodeId above : path) moments_[above].add(t);
            }
        } else {
            for (int i = 0; i < Tree::width; ++i)
                if (const NodeRef child = tree.child(node, i); !child.empty())
                    add_below(tree, set, child, Tree::child_id(node, i), path);
        }
        path.pop_back();
    }

    double scale_ = 1;  // a power of two, for coordinates whose fifth powers overflow
    std::vector<WindingMoments> moments_;
};

}  // namespace hedgerow
