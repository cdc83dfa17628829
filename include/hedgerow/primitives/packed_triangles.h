/// A copy of triangles in which a test reads one place in memory, with three corners in a register.
#pragma once

#include <algorithm>
#include <span>
#include <type_traits>

#include <hedgerow/base/bare_vector.h>
#include <hedgerow/geometry/lanes.h>
#include <hedgerow/primitives/concepts.h>

namespace hedgerow {

/// Triangles as three rows, one for each axis, of the three corners' coordinates, then the id: 40 bytes a
/// triangle (float), 80 (double). A row is loaded as four lanes, and the fourth is ignored.
template <std::floating_point T, PackedOrder order>
class PackedTriangles {
public:
    using Scalar = T;
    static constexpr int dimension = 3;

    PackedTriangles() = default;
    explicit PackedTriangles(std::size_t size) : triangles_(size) {}

    std::size_t bytes() const { return triangles_.capacity() * sizeof(Packed); }

    /// Makes room for position i.
    void reach(std::size_t i) {
        if (i >= triangles_.size()) triangles_.resize(i + 1);
    }
    void set(std::size_t i, const Triangle<T, 3>& t, PrimitiveId id) {
        Packed& p = triangles_[i];
        for (int k = 0; k < 3; ++k)
            p.row[3 * k] = t.a[k], p.row[3 * k + 1] = t.b[k], p.row[3 * k + 2] = t.c[k];
        p.row[9] = number_as_lane<T>(id);
    }

    /// Runs the watertight test's first pass, a filter, on all three edges at once. Triangles that pass go to
    /// `meet_exactly`.
    template <class Query>
    Flow test_leaf(const RayProbe<T, 3>& probe, const Leaf& leaf, Query& query) const {
        using L = Lanes<T>;
        const WatertightRay<T>& ray = probe.watertight();
        for (std::uint32_t i = leaf.first; i < leaf.first + leaf.count; ++i) {
            const Packed* const p = &triangles_[order == PackedOrder::of_leaves ? i : leaf.ids[i]];
            const L z = L::load(p->row + 3 * ray.kz) - L::all(ray.origin[ray.kz]);
            const L x = (L::load(p->row + 3 * ray.kx) - L::all(ray.origin[ray.kx])) - L::all(ray.shear_x) * z;
            const L y = (L::load(p->row + 3 * ray.ky) - L::all(ray.origin[ray.ky])) - L::all(ray.shear_y) * z;
            const L edges =
                edge_filter(x.previous_corner(), y.previous_corner(), x.next_corner(), y.next_corner());
            if ((edges.negative() & 7u) != 0 && (edges.positive() & 7u) != 0) continue;
            const auto m = meet_exactly(ray, p->corner(ray, 0), p->corner(ray, 1), p->corner(ray, 2));
            if (m && query.offer({m->t, m->u, m->v, p->id()}) == Flow::stop) return Flow::stop;
        }
        return Flow::go_on;
    }

    /// Prefetches what the tests of a leaf will read: where ids lie far apart in memory, a test waits longer
    /// than it computes. At most 16 triangles, since memory loads no more at once.
    void prefetch(const Leaf& leaf) const {
        for (std::uint32_t i = leaf.first; i < leaf.first + std::min(leaf.count, 16u); ++i)
            __builtin_prefetch(&triangles_[order == PackedOrder::of_leaves ? i : leaf.ids[i]]);
    }

private:
    struct Packed {
        T row[10];  // three corners for each axis, then the id

        PrimitiveId id() const { return number_of_lane(row[9]); }

        ShearedCorner<T> corner(const WatertightRay<T>& ray, int i) const {
            return shear(ray, Vec<T, 3>(row[i], row[3 + i], row[6 + i]));
        }
    };
    static_assert(sizeof(Packed) == 10 * sizeof(T));

    BareVector<Packed> triangles_;
};

}  // namespace hedgerow
