/// The Cornell box.
#include <utility>

#include <hedgerow/scenes/meshes.h>

#include "parts.h"
#include "precision.h"
#include "sizing.h"
#include "steps.h"
#include "welding.h"

namespace hedgerow {
namespace {

using Quad = std::array<Vec3d, 4>;
using Pieces = std::array<std::uint32_t, 3>;

/// The room's corners as measured. The floor and the ceiling are each counterclockwise seen from below. The
/// room is not quite a box.
constexpr double room_height = 548.8, room_depth = 559.2, light_gap = 0.1;
constexpr Quad floor_corners = {Vec3d(552.8, 0, 0), Vec3d(549.6, 0, room_depth), Vec3d(0, 0, room_depth),
                                Vec3d(0, 0, 0)};
constexpr Quad ceiling_corners = {Vec3d(556, room_height, 0), Vec3d(556, room_height, room_depth),
                                  Vec3d(0, room_height, room_depth), Vec3d(0, room_height, 0)};
constexpr double light_height = room_height - light_gap;
constexpr Quad light_corners = {Vec3d(343, light_height, 227), Vec3d(343, light_height, 332),
                                Vec3d(213, light_height, 332), Vec3d(213, light_height, 227)};
/// The blocks' tops, counterclockwise seen from above.
constexpr Quad short_block_top = {Vec3d(130, 165, 65), Vec3d(82, 165, 225), Vec3d(240, 165, 272),
                                  Vec3d(290, 165, 114)};
constexpr Quad tall_block_top = {Vec3d(423, 330, 247), Vec3d(265, 330, 296), Vec3d(314, 330, 456),
                                 Vec3d(472, 330, 406)};

TriangleMesh<double> room(const Pieces& n, detail::WeldedMesh to) {
    const Quad& f = floor_corners;
    const Quad& c = ceiling_corners;
    to.add_divided_quad({f[3], f[2], f[1], f[0]}, n[2], n[0]);
    to.add_divided_quad(c, n[2], n[0]);
    to.add_divided_quad({f[1], f[2], c[2], c[1]}, n[0], n[1]);  // back
    to.add_divided_quad({f[2], f[3], c[3], c[2]}, n[2], n[1]);  // right, seen from the open side
    to.add_divided_quad({f[0], f[1], c[1], c[0]}, n[2], n[1]);  // left
    return std::move(to.mesh);
}

TriangleMesh<double> light(const Pieces& n, detail::WeldedMesh to) {
    to.add_divided_quad(light_corners, n[2], n[0]);
    return std::move(to.mesh);
}

TriangleMesh<double> block(const Quad& top, const Pieces& n, detail::WeldedMesh to) {
    to.add_divided_quad(top, n[0], n[2]);
    for (std::size_t i = 0; i < 4; ++i) {
        const Vec3d a = top[i], b = top[(i + 1) % 4];
        const Vec3d below_a(a[0], 0, a[2]), below_b(b[0], 0, b[2]);
        to.add_divided_quad({below_a, below_b, b, a}, n[i % 2 == 0 ? 0 : 2], n[1]);
    }
    return std::move(to.mesh);
}

/// The pieces along the axes.
Pieces pieces_of(std::uint64_t size) {
    // Triangles of all faces in (y, z), in (z, x) and in (x, y): two per piece.
    return detail::nearest_box_split(size, {12, 10, 10});
}

TriangleMesh<double> build_cornell_box(std::uint64_t size, const Progress& progress) {
    const Pieces pieces = pieces_of(size);
    TriangleMesh<double> mesh;
    const auto welded = [&] { return detail::WeldedMesh(progress, size, mesh.size()); };
    mesh = room(pieces, welded());
    detail::append(mesh, light(pieces, welded()));
    detail::append(mesh, block(short_block_top, pieces, welded()));
    detail::append(mesh, block(tall_block_top, pieces, welded()));
    return mesh;
}

}  // namespace

std::array<std::uint64_t, 6> detail::parts_of_cornell_box(std::uint64_t size) {
    const Pieces pieces = pieces_of(size);
    const std::uint64_t x = pieces[0], y = pieces[1], z = pieces[2];
    return {2 * z * x, 2 * z * x, 2 * x * y, 2 * z * y, 2 * z * y, 2 * z * x};
}

template <class T>
TriangleMesh<T> cornell_box(std::uint64_t size, const Progress& progress) {
    return detail::in_precision<T>([&] { return build_cornell_box(size, progress); });
}
template TriangleMesh<float> cornell_box<float>(std::uint64_t, const Progress&);
template TriangleMesh<double> cornell_box<double>(std::uint64_t, const Progress&);

}  // namespace hedgerow
