/// The neighbours of every point of an array: what molecular dynamics, fluids of particles and clouds of
/// points ask at each step.
#pragma once

#include <vector>

#include <hedgerow/geometry/radius.h>
#include <hedgerow/queries/cell_neighbours.h>

namespace hedgerow {

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
template <class Points, class Asking>
requires requires(const Asking& asking) {
    asking[0][0];
}
auto neighbours_within(const Points& points, const Asking& asking, double radius,
                       const NeighbourOptions& options = {}) {
    NearLists<typename std::decay_t<decltype(points[0])>::Scalar> lists;
    neighbours_within(points, asking, radius, lists, options);
    return lists;
}

}  // namespace hedgerow
