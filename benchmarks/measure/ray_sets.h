/// The rays that the benchmarks ask.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <hedgerow/geometry/box.h>
#include <hedgerow/geometry/ray.h>
#include <hedgerow/primitives/triangle_mesh.h>
#include <hedgerow/queries/hit.h>

namespace hedgerow::benchmark {

/// A mesh file, or gen:NAME[:SIZE].
TriangleMesh<float> scene(const std::string& name);

/// A picture's rays; what leaves their hits, spread as from a matte surface, or towards one light; and lines
/// between random points of the scene's box.
enum class RayKind { primary, diffuse, random, shadow };
inline constexpr std::string_view ray_kinds[] = {"primary", "diffuse", "random", "shadow"};
constexpr std::string_view name_of(RayKind kind) {
    return ray_kinds[static_cast<std::size_t>(kind)];
}
/// Whether neighbours among them go much the same way.
constexpr bool coherent(RayKind kind) {
    return kind == RayKind::primary || kind == RayKind::shadow;
}

/// A pinhole view of the scene from the side, size × size, in 16×16 tiles.
std::vector<Ray3f> primary_rays(const Box3f& box, int size);
/// From the hits: cosine-distributed about the normal.
std::vector<Ray3f> diffuse_rays(const TriangleMesh<float>& mesh, const std::vector<Ray3f>& rays,
                                const std::vector<Hit<float>>& hits, std::uint64_t seed = 0);
/// From the hits to a point light that stands above the scene and beside the eye, at t = 1.
std::vector<Ray3f> shadow_rays(const TriangleMesh<float>& mesh, const Box3f& box,
                               const std::vector<Ray3f>& rays, const std::vector<Hit<float>>& hits);
std::vector<Ray3f> random_rays(const Box3f& box, std::size_t n, std::uint64_t seed = 0);

struct RaySet {
    std::string name;
    std::vector<Ray3f> rays;
};
/// Primary rays of a size × size picture, one diffuse ray from each of their hits, and n random ones.
std::vector<RaySet> ray_sets(const TriangleMesh<float>& mesh, const Box3f& box, int size, std::size_t n);

}  // namespace hedgerow::benchmark
