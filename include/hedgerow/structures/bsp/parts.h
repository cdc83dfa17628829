/// The parts of primitives in a cell of a BSP tree.
#pragma once

#include <vector>

#include <hedgerow/structures/references.h>

namespace hedgerow {

/// A primitive's part in a cell: `count` corners of a convex polygon, from `first` on in the cell's array,
/// and the box around them; or the primitive's whole box, without corners.
template <int D>
struct BspPart {
    PrimitiveId id;
    std::uint32_t first, count;
    Box<double, D> bounds;
};

/// The parts in a cell, with all their corners in one array.
template <int D>
class BspParts {
public:
    using Part = BspPart<D>;
    using Point = Vec<double, D>;

    std::uint32_t size() const { return static_cast<std::uint32_t>(parts_.size()); }
    const Part& operator[](std::size_t i) const { return parts_[i]; }
    auto begin() const { return parts_.begin(); }
    auto end() const { return parts_.end(); }

    void add(PrimitiveId id, const Box<double, D>& bounds) { parts_.push_back({id, 0, 0, bounds}); }
    /// Adds a part of these corners.
    template <class Corners>
    void add(PrimitiveId id, const Corners& corners) {
        begin_part(id);
        for (const auto& c : corners) add_corner(Point(c));
    }
    /// Adds a part of another cell.
    void add(const BspParts& from, const Part& part) {
        parts_.push_back(part);
        parts_.back().first = static_cast<std::uint32_t>(corners_.size());
        const auto first = from.corners_.begin() + part.first;
        corners_.insert(corners_.end(), first, first + part.count);
    }
    /// Adds what of another cell's part is on one side of a plane (sign 1: low, −1: high) or within the
    /// plane's margin of that side. A box stays whole.
    void add_side(const BspParts& from, const Part& part, const CutPlane<D>& plane, double sign) {
        if (part.count == 0) return add(from, part);
        begin_part(part.id);
        const Point* const all = from.corners_.data() + part.first;
        for (std::uint32_t i = 0; i < part.count; ++i) {
            const Point &p = all[i], &q = all[i + 1 < part.count ? i + 1 : 0];
            const double a = sign * plane.height(p) - plane.margin, b = sign * plane.height(q) - plane.margin;
            if (a <= 0) add_corner(p);
            if ((a < 0 && b > 0) || (a > 0 && b < 0)) add_corner(p + (q - p) * (a / (a - b)));
        }
    }
    /// The corners of a part, or of its box.
    std::uint32_t corner_count(const Part& part) const { return part.count > 0 ? part.count : 1u << D; }
    Point corner(const Part& part, std::uint32_t i) const {
        if (part.count > 0) return corners_[part.first + i];
        Point p;
        for (int k = 0; k < D; ++k) p[k] = (i >> k & 1u) != 0 ? part.bounds.high[k] : part.bounds.low[k];
        return p;
    }
    /// The least and the greatest height of a part over a plane. `axis` is −1 unless the plane lies across
    /// it.
    [[gnu::always_inline]] std::pair<double, double> heights(const Part& part, const CutPlane<D>& plane,
                                                             int axis) const {
        if (axis >= 0) return {part.bounds.low[axis] - plane.offset, part.bounds.high[axis] - plane.offset};
        if (part.count == 0) {
            Point lowest = part.bounds.low, highest = part.bounds.high;
            for (int k = 0; k < D; ++k)
                if (plane.normal[k] < 0) std::swap(lowest[k], highest[k]);
            return {plane.height(lowest), plane.height(highest)};
        }
        const Point* const all = corners_.data() + part.first;
        double low = plane.height(all[0]), high = low;
        for (std::uint32_t i = 1; i < part.count; ++i) {
            const double h = plane.height(all[i]);
            low = std::min(low, h), high = std::max(high, h);
        }
        return {low, high};
    }

private:
    void begin_part(PrimitiveId id) {
        parts_.push_back({id, static_cast<std::uint32_t>(corners_.size()), 0, {}});
    }
    void add_corner(const Point& p) {
        corners_.push_back(p);
        ++parts_.back().count;
        parts_.back().bounds.expand(p);
    }

    std::vector<Part> parts_;
    std::vector<Point> corners_;
};

}  // namespace hedgerow
