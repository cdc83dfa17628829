/// Distances of points to a few elements of a set, all elements at once. What they are for are upper bounds:
/// a distance is never below the true one, and mostly a few roundings of double above it.
#pragma once

#include <cstdint>

#include <hedgerow/base/instruction_set.h>
#include <hedgerow/geometry/shapes.h>

namespace hedgerow {

/// Up to eight triangles, or points as triangles whose corners are one. Rows of coordinates and of what
/// `prepare` derives from them, an element a place. Places beyond `count` must hold numbers.
struct NearElements {
    static constexpr int most = 8;

    alignas(64) double a[3][most], b[3][most], c[3][most];
    // Edges, products of edges, and reciprocals of these; 0 where an edge has no length.
    double ab[3][most], ac[3][most], ab2[most], ac2[most], abac[most];
    double per_ab2[most], per_ac2[most], per_bc2[most], per_area2[most];
    int count;
    bool points;       // all elements are
    unsigned slivers;  // a bit for each triangle whose plane is not known well

    void set(int place, const Triangle<double, 3>& t) {
        for (int k = 0; k < 3; ++k) a[k][place] = t.a[k], b[k][place] = t.b[k], c[k][place] = t.c[k];
    }
    Triangle<double, 3> triangle(int i) const {
        return {Vec3d(a[0][i], a[1][i], a[2][i]), Vec3d(b[0][i], b[1][i], b[2][i]),
                Vec3d(c[0][i], c[1][i], c[2][i])};
    }
};

/// How far a point is from each of some elements at most, and which is the nearest: the lowest of equal ones.
/// The distance to what is not there is infinite.
struct ToElements {
    alignas(64) double distance[NearElements::most];
    int nearest;

    double least() const { return distance[nearest]; }
};

/// A distance d that was computed stands for one of d·(1 + relative) + absolute.
struct DistanceMargin {
    double relative, absolute;
};

/// What measures elements, for one instruction set. All give the same bits.
struct ElementKernels {
    void (*prepare)(NearElements&);
    /// Measures `count` points.
    void (*measure)(const NearElements&, const DistanceMargin&, const Vec3d* points, int count,
                    ToElements* found);
};
template <>
const ElementKernels* in_use<ElementKernels>();
/// Those in use, or plain ones.
const ElementKernels& element_kernels();

}  // namespace hedgerow
