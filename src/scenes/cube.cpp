/// The closed cube.
#include <utility>

#include <hedgerow/scenes/meshes.h>

#include "precision.h"
#include "sizing.h"
#include "steps.h"
#include "welding.h"

namespace hedgerow {
namespace {

TriangleMesh<double> build_cube(std::uint64_t size, const Progress& progress) {
    const auto pieces = detail::nearest_box_split(size, {4, 4, 4});
    detail::WeldedMesh to(progress, size);
    for (int axis = 0; axis < 3; ++axis)
        for (const double side : {-1.0, 1.0}) {
            const int u = (axis + 1) % 3, v = (axis + 2) % 3;
            const auto corner = [&](double a, double b) {
                Vec3d p;
                p[axis] = side, p[u] = a, p[v] = b;
                return p;
            };
            const auto pieces_u = pieces[static_cast<std::size_t>(u)],
                       pieces_v = pieces[static_cast<std::size_t>(v)];
            // Counterclockwise seen from outside: on the low side the second axis runs backwards.
            to.add_divided_quad({corner(-1, -side), corner(1, -side), corner(1, side), corner(-1, side)},
                                pieces_u, pieces_v);
        }
    return std::move(to.mesh);
}

}  // namespace

template <class T>
TriangleMesh<T> cube(std::uint64_t size, const Progress& progress) {
    return detail::in_precision<T>([&] { return build_cube(size, progress); });
}
template TriangleMesh<float> cube<float>(std::uint64_t, const Progress&);
template TriangleMesh<double> cube<double>(std::uint64_t, const Progress&);

}  // namespace hedgerow
