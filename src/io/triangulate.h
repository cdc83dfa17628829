/// Polygons into triangles.
#pragma once

#include <cstdint>
#include <span>

#include <hedgerow/primitives/triangle_mesh.h>

#include "byte_source.h"

namespace hedgerow::detail {

/// Replaces a fan of n − 2 triangles from a polygon's first corner by as many that fill the polygon.
///
/// The polygon is looked at along the axis in which its normal (Newell's) is longest, so that signs are those
/// of the coordinates as they are. A convex polygon stays the fan that it is. Any other loses its ears, one
/// after the other (Meisters 1975): corners whose triangle no other part of the boundary enters. The
/// triangles of a polygon whose boundary does not cross itself then cover it once, turn as it does, and are
/// not flat unless that cannot be. It may touch itself, as where a hole is joined to the outside by a bridge.
///
/// A polygon without a normal (all corners on one line, a figure of eight whose halves are equal) stays a
/// fan. One that crosses itself has no inside to speak of: where no ear is left a corner that turns inwards
/// is cut as it is, and what has no such corner becomes a fan.
///
/// Corners that are no vertex and coordinates that are not finite are left to who validates the mesh. O(n)
/// for a convex polygon. Else each of the at most 11n ears that are looked at is held against the corners
/// that do not turn inwards, through a tree of boxes over the boundary: O(n log n) for outlines as they are
/// drawn, O(n²) at worst.
///
/// Throws InputError, naming `file`, before a large polygon takes more memory than there is, and Cancelled
/// soon after the reading of the file was cancelled.
template <class T>
void fill_polygon(const ByteSource& file, std::span<TriangleIndices> fan,
                  std::span<const Vec<T, 3>> vertices);

}  // namespace hedgerow::detail
