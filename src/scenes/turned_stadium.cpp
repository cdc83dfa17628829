/// The teapot in a stadium, out of line with every axis.
#include <cmath>

#include <hedgerow/scenes/meshes.h>

#include "precision.h"
#include "steps.h"

namespace hedgerow {
namespace {

/// Turns p by 30°, first about x and then about y.
Vec3d turned(const Vec3d& p) {
    const double cosine = std::sqrt(3.0) / 2, sine = 0.5;
    const Vec3d q(p[0], product(cosine, p[1]) - product(sine, p[2]),
                  product(sine, p[1]) + product(cosine, p[2]));
    return {product(cosine, q[0]) + product(sine, q[2]), q[1], product(cosine, q[2]) - product(sine, q[0])};
}

TriangleMesh<double> build_turned_stadium(std::uint64_t size, const Progress& progress) {
    TriangleMesh<double> mesh = teapot_in_stadium<double>(size, progress);
    for (Vec3d& p : mesh.vertices) p = turned(p);
    return mesh;
}

}  // namespace

template <class T>
TriangleMesh<T> turned_stadium(std::uint64_t size, const Progress& progress) {
    return detail::in_precision<T>([&] { return build_turned_stadium(size, progress); });
}
template TriangleMesh<float> turned_stadium<float>(std::uint64_t, const Progress&);
template TriangleMesh<double> turned_stadium<double>(std::uint64_t, const Progress&);

}  // namespace hedgerow
