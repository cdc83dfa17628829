/// A ray as a probe: conservative slabs, intervals cut by planes, and a walk through a lattice's cells.
#pragma once

#include <algorithm>
#include <optional>
#include <tuple>

#include <hedgerow/geometry/box_pair.h>
#include <hedgerow/geometry/box_rows.h>
#include <hedgerow/geometry/entry.h>
#include <hedgerow/geometry/lanes.h>
#include <hedgerow/geometry/lattice.h>
#include <hedgerow/probes/concepts.h>

namespace hedgerow {

/// A ray as a probe, prepared for a scene.
///
/// Every hit that a primitive test reports is within e = 16u·M + 4u·|o| of the primitive's own box. Here o is
/// the ray's origin, u the unit roundoff, and M the largest component of |corner − o| over the scene's box.
/// Two errors add up. The test's own error is under 8u·M: corners relative to o carry u·M, the shear 4u·M
/// more, and t is rounded by u·M. Computing a plane's t from o ± e (the difference, the reciprocal and the
/// product) costs at most 4u·M + 2u·|o|. e covers both with room to spare. Where t or a position may
/// underflow, a few subnormal steps of each are added to e. Hence a box that holds the hit primitive is
/// always entered at or before the hit's t, in every structure alike.
template <std::floating_point T, int D>
class RayProbe {
public:
    using Scalar = T;
    static constexpr int dimension = D;
    using State = Interval<T>;
    using Cell = typename Lattice<D>::Cell;

    /// `more` is added to e, for primitives whose hits err by more than their own test does.
    RayProbe(const Ray<T, D>& ray, const Box<T, D>& scene, T more = T(0)) : ray_(ray) {
        using L = Lanes<T>;
        using limits = std::numeric_limits<T>;
        // Treat subnormal components of the direction as 0.
        const L o = L::of(ray.origin), d = L::of(ray.direction).normal_or_zero();
        ray_.direction = first<D>(d);
        if (ray_.t_min < 0) ray_.t_min = T(0);
        // Reject a ray that cannot hit anything.
        const T longest = greatest(abs(d));
        const unsigned sound =
            less_equal(abs(d), L::all(limits::max())) & less_equal(abs(o), L::all(largest_coordinate<T>));
        usable_ = sound == 15u && longest > 0 && ray_.t_min <= ray_.t_max && !scene.empty();
        if (!usable_) return;

        // Move the origin by e: forward for near planes and back for far ones, so that boxes are entered
        // early and left late.
        slack_ = error_over(scene, 16 * unit_roundoff<T>) + more;
        const L outward = copysign(L::all(slack_), d);
        (o + outward).store(near_origin_);
        (o - outward).store(far_origin_);
        (L::all(T(1)) / d).store(inverse_);  // infinite for 0: only whether o ± e is inside matters then
        const unsigned down = d.negative();
        for (int i = 0; i < D; ++i) {
            near_row_[i] = static_cast<int>(down >> i & 1u) * 2;
            pair_origin_[i] = L::halves(near_origin_[i], far_origin_[i]);
            pair_inverse_[i] = L::halves(inverse_[i], -inverse_[i]);
        }
        if constexpr (D == 3) watertight_ = WatertightRay<T>(ray_.origin, ray_.direction);
    }

    const Ray<T, D>& ray() const { return ray_; }
    const WatertightRay<T>& watertight() const requires(D == 3) { return watertight_; }
    /// False if nothing can be hit: no usable direction, a coordinate that is NaN or too large, an empty
    /// interval or an empty scene.
    bool usable() const { return usable_; }
    /// The error bound e of hits in the scene.
    T slack() const { return slack_; }
    /// Whether a hit at t is within e of a primitive's own box, where e is computed over that box alone, so
    /// that the result depends on no other primitive. Uses 15u·M instead of 16u·M, so that this e never
    /// exceeds the slack, although it may add subnormal steps that the slack leaves out.
    bool meets_within_error(const Box<T, D>& own, T t) const {
        const T error = error_over(own, 15 * unit_roundoff<T>);
        const auto outward = [&](int i) { return std::copysign(error, ray_.direction[i]); };
        const Interval<T> in = slabs(
            own, std::numeric_limits<T>::infinity(), [&](int i) { return ray_.origin[i] + outward(i); },
            [&](int i) { return ray_.origin[i] - outward(i); });
        return in.entry <= t && t <= in.exit;
    }

    /// Tests a box. A NaN (0·∞) arises only where a plane is at exactly o ± e and the direction along its
    /// axis is 0. The comparisons then leave the interval as it is, so no hit within e is lost.
    bool enter(const Box<T, D>& box, T limit, T& at) const {
        const Interval<T> in = inside(box, limit);
        at = in.entry;
        return in.entry <= in.exit;
    }
    /// The conservative interval of the ray in a box, up to a limit.
    Interval<T> inside(const Box<T, D>& box, T limit) const {
        return slabs(
            box, limit, [&](int i) { return near_origin_[i]; }, [&](int i) { return far_origin_[i]; });
    }
    /// Tests two boxes at once. The low lanes hold entries and the high lanes negated exits, so that one
    /// maximum serves both. `at` has room for four.
    unsigned enter(const BoxPair<T, D>& pair, T limit, T* at) const {
        using L = Lanes<T>;
        L t = L::halves(ray_.t_min, -limit);
        for (int i = 0; i < D; ++i) {
            const T* row = pair.plane[i];
            const L planes = L::load_pairs(row + near_row_[i], row + (2 - near_row_[i]));
            t = max((planes - pair_origin_[i]) * pair_inverse_[i], t);
        }
        t.store(at);
        return less_equal(t + t.halves_swapped(), L::all(T(0))) & 3u;
    }
    unsigned enter(const BoxRows<T, D>& boxes, T limit, T* at) const {
        using L = Lanes<T>;
        return boxes.by_fours([&](int k) {
            L entry = L::all(ray_.t_min), exit = L::all(limit);
            for (int i = 0; i < D; ++i) {
                const bool down = near_row_[i] != 0;
                const L near = L::load((down ? boxes.high(i) : boxes.low(i)) + k);
                const L far = L::load((down ? boxes.low(i) : boxes.high(i)) + k);
                const L inverse = L::all(inverse_[i]);
                entry = max((near - L::all(near_origin_[i])) * inverse, entry);
                exit = min((far - L::all(far_origin_[i])) * inverse, exit);
            }
            entry.store(at + k);
            return less_equal(entry, exit);
        });
    }
    /// Tests any other volume (geometry/volumes.h) by the part of the line inside it. Computed in double;
    /// only `at` is rounded to T, which is monotone.
    template <class Volume>
    requires requires(const ThickLine<D>& l, const Volume& v) { part_in(l, v); }
    bool enter(const Volume& volume, T limit, T& at) const {
        const ThickLine<D> line = thick_line();
        const Interval<double> in = part_in(line, volume);
        const double entry = std::max(in.entry * line.unit, static_cast<double>(ray_.t_min));
        at = static_cast<T>(entry);
        return entry <= std::min(in.exit * line.unit, static_cast<double>(limit));
    }
    template <class Pack>
    requires(Pack::width > 0) unsigned enter(const Pack& pack, T limit, T* at) const {
        return enter_each(*this, pack, limit, at);
    }
    /// The ray's line, 4e thick. A hit is within e of its primitive. Computing where the line enters a volume
    /// errs by less than 8u·M + 8u·|o| (for a plane: height, slope and quotient), which is less than the
    /// other 3e.
    ThickLine<D> thick_line() const {
        const double unit = this->unit();
        return {Vec<double, D>(ray_.origin), Vec<double, D>(ray_.direction) * unit,
                4 * static_cast<double>(slack_), unit};
    }

    State root(const Box<T, D>& box) const { return inside(box, ray_.t_max); }
    bool within(const State& s, T limit) const {
        const T exit = s.exit < limit ? s.exit : limit;
        return s.entry <= exit;
    }
    /// Cuts by a plane across an axis. The plane is as thick as the error: the ray enters each side a little
    /// earlier and leaves it a little later.
    Cut<State> cut(const State& s, const AxisPlane<T>& plane, T limit) const {
        const int a = plane.axis;
        const T leave = (plane.position - far_origin_[a]) * inverse_[a];
        const T arrive = (plane.position - near_origin_[a]) * inverse_[a];
        return sides(s, near_row_[a] != 0, leave, arrive, limit);
    }

    /// Cuts by any plane, in double. A ray that is parallel to the plane within the error stays on both
    /// sides, or on one. Heights and speeds err by some roundings of double, which twice the slack covers. A
    /// direction of doubles is scaled to 1 first, since its products could leave the range of double.
    Cut<State> cut(const State& s, const CutPlane<D>& plane, T limit) const {
        const double thickness = product(plane.reach(), 2 * static_cast<double>(slack_)) + plane.margin;
        const double unit = std::is_same_v<T, double> ? this->unit() : 1;
        const double approach = dot(plane.normal, Vec<double, D>(ray_.direction) * unit);
        const double height = plane.height(Vec<double, D>(ray_.origin));
        const double speed = std::abs(approach), away = approach < 0 ? height : -height;
        const T leave = static_cast<T>((away + thickness) / speed * unit);
        const T arrive = static_cast<T>((away - thickness) / speed * unit);
        return sides(s, approach < 0, leave, arrive, limit);
    }

    /// Visits the cells along the ray in order (Amanatides and Woo 1987). Each crossing is computed afresh
    /// from the cell's integer coordinates, not accumulated. `limit()` is called before each step.
    /// `visit(cell)` may stop the walk, or report that a block of cells is empty. The walk then skips to
    /// where the ray leaves that block, and computes the next cell from that position, which errs by less
    /// than the lattice's pad. If the error exceeds half of the pad, neighbours within reach of the error are
    /// visited too, each of them once.
    template <class Limit, class Visit>
    void sweep(const Lattice<D>& lattice, Limit limit, Visit visit) const {
        if (!usable_) return;
        const Vec<double, D> o(ray_.origin), d(ray_.direction),
            inverse = map(d, [](double x) { return 1 / x; });
        // Find the part of the ray in the lattice, and its first cell.
        const Interval<double> in = inside(lattice, o, d, inverse);
        if (!(in.entry <= in.exit)) return;
        Cell cell{};
        for (int a = 0; a < D; ++a)
            cell[static_cast<std::size_t>(a)] = lattice.coordinate(o[a] + product(d[a], in.entry), a);
        // How far the neighbours reach that must be visited too; 0 if the cell is visited alone.
        const auto reach = neighbours_within_slack(lattice);
        const bool alone = reach == Cell{};
        // How much earlier, in t, a hit in a cell may be than the computed entry of the cell.
        const double back =
            4 * static_cast<double>(slack_) / max_component(abs(d)) + 0x1p-40 * std::abs(in.entry);
        Cell ahead{}, end = cell;  // the step along each axis, and the last cell in that direction
        for (int a = 0; a < D; ++a) {
            const auto i = static_cast<std::size_t>(a);
            if (d[a] > 0) ahead[i] = 1, end[i] = lattice.resolution[i] - 1;
            if (d[a] < 0) ahead[i] = -1, end[i] = 0;
        }
        // The t at which the ray leaves cell c along axis a. Infinite in the lattice's last cell: the walk
        // ends at in.exit only, since beyond its last plane the ray may still graze the lattice.
        const auto leaves = [&](const Cell& c, int a) {
            const auto i = static_cast<std::size_t>(a);
            const double t = product(lattice.plane(c[i] + (ahead[i] > 0), a) - o[a], inverse[a]);
            return c[i] == end[i] ? std::numeric_limits<double>::infinity() : t;
        };
        double entry = in.entry;
        int stepped = -1;  // the axis of the last step
        while (entry - back <= static_cast<double>(limit()) && entry <= in.exit) {
            std::int32_t empty = 0;  // the bits of a coordinate that vary within the empty block
            // Visit the cell, or the neighbours that the last step added.
            if (alone) [[likely]] {
                const Looked looked = visit(cell);
                if (looked.flow == Flow::stop) return;
                empty = (1 << looked.empty_bits) - 1;
            } else {
                const auto added = neighbours_added(lattice, cell, reach, stepped, ahead);
                if (added && !for_each_cell(added->first, added->second,
                                            [&](const Cell& c) { return visit(c).flow != Flow::stop; }))
                    return;
            }
            Cell last;  // of the empty block, in the direction of the ray
            Vec<double, D> exit;
            for (int a = 0; a < D; ++a) {
                const auto i = static_cast<std::size_t>(a);
                last[i] = ahead[i] < 0 ? cell[i] & ~empty : std::min(cell[i] | empty, end[i]);
                exit[a] = leaves(last, a);
            }
            // Find the axis along which the ray leaves the block first.
            int axis = exit[1] < exit[0];
            if constexpr (D == 3) axis = exit[2] < exit[axis] ? 2 : axis;
            if (!(exit[axis] < std::numeric_limits<double>::infinity())) return;
            entry = std::max(entry, exit[axis]);
            // Skip to the cell of the block that the ray leaves from, then step along that axis.
            for (int a = 0; a < D && empty != 0; ++a) {
                const auto i = static_cast<std::size_t>(a);
                const auto [low, high] = std::minmax(cell[i], last[i]);
                cell[i] = std::clamp(lattice.coordinate(o[a] + product(d[a], entry), a), low, high);
            }
            const auto i = static_cast<std::size_t>(axis);
            cell[i] = last[i] + ahead[i];
            stepped = axis;
        }
    }

private:
    /// 1 / the direction's largest component.
    double unit() const {
        double least = std::numeric_limits<double>::infinity();
        for (int i = 0; i < D; ++i) least = std::min(least, std::abs(static_cast<double>(inverse_[i])));
        return least;
    }
    /// The error e over a box: share·M + 4u·|o|, and some subnormal steps where t may underflow.
    T error_over(const Box<T, D>& box, T share) const {
        using L = Lanes<T>;
        const L o = L::of(ray_.origin);
        const T reach = greatest(max(abs(L::of(box.low) - o), abs(L::of(box.high) - o)));
        const T longest = greatest(abs(L::of(ray_.direction)));
        constexpr T steps = 16 * std::numeric_limits<T>::denorm_min(),
                    negligible = unit_roundoff<T> / (2 * steps);
        T error = product(share, reach) + product(4 * unit_roundoff<T>, greatest(abs(o)));
        if (1 + longest > reach * negligible) [[unlikely]]
            error += product(steps, 1 + longest);
        return error;
    }
    template <class Near, class Far>
    Interval<T> slabs(const Box<T, D>& box, T limit, Near near_origin, Far far_origin) const {
        Interval<T> in{ray_.t_min, limit};
        for (int i = 0; i < D; ++i) {
            const bool down = near_row_[i] != 0;
            const T near = ((down ? box.high[i] : box.low[i]) - near_origin(i)) * inverse_[i];
            const T far = ((down ? box.low[i] : box.high[i]) - far_origin(i)) * inverse_[i];
            in.entry = near > in.entry ? near : in.entry;
            in.exit = far < in.exit ? far : in.exit;
        }
        return in;
    }
    /// The cut at a plane: the ray leaves the near side at `leave` and enters the far side at `arrive`. A NaN
    /// leaves the interval as it is, and both sides are visited.
    static Cut<State> sides(const State& s, bool near_is_high, T leave, T arrive, T limit) {
        const T last = s.exit < limit ? s.exit : limit;
        return {near_is_high,
                {s.entry, leave < s.exit ? leave : s.exit},
                {arrive > s.entry ? arrive : s.entry, s.exit},
                !(leave < s.entry),
                !(arrive > last)};
    }
    /// The part of the ray in a lattice, widened by what primitives may reach beyond the lattice.
    Interval<double> inside(const Lattice<D>& lattice, const Vec<double, D>& o, const Vec<double, D>& d,
                            const Vec<double, D>& inverse) const {
        Interval<double> in{static_cast<double>(ray_.t_min), static_cast<double>(ray_.t_max)};
        for (int a = 0; a < D; ++a) {
            const double margin = product(0.5, lattice.pad[a]) + static_cast<double>(slack_);
            const double low = lattice.low[a] - margin;
            const double high = lattice.plane(lattice.resolution[static_cast<std::size_t>(a)], a) + margin;
            if (d[a] == 0) {
                if (o[a] < low || o[a] > high) in.exit = -1;
                continue;
            }
            in.entry = std::max(in.entry, product((d[a] < 0 ? high : low) - o[a], inverse[a]));
            in.exit = std::min(in.exit, product((d[a] < 0 ? low : high) - o[a], inverse[a]));
        }
        return in;
    }
    /// How many cells beside the ray's own the error may hide hits in, along each axis. Usually 0.
    Cell neighbours_within_slack(const Lattice<D>& lattice) const {
        Cell reach{};
        const double wide = static_cast<double>(slack_);
        for (int a = 0; a < D; ++a) {
            if (wide <= product(0.5, lattice.pad[a])) continue;
            const double cells = wide / lattice.size[a] + 1,
                         most = lattice.resolution[static_cast<std::size_t>(a)];
            reach[static_cast<std::size_t>(a)] = static_cast<std::int32_t>(std::min(cells, most));
        }
        return reach;
    }
    /// The cells around `cell` that earlier steps have not visited, as the first and last cell of a block: at
    /// first all, after a step the new layer only. None if that layer is outside the lattice.
    static std::optional<std::pair<Cell, Cell>> neighbours_added(const Lattice<D>& lattice, const Cell& cell,
                                                                 const Cell& reach, int stepped,
                                                                 const Cell& ahead) {
        std::pair<Cell, Cell> block;
        for (std::size_t a = 0; a < cell.size(); ++a) {
            block.first[a] = std::max(0, cell[a] - reach[a]);
            block.second[a] = std::min(lattice.resolution[a] - 1, cell[a] + reach[a]);
        }
        if (stepped < 0) return block;
        const auto i = static_cast<std::size_t>(stepped);
        const std::int32_t layer = cell[i] + ahead[i] * reach[i];
        if (layer < 0 || layer >= lattice.resolution[i]) return std::nullopt;
        block.first[i] = block.second[i] = layer;
        return block;
    }

    Ray<T, D> ray_;
    T inverse_[4] = {}, near_origin_[4], far_origin_[4];
    Lanes<T> pair_origin_[D], pair_inverse_[D];  // near planes in the low half, far ones in the high half
    int near_row_[D] = {};
    T slack_ = T(0);
    bool usable_ = false;
    struct Nothing {};
    [[no_unique_address]] std::conditional_t<D == 3, WatertightRay<T>, Nothing> watertight_;
};

}  // namespace hedgerow
