/// Discrete orientation polytopes: boxes with their edges and corners cut off.
#pragma once

#include <hedgerow/geometry/slab.h>

namespace hedgerow {

/// The directions of k-DOPs: the axes, then the diagonals of the cube (or square), then the diagonals of the
/// cube's faces.
template <int D>
struct KdopDirections;
template <>
struct KdopDirections<3> {
    static constexpr Vec3d all[] = {{1, 0, 0},  {0, 1, 0},   {0, 0, 1}, {1, 1, 1},  {1, 1, -1},
                                    {1, -1, 1}, {1, -1, -1}, {1, 1, 0}, {1, -1, 0}, {1, 0, 1},
                                    {1, 0, -1}, {0, 1, 1},   {0, 1, -1}};
};
template <>
struct KdopDirections<2> {
    static constexpr Vec2d all[] = {{1, 0}, {0, 1}, {1, 1}, {1, -1}};
};

/// A k-DOP: k/2 slabs in fixed directions (Klosowski, Held, Mitchell, Sowizral and Zikan 1998). In space: the
/// axes alone (6), a box with its corners cut off (14), with its edges cut off (18), or with both (26). In
/// the plane: 4 or 8.
template <std::floating_point T, int D, int k>
struct Kdop {
    static_assert(D == 3 ? k == 6 || k == 14 || k == 18 || k == 26 : k == 4 || k == 8);
    using Scalar = T;
    static constexpr int dimension = D;

    T low[k / 2], high[k / 2];

    static constexpr int orthonormal = D;
    static constexpr int slab_count() { return k / 2; }
    static constexpr Vec<double, D> direction(int i) {
        return KdopDirections<D>::all[k == 18 && i >= D ? i + 4 : i];
    }
    Slab<D> slab(int i) const {
        return {direction(i), static_cast<double>(low[i]), static_cast<double>(high[i])};
    }
};

}  // namespace hedgerow
