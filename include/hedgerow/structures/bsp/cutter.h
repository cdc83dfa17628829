/// How BSP trees choose planes and cut cells.
#pragma once

#include <hedgerow/geometry/polytope.h>
#include <hedgerow/parallel/sort.h>
#include <hedgerow/structures/bsp/axis_costs.h>
#include <hedgerow/structures/bsp/build.h>
#include <hedgerow/structures/bsp/part_lanes.h>
#include <hedgerow/structures/bsp/suggested_planes.h>
#include <hedgerow/structures/cells.h>
#include <hedgerow/structures/kdtree/builders/sweep.h>

namespace hedgerow {

/// Chooses planes and cuts cells. Candidates are planes across the axes beside the bounds of every part, and
/// planes that the geometry suggests: the plane of a triangle, and the planes through its edges at right
/// angles to it (Ize, Wald, Parker, RT 2008). The cost of a candidate is the SAH with the surfaces of the two
/// convex parts of the cell.
///
/// Few candidates are weighed so (docs/design/045-bsp-builds.md). A sweep over all bounds along each axis
/// finds the best plane across one, with surfaces that are interpolated. The other planes are ranked by a
/// guess of the cost, and only the first few are weighed. In cells of more than `samples` primitives only
/// some of them suggest planes (BspOptions), and some parts stand for all where planes are ranked. Large
/// cells are few, and their planes decide how often primitives repeat, so there more planes are suggested,
/// counted and weighed.
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
        bool is_box = true;  // the shape is a box
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
        Box<double, D> all;
        for (const auto& r : references) {
            const Box<T, D> own = r.box();
            const Box<double, D> box{Vec<double, D>(own.low), Vec<double, D>(own.high)};
            all.expand(box);
            if (const auto corners = corners_(r.id()))
                cell.inside.add(r.id(), *corners);
            else
                cell.inside.add(r.id(), box);
        }
        cell.shape = Polytope<D>(all);
        return cell;
    }

    std::optional<Plane> choose(const Cell& cell, int) const {
        if (!may_pay_to_cut(cell)) return std::nullopt;
        Best best{{}, costs_.intersection_cost * cell.size()};
        const double whole = cell.shape.surface();
        if (!(whole > 0)) return std::nullopt;
        const auto offer = [&](const Plane& plane) { weigh(cell, whole, plane, best); };
        // Weigh the best plane across an axis, by surfaces that are interpolated.
        double volume = 0;
        KdBest<T> across;
        for (int axis = 0; axis < D; ++axis) {
            const BspAxisCosts<T, D> costs(
                {costs_.traversal_cost, costs_.intersection_cost, costs_.empty_bonus}, cell.shape, whole,
                cell.is_box, axis);
            volume += costs.volume() / D;
            if (cell.size() > most_sorted)
                find_border(cell, costs, axis, across);
            else
                find_bound(cell, costs, axis, across);
        }
        if (across.cost < best.cost) offer(Plane::across(across.plane.axis, across.plane.position));
        offer_through_parts(cell, volume / whole, best.cost, offer);
        return best.plane;
    }

    std::pair<Cell, Cell> cut(const Cell& cell, const Plane& chosen) const {
        const CutPlane<D> plane = chosen.in_double(margin_);
        std::pair<Cell, Cell> sides;
        auto& [low, high] = sides;
        std::tie(low.shape, high.shape) = cell.shape.cut(plane);
        low.is_box = high.is_box = cell.is_box && chosen.axis >= 0;
        for (const auto& part : cell.inside) {
            const auto [to_low, to_high] = sides_of(cell.inside, part, plane, chosen.axis);
            if (to_low && to_high) {
                low.inside.add_side(cell.inside, part, plane, 1);
                high.inside.add_side(cell.inside, part, plane, -1);
            } else {
                (to_low ? low : high).inside.add(cell.inside, part);
            }
        }
        const Box<double, D> whole = cell.shape.bounds();
        restore_shape(low, whole), restore_shape(high, whole);
        return sides;
    }

private:
    struct Best {
        std::optional<Plane> plane;
        double cost;
    };
    /// How planes that are not across an axis are chosen in a cell: so many parts suggest them at least, they
    /// are ranked by the sides of at most so many parts, and so many are weighed.
    struct Effort {
        std::uint32_t samples, counted;
        std::size_t weighed;
    };
    static constexpr std::size_t most_weighed = 16;
    Effort effort(const Cell& cell) const {
        constexpr std::uint32_t large = 64;
        if (cell.size() > large) return {2 * samples_, large, most_weighed};
        return {samples_, 16, 3};
    }
    /// Beyond this many parts, their bounds are counted in so many bins along each axis.
    static constexpr std::uint32_t most_sorted = 256;
    static constexpr std::size_t bins = 128;

    /// Heights up to this count as on the plane.
    static double on_plane(const CutPlane<D>& plane, int axis) {
        return axis >= 0 ? -plane.margin : plane.margin / 4;
    }
    /// Whether a part is in the low cell of a plane, and whether it is in the high one.
    [[gnu::always_inline]] static std::pair<bool, bool> sides_of(const BspParts<D>& parts,
                                                                 const BspPart<D>& part,
                                                                 const CutPlane<D>& plane, int axis) {
        const double on = on_plane(plane, axis);
        const auto [low, high] = parts.heights(part, plane, axis);
        const bool to_high = high > on;
        return {low < -on || !to_high, to_high};
    }

    /// Whether a cut may save more tests than its node costs.
    bool may_pay_to_cut(const Cell& cell) const {
        return cell.size() > leaf_size_ &&
               std::min(costs_.traversal_cost, costs_.plane_cost) < costs_.intersection_cost * cell.size();
    }
    /// Takes the box around the parts, within the cell that was cut, as the shape of a cell that is much
    /// shorter than that. Between planes that coincide up to roundings a cell is a splinter, although within
    /// the margin of these planes it holds all that lies along them.
    void restore_shape(Cell& cell, const Box<double, D>& within) const {
        if (!may_pay_to_cut(cell)) return;
        const auto length = [](const Box<double, D>& box) { return max_component(box.high - box.low); };
        Box<double, D> around;
        for (const auto& part : cell.inside) around.expand(part.bounds);
        const auto margin = Vec<double, D>::all(margin_);
        around = intersection(around, Box<double, D>{within.low - margin, within.high + margin});
        if (around.empty()) return;
        if (!cell.shape.empty() && length(around) <= 2 * length(cell.shape.bounds())) return;
        cell.shape = Polytope<D>(around);
        cell.is_box = true;
    }
    double node_cost(int axis) const { return axis >= 0 ? costs_.traversal_cost : costs_.plane_cost; }
    /// Of `all` parts that stand for a cell, how many on both sides of a plane make it useless: the plane
    /// then costs at least `most`, which is at most the cost of testing all parts. The sides have no less
    /// surface together than the cell, so a plane costs at least the tests of its smaller side.
    std::uint32_t too_many(const Cell& cell, int axis, std::uint32_t all, double most) const {
        const double share = (most - node_cost(axis)) / (costs_.intersection_cost * cell.size());
        return static_cast<std::uint32_t>(std::ceil(std::clamp(share, 0.0, 1.0) * all));
    }
    /// How many parts are on the sides of a plane, or fewer once `enough` are on both.
    static BspCounts count(const Cell& cell, const CutPlane<D>& plane, int axis, std::uint32_t enough) {
        BspCounts counts{0, 0, cell.size()};
        for (const auto& part : cell.inside) {
            const auto [to_low, to_high] = sides_of(cell.inside, part, plane, axis);
            counts.low += to_low, counts.high += to_high;
            if (counts.smaller() >= enough) break;
        }
        return counts;
    }
    /// The SAH of a plane, by the surfaces of its sides over that of the cell.
    double cost(const Cell& cell, int axis, const BspCounts& counts, double low_share,
                double high_share) const {
        const double bonus = counts.low == 0 || counts.high == 0 ? 1 - costs_.empty_bonus : 1;
        const double test = costs_.intersection_cost * bonus * cell.size() / counts.all;
        return node_cost(axis) + product(test, low_share * counts.low + high_share * counts.high);
    }
    void weigh(const Cell& cell, double whole, const Plane& candidate, Best& best) const {
        if (cell.size() > worth_a_task) executor_.look();
        const CutPlane<D> plane = candidate.in_double(margin_);
        const std::uint32_t enough = too_many(cell, candidate.axis, cell.size(), best.cost);
        const BspCounts counts = count(cell, plane, candidate.axis, enough);
        if (counts.smaller() >= enough) return;
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
    /// Finds the best plane across an axis beside a part. O(n log n).
    void find_bound(const Cell& cell, const BspAxisCosts<T, D>& costs, int axis, KdBest<T>& best) const {
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
    /// Finds the best border of equal bins along an axis. O(n).
    void find_border(const Cell& cell, const BspAxisCosts<T, D>& costs, int axis, KdBest<T>& best) const {
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
    /// cell is taken to be a prism along the plane's normal, with the cell's volume, surface and extent.
    /// `mean_depth` is the volume over the surface.
    template <class Offer>
    void offer_through_parts(const Cell& cell, double mean_depth, double most, Offer offer) const {
        // A node alone may cost as much. Sets without corners suggest no planes.
        if (costs_.plane_cost >= most || cell.inside[0].count == 0) return;
        const auto [samples, counted, weighed] = effort(cell);
        const std::uint32_t apart = std::max(1u, cell.size() / samples);
        const BspPartLanes<T, D> sample(cell.inside, (cell.size() + counted - 1) / counted);
        std::array<std::pair<double, Plane>, most_weighed> ranked;
        std::size_t kept = 0;
        const auto rank = [&, weighed = weighed](const Plane& candidate) {
            const CutPlane<D> plane = candidate.in_double(margin_);
            const double worst = kept == weighed ? ranked[kept - 1].first : most;
            const std::uint32_t enough = too_many(cell, candidate.axis, sample.size(), worst);
            const BspCounts counts = sample.count(plane, on_plane(plane, candidate.axis), enough);
            if (counts.smaller() >= enough) return;
            const auto [low, high] = cell.shape.heights(plane);
            if (!(low < high)) return;
            const double ends = std::min(2 * mean_depth / (high - low), 1.0);  // over the surface of the cell
            const double below = product(std::clamp(-low / (high - low), 0.0, 1.0), 1 - ends);
            const double guess = cost(cell, candidate.axis, counts, ends + below, 1 - below);
            // Insert the plane before those of higher guesses.
            std::size_t place = kept;
            while (place > 0 && guess < ranked[place - 1].first) --place;
            if (place == weighed) return;
            kept = std::min(kept + 1, weighed);
            std::move_backward(ranked.begin() + static_cast<std::ptrdiff_t>(place),
                               ranked.begin() + static_cast<std::ptrdiff_t>(kept) - 1,
                               ranked.begin() + static_cast<std::ptrdiff_t>(kept));
            ranked[place] = {guess, candidate};
        };
        for (std::uint32_t i = 0; i < cell.size(); i += apart) {
            if (const auto corners = corners_(cell.inside[i].id)) for_each_plane_through(*corners, rank);
        }
        for (std::size_t i = 0; i < kept; ++i) offer(ranked[i].second);
    }

    Executor& executor_;
    CornersOf<T, D> corners_;
    BspCosts costs_;
    std::uint32_t leaf_size_, samples_;
    double margin_;
};

}  // namespace hedgerow
