/// Distances of a point to a few elements, one after the other: what all instruction sets compute, and what
/// is computed without any.
///
/// The closest point of a triangle a + v·ab + w·ac is sought on its face and on its edges, and the nearest of
/// what is found counts. All are points of the triangle, however v and w are rounded, so no distance is below
/// the true one but for the rounding of coordinates.
#pragma once

#include <hedgerow/engine/near_elements.h>

namespace hedgerow::detail {

/// Squared lengths up to this have no reciprocal, and a triangle is a sliver if the square of its area is
/// less than this part of that of a rectangle with its sides.
inline constexpr double least_product = 0x1p-900, least_area = 0x1p-30;

/// Replaces the distances to slivers by those of `closest_point`.
void measure_slivers(const NearElements& near, const DistanceMargin& margin, const Vec3d& p,
                     double (&distance)[NearElements::most]);

extern const ElementKernels plain_element_kernels;

}  // namespace hedgerow::detail
