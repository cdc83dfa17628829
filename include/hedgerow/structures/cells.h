/// Which cells a primitive stands in: what grids, kd-trees, octrees and BSP trees share.
#pragma once

#include <array>
#include <optional>

#include <hedgerow/structures/references.h>

namespace hedgerow {

/// How far a cell is enlarged on every side before it is asked whether a primitive meets it.
///
/// A probe visits each cell that an answer may lie in: a hit within the ray's slack, a closest point, a
/// place in the region asked about. An answer lies on its primitive but for the roundings of the test that
/// gave it: of overlaps none, of distances fewer than 8 of the largest coordinate (a hit's are in the probe's
/// slack). Clipping adds fewer than 48 (geometry/clip.h). So a primitive that comes within the margin of a
/// cell is inserted there, and one that does not has no answer in it.
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

/// What tells of cells (enlarged already) that a primitive's box meets whether it is to stand in them. Only a
/// set whose hits lie on the primitives themselves can be told apart more finely than by boxes.
template <PrimitiveSet P>
auto stands_in(const P& set, PrimitiveId id) {
    using Cell = Box<typename P::Scalar, P::dimension>;
    if constexpr (!HitsLieOnPrimitives<P>)
        return [](const Cell&) { return true; };
    else if constexpr (requires { set.overlap_test(id); })
        return set.overlap_test(id);
    else
        return [&set, id](const Cell& cell) { return set.overlaps(id, cell); };
}

/// Bounds of the part of a primitive that is to stand in a cell (enlarged already), empty if there is none:
/// clipped exactly where the set can do that, otherwise what the boxes share.
template <PrimitiveSet P>
Box<typename P::Scalar, P::dimension> part_in(const P& set, PrimitiveId id,
                                              const Box<typename P::Scalar, P::dimension>& cell) {
    if constexpr (HitsLieOnPrimitives<P> && requires { set.clipped_bounds(id, cell); })
        return set.clipped_bounds(id, cell);
    else
        return intersection(set.bounds(id), cell);
}

// The same for builders that are compiled once, in core, and know no sets.

template <std::floating_point T, int D>
using PartIn = FunctionRef<Box<T, D>(PrimitiveId, const Box<T, D>&)>;

/// The corners of a primitive that is no more than what they span, a triangle or (in the plane) a segment;
/// nothing for others.
template <std::floating_point T, int D>
using Corners = std::optional<std::array<Vec<T, D>, static_cast<std::size_t>(D)>>;
template <std::floating_point T, int D>
using CornersOf = FunctionRef<Corners<T, D>(PrimitiveId)>;

template <PrimitiveSet P>
Corners<typename P::Scalar, P::dimension> corners_in(const P& set, PrimitiveId id) {
    if constexpr (HitsLieOnPrimitives<P> && requires { set.corners(id); })
        return set.corners(id);
    else
        return std::nullopt;
}

}  // namespace hedgerow
