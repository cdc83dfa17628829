/// The boxes of a binary node's two children. For each axis: both low planes, then both high planes.
#pragma once

#include <hedgerow/geometry/box.h>

namespace hedgerow {

template <std::floating_point T, int D>
struct BoxPair {
    using Scalar = T;
    static constexpr int dimension = D;
    static constexpr int width = 2;

    T plane[D][4];  // low of 0, low of 1, high of 0, high of 1

    Box<T, D> operator[](int i) const {
        Box<T, D> b;
        for (int k = 0; k < D; ++k) b.low[k] = plane[k][i], b.high[k] = plane[k][2 + i];
        return b;
    }
    void set(int i, const Box<T, D>& b) {
        for (int k = 0; k < D; ++k) plane[k][i] = b.low[k], plane[k][2 + i] = b.high[k];
    }
};

}  // namespace hedgerow
