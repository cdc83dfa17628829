/// Slabs, which are the space between two parallel planes, and volumes that are intersections of slabs.
#pragma once

#include <hedgerow/geometry/vec.h>

namespace hedgerow {

/// The points x with low <= normal·x <= high. A slab with low = −infinity is a half-space.
template <int D>
struct Slab {
    Vec<double, D> normal;
    double low, high;

    /// The most that a height changes when every coordinate changes by 1: the sum of the normal's magnitudes.
    double reach() const {
        double sum = 0;
        for (int k = 0; k < D; ++k) sum += std::abs(normal[k]);
        return sum;
    }
};

/// A volume that is the intersection of its slabs. The first `orthonormal` of the slabs have orthonormal
/// normals.
template <class V>
concept SlabVolume = requires(const V& v) {
    { V::orthonormal } -> std::convertible_to<int>;
    { v.slab_count() } -> std::convertible_to<int>;
    { v.slab(0) } -> std::same_as<Slab<V::dimension>>;
};

}  // namespace hedgerow
