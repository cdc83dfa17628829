/// Scenes, ray sets and clocks that the benchmarks share.
#pragma once

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <string>
#include <vector>

#include <hedgerow/any_index.h>
#include <hedgerow/io/mesh_file.h>
#include <hedgerow/scenes/generate.h>
#include <hedgerow/scenes/random.h>

namespace hedgerow::benchmark {

inline double seconds() {
    using namespace std::chrono;
    return duration<double>(steady_clock::now().time_since_epoch()).count();
}
/// The clock in GHz while one thread computes: 64-bit products that wait for each other take 3 cycles on
/// every processor of the last decade.
inline double clock_rate() {
    constexpr int products = 20'000'000;
    std::uint64_t x = 3;
    double least = 1e300;
    for (int r = 0; r < 5; ++r) {
        const double start = seconds();
        for (int i = 0; i < products; ++i) {
            x *= 0x9E3779B97F4A7C15u;
            asm volatile("" : "+r"(x));
        }
        least = std::min(least, seconds() - start);
    }
    return 3e-9 * products / least;
}
inline double median(std::vector<double> all) {
    std::sort(all.begin(), all.end());
    return all[all.size() / 2];
}

inline TriangleMesh<float> scene(const std::string& name) {
    if (name.starts_with("gen:"))
        return std::get<TriangleMesh<float>>(generate<float>(parse_scene_spec(name)));
    return load_mesh<float>(name);
}

/// The processor's name, for the reader of the figures.
inline std::string processor() {
    std::string name = "unknown processor";
    if (FILE* f = std::fopen("/proc/cpuinfo", "r")) {
        char line[256];
        while (std::fgets(line, sizeof line, f))
            if (std::string(line).starts_with("model name"))
                name = std::string(line).substr(std::string(line).find(':') + 2);
        std::fclose(f);
    }
    while (!name.empty() && name.back() == '\n') name.pop_back();
    return name;
}

/// A pinhole view of the scene from the side, in 16×16 tiles.
inline std::vector<Ray3f> primary_rays(const Box3f& box, int size) {
    const Vec3f center = box.center();
    const float diagonal = length(box.extent());
    const Vec3f eye = center + Vec3f(0.3f, 0.5f, 1.f) * (0.85f * diagonal);
    const Vec3f forward = normalized(center - eye);
    const Vec3f right = normalized(cross(forward, Vec3f(0, 1, 0)));
    const Vec3f up = cross(right, forward);
    std::vector<Ray3f> rays;
    for (int ty = 0; ty < size; ty += 16)
        for (int tx = 0; tx < size; tx += 16)
            for (int y = ty; y < ty + 16; ++y)
                for (int x = tx; x < tx + 16; ++x) {
                    const float u = (float(x) + 0.5f) / float(size) - 0.5f,
                                v = 0.5f - (float(y) + 0.5f) / float(size);
                    rays.push_back({eye, normalized(forward + right * u + up * v)});
                }
    return rays;
}

/// From the primary hits: cosine-distributed about the normal.
inline std::vector<Ray3f> diffuse_rays(const TriangleMesh<float>& mesh, const std::vector<Ray3f>& rays,
                                       const std::vector<Hit<float>>& hits) {
    std::vector<Ray3f> result;
    const auto view = mesh.view();
    for (std::size_t i = 0; i < rays.size(); ++i) {
        if (!hits[i]) continue;
        Vec3f n = normalized(view.normal(hits[i].element));
        if (dot(n, rays[i].direction) > 0) n = -n;
        Random random(7, i);
        const Vec3f d(random.direction<3>());
        result.push_back({offset_origin(rays[i], hits[i].t, view.triangle(hits[i].element), n),
                          normalized(n + d * 0.999f)});
    }
    return result;
}

inline std::vector<Ray3f> random_rays(const Box3f& box, std::size_t n) {
    std::vector<Ray3f> rays;
    for (std::size_t i = 0; i < n; ++i) {
        Random random(11, i);
        const auto at = [&] {
            Vec3f p;
            for (int k = 0; k < 3; ++k)
                p[k] = box.low[k] + float(random.uniform()) * (box.high[k] - box.low[k]);
            return p;
        };
        const Vec3f a = at();
        rays.push_back({a, at() - a});
    }
    return rays;
}

struct RaySet {
    std::string name;
    std::vector<Ray3f> rays;
};
/// Primary rays of a size × size picture, one diffuse ray from each of their hits, and n random ones.
inline std::vector<RaySet> ray_sets(const TriangleMesh<float>& mesh, const Box3f& box, int size,
                                    std::size_t n) {
    const auto index = build<Bvh>(mesh);
    auto primary = primary_rays(box, size);
    std::vector<Hit<float>> hits(primary.size());
    closest_hits(index, std::span<const Ray3f>(primary), std::span<Hit<float>>(hits));
    auto diffuse = diffuse_rays(mesh, primary, hits);
    return {
        {"primary", std::move(primary)}, {"diffuse", std::move(diffuse)}, {"random", random_rays(box, n)}};
}

}  // namespace hedgerow::benchmark
