/// Neighbours by cells that are sorted for a question: what is compiled of it in the library `core`.
#pragma once

#include <concepts>
#include <cstddef>
#include <vector>

#include <hedgerow/base/strided.h>
#include <hedgerow/geometry/periods.h>
#include <hedgerow/parallel/executor.h>
#include <hedgerow/primitives/concepts.h>
#include <hedgerow/queries/near_rows.h>
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
/// What `neighbours_within`, `pairs_within` and batches of `within` do. T is float or double, D 2 or 3.
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
/// Lists the points of a set within the options' distance of each of `points`, in the order of (distance²,
/// element), by cells that are sorted for it. Returns false, and lists nothing, where a walk may be faster,
/// and for other primitives.
template <class P, class T>
bool listed_by_cells(const P& set, const Strided<Vec<T, P::dimension>>& points, NearLists<T, IdOf<P>>& lists,
                     const PointOptions& options) {
    if constexpr (PointSet<P> && CellNeighbours<T, P::dimension>::compiled) {
        std::vector<Vec<T, P::dimension>> copies;
        if (!CellNeighbours<T, P::dimension>::within(points_of(set, copies), points,
                                                     NearLimits<T>::of_batch(options).distance2, lists,
                                                     options.threads))
            return false;
        leave_out_of(lists, options);
        return true;
    } else {
        return false;
    }
}
}  // namespace detail

}  // namespace hedgerow
