/// Generated triangle meshes.
///
/// `size` is the number of triangles asked for; a mesh comes as near to it as its shape allows, within 20 %
/// from 100 triangles on. Everything is computed in double from exact or correctly rounded operations and
/// then rounded to T, so a mesh has the same bits on every machine, and the float one is the double one
/// rounded. Each costs O(size) time and memory. T is float or double. Meshes are counterclockwise seen from
/// outside, z is up (in the Cornell box y is), and vertices are shared where surfaces join. `progress` is
/// told of the elements that are made and looked at about once in 4096 of them: all throw Cancelled if it is
/// cancelled.
#pragma once

#include <cstdint>

#include <hedgerow/parallel/progress.h>
#include <hedgerow/primitives/triangle_mesh.h>

namespace hedgerow {

/// The Utah teapot: 32 bicubic Bézier patches (Newell 1975; for the history of the data see Crow, "The
/// origins of the teapot", IEEE CG&A 7(1), 1987), with the bottom that was added later. Stands on z = 0 and
/// fills about
/// [-3, 3.43] × [-2, 2] × [0, 3.15]; the spout points to +x. At least 52 triangles. As ever the lid, the
/// handle and the spout are sheets of their own: all is closed but for the gap under the lid, the spout's
/// mouth and the ends that lie inside the body.
template <class T>
TriangleMesh<T> teapot(std::uint64_t size, const Progress& progress = {});

/// The teapot in a stadium, which breaks uniform grids (the phrase is Haines's, Ray Tracing News, 1988): the
/// teapot of `teapot`, finely divided, on the middle of the field of an elliptic bowl of stepped seating rows
/// 340 times as long. A ninth of the triangles is in the teapot. The bowl comes first, and is one open sheet.
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

/// Grass on uneven ground: an eighth of the triangles is `terrain`, the rest blades on it, three thin
/// triangles each, 0.02 to 0.05 high, bent over to any side. The more blades, the thinner. Heights as
/// terrain's, and the blades; those near the sides lean out of the unit square.
template <class T>
TriangleMesh<T> grass(std::uint64_t size, std::uint64_t seed = 0, const Progress& progress = {});

/// A ball of hair, the hard case of Laine and Karras (Efficient sparse voxel octrees, 2010): thin curved
/// strands about the origin, strips of 32 triangles each, between the radii 1/2 and 1. The more strands, the
/// thinner. Each is an open sheet of its own.
template <class T>
TriangleMesh<T> hairball(std::uint64_t size, std::uint64_t seed = 0, const Progress& progress = {});

/// A furnished flat of six rooms, 13 m × 9 m and 2.8 m high, in metres: walls with doors and windows that are
/// open, mouldings 5 m long and 5 mm wide, planks, tables, chairs, shelves of books, curtains, lamps,
/// crockery and cutlery of 1 mm. Most of it lies along the axes. Things come in the order of their
/// importance, the last ones only if there are triangles left for them; a larger size divides what is round
/// more finely. Each thing is a mesh of its own, and some are open sheets. The floor is at z = 0. `seed`
/// chooses how far doors are open, books, planks, fruit, leaves and pens.
template <class T>
TriangleMesh<T> interior(std::uint64_t size, std::uint64_t seed = 0, const Progress& progress = {});

/// `size` separate triangles in the unit cube, evenly spread and evenly turned, each on a circumscribed
/// sphere of radius size^(-1/3)/2. Throws UsageError beyond 2^32/3 triangles, when indices no longer fit.
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
