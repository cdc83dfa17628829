/// The rays that the benchmarks trace.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <hedgerow/geometry/box.h>
#include <hedgerow/geometry/ray.h>
#include <hedgerow/primitives/triangle_mesh.h>
#include <hedgerow/queries/hit.h>
#include <hedgerow/render/camera/camera.h>
#include <hedgerow/scenes/random.h>

namespace hedgerow::measure {

/// Primary rays are those of a picture. Diffuse rays leave the hits of primary rays as from a matte surface,
/// shadow rays leave these hits towards one light. Ambient rays are diffuse rays that end after a tenth of
/// the scene's diagonal. Random rays go from one random point of the scene's box through another.
enum class RayKind { primary, diffuse, random, shadow, ambient };
inline constexpr std::string_view ray_kinds[] = {"primary", "diffuse", "random", "shadow", "ambient"};
constexpr std::string_view name_of(RayKind kind) {
    return ray_kinds[static_cast<std::size_t>(kind)];
}
/// Whether neighbouring rays of the kind take nearly the same path.
constexpr bool coherent(RayKind kind) {
    return kind == RayKind::primary || kind == RayKind::shadow;
}
/// Whether rays of the kind ask if something is in their way, and not what.
constexpr bool only_any_hit(RayKind kind) {
    return kind == RayKind::shadow || kind == RayKind::ambient;
}

/// A view of a box from the side, and a light above and beside it.
Camera side_camera(const Box3f& box);
Vec3f side_light(const Box3f& box);
/// The rays of a size × size picture, rounded up to whole tiles of 16×16, tile by tile.
std::vector<Ray3f> primary_rays(const Camera& camera, int size);
/// Rays from the hits, cosine-distributed about the normal.
std::vector<Ray3f> diffuse_rays(const TriangleMesh<float>& mesh, const std::vector<Ray3f>& rays,
                                const std::vector<Hit<float>>& hits, std::uint64_t seed = 0);
/// Diffuse rays that end after a tenth of the box's diagonal.
std::vector<Ray3f> ambient_rays(std::vector<Ray3f> diffuse, const Box3f& box);
/// Rays from the hits to a point light, which is at t = 1.
std::vector<Ray3f> shadow_rays(const TriangleMesh<float>& mesh, const Vec3f& light,
                               const std::vector<Ray3f>& rays, const std::vector<Hit<float>>& hits);
std::vector<Ray3f> random_rays(const Box3f& box, std::size_t n, std::uint64_t seed = 0);

/// A random point of the box, and a ray from one such point through another.
template <std::floating_point T, int D>
Vec<T, D> random_point(const Box<T, D>& box, Random& random) {
    const Vec<double, D> share = random.in_cube<D>();
    Vec<T, D> p;
    for (int k = 0; k < D; ++k) p[k] = box.low[k] + static_cast<T>(share[k]) * (box.high[k] - box.low[k]);
    return p;
}
template <std::floating_point T, int D>
Ray<T, D> random_ray(const Box<T, D>& box, Random& random) {
    const Vec<T, D> from = random_point(box, random);
    return {from, random_point(box, random) - from};
}

struct RaySet {
    std::string name;
    std::vector<Ray3f> rays;
    bool coherent = false;      ///< see the function of this name
    bool only_any_hit = false;  ///< see the function of this name
};
/// Primary rays of a size × size picture, one diffuse ray from each of their hits, and n random ones.
std::vector<RaySet> ray_sets(const TriangleMesh<float>& mesh, const Box3f& box, int size, std::size_t n);

}  // namespace hedgerow::measure
