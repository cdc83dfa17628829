/// Line segments in the plane.
#pragma once

#include <array>
#include <vector>

#include <hedgerow/base/strided.h>
#include <hedgerow/geometry/clip.h>
#include <hedgerow/geometry/shapes.h>
#include <hedgerow/primitives/concepts.h>

namespace hedgerow {

/// A view of segments in the caller's array. Nothing is copied.
template <std::floating_point T>
class SegmentSetView {
public:
    using Scalar = T;
    static constexpr int dimension = 2;

    SegmentSetView() = default;
    explicit SegmentSetView(Strided<Segment<T, 2>> segments) : segments_(segments) {}

    std::size_t size() const { return segments_.size(); }
    Segment<T, 2> segment(std::size_t i) const { return segments_[i]; }
    Box<T, 2> bounds(std::size_t i) const { return segments_[i].bounds(); }
    bool finite(std::size_t i) const {
        return hedgerow::finite(segments_[i].a) && hedgerow::finite(segments_[i].b);
    }
    Foot<T, 2> closest_point(std::size_t i, const Vec<T, 2>& p) const {
        return hedgerow::closest_point(p, segments_[i]);
    }
    Foot<T, 2> farthest_point(std::size_t i, const Vec<T, 2>& p) const {
        return hedgerow::farthest_point(p, segments_[i]);
    }
    template <Region R>
    bool overlaps(std::size_t i, const R& region) const {
        return overlap(segments_[i], region);
    }
    template <Region R>
    bool lies_within(std::size_t i, const R& region) const {
        return lies_in(segments_[i], region);
    }
    static constexpr bool hits_lie_on_primitives = true;
    std::array<Vec<T, 2>, 2> corners(std::size_t i) const { return {segments_[i].a, segments_[i].b}; }
    Box<T, 2> clipped_bounds(std::size_t i, const Box<T, 2>& box) const {
        return hedgerow::clipped_bounds(segments_[i], box);
    }
    std::optional<Meeting<T>> meet(std::size_t i, const Ray<T, 2>& ray) const {
        const auto m = meet_line(ray.origin, ray.direction, segments_[i]);
        if (!m || !(ray.t_min <= m->t && m->t <= ray.t_max)) return std::nullopt;
        return m;
    }

private:
    Strided<Segment<T, 2>> segments_;
};

/// Segments in an array that the set owns. The id of a segment is its position.
template <std::floating_point T>
struct SegmentSet {
    using Scalar = T;
    static constexpr int dimension = 2;

    std::vector<Segment<T, 2>> segments;

    std::size_t size() const { return segments.size(); }
    SegmentSetView<T> view() const { return SegmentSetView<T>(std::span(segments)); }
};

}  // namespace hedgerow
