#include <hedgerow/measure/ray_sets.h>

#include <hedgerow/ask.h>
#include <hedgerow/render/camera/presets.h>
#include <hedgerow/render/camera/ray_maker.h>
#include <hedgerow/scenes/random.h>

namespace hedgerow::measure {

namespace {

/// Calls f(i, origin, normal) for each ray i that hits. `origin` is where its next ray starts: off the
/// surface, on the side of ray i. The normal points to that side.
template <class F>
void for_each_hit(const TriangleMesh<float>& mesh, const std::vector<Ray3f>& rays,
                  const std::vector<Hit<float>>& hits, F f) {
    const auto view = mesh.view();
    for (std::size_t i = 0; i < rays.size(); ++i) {
        if (!hits[i]) continue;
        Vec3f n = normalized(view.normal(hits[i].element));
        if (dot(n, rays[i].direction) > 0) n = -n;
        f(i, offset_origin(rays[i], hits[i].t, view.triangle(hits[i].element), n), n);
    }
}

}  // namespace

Camera side_camera(const Box3f& box) {
    Camera camera;
    camera.target = box.center();
    camera.eye = camera.target + Vec3f(0.3f, 0.5f, 1.f) * (0.85f * length(box.extent()));
    camera.up = {0, 1, 0};
    camera.field_of_view = 53;
    return camera;
}

Vec3f side_light(const Box3f& box) {
    return side_camera(box).eye + Vec3f(0.6f, 0.8f, -0.3f) * length(box.extent());
}

std::vector<Ray3f> primary_rays(const Camera& camera, int size) {
    const RayMaker make(camera, size, size);
    std::vector<Ray3f> rays;
    for (int ty = 0; ty < size; ty += 16)
        for (int tx = 0; tx < size; tx += 16)
            for (int y = ty; y < ty + 16; ++y)
                for (int x = tx; x < tx + 16; ++x)
                    rays.push_back(
                        make.ray<float>(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f));
    return rays;
}

std::vector<Ray3f> diffuse_rays(const TriangleMesh<float>& mesh, const std::vector<Ray3f>& rays,
                                const std::vector<Hit<float>>& hits, std::uint64_t seed) {
    std::vector<Ray3f> result;
    for_each_hit(mesh, rays, hits, [&](std::size_t i, const Vec3f& from, const Vec3f& n) {
        Random random(7 + 16 * seed, i);
        const Vec3f d(random.direction<3>());
        result.push_back({from, normalized(n + d * 0.999f)});
    });
    return result;
}

std::vector<Ray3f> ambient_rays(std::vector<Ray3f> diffuse, const Box3f& box) {
    const float reach = length(box.extent()) / 10;
    for (Ray3f& ray : diffuse) ray.t_max = reach / length(ray.direction);
    return diffuse;
}

std::vector<Ray3f> shadow_rays(const TriangleMesh<float>& mesh, const Vec3f& light,
                               const std::vector<Ray3f>& rays, const std::vector<Hit<float>>& hits) {
    std::vector<Ray3f> result;
    for_each_hit(mesh, rays, hits, [&](std::size_t, const Vec3f& from, const Vec3f&) {
        Ray3f ray{from, light - from};
        ray.t_max = 1;
        result.push_back(ray);
    });
    return result;
}

std::vector<Ray3f> random_rays(const Box3f& box, std::size_t n, std::uint64_t seed) {
    std::vector<Ray3f> rays;
    for (std::size_t i = 0; i < n; ++i) {
        Random random(11 + 16 * seed, i);
        rays.push_back(random_ray(box, random));
    }
    return rays;
}

std::vector<RaySet> ray_sets(const TriangleMesh<float>& mesh, const Box3f& box, int size, std::size_t n) {
    const auto index = build(mesh);
    auto primary = primary_rays(side_camera(box), size);
    std::vector<Hit<float>> hits(primary.size());
    closest_hits(index, std::span<const Ray3f>(primary), std::span<Hit<float>>(hits));
    auto diffuse = diffuse_rays(mesh, primary, hits);
    return {
        {"primary", std::move(primary)}, {"diffuse", std::move(diffuse)}, {"random", random_rays(box, n)}};
}

}  // namespace hedgerow::measure
