/// The fast multipole method over any structure, as its description in the literature.
#pragma once

#include <span>
#include <string>
#include <vector>

#include <hedgerow/base/error.h>
#include <hedgerow/nbody/operators.h>
#include <hedgerow/walks/pairs.h>
#include <hedgerow/walks/passes.h>

namespace hedgerow {

/// What charges do to each other: potential and gradient at each of them, in the order of their ids, by
/// expansions of order p (Greengard and Rokhlin 1987; the walk over pairs of cells: Dehnen 2002).
///
/// A cell's multipole is computed from its points or its children (upward pass). The walk over pairs of nodes
/// converts the multipoles of two cells into each other's local expansions if they are far apart for their
/// size, (radius a + radius b) < opening_angle · distance, and sums the pairs of two leaves one by one. Local
/// expansions are handed to children, and evaluated at the points (downward pass). Both cells of a pair take
/// the same terms, so forces add up to nothing but for roundings.
///
/// For teaching and for tests: O(n), but everything in double, in one thread, and without vectors.
template <int p = 6>
class PlainFmm {
public:
    explicit PlainFmm(double opening_angle = 0.5) : opening_angle_(opening_angle) {}

    /// `charges` has one for each point of the index, of any sign. Points in one place do nothing to each
    /// other. Throws InputError for another number of charges, and if the index holds a point in several
    /// leaves, as an Orthtree or a KdTree may do.
    template <class Index>
    std::vector<PotentialAt<double>> operator()(const Index& index, std::span<const double> charges) const {
        detail::expect_one_charge_each(charges.size(), index.primitives().size());
        std::vector<PotentialAt<double>> found(charges.size());
        const auto hierarchy = hierarchy_of(index.structure(), index.primitives());
        std::vector<Cell> cells(hierarchy.node_count());
        const auto point = [&](PrimitiveId i) { return Vec3d(index.primitives().bounds(i).low); };

        // Upward: multipoles about the middle of each cell's box, and how far its points may be from there.
        const auto cell_of = [&](const auto& node) -> Cell& {
            Cell& cell = cells[node.id];
            if (!cell.placed) cell = Cell(node.box);
            return cell;
        };
        std::size_t held = 0;
        upward_pass(
            hierarchy,
            [&](const auto& node, const Leaf& leaf) {
                Cell& cell = cell_of(node);
                for (const PrimitiveId i : ids(leaf)) p2m(charges[i], point(i) - cell.center, cell.multipole);
                held += leaf.count;
            },
            [&](const auto& node, const auto& child) {
                Cell& cell = cell_of(node);
                const Cell& part = cells[child.id];
                m2m(part.multipole, part.center - cell.center, cell.multipole);
            });
        if (held != charges.size())
            throw InputError("the structure has " + std::to_string(held) + " points in its leaves for " +
                             std::to_string(charges.size()) + " charges: use one that holds each point once");

        // Across: cells that are far apart for their size act as a whole.
        Interaction<typename decltype(hierarchy)::BoxType, decltype(point)> query{cells, charges, point,
                                                                                  opening_angle_, found};
        NoVisits none;
        walk_pairs(hierarchy, query, none);

        // Downward: local expansions, to the points.
        downward_pass(
            hierarchy,
            [&](const auto& node, const auto& child) {
                Cell& part = cells[child.id];
                l2l(cells[node.id].local, part.center - cells[node.id].center, part.local);
            },
            [&](const auto& node, const Leaf& leaf) {
                for (const PrimitiveId i : ids(leaf))
                    add(found[i], l2p(cells[node.id].local, point(i) - cells[node.id].center));
            });
        return found;
    }

private:
    struct Cell {
        Vec3d center;
        double radius = 0;
        bool placed = false;
        Harmonics<double, p> multipole;
        Harmonics<double, p + 1> local;

        Cell() = default;
        template <std::floating_point T>
        explicit Cell(const Box<T, 3>& box)
            : center(box.center()), radius(length(Vec3d(box.extent())) / 2), placed(true) {}
    };
    static std::span<const PrimitiveId> ids(const Leaf& leaf) { return {leaf.ids + leaf.first, leaf.count}; }
    static void add(PotentialAt<double>& sum, const PotentialAt<double>& more) {
        sum.potential += more.potential, sum.gradient = sum.gradient + more.gradient;
    }

    template <class AnyBox, class Point>
    struct Interaction {
        using BoxType = AnyBox;
        static constexpr Order order = Order::none;
        std::vector<Cell>& cells;
        std::span<const double> charges;
        const Point& point;
        double opening_angle;
        std::vector<PotentialAt<double>>& found;

        static typename BoxType::Scalar bound(const BoxType&, const BoxType&) { return 0; }
        static typename BoxType::Scalar limit() { return 0; }
        Verdict accept(NodeId i, NodeId j) {
            Cell &a = cells[i], &b = cells[j];
            const Vec3d apart = b.center - a.center;
            if (!(a.radius + b.radius < opening_angle * length(apart))) return Verdict::open;
            m2l(a.multipole, apart, b.local);
            m2l(b.multipole, -apart, a.local);
            return Verdict::accept;
        }
        Flow offer(const auto& a, const auto& b) {
            for (const PrimitiveId i : ids(a.items))
                for (const PrimitiveId j : ids(b.items)) act(i, j);
            return Flow::go_on;
        }
        Flow offer(const auto& leaf) {
            for (std::size_t i = 0; i < leaf.items.count; ++i)
                for (std::size_t j = i + 1; j < leaf.items.count; ++j)
                    act(ids(leaf.items)[i], ids(leaf.items)[j]);
            return Flow::go_on;
        }
        void act(PrimitiveId i, PrimitiveId j) {
            const Vec3d apart = point(i) - point(j);
            add(found[i], p2p(charges[j], apart));
            add(found[j], p2p(charges[i], -apart));
        }
    };

    double opening_angle_;
};

}  // namespace hedgerow
