/// The Utah teapot, tessellated.
#include <utility>

#include <hedgerow/scenes/meshes.h>

#include "precision.h"
#include "sizing.h"
#include "steps.h"
#include "teapot_patches.h"
#include "welding.h"

namespace hedgerow {
namespace {

using Row = std::array<Vec3d, 4>;
using Patch = std::array<Row, 4>;

Row control_points(const detail::TeapotRing& ring) {
    const double r = ring.radius, near = product(ring.bulge, r), z = ring.z;
    return {Vec3d(r, 0, z), Vec3d(r, -near, z), Vec3d(near, -r, z), Vec3d(0, -r, z)};
}
Row control_points(const detail::TeapotOval& o) {
    const double y = -o.half_width;
    return {Vec3d(o.x0, 0, o.z0), Vec3d(o.x0, y, o.z0), Vec3d(o.x1, y, o.z1), Vec3d(o.x1, 0, o.z1)};
}
template <class R>
Patch control_points(const std::array<R, 4>& rows) {
    return {control_points(rows[0]), control_points(rows[1]), control_points(rows[2]),
            control_points(rows[3])};
}

/// The point at i/n on the way from a to b. It is exactly a or b at the ends, and where a and b are equal. So
/// patches can be welded, and poles are single points.
Vec3d between(const Vec3d& a, const Vec3d& b, std::uint64_t i, std::uint64_t n) {
    const auto part = [n](std::uint64_t k) { return static_cast<double>(k) / static_cast<double>(n); };
    return 2 * i < n ? a + (b - a) * part(i) : b + (a - b) * part(n - i);
}

/// The cubic Bézier curve at i/n (de Casteljau).
Vec3d on_curve(const Row& p, std::uint64_t i, std::uint64_t n) {
    const Vec3d a = between(p[0], p[1], i, n), b = between(p[1], p[2], i, n), c = between(p[2], p[3], i, n);
    return between(between(a, b, i, n), between(b, c, i, n), i, n);
}

/// Adds one patch in rows × columns quadrilaterals, mirrored in x or y or both.
void add_patch(detail::WeldedMesh& to, const Patch& patch, const detail::Split& split, bool flip_x,
               bool flip_y) {
    std::vector<Vec3d> last, row(split.columns + 1);
    for (std::uint64_t i = 0; i <= split.rows; ++i) {
        Row across;
        for (std::size_t k = 0; k < 4; ++k)
            across[k] = on_curve({patch[0][k], patch[1][k], patch[2][k], patch[3][k]}, i, split.rows);
        for (std::uint64_t k = 0; k <= split.columns; ++k) {
            const Vec3d p = on_curve(across, k, split.columns);
            row[k] = {flip_x ? -p[0] : p[0], flip_y ? -p[1] : p[1], p[2]};
        }
        for (std::uint64_t k = 0; i > 0 && k < split.columns; ++k) {
            if (flip_x == flip_y)
                to.add_quad(last[k], last[k + 1], row[k + 1], row[k]);
            else
                to.add_quad(last[k], row[k], row[k + 1], last[k + 1]);
        }
        last = row;
    }
}

TriangleMesh<double> build_teapot(std::uint64_t size, const Progress& progress) {
    // 32 patches have two triangles per cell. At the two poles, one patch in each quarter loses one triangle
    // per column. In one column handle and spout would be flat, so one column is only for sizes that two
    // cannot reach.
    const std::uint64_t least_columns = size < 90 ? 1 : 2;
    const detail::Split split = detail::nearest_split(size, {64, -8, 1, least_columns});
    detail::WeldedMesh to(progress, size);
    for (const auto& rings : detail::teapot_revolved)
        for (const bool flip_x : {false, true})
            for (const bool flip_y : {false, true})
                add_patch(to, control_points(rings), split, flip_x, flip_y);
    for (const auto& ovals : detail::teapot_swept)
        for (const bool flip_y : {false, true}) add_patch(to, control_points(ovals), split, false, flip_y);
    return std::move(to.mesh);
}

}  // namespace

template <class T>
TriangleMesh<T> teapot(std::uint64_t size, const Progress& progress) {
    return detail::in_precision<T>([&] { return build_teapot(size, progress); });
}
template TriangleMesh<float> teapot<float>(std::uint64_t, const Progress&);
template TriangleMesh<double> teapot<double>(std::uint64_t, const Progress&);

}  // namespace hedgerow
