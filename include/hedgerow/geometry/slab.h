/// What lies between two parallel planes, and volumes that are what several slabs share.
#pragma once

#include <hedgerow/geometry/vec.h>

namespace hedgerow {

/// The points x with low <= normal·x <= high. low may be −infinity: then it is a half-space.
template <int D>
struct Slab {
    Vec<double, D> normal;
    double low, high;

    /// The sum of the normal's magnitudes: how far heights move at most when every coordinate moves by 1.
    double reach() const {
        double sum = 0;
        for (int k = 0; k < D; ++k) sum += std::abs(normal[k]);
        return sum;
    }
};

/// What its slabs share. The first `orthonormal` of them have orthonormal normals.
template <class V>
concept SlabVolume = requires(const V& v) {
    { V::orthonormal } -> std::convertible_to<int>;
    { v.slab_count() } -> std::convertible_to<int>;
    { v.slab(0) } -> std::same_as<Slab<V::dimension>>;
};

}  // namespace hedgerow
