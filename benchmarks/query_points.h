/// The points that benchmarks ask about.
#pragma once

#include <cmath>
#include <random>
#include <vector>

#include <hedgerow/primitives/triangle_mesh.h>

namespace hedgerow {

/// Places on triangles, chosen by area, moved off by up to 1% of the diagonal.
inline std::vector<Vec3f> near_points(const TriangleMesh<float>& mesh, const Box3f& box, std::size_t count) {
    const TriangleMeshView<float> view = mesh.view();
    std::vector<double> areas;
    for (std::size_t i = 0; i < mesh.size(); ++i)
        areas.push_back(static_cast<double>(length(view.normal(i))));
    std::mt19937 random(1);
    std::discrete_distribution<std::size_t> triangle(areas.begin(), areas.end());
    std::uniform_real_distribution<float> share(0, 1), off(-1, 1);
    const float way = 0.01f * length(box.extent()) / std::sqrt(3.0f);
    std::vector<Vec3f> points;
    for (std::size_t i = 0; i < count; ++i) {
        const auto t = view.triangle(triangle(random));
        float v = share(random), w = share(random);
        if (v + w > 1) v = 1 - v, w = 1 - w;
        const Vec3f p = t.a + (t.b - t.a) * v + (t.c - t.a) * w;
        points.push_back(p + Vec3f(off(random), off(random), off(random)) * way);
    }
    return points;
}
/// Points anywhere in the doubled box.
inline std::vector<Vec3f> far_points(const Box3f& box, std::size_t count) {
    std::mt19937 random(2);
    std::uniform_real_distribution<float> at(-0.5f, 1.5f);
    std::vector<Vec3f> points;
    for (std::size_t i = 0; i < count; ++i) {
        Vec3f p;
        for (int k = 0; k < 3; ++k) p[k] = box.low[k] + box.extent()[k] * at(random);
        points.push_back(p);
    }
    return points;
}

}  // namespace hedgerow
