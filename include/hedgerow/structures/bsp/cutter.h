/// How BSP trees choose planes and cut cells.
#pragma once

#include <hedgerow/geometry/polytope.h>
#include <hedgerow/parallel/sort.h>
#include <hedgerow/structures/bsp/axis_costs.h>
#include <hedgerow/structures/bsp/build.h>
#include <hedgerow/structures/bsp/parts.h>
#include <hedgerow/structures/cells.h>
#include <hedgerow/structures/kdtree/builders/sweep.h>

namespace hedgerow {

/// Chooses planes and cuts cells. Candidates are planes across the axes beside the bounds of every part, and
/// planes that the geometry suggests: the plane of a triangle, and the planes through its edges at right
/// angles to it (Ize, Wald, Parker, RT 2008). The cost of a candidate is the SAH with the surfaces of the two
/// convex parts of the cell.
///
/// Few candidates are weighed so (docs/design/045-bsp-builds.md). Along each axis a sweep over all bounds
/// finds the best plane, with surfaces that are interpolated. The other planes are ranked by a guess of the
/// cost, and only the first few are weighed. In cells of more than `samples` primitives only some of them
/// suggest planes (BspOptions), and in large ones some parts stand for all where planes are ranked.
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
        bool is_box = true;  // the shape is the box
        BspParts<D> inside;

        std::uint32_t size() const { return inside.size(); }
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
            const Box<T, D> own = r.box();
            const Box<double, D> box{Vec<double, D>(own.low), Vec<double, D>(own.high)};
            cell.box.expand(box);
            if (const auto corners = corners_(r.id()))
                cell.inside.add(r.id(), *corners);
            else
                cell.inside.add(r.id(), box);
        }
        cell.shape = Polytope<D>(cell.box);
        return cell;
    }

    std::optional<Plane> choose(const Cell& cell, int) const {
        if (cell.size() <= leaf_size_) return std::nullopt;
        Best best{{}, costs_.intersection_cost * cell.size()};
        // A node alone may cost as much as the tests that it could save.
        if (std::min(costs_.traversal_cost, costs_.plane_cost) >= best.cost) return std::nullopt;
        const double whole = cell.shape.surface();
        if (!(whole > 0)) return std::nullopt;
        const auto offer = [&](const Plane& plane) { weigh(cell, whole, plane, best); };
        for (int axis = 0; axis < D; ++axis) offer_across(cell, whole, axis, offer);
        if (costs_.plane_cost < best.cost) offer_through_parts(cell, best.cost, offer);
        return best.plane;
    }

    std::pair<Cell, Cell> cut(const Cell& cell, const Plane& chosen) const {
        const CutPlane<D> plane = chosen.in_double(margin_);
        std::pair<Cell, Cell> sides;
        auto& [low, high] = sides;
        std::tie(low.shape, high.shape) = cell.shape.cut(plane);
        low.box = high.box = cell.box;
        low.is_box = high.is_box = cell.is_box && chosen.axis >= 0;
        if (chosen.axis >= 0) low.box.high[chosen.axis] = high.box.low[chosen.axis] = plane.offset;
        for (const auto& part : cell.inside) {
            const auto [to_low, to_high] = sides_of(cell.inside, part, plane, chosen.axis);
            if (to_low && to_high) {
                low.inside.add_side(cell.inside, part, plane, 1);
                high.inside.add_side(cell.inside, part, plane, -1);
            } else {
                (to_low ? low : high).inside.add(cell.inside, part);
            }
        }
        return sides;
    }

private:
    struct Best {
        std::optional<Plane> plane;
        double cost;
    };
    struct Counts {
        std::uint32_t low = 0, high = 0, all = 0;
    };
    /// Planes are ranked by the sides of all parts, or in larger cells of at most so many.
    static constexpr std::uint32_t most_counted = 16;
    /// How many of the planes that are not across an axis are weighed.
    static constexpr std::size_t most_weighed = 3;
    /// Beyond this many parts, their bounds are counted in so many bins along each axis.
    static constexpr std::uint32_t most_sorted = 1024;
    static constexpr std::size_t bins = 256;

    /// Whether a part is in the low cell of a plane, and whether it is in the high one.
    [[gnu::always_inline]] static std::pair<bool, bool> sides_of(const BspParts<D>& parts,
                                                                 const BspPart<D>& part,
                                                                 const CutPlane<D>& plane, int axis) {
        const double on = axis >= 0 ? -plane.margin : plane.margin / 4;
        const auto [low, high] = parts.heights(part, plane, axis);
        const bool to_high = high > on;
        return {low < -on || !to_high, to_high};
    }

    /// How many of every stride-th part are on the sides of a plane.
    static Counts count(const Cell& cell, const CutPlane<D>& plane, int axis, std::uint32_t stride) {
        Counts counts;
        for (std::uint32_t i = 0; i < cell.size(); i += stride, ++counts.all) {
            const auto [to_low, to_high] = sides_of(cell.inside, cell.inside[i], plane, axis);
            counts.low += to_low, counts.high += to_high;
        }
        return counts;
    }
    /// The SAH of a plane, by the surfaces of its sides over that of the cell.
    double cost(const Cell& cell, int axis, const Counts& counts, double low_share, double high_share) const {
        const double node = axis >= 0 ? costs_.traversal_cost : costs_.plane_cost;
        const double bonus = counts.low == 0 || counts.high == 0 ? 1 - costs_.empty_bonus : 1;
        const double test = costs_.intersection_cost * bonus * cell.size() / counts.all;
        return node + product(test, low_share * counts.low + high_share * counts.high);
    }
    /// Whether a plane separates no parts, or surely costs no less than `most`: the sides have no less
    /// surface together than the cell, so the cost is at least that of the smaller side's primitives.
    bool is_useless(const Cell& cell, int axis, const Counts& counts, double most) const {
        if (counts.low == counts.all && counts.high == counts.all) return true;
        const bool fewer_low = counts.low < counts.high;
        return cost(cell, axis, counts, fewer_low, !fewer_low) >= most;
    }
    void weigh(const Cell& cell, double whole, const Plane& candidate, Best& best) const {
        if (cell.size() > worth_a_task) executor_.look();
        const CutPlane<D> plane = candidate.in_double(margin_);
        const Counts counts = count(cell, plane, candidate.axis, 1);
        if (is_useless(cell, candidate.axis, counts, best.cost)) return;
        const auto [low, high] = cell.shape.surfaces(plane, whole);
        const double low_share = low / whole, high_share = high / whole;
        if (!(low_share > 0 && high_share > 0)) return;  // the plane misses the cell
        // A plane along a face that parts no primitives changes nothing. The next cell would choose it again.
        constexpr double all = 1 - 1e-9;
        if ((counts.low == 0 && high_share >= all) || (counts.high == 0 && low_share >= all)) return;
        const double cost = this->cost(cell, candidate.axis, counts, low_share, high_share);
        if (cost < best.cost) best = {candidate, cost};
    }

    /// Positions along an axis 1.5 margins outside of a part: a plane there has the part on one side only.
    std::pair<T, T> beside(const BspPart<D>& part, int axis) const {
        return {rounded_to<T>(part.bounds.low[axis] - 1.5 * margin_),
                rounded_to<T>(part.bounds.high[axis] + 1.5 * margin_)};
    }
    /// Offers the best of the planes across an axis, by surfaces that are interpolated.
    template <class Offer>
    void offer_across(const Cell& cell, double whole, int axis, Offer offer) const {
        const BspAxisCosts<T, D> costs({costs_.traversal_cost, costs_.intersection_cost, costs_.empty_bonus},
                                       cell.shape, whole, cell.is_box, axis);
        KdBest<T> best;
        if (cell.size() > most_sorted)
            offer_borders(cell, costs, axis, best);
        else
            offer_bounds(cell, costs, axis, best);
        if (best.cost < std::numeric_limits<double>::infinity())
            offer(Plane::across(axis, best.plane.position));
    }
    /// Offers the planes beside all parts. O(n log n).
    void offer_bounds(const Cell& cell, const BspAxisCosts<T, D>& costs, int axis, KdBest<T>& best) const {
        std::vector<KdEvent<T>> events;
        events.reserve(2 * cell.size());
        for (std::uint32_t i = 0; i < cell.size(); ++i) {
            const auto [low, high] = beside(cell.inside[i], axis);
            events.emplace_back(low, i, true);
            events.emplace_back(high, i, false);
        }
        std::sort(events.begin(), events.end());
        sweep_events(events, cell.size(), costs, best);
    }
    /// Offers the borders of equal bins. O(n).
    void offer_borders(const Cell& cell, const BspAxisCosts<T, D>& costs, int axis, KdBest<T>& best) const {
        if (!(costs.width() > 0)) return;
        const double scale = static_cast<double>(bins) / costs.width();
        const auto bin = [&](double x) {
            const double place = product(x - costs.low(), scale);
            return static_cast<std::size_t>(std::clamp(place, 0.0, static_cast<double>(bins - 1)));
        };
        std::array<std::uint32_t, bins> begins{}, ends{};
        for (const auto& part : cell.inside)
            ++begins[bin(part.bounds.low[axis])], ++ends[bin(part.bounds.high[axis])];
        std::uint32_t on_low = 0, on_high = cell.size();
        for (std::size_t b = 1; b < bins; ++b) {
            on_low += begins[b - 1], on_high -= ends[b - 1];
            costs.offer(rounded_to<T>(costs.low() + static_cast<double>(b) / scale), on_low, on_high, best);
        }
    }

    /// Offers the best of the planes that parts suggest and that may cost less than `most`, by a guess: the
    /// surfaces of a plane's sides are taken to be in proportion to their extents across it.
    template <class Offer>
    void offer_through_parts(const Cell& cell, double most, Offer offer) const {
        const std::uint32_t apart = cell.size() > samples_ ? cell.size() / samples_ : 1;
        const std::uint32_t stride = (cell.size() + most_counted - 1) / most_counted;
        std::array<std::pair<double, Plane>, most_weighed> ranked;
        std::size_t kept = 0;
        const auto rank = [&](const Plane& candidate) {
            const CutPlane<D> plane = candidate.in_double(margin_);
            const Counts counts = count(cell, plane, candidate.axis, stride);
            if (is_useless(cell, candidate.axis, counts, most)) return;
            const auto [low, high] = cell.shape.heights(plane);
            const double share = std::clamp(-low / (high - low), 0.0, 1.0);
            const double guess = cost(cell, candidate.axis, counts, share, 1 - share);
            // Insert the plane before those of higher guesses.
            std::size_t place = kept;
            while (place > 0 && guess < ranked[place - 1].first) --place;
            if (place == most_weighed) return;
            kept = std::min(kept + 1, most_weighed);
            std::move_backward(ranked.begin() + static_cast<std::ptrdiff_t>(place),
                               ranked.begin() + static_cast<std::ptrdiff_t>(kept) - 1,
                               ranked.begin() + static_cast<std::ptrdiff_t>(kept));
            ranked[place] = {guess, candidate};
        };
        for (std::uint32_t i = 0; i < cell.size(); i += apart) {
            if (cell.inside[i].count == 0) continue;
            if (const auto corners = corners_(cell.inside[i].id)) for_each_plane_through(*corners, rank);
        }
        for (std::size_t i = 0; i < kept; ++i) offer(ranked[i].second);
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
