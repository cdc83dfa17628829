/// Which cells a primitive is in: shared by grids, kd-trees, octrees and BSP trees.
#pragma once

#include <array>
#include <optional>

#include <hedgerow/structures/references.h>

namespace hedgerow {

/// How far a cell is enlarged on every side before a primitive is tested against it.
///
/// A probe visits every cell that may contain an answer: a hit within the ray's slack, a closest point, or a
/// place in the queried region. An answer lies on its primitive, but for the roundings of the test that found
/// it. An overlap has no roundings, and a distance has fewer than 8 of the largest coordinate; the roundings
/// of a hit are in the ray's slack. Clipping adds fewer than 48 (geometry/clip.h). So a primitive that comes
/// within the margin of a cell is inserted there, and a primitive that does not has no answer in that cell.
template <std::floating_point T, int D>
T cell_margin(const Box<T, D>& scene) {
    if (scene.empty()) return T(0);
    const T largest = std::max(max_component(abs(scene.low)), max_component(abs(scene.high)));
    return product(64 * unit_roundoff<T>, largest) + 64 * std::numeric_limits<T>::denorm_min();
}

template <std::floating_point T, int D>
Box<T, D> enlarged(const Box<T, D>& box, T margin) {
    const auto by = Vec<T, D>::all(margin);
    return {box.low - by, box.high + by};
}

// A set that stands for another, of any type, has these functions as members (any_set.h).

/// Whether the hits of a set lie on its primitives themselves, not only in their boxes.
template <PrimitiveSet P>
bool hits_lie_on(const P& set) {
    if constexpr (requires { set.hits_lie_on(); })
        return set.hits_lie_on();
    else
        return HitsLieOnPrimitives<P>;
}

/// Returns a test of cells: whether the primitive is to be inserted in a cell. The cell must already be
/// enlarged and meet the primitive's box. The test is finer than boxes only for sets whose hits lie on the
/// primitives themselves.
template <PrimitiveSet P>
auto stands_in(const P& set, PrimitiveId id) {
    using Cell = Box<typename P::Scalar, P::dimension>;
    if constexpr (requires { set.stands_in(id); })
        return set.stands_in(id);
    else if constexpr (!HitsLieOnPrimitives<P>)
        return [](const Cell&) { return true; };
    else if constexpr (requires { set.overlap_test(id); })
        return set.overlap_test(id);
    else
        return [&set, id](const Cell& cell) { return set.overlaps(id, cell); };
}

/// Bounds of a primitive's part in a cell that is already enlarged; empty if there is none. The part is
/// clipped exactly if the set can do that; otherwise it is the intersection of the boxes.
template <PrimitiveSet P>
Box<typename P::Scalar, P::dimension> part_in(const P& set, PrimitiveId id,
                                              const Box<typename P::Scalar, P::dimension>& cell) {
    if constexpr (requires { set.part_in(id, cell); })
        return set.part_in(id, cell);
    else if constexpr (HitsLieOnPrimitives<P> && requires { set.clipped_bounds(id, cell); })
        return set.clipped_bounds(id, cell);
    else
        return intersection(set.bounds(id), cell);
}

// The types of part_in and corners_in for builders that are compiled once, in core, and know no sets.

template <std::floating_point T, int D>
using PartIn = FunctionRef<Box<T, D>(PrimitiveId, const Box<T, D>&)>;

/// The corners of a primitive that is their convex hull: a triangle, or in the plane a segment. Nothing for
/// other primitives.
template <std::floating_point T, int D>
using Corners = std::optional<std::array<Vec<T, D>, static_cast<std::size_t>(D)>>;
template <std::floating_point T, int D>
using CornersOf = FunctionRef<Corners<T, D>(PrimitiveId)>;

template <PrimitiveSet P>
Corners<typename P::Scalar, P::dimension> corners_in(const P& set, PrimitiveId id) {
    if constexpr (requires { set.corners_in(id); })
        return set.corners_in(id);
    else if constexpr (HitsLieOnPrimitives<P> && requires { set.corners(id); })
        return set.corners(id);
    else
        return std::nullopt;
}

}  // namespace hedgerow
