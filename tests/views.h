/// Cameras around a scene and in it, and what is seen from them.
#pragma once

#include <vector>

#include <gtest/gtest.h>

#include <hedgerow/primitives/triangle_mesh.h>
#include <hedgerow/queries/hit.h>
#include <hedgerow/render/camera/camera.h>
#include <hedgerow/scenes/random.h>

namespace hedgerow {

/// Camera number `number` near a mesh or in its box; with parallel rays if they are asked for.
template <class T>
Camera seen_from(const TriangleMesh<T>& mesh, std::uint64_t number, bool inside, bool parallel = false) {
    Box<T, 3> box;
    for (const auto& v : mesh.vertices) box.expand(v);
    Random random(77, number);
    const Vec3f middle(box.center()), extent(box.extent());
    const auto in_cube = [&] { return Vec3f(random.in_cube<3>() - Vec3d::all(0.5)); };
    Camera camera;
    const Vec3f away = in_cube();
    camera.eye = middle;
    for (int k = 0; k < 3; ++k) camera.eye[k] += extent[k] * away[k] * (inside ? 0.8f : 3.f);
    camera.target = middle;
    if (inside) camera.target = camera.eye + in_cube();
    camera.up = number % 3 == 0 ? in_cube() : Vec3f(0, 0, 1);
    camera.field_of_view = number % 4 == 0 ? 110 : number % 4 == 1 ? 0.5f : 45;
    if (parallel) camera.projection = Projection::orthographic;
    return camera;
}

/// Expects the same hits of all samples, and tells how many differ.
template <class T>
void expect_same(const std::vector<Hit<T>>& want, const std::vector<Hit<T>>& hits) {
    std::size_t differ = 0;
    for (std::size_t i = 0; i < hits.size(); ++i) differ += !(hits[i] == want[i]);
    EXPECT_EQ(differ, 0u) << "of " << hits.size();
}

}  // namespace hedgerow
