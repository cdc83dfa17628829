/// Points in an array.
#pragma once

#include <vector>

#include <hedgerow/base/strided.h>
#include <hedgerow/geometry/shapes.h>
#include <hedgerow/primitives/concepts.h>

namespace hedgerow {

/// A view of points in the caller's array. Nothing is copied.
template <std::floating_point T, int D>
class PointCloudView {
public:
    using Scalar = T;
    static constexpr int dimension = D;

    PointCloudView() = default;
    explicit PointCloudView(Strided<Vec<T, D>> points) : points_(points) {}

    std::size_t size() const { return points_.size(); }
    const Strided<Vec<T, D>>& points() const { return points_; }
    Vec<T, D> point(std::size_t i) const { return points_[i]; }
    Box<T, D> bounds(std::size_t i) const { return {points_[i], points_[i]}; }
    Foot<T, D> closest_point(std::size_t i, const Vec<T, D>& p) const {
        return hedgerow::closest_point(p, points_[i]);
    }
    Foot<T, D> farthest_point(std::size_t i, const Vec<T, D>& p) const {
        return hedgerow::farthest_point(p, points_[i]);
    }
    template <Region R>
    bool overlaps(std::size_t i, const R& region) const {
        return lies_in(points_[i], region);
    }
    template <Region R>
    bool lies_within(std::size_t i, const R& region) const {
        return lies_in(points_[i], region);
    }

private:
    Strided<Vec<T, D>> points_;
};

/// Points in an array that the set owns. The id of a point is its position.
template <std::floating_point T, int D>
struct PointCloud {
    using Scalar = T;
    static constexpr int dimension = D;

    std::vector<Vec<T, D>> points;

    std::size_t size() const { return points.size(); }
    PointCloudView<T, D> view() const { return PointCloudView<T, D>(std::span(points)); }
};

}  // namespace hedgerow
