/// Divides polygons into triangles.
#pragma once

#include <cstdint>
#include <span>

#include <hedgerow/primitives/triangle_mesh.h>

#include "byte_source.h"

namespace hedgerow::detail {

/// Replaces a fan of n − 2 triangles from a polygon's first corner by n − 2 triangles that fill the polygon.
///
/// The polygon is projected along the axis in which its normal (Newell's) is longest, so that signs are
/// computed from the coordinates as they are. A convex polygon stays a fan. Any other polygon loses its ears,
/// one after the other (Meisters 1975): corners whose triangle no other part of the boundary enters. If the
/// boundary does not cross itself, the triangles cover the polygon once, turn as the polygon does, and are
/// flat only where that cannot be avoided. The boundary may touch itself, for example where a bridge joins a
/// hole to the outside.
///
/// A polygon without a normal (all corners on one line, or a figure of eight whose halves are equal) stays a
/// fan. A polygon that crosses itself has no clear inside. If it has no ear left, a corner that turns inwards
/// is cut anyway; if it has no such corner left, the rest becomes a fan.
///
/// Corners that name no vertex and coordinates that are not finite are left alone: the validation of the mesh
/// refuses them. O(n) for a convex polygon. Otherwise at most 11n ears are tested against the corners that do
/// not turn inwards, through a tree of boxes over the boundary: O(n log n) for ordinary outlines, O(n²) at
/// worst.
///
/// Throws InputError, naming `file`, before a large polygon takes more memory than there is, and Cancelled
/// soon after the reading of the file was cancelled.
///
/// `alike` are fans of the same polygon whose corners are other ordinals, such as those of normals. They are
/// divided as the first fan is.
template <class T>
void fill_polygon(const ByteSource& file, std::span<TriangleIndices> fan, std::span<const Vec<T, 3>> vertices,
                  std::span<const std::span<TriangleIndices>> alike = {});

}  // namespace hedgerow::detail
