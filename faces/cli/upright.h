/// Which way is up in a scene, when nobody says.
#pragma once

#include <algorithm>
#include <cmath>
#include <string>

#include <hedgerow/primitives/triangle_mesh.h>

#include "common.h"

namespace hedgerow::cli {

/// An axis, 0 for x to 2 for z, and the reason for it in words.
struct Upright {
    int axis;
    std::string reason;

    char letter() const { return static_cast<char>('x' + axis); }
};

/// What lies flat where a mesh is lowest along an axis: the area, seen along the axis, of the triangles
/// within a two-hundredth of the mesh's diagonal, and its share of that side of the bounding box.
struct FlatBase {
    double area = 0, share = 0;

    /// Whether a mesh stands on this one rather than on the other: it covers a tenth of its side, a larger
    /// share than the other of its own, and four times the other's area.
    bool large_beside(const FlatBase& other) const {
        return share >= 0.1 && share > other.share && area >= 4 * other.area;
    }
};
struct FlatBases {
    FlatBase y, z;
};

/// O(n).
template <std::floating_point T>
FlatBases flat_bases(const TriangleMeshView<T>& mesh) {
    Box3d box;
    for (std::size_t i = 0; i < mesh.size(); ++i)
        for (const auto& p : mesh.corners(i)) box.expand(Vec3d(p));
    if (box.empty()) return {};
    const Vec3d extent = box.extent();
    const double thin = length(extent) / 200;
    Vec3d area;
    for (std::size_t i = 0; i < mesh.size(); ++i) {
        const auto [a, b, c] = mesh.corners(i);
        const Vec3d across = cross(Vec3d(b) - Vec3d(a), Vec3d(c) - Vec3d(a)) * 0.5;
        for (int k = 1; k < 3; ++k)
            if (static_cast<double>(std::max({a[k], b[k], c[k]})) <= box.low[k] + thin)
                area[k] += std::abs(across[k]);
    }
    const auto base = [&](int axis) {
        const double side = extent[0] * extent[3 - axis];
        return FlatBase{area[axis], side > 0 ? std::min(1.0, area[axis] / side) : 0};
    };
    return {base(1), base(2)};
}

/// By the format of a mesh file, and where that leaves it open by its flat bases.
Upright upright_by_format(const std::string& path, const FlatBases& bases);

/// Generated scenes and points have Z up, meshes from files what their format says.
template <class P>
Upright upright_of(const Common& common, const P& primitives) {
    if (common.scene.starts_with("gen:")) return {2, "as in all generated scenes"};
    using T = typename P::Scalar;
    if constexpr (std::same_as<P, TriangleMeshView<T>>)
        return upright_by_format(common.scene, flat_bases(primitives));
    else if constexpr (std::same_as<P, TriangleMesh<T>>)
        return upright_by_format(common.scene, flat_bases(primitives.view()));
    else
        return {2, "as in all scenes of points"};
}

}  // namespace hedgerow::cli
