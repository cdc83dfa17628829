/// The teapot in a stadium.
#include <vector>

#include <hedgerow/scenes/meshes.h>

#include "circle.h"
#include "parts.h"
#include "precision.h"
#include "sizing.h"
#include "steps.h"
#include "welding.h"

namespace hedgerow {
namespace {

// In units of the teapot's data; the teapot is 6.4 long.
constexpr double field_half_length = 600, field_half_width = 400;
constexpr double seating_depth = 490, wall_height = 10, rake_height = 250;
constexpr double teapot_height_above_field = 0x1p-6;  // so that the teapot and the field do not touch

/// A point of the bowl's profile: its distance outside of the field's edge, and its height. Within the field,
/// `scale` shrinks the edge instead.
struct SectionPoint {
    double outside, z, scale = 1;
};

/// The profile, from near the middle of the field to the foot of the outer wall.
std::vector<SectionPoint> section(std::uint64_t rows, int field_rings) {
    std::vector<SectionPoint> points;
    for (int i = 1; i <= field_rings; ++i) points.push_back({0, 0, static_cast<double>(i) / field_rings});
    for (std::uint64_t i = 0; i < rows; ++i) {
        const double s = static_cast<double>(i) / static_cast<double>(rows);
        const double end = static_cast<double>(i + 1) / static_cast<double>(rows);
        const double z = wall_height + product(rake_height, (s + product(s, s)) / 2);  // steeper further up
        points.push_back({product(seating_depth, s), z});
        points.push_back({product(seating_depth, end), z});
    }
    points.push_back({seating_depth, 0});
    return points;
}

TriangleMesh<double> bowl(std::uint64_t size, const Progress& progress) {
    const int field_rings = size < 4000 ? 1 : 2;
    // A column has eight segments. A segment has four triangles per row of seats, and 2·field_rings + 1 for
    // the field and the outer wall.
    const detail::Split split = detail::nearest_split(size, {32, 16 * field_rings + 8, 0.5});
    const std::vector<Vec2d> around = detail::circle(split.columns);
    const auto n = static_cast<std::uint32_t>(around.size());
    TriangleMesh<double> mesh;
    mesh.vertices.push_back({});
    std::uint32_t inner = 0;
    // Add the rings of the profile, and join each to the one before. The first ring is joined to the middle.
    for (const SectionPoint& at : section(split.rows, field_rings)) {
        const auto outer = static_cast<std::uint32_t>(mesh.vertices.size());
        const double a = product(field_half_length, at.scale) + at.outside;
        const double b = product(field_half_width, at.scale) + at.outside;
        for (const Vec2d& p : around) mesh.vertices.push_back({product(a, p[0]), product(b, p[1]), at.z});
        for (std::uint32_t i = 0; i < n; ++i) {
            detail::step(progress, mesh.size(), size, 2);
            const std::uint32_t next = i + 1 < n ? i + 1 : 0;
            mesh.triangles.push_back({inner == 0 ? 0 : inner + i, outer + i, outer + next});
            if (inner != 0) mesh.triangles.push_back({inner + i, outer + next, inner + next});
        }
        inner = outer;
    }
    return mesh;
}

TriangleMesh<double> build_stadium(std::uint64_t size, const Progress& progress) {
    const TriangleMesh<double> pot =
        teapot<double>(detail::teapot_size_of_stadium(size), detail::part_of(progress));
    TriangleMesh<double> mesh = bowl(size > pot.size() ? size - pot.size() : 0, progress);
    detail::append(mesh, pot, {0, 0, teapot_height_above_field});
    return mesh;
}

}  // namespace

template <class T>
TriangleMesh<T> teapot_in_stadium(std::uint64_t size, const Progress& progress) {
    return detail::in_precision<T>([&] { return build_stadium(size, progress); });
}
template TriangleMesh<float> teapot_in_stadium<float>(std::uint64_t, const Progress&);
template TriangleMesh<double> teapot_in_stadium<double>(std::uint64_t, const Progress&);

}  // namespace hedgerow
