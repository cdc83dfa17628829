/// CGAL's pairs of triangles, if CGAL was found when the build was configured. CGAL is a peer in benchmarks
/// alone: its licence (GPL) is not the library's, and nothing that is installed links to it.
#pragma once

#include <hedgerow/measure/contest.h>
#include <hedgerow/primitives/triangle_mesh.h>

namespace hedgerow::measure {

/// Adds CGAL's ways to find the self-intersections of a mesh, each with all that it builds. The mesh is
/// handed over in CGAL's own types, which is not timed. It must outlive the contest.
void add_cgal_self_intersections(Contest& contest, const TriangleMesh<float>& mesh);
/// Adds CGAL's ways to find the pairs of triangles of two meshes that meet.
void add_cgal_crossings(Contest& contest, const TriangleMesh<float>& a, const TriangleMesh<float>& b);

#if !HEDGEROW_HAS_CGAL
inline void add_cgal_self_intersections(Contest&, const TriangleMesh<float>&) {}
inline void add_cgal_crossings(Contest&, const TriangleMesh<float>&, const TriangleMesh<float>&) {}
#endif

}  // namespace hedgerow::measure
