/// Converts scenes in double to scenes in T.
#pragma once

#include <type_traits>
#include <utility>
#include <vector>

#include <hedgerow/primitives/point_cloud.h>
#include <hedgerow/primitives/segment_set.h>
#include <hedgerow/primitives/sphere_set.h>
#include <hedgerow/primitives/triangle_mesh.h>

namespace hedgerow::detail {

template <class T, int D>
Vec<T, D> narrowed(const Vec<double, D>& p) {
    return Vec<T, D>(p);
}
template <class T>
Segment<T, 2> narrowed(const Segment<double, 2>& s) {
    return {narrowed<T>(s.a), narrowed<T>(s.b)};
}
template <class T>
Sphere<T, 3> narrowed(const Sphere<double, 3>& s) {
    return {narrowed<T>(s.center), static_cast<T>(s.radius)};
}
template <class T, class E>
auto narrowed(const std::vector<E>& all) {
    std::vector<decltype(narrowed<T>(all[0]))> result;
    result.reserve(all.size());
    for (const E& element : all) result.push_back(narrowed<T>(element));
    return result;
}
template <class T>
TriangleMesh<T> narrowed(TriangleMesh<double>&& mesh) {
    return {narrowed<T>(mesh.vertices), std::move(mesh.triangles), std::move(mesh.faces)};
}
template <class T>
SphereSet<T, 3> narrowed(SphereSet<double, 3>&& set) {
    return {narrowed<T>(set.spheres)};
}
template <class T, int D>
PointCloud<T, D> narrowed(PointCloud<double, D>&& cloud) {
    return {narrowed<T>(cloud.points)};
}
template <class T>
SegmentSet<T> narrowed(SegmentSet<double>&& set) {
    return {narrowed<T>(set.segments)};
}

/// Returns build() with each coordinate rounded to T once. Rounding is to nearest, whatever mode the caller
/// has set.
template <class T, class F>
auto in_precision(F build) {
    return in_ieee_mode([&] {
        if constexpr (std::is_same_v<T, double>)
            return build();
        else
            return narrowed<T>(build());
    });
}

}  // namespace hedgerow::detail
