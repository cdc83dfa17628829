/// SBVH (Stich, Friedrich, Dietrich, Spatial splits in bounding volume hierarchies, HPG 2009): where the two
/// sides of the best split of objects overlap much, a plane may cut the primitives themselves. Each side then
/// stores the bounds of its parts.
#pragma once

#include <hedgerow/structures/bvh/builders/binned.h>
#include <hedgerow/structures/cells.h>

namespace hedgerow {

/// A primitive that a plane cuts is stored on both sides or, where that costs less, whole on one (the paper's
/// unsplitting). Each range owns spare places for duplicates, and divides them between its children by their
/// sizes. So memory has a bound, and the tree is the same however many threads build it.
///
/// Spatial splits pay for long or large triangles that boxes fit badly (a turned building). They hardly pay
/// on scans, whose triangles are small beside their nodes, and on hair finer than the nodes above it
/// (docs/design/003-builders.md).
///
/// The bounds of a part are enlarged by the margin of cells.h on every side, within the bounds of the
/// reference that was cut. So the leaves of a primitive together contain every answer that lies on it.
template <std::floating_point T, int D>
class SpatialSplitter : public BinnedSplitter<T, D> {
public:
    using Base = BinnedSplitter<T, D>;

    /// `duplicates`: how many references may be added, as a share of the primitives. `overlap`: a plane is
    /// tried only where the boxes of the best split of objects overlap by at least that share of the root's
    /// area (the paper's α).
    SpatialSplitter(CornersOf<T, D> corners, ReferenceList<T, D> references, const SahOptions& options,
                    double duplicates, double overlap)
        : Base(std::move(references), options), corners_(corners), size_(this->references_.size()) {
        auto scene = LaneBox<T>::none();
        for (const auto& r : this->references_) scene.expand(r.lanes());
        if (size_ > 0) {
            margin_ = cell_margin(scene.template box<D>());
            worth_a_plane_ = overlap * static_cast<double>(scene.template half_area<D>());
        }
        const auto room = static_cast<std::size_t>(duplicates * static_cast<double>(size_));
        this->references_.resize(std::min<std::size_t>(size_ + room, 0x80000000u), Reference<T, D>({}, 0));
    }

    Range<T, D> root() const {
        auto all = Range<T, D>::over(this->references_, 0, static_cast<std::uint32_t>(size_));
        all.room = static_cast<std::uint32_t>(this->references_.size() - size_);
        return all;
    }

    bool split(const Range<T, D>& range, Range<T, D>& left, Range<T, D>& right) {
        const auto binning = this->binning_of(range);
        const auto bins = this->filled(binning, range);
        const auto objects = this->cheapest(bins, range.size());
        Plane plane;
        // Try planes if there is room and the best split of objects overlaps much.
        if (range.room > 0 && overlap_of(bins, objects) >= worth_a_plane_) plane = cheapest_plane(range);
        // Make a leaf if that costs no more than the cheaper split; otherwise make that split.
        const double cost = std::min(objects.cost, plane.cost);
        if (!(cost < std::numeric_limits<double>::infinity()) || this->cheaper_as_leaf(range, cost))
            return false;
        if (plane.cost < objects.cost && cut(range, plane, left, right)) return true;
        if (objects.axis < 0) return false;
        this->divide(range, binning, bins, objects, left, right);
        return true;
    }

private:
    struct Plane {
        double cost = std::numeric_limits<double>::infinity();
        int axis = -1;
        T position = T(0);
        LaneBox<T> left = LaneBox<T>::none(), right = LaneBox<T>::none();
        std::uint32_t on_left = 0, on_right = 0;
    };
    /// The space between two planes across an axis: the box of the parts in it, and how many primitives begin
    /// and end there.
    struct Slab {
        LaneBox<T> box = LaneBox<T>::none();
        std::uint32_t begin = 0, end = 0;
    };
    static constexpr int most_slabs = 32;

    double overlap_of(const typename Base::Bins& bins, const typename Base::Best& best) const {
        if (best.axis < 0) return std::numeric_limits<double>::infinity();
        const auto [left, right] = Base::sides(bins, best);
        const Box<T, D> shared = intersection(left.template box<D>(), right.template box<D>());
        return shared.empty() ? 0 : static_cast<double>(shared.half_area());
    }

    /// The parts of a reference on the two sides of a plane. Either may be empty.
    std::pair<Reference<T, D>, Reference<T, D>> parts(const Reference<T, D>& r, int axis, T position) const {
        Box<T, D> low = r.box(), high = low;
        low.high[axis] = std::min(low.high[axis], position + margin_);
        high.low[axis] = std::max(high.low[axis], position - margin_);
        if (const auto corners = corners_(r.id())) {
            const auto [below, above] = cut_corners(*corners, axis, position);
            low = intersection(low, below), high = intersection(high, above);
        }
        return {{low, r.id()}, {high, r.id()}};
    }
    /// Bounds, on each side of a plane, of the simplex that the corners span: bounds of the corners on that
    /// side and of the points where edges cross the plane. Their intersection with a reference's own box
    /// contains all of its part, and seldom more.
    std::pair<Box<T, D>, Box<T, D>> cut_corners(
        const std::array<Vec<T, D>, static_cast<std::size_t>(D)>& corners, int axis, T position) const {
        std::pair<Box<T, D>, Box<T, D>> sides;
        auto& [low, high] = sides;
        for (std::size_t i = 0; i < corners.size(); ++i) {
            // Add the corner to its side, and the crossing of the edge that begins there to both sides.
            const Vec<T, D>&p = corners[i], &q = corners[(i + 1) % corners.size()];
            if (p[axis] <= position) low.expand(p);
            if (p[axis] >= position) high.expand(p);
            if ((p[axis] < position) == (q[axis] < position)) continue;
            const Vec<double, D> from(p), to(q);
            const double f = (static_cast<double>(position) - from[axis]) / (to[axis] - from[axis]);
            const Vec<T, D> crossing(from * (1 - f) + to * f);
            low.expand(crossing), high.expand(crossing);
        }
        if (!low.empty()) low = enlarged(low, margin_);
        if (!high.empty()) high = enlarged(high, margin_);
        return sides;
    }

    /// Cuts the range's box into equal slabs along each axis. Returns the border of least cost whose
    /// duplicates the room allows.
    Plane cheapest_plane(const Range<T, D>& range) const {
        Plane best;
        const Box<T, D> box = range.box.template box<D>();
        const int count = std::min(most_slabs, 4 + static_cast<int>(std::min(range.size() / 20, 64u)));
        for (int axis = 0; axis < D; ++axis) {
            // Skip an axis along which slabs would be no wider than 8 margins.
            const T width = (box.high[axis] - box.low[axis]) / T(count);
            if (!(width > 8 * margin_)) continue;
            // Add the parts of all references to the slabs, then find the cheapest border.
            std::array<Slab, most_slabs> slabs;
            const auto border = [&](int i) { return box.low[axis] + product(T(i), width); };
            const auto slab = [&](T x) {
                return std::clamp(static_cast<int>((x - box.low[axis]) / width), 0, count - 1);
            };
            for (std::uint32_t i = range.first; i < range.last; ++i)
                enter(this->references_[i], axis, slab, border, slabs);
            sweep(range, axis, count, border, slabs, best);
        }
        return best;
    }
    /// Chops a reference at each border that it crosses, and adds the parts to their slabs.
    template <class SlabOf, class Border>
    void enter(const Reference<T, D>& whole, int axis, SlabOf slab, Border border,
               std::array<Slab, most_slabs>& slabs) const {
        Reference<T, D> rest = whole;
        auto at = static_cast<std::size_t>(slab(rest.low[axis]));
        const auto last = static_cast<std::size_t>(slab(rest.high[axis]));
        ++slabs[at].begin;
        ++slabs[last].end;
        for (; at < last; ++at) {
            const auto [left, right] = parts(rest, axis, border(static_cast<int>(at) + 1));
            if (!left.box().empty()) slabs[at].box.expand(left.lanes());
            rest = right;
            if (rest.box().empty()) return;
        }
        slabs[at].box.expand(rest.lanes());
    }
    template <class Border>
    void sweep(const Range<T, D>& range, int axis, int count, Border border,
               const std::array<Slab, most_slabs>& slabs, Plane& best) const {
        // Gather the box of the right side of each border, from the last border to the first.
        std::array<LaneBox<T>, most_slabs> right_box;
        auto box = LaneBox<T>::none();
        for (auto b = static_cast<std::size_t>(count); b-- > 1;) {
            box.expand(slabs[b].box);
            right_box[b] = box;
        }
        // Compute the cost of each border, and skip those with an empty side or too many references.
        Plane p{0, axis, T(0), LaneBox<T>::none(), LaneBox<T>::none(), 0, range.size()};
        for (std::size_t b = 1; b < static_cast<std::size_t>(count); ++b) {
            p.left.expand(slabs[b - 1].box);
            p.on_left += slabs[b - 1].begin;
            p.on_right -= slabs[b - 1].end;
            if (p.on_left == 0 || p.on_right == 0 || p.on_left + p.on_right > range.capacity()) continue;
            p.right = right_box[b];
            p.cost = this->cost(p.left, p.on_left) + this->cost(p.right, p.on_right);
            p.position = border(static_cast<int>(b));
            if (p.cost < best.cost) best = p;
        }
    }

    /// Moves references that lie wholly left before those that lie wholly right, and straddlers to one side
    /// or both. Returns false, with the references only reordered, if all end on one side.
    bool cut(const Range<T, D>& range, const Plane& plane, Range<T, D>& left, Range<T, D>& right) {
        auto& all = this->references_;
        std::uint32_t last = range.last, end = range.last;
        left = right = {};
        for (std::uint32_t i = range.first; i < last;) {
            const Reference<T, D> r = all[i];
            int sides = sides_of(r, plane);
            // By rounding there may be more straddlers than the slabs counted. Without room they stay whole.
            if (sides == both && end == range.first + range.capacity()) sides = only_left;
            if (sides == both) {
                // Replace the reference by its left part, and append the right part behind all others.
                const auto [low, high] = parts(r, plane.axis, plane.position);
                left.add(low), right.add(high);
                all[i++] = low;
                all[end++] = high;
            } else if (sides == only_left) {
                left.add(r);
                ++i;
            } else {
                right.add(r);
                std::swap(all[i], all[--last]);
            }
        }
        left.first = range.first, left.last = right.first = last, right.last = end;
        return left.size() > 0 && right.size() > 0;
    }
    static constexpr int only_left = 1, only_right = 2, both = 3;
    int sides_of(const Reference<T, D>& r, const Plane& plane) const {
        if (r.high[plane.axis] <= plane.position) return only_left;
        if (r.low[plane.axis] >= plane.position) return only_right;
        const auto [low, high] = parts(r, plane.axis, plane.position);
        if (low.box().empty()) return only_right;
        if (high.box().empty()) return only_left;
        // Compare the costs of a split with those of the whole reference on one side.
        const auto with = [&](LaneBox<T> box) {
            box.expand(r.lanes());
            return box;
        };
        const double to_left =
            this->cost(with(plane.left), plane.on_left) + this->cost(plane.right, plane.on_right - 1);
        const double to_right =
            this->cost(plane.left, plane.on_left - 1) + this->cost(with(plane.right), plane.on_right);
        if (plane.cost <= std::min(to_left, to_right)) return both;
        return to_left <= to_right ? only_left : only_right;
    }

    CornersOf<T, D> corners_;
    std::size_t size_;
    T margin_ = T(0);
    double worth_a_plane_ = 0;
};

}  // namespace hedgerow
