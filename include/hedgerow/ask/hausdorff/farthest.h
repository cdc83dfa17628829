/// The points of a set A that were asked for their distance to a set B, and the farthest of them.
#pragma once

#include <cmath>
#include <limits>
#include <vector>

#include <hedgerow/ask/hausdorff/corners.h>
#include <hedgerow/ask/hausdorff/distance_error.h>
#include <hedgerow/ask/hausdorff/interval.h>
#include <hedgerow/ask/points.h>

namespace hedgerow::detail {

/// Asks for points of A in batches, and keeps the one that is farthest from index B: the lower bound.
template <class A, class IB>
class Farthest {
public:
    using T = typename A::Scalar;
    static constexpr int dimension = A::dimension;
    using Point = Vec<T, dimension>;

    Farthest(const IB& b, const DistanceError<T>& error, Executor& threads, double at_least)
        : b_(b), error_(error), threads_(threads), lower_(at_least) {}

    double lower() const { return lower_; }
    /// The witnesses of the lower bound.
    const Hausdorff<T, dimension>& best() const { return best_; }

    /// Finds the point of B that is closest to each of some points.
    const std::vector<Near<T, dimension>>& ask(const std::vector<Point>& points) {
        near_.resize(points.size());
        closest_points(b_, points, near_, {.threads = threads_});
        return near_;
    }
    /// Takes note of a point of an element of A that was rounded to `query`, which is `away` from it.
    void see(const Point& query, double away, PrimitiveId element, const Near<T, dimension>& near) {
        const double far = error_.below(distance(near)) - away;
        if (!(far > lower_ || (far == lower_ && !best_))) return;
        lower_ = far;
        best_.element_a = element, best_.point_a = query;
        best_.element_b = near.element, best_.point_b = near.point;
    }
    /// At least the distance to B of a point that was not rounded.
    double above(const Near<T, dimension>& near) const { return error_.above(distance(near)); }

private:
    static double distance(const Near<T, dimension>& near) {
        return std::sqrt(static_cast<double>(near.distance2));
    }

    const IB& b_;
    const DistanceError<T>& error_;
    Executor& threads_;
    double lower_;
    Hausdorff<T, dimension> best_;
    std::vector<Near<T, dimension>> near_;
};

/// The corners of A, each of which is asked for once.
template <class A, class IB>
class AskedCorners {
public:
    using T = typename A::Scalar;
    struct Asked {
        double distance = std::numeric_limits<double>::infinity();  // at least that to B
        PrimitiveId nearest = no_primitive;                         // until the corner is asked for
    };

    AskedCorners(const Corners<A>& corners, Farthest<A, IB>& farthest)
        : corners_(corners), farthest_(farthest) {}
    void make_room() { asked_.resize(corners_.size()); }

    /// What is known of a corner. That may be nothing before `finish` after it was asked for.
    const Asked& operator[](std::size_t corner) const { return asked_[corner]; }
    /// Asks for a corner of an element soon.
    void ask(std::size_t corner, PrimitiveId element) {
        Asked& asked = asked_[corner];
        if (asked.nearest != no_primitive) return;
        asked.nearest = 0;  // not again
        number_.push_back(corner), element_.push_back(element), point_.push_back(corners_[corner]);
        if (point_.size() == batch) finish();
    }
    void finish() {
        const auto& found = farthest_.ask(point_);
        for (std::size_t i = 0; i < point_.size(); ++i) {
            farthest_.see(point_[i], 0, element_[i], found[i]);
            asked_[number_[i]] = {farthest_.above(found[i]), found[i].element};
        }
        number_.clear(), element_.clear(), point_.clear();
    }

private:
    static constexpr std::size_t batch = 1 << 16;

    const Corners<A>& corners_;
    Farthest<A, IB>& farthest_;
    std::vector<Asked> asked_;
    std::vector<std::size_t> number_;  // of those that wait, with their elements and places
    std::vector<PrimitiveId> element_;
    std::vector<Vec<T, A::dimension>> point_;
};

}  // namespace hedgerow::detail
