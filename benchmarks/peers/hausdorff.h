/// CGAL's Hausdorff distance, if CGAL was found when the build was configured (peers/pairs.h).
#pragma once

#include <hedgerow/measure/contest.h>
#include <hedgerow/primitives/triangle_mesh.h>

namespace hedgerow::measure {

/// Adds CGAL's directed distance from a to b within `error`, with all that it builds. It returns the distance
/// in units of a millionth of `error`. The meshes are handed over in CGAL's own types, which is not timed.
void add_cgal_hausdorff(Contest& contest, const TriangleMesh<float>& a, const TriangleMesh<float>& b,
                        double error);

#if !HEDGEROW_HAS_CGAL
inline void add_cgal_hausdorff(Contest&, const TriangleMesh<float>&, const TriangleMesh<float>&, double) {}
#endif

}  // namespace hedgerow::measure
