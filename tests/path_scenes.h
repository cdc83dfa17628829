/// What tests of paths share: small scenes, a camera, and estimates of the light of pictures.
#pragma once

#include <cmath>
#include <cstdint>
#include <functional>
#include <utility>
#include <vector>

#include <hedgerow/parallel/executor.h>
#include <hedgerow/render/integrators/path_picture.h>
#include <hedgerow/scenes/meshes.h>

namespace hedgerow::test {

inline Material matte(const Vec3f& colour, const Vec3f& emission = {}) {
    Material m;
    m.base_colour = colour, m.emission = emission;
    return m;
}
/// One object a mesh, each with its material.
template <class T>
Model<T> model_of(const std::vector<std::pair<TriangleMesh<T>, Material>>& parts) {
    Model<T> model;
    for (const auto& [mesh, material] : parts) {
        Object<T> object;
        object.mesh = mesh;
        object.material = static_cast<std::uint32_t>(model.materials.size());
        model.instances.push_back({"", static_cast<std::uint32_t>(model.objects.size()), {}});
        model.objects.push_back(object);
        model.materials.push_back(material);
    }
    return model;
}
/// A closed box around the origin, its fronts outward.
template <class T>
TriangleMesh<T> box(double x, double y, double z, const Vec3d& middle = {}) {
    TriangleMesh<T> mesh;
    for (int i = 0; i < 8; ++i)
        mesh.vertices.push_back(
            Vec<T, 3>(middle + Vec3d((i & 1) != 0 ? x : -x, (i & 2) != 0 ? y : -y, (i & 4) != 0 ? z : -z)));
    const std::uint32_t faces[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4},
                                       {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};
    for (const auto& f : faces)
        mesh.triangles.push_back({f[0], f[1], f[2]}), mesh.triangles.push_back({f[0], f[2], f[3]});
    return mesh;
}
/// The cube's vertices drawn to a sphere of radius 1.
inline TriangleMesh<float> ball(std::uint64_t size) {
    TriangleMesh<double> fine = cube<double>(size);
    TriangleMesh<float> mesh;
    for (const Vec3d& p : fine.vertices) mesh.vertices.push_back(Vec3f(normalized(p)));
    mesh.triangles = fine.triangles;
    return mesh;
}
/// A square across z, with its front up.
template <class T>
TriangleMesh<T> square(double half, double z) {
    const T a = static_cast<T>(half), h = static_cast<T>(z);
    return {{{-a, -a, h}, {a, -a, h}, {a, a, h}, {-a, a, h}}, {{0, 1, 2}, {0, 2, 3}}, {}};
}
/// A view of 90 degrees.
inline Camera camera_at(const Vec3f& eye, const Vec3f& target, const Vec3f& up = {0, 0, 1}) {
    Camera c;
    c.eye = eye, c.target = target, c.up = up, c.field_of_view = 90;
    return c;
}
/// A picture of 8 by 6 pixels.
inline PathPictureOptions few_pixels(const Camera& camera, std::uint32_t samples) {
    PathPictureOptions o;
    o.camera = camera, o.width = 8, o.height = 6, o.samples = samples;
    return o;
}
template <class T>
PathPicture trace(const Model<T>& model, const PathPictureOptions& options,
                  SceneLightsOptions of_lights = {}) {
    const ModelScene<T> scene(model, serial_executor());
    of_lights.compensates = options.paths.material_sampling;
    const SceneLights<T> lights(scene, of_lights);
    return trace_paths(PathScene<T>{scene, lights, scene.tracer()}, by(default_executor(), options));
}
/// The mean of all pixels and samples, and its standard error, of the first colour.
struct Estimate {
    double mean = 0, error = 0;
};
inline Estimate estimate(const PathPicture& picture) {
    double sum = 0, squares = 0;
    const auto n = double(picture.light.size());
    for (std::size_t i = 0; i < picture.light.size(); ++i) {
        const auto value = double(picture.light.mean(i)[0]);
        const auto error = double(picture.light.standard_error(i));
        sum += value, squares += error * error;
    }
    return {sum / n, std::sqrt(squares) / n};
}
/// Three ways to look for light.
inline void for_each_way(const std::function<void(PathOptions&, const char*)>& look) {
    const std::pair<bool, bool> ways[] = {{true, true}, {true, false}, {false, true}};
    const char* const names[] = {"both", "light sampling", "material sampling"};
    for (int i = 0; i < 3; ++i) {
        PathOptions o;
        o.light_sampling = ways[i].first, o.material_sampling = ways[i].second;
        look(o, names[i]);
    }
}

}  // namespace hedgerow::test
