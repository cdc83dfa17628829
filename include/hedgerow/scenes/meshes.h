/// Generated triangle meshes.
///
/// `size` is the wanted number of triangles. A mesh comes as near to it as its shape allows: within 20 % from
/// 100 triangles on. Everything is computed in double by exact or correctly rounded operations and then
/// rounded to T. So a mesh has the same bits on every machine, and the float mesh is the double mesh rounded.
/// Each generator takes O(size) time and memory. T is float or double.
///
/// Triangles are counterclockwise seen from outside, z is up (y in the Cornell box), and vertices are shared
/// where surfaces join. `progress` counts the elements made, and is checked for cancellation about once in
/// 4096 of them. Every generator throws Cancelled if `progress` is cancelled.
#pragma once

#include <cstdint>

#include <hedgerow/parallel/progress.h>
#include <hedgerow/primitives/triangle_mesh.h>

namespace hedgerow {

/// The Utah teapot: 32 bicubic Bézier patches (Newell 1975; for the history of the data see Crow, "The
/// origins of the teapot", IEEE CG&A 7(1), 1987), with the bottom that was added later. Its bottom is on z =
/// 0, and it fills about [-3, 3.43] × [-2, 2] × [0, 3.15]; the spout points to +x. At least 52 triangles. The
/// lid, the handle and the spout are separate sheets, as usual. All is closed except for the gap under the
/// lid, the spout's mouth and the ends that are inside the body.
template <class T>
TriangleMesh<T> teapot(std::uint64_t size, const Progress& progress = {});

/// The teapot in a stadium, which breaks uniform grids (the phrase is Haines's, Ray Tracing News, 1988). A
/// finely divided `teapot` is on the middle of the field of an elliptic bowl, which has stepped rows of seats
/// and is 340 times as long. A ninth of the triangles is in the teapot. The bowl comes first, and is one open
/// sheet.
template <class T>
TriangleMesh<T> teapot_in_stadium(std::uint64_t size, const Progress& progress = {});

/// The stadium of `teapot_in_stadium`, turned by 30° about x and then about y: nothing in it lies along an
/// axis, so every box around its large triangles holds mostly air.
template <class T>
TriangleMesh<T> turned_stadium(std::uint64_t size, const Progress& progress = {});

/// A fractal landscape over the unit square, heights in about [0, 0.25]: eleven octaves of value noise (after
/// Fournier, Fussell and Carpenter 1982; Musgrave 1989), each turned by the 3-4-5 triangle's angle to hide
/// the lattice. One regular grid, rows along x. A larger size samples the same land more finely.
template <class T>
TriangleMesh<T> terrain(std::uint64_t size, std::uint64_t seed = 0, const Progress& progress = {});

/// Grass on uneven ground. An eighth of the triangles is `terrain`; the rest are blades on it, three thin
/// triangles each, 0.02 to 0.05 high, bent over to any side. The more blades, the thinner. Heights are those
/// of terrain and of the blades on it; blades near the sides lean out of the unit square.
template <class T>
TriangleMesh<T> grass(std::uint64_t size, std::uint64_t seed = 0, const Progress& progress = {});

/// A ball of hair, the hard case of Laine and Karras (Efficient sparse voxel octrees, 2010): thin curved
/// strands around the origin, between the radii 1/2 and 1. A strand is a strip of 32 triangles and an open
/// sheet of its own. The more strands, the thinner.
template <class T>
TriangleMesh<T> hairball(std::uint64_t size, std::uint64_t seed = 0, const Progress& progress = {});

/// A smooth closed surface with fine detail, as scanners make of statues: one sheet of small triangles of
/// much the same size, whose vertices are not regular. A sphere, bent and roughened by value noise; about 2.7
/// high and 2.2 wide, around the origin. A larger size samples the same boulder more finely.
template <class T>
TriangleMesh<T> boulder(std::uint64_t size, std::uint64_t seed = 0, const Progress& progress = {});

/// A furnished flat of six rooms, 13 m × 9 m and 2.8 m high, in metres: walls with doors and windows that are
/// open, mouldings 5 m long and 5 mm wide, planks, tables, chairs, shelves of books, curtains, lamps,
/// crockery and cutlery of 1 mm. Most of it lies along the axes. Things are added in the order of their
/// importance, each only if there are triangles left for it. A larger size divides round things more finely.
/// Each thing is a mesh of its own, and some are open sheets. The floor is at z = 0. `seed` chooses how far
/// doors are open, books, planks, fruit, leaves and pens.
template <class T>
TriangleMesh<T> interior(std::uint64_t size, std::uint64_t seed = 0, const Progress& progress = {});

/// `size` separate triangles in the unit cube, with uniform places and directions. The corners of each are on
/// a sphere of radius size^(-1/3)/2. Throws UsageError beyond 2^32/3 triangles, when indices no longer fit.
template <class T>
TriangleMesh<T> soup(std::uint64_t size, std::uint64_t seed = 0, const Progress& progress = {});

/// The Cornell box (Goral, Torrance, Greenberg and Battaile 1984; the measured data of 1998), in millimetres:
/// room, light and two blocks, y up, open to −z. 32 triangles at size 32 or less, subdivided beyond. Walls
/// face inward. The blocks have no underside; the light hangs 0.1 mm below the ceiling, not in its plane. The
/// meshes of room, light and each block are not joined. Order: floor, ceiling, back, right, left, light,
/// short, tall block.
template <class T>
TriangleMesh<T> cornell_box(std::uint64_t size, const Progress& progress = {});

/// The cube [-1, 1]³, closed. 12 triangles at size 12 or less, subdivided beyond.
template <class T>
TriangleMesh<T> cube(std::uint64_t size, const Progress& progress = {});

}  // namespace hedgerow
