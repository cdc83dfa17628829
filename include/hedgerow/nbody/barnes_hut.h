/// The method of Barnes and Hut over any structure: far cells act as one charge at their center.
#pragma once

#include <span>
#include <string>
#include <vector>

#include <hedgerow/base/error.h>
#include <hedgerow/nbody/direct_sum.h>
#include <hedgerow/nbody/potential.h>
#include <hedgerow/probes/point.h>
#include <hedgerow/walks/fold.h>

namespace hedgerow {

namespace detail {
template <class S>
concept FoldableTree = VolumeTree<S> || OrthantTree<S> || PlaneTree<S>;
}  // namespace detail

/// Potentials of charges in space or in the plane, for any kernel of the distance (potential.h), by a walk
/// from each target (Barnes and Hut, A hierarchical O(N log N) force-calculation algorithm, 1986). A cell
/// that is seen under less than the *opening angle* acts as its total charge at its center of charge: the
/// longest side of the box around its points is less than so many times the distance of that center. With 0
/// the sum is direct.
///
/// Centers are weighted by |q|, so that charges of both signs have one; the error is then of first order in
/// the angle, and of second order where all have one sign. A target's own place does nothing to it. O(log n)
/// a target over a tree whose cells are compact, direct sums over grids and brute force. In double, one walk
/// a target, for teaching and tests.
template <class Index, class Kernel = InverseDistance>
class BarnesHut {
public:
    using T = typename Index::Scalar;
    static constexpr int D = Index::dimension;
    using Point = Vec<double, D>;

    /// `charges` has one for each point of the index, which must outlive this. Throws InputError for another
    /// number, and for a structure that may hold a point in several cells (`exclusive`).
    BarnesHut(const Index& index, std::span<const double> charges, double opening_angle = 0.5,
              Kernel kernel = {})
        : index_(index), charges_(charges), opening_angle_(opening_angle), kernel_(kernel) {
        detail::expect_one_charge_each(charges.size(), index.primitives().size());
        if (!index.structure().exclusive())
            throw InputError("charges would count several times: use a structure that holds each point once");
        if constexpr (detail::FoldableTree<std::remove_cvref_t<decltype(index.structure())>>)
            cells_ = fold(
                index.structure(), [&](const Leaf& leaf) { return cell_of(leaf); },
                [](const Cell& a, const Cell& b) { return joined(a, b); });
    }

    /// The potential and its gradient at a point, in the index's coordinates.
    PotentialAt<double, D> operator()(const Vec<T, D>& point) const {
        NoVisits none;
        return (*this)(point, none);
    }
    /// `count` receives the nodes opened, and the leaves with their points.
    template <class Count>
    PotentialAt<double, D> operator()(const Vec<T, D>& point, Count& count) const {
        Sum sum{PointProbe<T, D>(point), *this};
        index_.ask(sum, count);
        return sum.sum;
    }

private:
    /// What a cell's points are together.
    struct Cell {
        Box<double, D> box;
        double charge = 0, weight = 0;
        Point weighted{};  ///< Σ |q|·x
    };
    static Cell joined(const Cell& a, const Cell& b) {
        return {merged(a.box, b.box), a.charge + b.charge, a.weight + b.weight, a.weighted + b.weighted};
    }
    Cell cell_of(const Leaf& leaf) const {
        Cell cell;
        for (std::uint32_t i = leaf.first; i < leaf.first + leaf.count; ++i) {
            const Point p = place(leaf.ids[i]);
            const double charge = charges_[leaf.ids[i]];
            cell = joined(cell, {{p, p}, charge, std::abs(charge), p * std::abs(charge)});
        }
        return cell;
    }
    Point place(PrimitiveId id) const { return Point(index_.primitives().bounds(id).low); }

    struct Sum {
        using Probe = PointProbe<T, D>;
        static constexpr Order order = Order::none;
        Probe asked;
        const BarnesHut& method;
        PotentialAt<double, D> sum{};

        const Probe& probe() const { return asked; }
        static T limit() { return std::numeric_limits<T>::infinity(); }
        Flow offer(const PointCandidate<T, D>& c) {
            add(method.charges_[c.element], Point(asked.point()) - method.place(c.element));
            return Flow::go_on;
        }
        Verdict accept(const auto& node) {
            if (method.cells_.empty()) return Verdict::open;
            const Cell& cell = method.cells_[node.id()];
            if (cell.weight == 0) return Verdict::prune;
            // In its box in spite of roundings: points in one place have their center there.
            const Point center = min(max(cell.weighted / cell.weight, cell.box.low), cell.box.high);
            const Point apart = Point(asked.point()) - center;
            if (!(max_component(cell.box.extent()) < method.opening_angle_ * length(apart)))
                return Verdict::open;
            add(cell.charge, apart);
            return Verdict::accept;
        }
        void add(double charge, const Point& apart) {
            if (const double d2 = length2(apart); d2 > 0) {
                const auto [potential, slope] = method.kernel_(d2);
                sum.potential += charge * potential;
                sum.gradient = sum.gradient + apart * (charge * slope);
            }
        }
    };

    const Index& index_;
    std::span<const double> charges_;
    double opening_angle_;
    Kernel kernel_;
    std::vector<Cell> cells_;
};

struct BarnesHutOptions {
    /// A cell acts as a whole if its radius around its center of charge is less than so many times the least
    /// distance from there to a group of targets. Above 0 and below 1.
    double opening_angle = 0.5;
    /// By its quadrupole too; else as one charge.
    bool quadrupoles = true;
    Threads threads = {};
};
/// Writes the potential Σ q/r, or that of softened charges, and its gradient at each charge, of all others,
/// by the method of Barnes and Hut in vectors: one walk for each leaf of an octree, with about 48 targets, in
/// single precision (errors below 10⁻⁵ are out of reach). For masses; charges that cancel have poor centers.
/// Forces do not add up to nothing. `forces` reaches any error in less time, and keeps it; this is the method
/// of its name for those who need it. O(n log n); the same bits for any executor.
///
/// Throws as `forces` does, and UsageError for an angle out of its range. In the library `nbody`; T is float
/// or double.
template <std::floating_point T>
void barnes_hut(const Charges<T>& charges, PotentialsFound<T> found, const BarnesHutOptions& options = {});

}  // namespace hedgerow
