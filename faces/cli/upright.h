/// The upward axis of a scene, if the user does not name one.
#pragma once

#include <algorithm>
#include <cmath>
#include <string>

#include <hedgerow/primitives/triangle_mesh.h>

#include "common.h"

namespace hedgerow::cli {

/// An upward axis, 0 for x to 2 for z, and the reason for it in words.
struct Upright {
    int axis;
    std::string reason;

    char letter() const { return static_cast<char>('x' + axis); }
};

/// The flat base of a mesh along an axis: its triangles that lie within 1/200 of the mesh's diagonal of its
/// lowest point. `area` is their area as seen along the axis, and `share` is that area as a share of the
/// bounding box's side, at most 1.
struct FlatBase {
    double area = 0, share = 0;

    /// Whether a mesh stands on this base rather than on the other. It does if this base covers at least a
    /// tenth of its side, a larger share than the other covers of its side, and at least four times the
    /// other's area.
    bool large_beside(const FlatBase& other) const {
        return share >= 0.1 && share > other.share && area >= 4 * other.area;
    }
};
struct FlatBases {
    FlatBase y, z;
};

/// The flat bases of a mesh along y and along z. O(n).
template <std::floating_point T>
FlatBases flat_bases(const TriangleMeshView<T>& mesh) {
    // Find the bounding box.
    Box3d box;
    for (std::size_t i = 0; i < mesh.size(); ++i)
        for (const auto& p : mesh.corners(i)) box.expand(Vec3d(p));
    if (box.empty()) return {};
    const Vec3d extent = box.extent();
    const double thin = length(extent) / 200;
    // Sum up the areas of the triangles that are low along y or z, as seen along that axis.
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

/// The upward axis by the format of a mesh file, or by the flat bases if the format defines none.
Upright upright_by_format(const std::string& path, const FlatBases& bases);

/// The upward axis of a scene: z for generated scenes and points, upright_by_format for meshes from files.
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
