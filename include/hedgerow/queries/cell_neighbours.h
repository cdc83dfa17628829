/// Neighbours by cells that are sorted for a question: what is compiled of it in the library `core`.
#pragma once

#include <concepts>
#include <cstddef>
#include <vector>

#include <hedgerow/base/strided.h>
#include <hedgerow/geometry/periods.h>
#include <hedgerow/geometry/radius.h>
#include <hedgerow/parallel/executor.h>
#include <hedgerow/primitives/concepts.h>
#include <hedgerow/queries/near_rows.h>
#include <hedgerow/queries/pairs_within.h>
#include <hedgerow/walks/structure.h>

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
/// The points of a set that a structure holds, in an array: the set's own, or copies.
template <PointSet P>
class HeldPoints {
public:
    using V = Vec<typename P::Scalar, P::dimension>;

    template <class S>
    HeldPoints(const S& structure, const P& set) {
        if (holds_all(structure, set.size())) {
            if constexpr (requires { set.points(); })
                points_ = set.points();
            else
                for (std::size_t i = 0; i < set.size(); ++i) copies_.push_back(set.point(i));
        } else {
            for (PrimitiveId id = 0; id < set.size(); ++id)
                if (holds(structure, id)) elements_.push_back(id), copies_.push_back(set.point(id));
            all_ = false;
        }
        if (points_.size() == 0) points_ = copies_;
    }
    HeldPoints(const HeldPoints&) = delete;
    HeldPoints& operator=(const HeldPoints&) = delete;

    const Strided<V>& points() const { return points_; }
    bool all() const { return all_; }
    /// The number in the set of point i of the array; ascending with i.
    PrimitiveId element(PrimitiveId i) const { return all_ ? i : elements_[i]; }

private:
    Strided<V> points_;
    std::vector<V> copies_;
    std::vector<PrimitiveId> elements_;
    bool all_ = true;
};

/// Lists the points of an index within the options' distance of each of `points`, in the order of (distance²,
/// element), by cells that are sorted for it. Returns false, and lists nothing, where a walk may be faster,
/// and for other primitives.
template <class I, class T>
bool listed_by_cells(const I& index, const Strided<Vec<T, I::dimension>>& points,
                     NearLists<T, IdOf<typename I::Primitives>>& lists, const PointOptions& options) {
    using P = typename I::Primitives;
    if constexpr (PointSet<P> && CellNeighbours<T, P::dimension>::compiled) {
        const HeldPoints<P> held(index.structure(), index.primitives());
        if (!CellNeighbours<T, P::dimension>::within(
                held.points(), points, NearLimits<T>::of_batch(options).distance2, lists, options.threads))
            return false;
        if (!held.all())
            for (PrimitiveId& id : lists.ids) id = held.element(id);
        leave_out_of(lists, options);
        return true;
    } else {
        return false;
    }
}
/// Writes the pairs of points of an index, or of two, within a radius of each other to `found`.
template <class T, class I>
std::size_t list_pairs_within(const I& index, double radius, std::vector<PairWithin<T>>& found,
                              Threads threads) {
    const HeldPoints<typename I::Primitives> held(index.structure(), index.primitives());
    CellNeighbours<T, I::dimension>::pairs(held.points(), square_within<T>(radius), found, threads);
    if (!held.all())
        for (auto& pair : found) pair.a = held.element(pair.a), pair.b = held.element(pair.b);
    return found.size();
}
template <class T, class IA, class IB>
std::size_t list_pairs_within(const IA& a, const IB& b, double radius, std::vector<PairWithin<T>>& found,
                              Threads threads) {
    const HeldPoints<typename IA::Primitives> of_a(a.structure(), a.primitives());
    const HeldPoints<typename IB::Primitives> of_b(b.structure(), b.primitives());
    CellNeighbours<T, IA::dimension>::pairs(of_a.points(), of_b.points(), square_within<T>(radius), found,
                                            threads);
    if (!of_a.all() || !of_b.all())
        for (auto& pair : found) pair.a = of_a.element(pair.a), pair.b = of_b.element(pair.b);
    return found.size();
}
}  // namespace detail

}  // namespace hedgerow
