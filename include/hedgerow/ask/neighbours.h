/// The neighbours of every point of an array: what molecular dynamics, fluids of particles and clouds of
/// points ask at each step.
#pragma once

#include <concepts>
#include <cstddef>
#include <vector>

#include <hedgerow/base/strided.h>
#include <hedgerow/geometry/periods.h>
#include <hedgerow/geometry/radius.h>
#include <hedgerow/parallel/executor.h>
#include <hedgerow/primitives/concepts.h>
#include <hedgerow/queries/lists.h>
#include <hedgerow/queries/pairs_within.h>

namespace hedgerow {

struct NeighbourOptions {
    /// Space repeats after these lengths along each axis, and distances are those to the nearest image; 0
    /// where it does not. Points may be anywhere. In the plane the third is not read.
    Periods<3> periods = {};
    /// Each pair once: only neighbours with a greater number are listed.
    bool once = false;
    bool distances = false;  ///< whether to measure squared distances; else lists have no column of them
    /// If not null: gets the points in the order of cells in rows, and lists are in that order too. Number i
    /// is then that of point (*order)[i] of the array, in the lists and in what they hold. A simulation that
    /// puts its arrays in this order keeps near particles near in memory, and lists are written as they are
    /// found: else they are renumbered, which takes twice to five times as long as to find them.
    std::vector<PrimitiveId>* order = nullptr;
    Threads threads = {};
};

namespace detail {
/// What this header's functions, `pairs_within` and batches of `within` do, compiled in the library `core`:
/// T is float or double, D 2 or 3.
template <std::floating_point T, int D>
struct CellNeighbours {
    using Points = Strided<Vec<T, D>>;
    static constexpr bool compiled =
        (D == 2 || D == 3) && (std::same_as<T, float> || std::same_as<T, double>);
    static void list(const Points& points, T max_distance2, NearLists<T>& lists,
                     const NeighbourOptions& options);
    static void list(const Points& points, const Points& asking, T max_distance2, NearLists<T>& lists,
                     const NeighbourOptions& options);
    /// Writes the pairs of points of one set, each once, or of two, that are within a squared distance.
    static std::size_t pairs(const Points& points, T max_distance2, std::vector<PairWithin<T>>& found,
                             Threads threads);
    static std::size_t pairs(const Points& a, const Points& b, T max_distance2,
                             std::vector<PairWithin<T>>& found, Threads threads);
    /// Lists all `points` within a squared distance of each of `asking`, in the order of (distance², id).
    /// Returns false, and lists nothing, where a tree may be faster: for few that ask, for cells that hold
    /// far more points than are near, and for coordinates that no cell has.
    static bool within(const Points& points, const Points& asking, T max_distance2, NearLists<T>& lists,
                       Threads threads);
};
/// The points of a set in an array: its own, or copied to `copies`.
template <PointSet P, class V>
Strided<V> points_of(const P& set, std::vector<V>& copies) {
    if constexpr (requires { set.points(); }) {
        return set.points();
    } else {
        for (std::size_t i = 0; i < set.size(); ++i) copies.push_back(set.point(i));
        return copies;
    }
}
}  // namespace detail

/// Lists for each point the others within a radius, ascending by number: those whose distance, in double and
/// rounded once to T, is at most the radius (geometry/radius.h), as `within` of each point finds them but for
/// the point itself. Coincident points are neighbours. Nobody has any if the radius is negative or NaN.
///
/// O(n + pairs) time, wherever the points are, and memory for the lists and 24 to 60 bytes a point. Large
/// arrays are listed on all cores, or the threads of the options; the lists are the same for any threads and
/// instruction set. Points are sorted by cells of the radius's length (the method of linked cells, Hockney
/// and Eastwood, Computer Simulation Using Particles, 1981, section 8.4; cells are stored as rows of a sorted
/// array); vectors of float relative to a cell decide which points are near, and those in doubt are measured
/// in double.
///
/// Throws InputError for a point whose coordinate is NaN, infinite or beyond `largest_coordinate`, and
/// UsageError for a period that is negative, NaN or infinite. T is float or double, D 2 or 3.
template <std::floating_point T, int D>
void neighbours_within(const Strided<Vec<T, D>>& points, double radius, NearLists<T>& lists,
                       const NeighbourOptions& options = {}) {
    detail::CellNeighbours<T, D>::list(points, square_within<T>(radius), lists, options);
}
/// Lists for each point of `asking` all `points` within a radius of it, in the order of `asking`. Throws
/// UsageError also for the options `once` and `order`.
template <std::floating_point T, int D>
void neighbours_within(const Strided<Vec<T, D>>& points, const Strided<Vec<T, D>>& asking, double radius,
                       NearLists<T>& lists, const NeighbourOptions& options = {}) {
    detail::CellNeighbours<T, D>::list(points, asking, square_within<T>(radius), lists, options);
}
/// Of vectors of points.
template <std::floating_point T, int D>
void neighbours_within(const std::vector<Vec<T, D>>& points, double radius, NearLists<T>& lists,
                       const NeighbourOptions& options = {}) {
    neighbours_within(Strided<Vec<T, D>>(points), radius, lists, options);
}
template <std::floating_point T, int D>
void neighbours_within(const std::vector<Vec<T, D>>& points, const std::vector<Vec<T, D>>& asking,
                       double radius, NearLists<T>& lists, const NeighbourOptions& options = {}) {
    neighbours_within(Strided<Vec<T, D>>(points), Strided<Vec<T, D>>(asking), radius, lists, options);
}
/// Returns the lists: of a vector of points, or of Strided ones.
template <class Points>
auto neighbours_within(const Points& points, double radius, const NeighbourOptions& options = {}) {
    NearLists<typename std::decay_t<decltype(points[0])>::Scalar> lists;
    neighbours_within(points, radius, lists, options);
    return lists;
}

}  // namespace hedgerow
