/// How BSP trees choose planes and cut cells.
#pragma once

#include <hedgerow/geometry/polytope.h>
#include <hedgerow/parallel/sort.h>
#include <hedgerow/structures/bsp/build.h>
#include <hedgerow/structures/cells.h>
#include <hedgerow/structures/kdtree/builders/sweep.h>

namespace hedgerow {

/// A primitive's part in a cell: the corners of a convex part of the primitive (`exact`), or those of its
/// whole box.
template <int D>
struct BspPart {
    PrimitiveId id;
    bool exact;
    std::vector<Vec<double, D>> corners;

    /// Least and greatest height over a plane.
    std::pair<double, double> heights(const CutPlane<D>& plane) const {
        double low = plane.height(corners[0]), high = low;
        for (std::size_t i = 1; i < corners.size(); ++i) {
            const double h = plane.height(corners[i]);
            low = std::min(low, h), high = std::max(high, h);
        }
        return {low, high};
    }
    /// Least and greatest coordinate along an axis.
    std::pair<double, double> reach(int axis) const {
        double low = corners[0][axis], high = low;
        for (const auto& c : corners) low = std::min(low, c[axis]), high = std::max(high, c[axis]);
        return {low, high};
    }
    /// The part on one side of a plane (sign 1: low, −1: high) or within the plane's margin of that side. A
    /// box stays whole.
    BspPart side(const CutPlane<D>& plane, double sign) const {
        if (!exact) return *this;
        BspPart kept{id, true, {}};
        for (std::size_t i = 0; i < corners.size(); ++i) {
            const auto &p = corners[i], &q = corners[(i + 1) % corners.size()];
            const double a = sign * plane.height(p) - plane.margin, b = sign * plane.height(q) - plane.margin;
            if (a <= 0) kept.corners.push_back(p);
            if ((a < 0 && b > 0) || (a > 0 && b < 0)) kept.corners.push_back(p + (q - p) * (a / (a - b)));
        }
        return kept;
    }
};

/// Chooses planes and cuts cells. Candidates are planes across the axes at the bounds of every part, and
/// planes that the geometry suggests: the plane of a triangle, and the planes through its edges at right
/// angles to it (Ize, Wald, Parker, RT 2008). The cost of a candidate is the SAH with the surfaces of the two
/// convex parts of the cell. In cells of more than `samples` primitives only some of them suggest planes
/// (BspOptions). There the sweep of the kd-tree also finds the best plane across each axis over all bounds,
/// as if the cell were a box.
///
/// Heights within a fourth of a plane's margin count as on the plane. A primitive that is wholly on a plane
/// is in the low cell only, since a probe treats a plane as thick as its margin. A probe adds no margin to a
/// plane across an axis: there a primitive that comes within the margin is in both cells.
template <std::floating_point T, int D>
class BspCutter {
public:
    using Plane = BspPlane<T, D>;
    struct Cell {
        Polytope<D> shape;
        Box<double, D> box;
        std::vector<BspPart<D>> inside;

        std::uint32_t size() const { return static_cast<std::uint32_t>(inside.size()); }
        template <class F>
        void for_each_id(F f) const {
            for (const auto& part : inside) f(part.id);
        }
    };

    BspCutter(CornersOf<T, D> corners, const BspOptions& options, double margin, Executor& executor)
        : executor_(executor),
          corners_(corners),
          costs_(options.costs),
          leaf_size_(options.leaf_size),
          samples_(std::max(1u, options.samples)),
          margin_(margin) {}

    Cell root(const ReferenceList<T, D>& references) const {
        Cell cell;
        for (const auto& r : references) {
            const auto b = r.box();
            cell.box.expand(Box<double, D>{Vec<double, D>(b.low), Vec<double, D>(b.high)});
            cell.inside.push_back(whole(r.id(), b));
        }
        cell.shape = Polytope<D>(cell.box);
        return cell;
    }

    std::optional<Plane> choose(const Cell& cell, int) const {
        if (cell.size() <= leaf_size_) return std::nullopt;
        Best best{{}, costs_.intersection_cost * cell.size()};
        const double whole = cell.shape.surface();
        if (!(whole > 0)) return std::nullopt;
        const auto offer = [&](const Plane& plane) { weigh(cell, whole, plane, best); };
        const bool small = cell.size() <= samples_;
        if (!small) offer_sweep(cell, offer);
        const std::uint32_t stride = small ? 1 : cell.size() / samples_;
        for (std::uint32_t i = 0; i < cell.size(); i += stride) offer_around(cell, cell.inside[i], offer);
        return best.plane;
    }

    std::pair<Cell, Cell> cut(const Cell& cell, const Plane& chosen) const {
        const CutPlane<D> plane = chosen.in_double(margin_);
        std::pair<Cell, Cell> sides;
        auto& [low, high] = sides;
        std::tie(low.shape, high.shape) = cell.shape.cut(plane);
        low.box = high.box = cell.box;
        if (chosen.axis >= 0) low.box.high[chosen.axis] = high.box.low[chosen.axis] = plane.offset;
        for (const auto& part : cell.inside) {
            const auto [to_low, to_high] = sides_of(part, plane, chosen.axis >= 0);
            if (to_low && to_high) {
                low.inside.push_back(part.side(plane, 1));
                high.inside.push_back(part.side(plane, -1));
            } else {
                (to_low ? low : high).inside.push_back(part);
            }
        }
        return sides;
    }

private:
    struct Best {
        std::optional<Plane> plane;
        double cost;
    };

    /// The whole primitive: its corners if the set has them, otherwise the corners of its box.
    BspPart<D> whole(PrimitiveId id, const Box<T, D>& box) const {
        BspPart<D> part{id, false, {}};
        if (const auto corners = corners_(id)) {
            part.exact = true;
            for (const auto& c : *corners) part.corners.emplace_back(c);
        } else {
            for (int i = 0; i < 1 << D; ++i) {
                Vec<double, D> p;
                for (int k = 0; k < D; ++k) p[k] = static_cast<double>(i >> k & 1 ? box.high[k] : box.low[k]);
                part.corners.push_back(p);
            }
        }
        return part;
    }

    /// Whether a part is in the low cell of a plane, and whether it is in the high one.
    static std::pair<bool, bool> sides_of(const BspPart<D>& part, const CutPlane<D>& plane,
                                          bool across_axis) {
        const auto [low, high] = part.heights(plane);
        const double on = across_axis ? -plane.margin : plane.margin / 4;
        const bool to_high = high > on;
        return {low < -on || !to_high, to_high};
    }

    void weigh(const Cell& cell, double whole, const Plane& candidate, Best& best) const {
        if (cell.size() > worth_a_task) executor_.look();
        const CutPlane<D> plane = candidate.in_double(margin_);
        // Count the parts on each side, and skip a plane that separates none.
        std::uint32_t on_low = 0, on_high = 0;
        for (const auto& part : cell.inside) {
            const auto [to_low, to_high] = sides_of(part, plane, candidate.axis >= 0);
            on_low += to_low, on_high += to_high;
        }
        if (on_low == cell.size() && on_high == cell.size()) return;
        // Cutting the cell is dear. Skip it where the node alone costs as much as the best plane so far.
        const double node = candidate.axis >= 0 ? costs_.traversal_cost : costs_.plane_cost;
        const double bonus = on_low == 0 || on_high == 0 ? 1 - costs_.empty_bonus : 1;
        if (node >= best.cost) return;
        const auto [low, high] = cell.shape.cut(plane);
        const double low_share = low.surface() / whole, high_share = high.surface() / whole;
        if (!(low_share > 0 && high_share > 0)) return;  // the plane misses the cell
        // A plane along a face that parts no primitives changes nothing. The next cell would choose it again.
        constexpr double all = 1 - 1e-9;
        if ((on_low == 0 && high_share >= all) || (on_high == 0 && low_share >= all)) return;
        // The SAH, with areas relative to the cell's.
        const double cost =
            node + product(costs_.intersection_cost * bonus, low_share * on_low + high_share * on_high);
        if (cost < best.cost) best = {candidate, cost};
    }

    /// Positions along an axis 1.5 margins outside of a part: a plane there has the part on one side only.
    std::pair<T, T> beside(const BspPart<D>& part, int axis) const {
        const auto [low, high] = part.reach(axis);
        return {rounded_to<T>(low - 1.5 * margin_), rounded_to<T>(high + 1.5 * margin_)};
    }
    /// Offers for each axis the plane that the kd-tree would choose. O(n log n).
    template <class Offer>
    void offer_sweep(const Cell& cell, Offer offer) const {
        const KdCosts costs{costs_.traversal_cost, costs_.intersection_cost, costs_.empty_bonus};
        const Box<double, D> bounds = intersection(cell.shape.bounds(), cell.box);
        const Box<T, D> box{Vec<T, D>(bounds.low), Vec<T, D>(bounds.high)};
        std::vector<KdEvent<T>> events;
        events.reserve(2 * cell.inside.size());
        for (int axis = 0; axis < D; ++axis) {
            events.clear();
            for (std::uint32_t i = 0; i < cell.size(); ++i) {
                const auto [low, high] = beside(cell.inside[i], axis);
                events.emplace_back(low, i, true);
                events.emplace_back(high, i, false);
            }
            sort_watched(events.begin(), events.end(), executor_);
            KdBest<T> best;
            sweep_events(events, cell.size(), KdAxisCosts<T, D>(costs, box, axis), best);
            if (best.cost < std::numeric_limits<double>::infinity())
                offer(Plane::across(axis, best.plane.position));
        }
    }
    /// Offers the planes that a part suggests.
    template <class Offer>
    void offer_around(const Cell& cell, const BspPart<D>& part, Offer offer) const {
        for (int axis = 0; axis < D; ++axis) {
            const auto [low, high] = beside(part, axis);
            if (static_cast<double>(low) > cell.box.low[axis]) offer(Plane::across(axis, low));
            if (static_cast<double>(high) < cell.box.high[axis]) offer(Plane::across(axis, high));
        }
        if (const auto corners = corners_(part.id)) for_each_plane_through(*corners, offer);
    }

    /// Offers the plane of a triangle, and the planes through its edges at right angles to it.
    template <class Offer>
    static void for_each_plane_through(const std::array<Vec<T, 3>, 3>& corners, Offer offer) {
        const std::array<Vec3d, 3> p = {Vec3d(corners[0]), Vec3d(corners[1]), Vec3d(corners[2])};
        const Vec3d normal = normalized(cross(p[1] - p[0], p[2] - p[0]));
        if (!(length2(normal) > 0.5)) return;
        offer_plane(normal, p[0], offer);
        for (std::size_t i = 0; i < 3; ++i)
            offer_plane(normalized(cross(normal, p[(i + 1) % 3] - p[i])), p[i], offer);
    }
    /// Offers the line of a segment, and the lines through its ends at right angles to it.
    template <class Offer>
    static void for_each_plane_through(const std::array<Vec<T, 2>, 2>& corners, Offer offer) {
        const Vec2d a(corners[0]), b(corners[1]), along = normalized(b - a);
        if (!(length2(along) > 0.5)) return;
        offer_plane(Vec2d(-along[1], along[0]), a, offer);
        offer_plane(along, a, offer);
        offer_plane(along, b, offer);
    }
    template <class Offer>
    static void offer_plane(const Vec<double, D>& normal, const Vec<double, D>& through, Offer offer) {
        for (int axis = 0; axis < D; ++axis)
            if (std::abs(normal[axis]) > 1 - 1e-9)
                return offer(Plane::across(axis, rounded_to<T>(through[axis])));
        const Vec<T, D> stored(normal);
        offer(Plane{stored, rounded_to<T>(dot(Vec<double, D>(stored), through)), -1});
    }

    Executor& executor_;
    CornersOf<T, D> corners_;
    BspCosts costs_;
    std::uint32_t leaf_size_, samples_;
    double margin_;
};

}  // namespace hedgerow
