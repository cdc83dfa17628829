/// Scenes that no plane or cell divides well, because all primitives meet in one place.
#pragma once

#include <cmath>
#include <numbers>

#include <hedgerow/hedgerow.h>
#include <hedgerow/scenes/meshes.h>
#include <hedgerow/scenes/random.h>

namespace hedgerow::crowded {

/// A disc of n slivers, perpendicular to z, that meet in its middle. With a raised middle it is a cone.
template <class T>
TriangleMesh<T> fan(std::uint32_t n, double raised = 0) {
    TriangleMesh<T> mesh;
    mesh.vertices.emplace_back(T(0), T(0), T(raised));
    for (std::uint32_t i = 0; i < n; ++i) {
        const double angle = 2 * std::numbers::pi * i / n;
        mesh.vertices.emplace_back(T(std::cos(angle)), T(std::sin(angle)), T(0));
        mesh.triangles.push_back({0, i + 1, (i + 1) % n + 1});
    }
    return mesh;
}
/// The same triangle n times.
template <class T>
TriangleMesh<T> alike(std::uint32_t n) {
    TriangleMesh<T> mesh;
    mesh.vertices = {{T(0), T(0), T(0.1)}, {T(1), T(0.2), T(1)}, {T(0.3), T(1), T(0)}};
    mesh.triangles.assign(n, {0, 1, 2});
    return mesh;
}
/// The 12 triangles of one box, repeated until there are n.
template <class T>
TriangleMesh<T> boxes(std::uint32_t n) {
    TriangleMesh<T> mesh = cube<T>(12);
    const auto one = mesh.triangles;
    while (mesh.triangles.size() < n) mesh.triangles.push_back(one[mesh.triangles.size() % one.size()]);
    return mesh;
}
/// Triangles whose boxes are centered at the origin and have one size, or n sizes.
template <class T>
TriangleMesh<T> around_origin(std::uint32_t n, bool one_size) {
    TriangleMesh<T> mesh;
    for (std::uint32_t i = 0; i < n; ++i) {
        Random random(7, i);
        const T h = T(one_size ? 1 : 1 - double(i) / n);
        const auto within = [&] { return T(2 * random.uniform() - 1) * h; };
        mesh.vertices.emplace_back(-h, -h, within());
        mesh.vertices.emplace_back(h, within(), h);
        mesh.vertices.emplace_back(within(), h, -h);
        mesh.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
    }
    return mesh;
}
/// Spheres around the origin that have one size, or n sizes.
template <class T>
SphereSet<T, 3> spheres_around_origin(std::uint32_t n, bool one_size) {
    SphereSet<T, 3> set;
    for (std::uint32_t i = 0; i < n; ++i)
        set.spheres.push_back({Vec<T, 3>::all(T(0)), T(one_size ? 1 : 1 - double(i) / n)});
    return set;
}
/// Segments from one point in the plane to n others around it.
template <class T>
SegmentSet<T> star(std::uint32_t n) {
    SegmentSet<T> set;
    for (std::uint32_t i = 0; i < n; ++i)
        set.segments.push_back({{T(0.1), T(0.2)}, Vec<T, 2>(Random(2, i).direction<2>())});
    return set;
}
/// The same segment n times.
template <class T>
SegmentSet<T> alike_segments(std::uint32_t n) {
    SegmentSet<T> set;
    set.segments.assign(n, {{T(0), T(0.1)}, {T(1), T(0.7)}});
    return set;
}
/// The same point n times.
template <class T, int D>
PointCloud<T, D> alike_points(std::uint32_t n) {
    PointCloud<T, D> set;
    set.points.assign(n, Vec<T, D>::all(T(0.3)));
    return set;
}

}  // namespace hedgerow::crowded
