/// Up to 16 boxes in rows, the volumes of a wide node, and how a probe enters four of them at a time.
#pragma once

#include <hedgerow/geometry/box.h>
#include <hedgerow/geometry/lanes.h>

namespace hedgerow {

/// Of each axis the row of the low planes, then that of the high ones. A row has `places`, a multiple of
/// four, of which the first `boxes` are in use.
template <std::floating_point T, int D>
class BoxRows {
public:
    using Scalar = T;
    static constexpr int dimension = D;
    static constexpr int width = 16;  // at most

    BoxRows(const T* rows, int places, int boxes) : rows_(rows), places_(places), boxes_(boxes) {}

    int size() const { return boxes_; }
    Box<T, D> operator[](int i) const {
        Box<T, D> b;
        for (int k = 0; k < D; ++k) b.low[k] = low(k)[i], b.high[k] = high(k)[i];
        return b;
    }
    /// The planes across an axis.
    const T* low(int axis) const { return rows_ + 2 * axis * places_; }
    const T* high(int axis) const { return low(axis) + places_; }

    /// Bit i says what bit i − k of f(k) does, f being asked of the boxes from k to k + 3.
    template <class F>
    unsigned by_fours(F f) const {
        unsigned bits = 0;
        for (int k = 0; k < boxes_; k += 4) bits |= f(k) << k;
        return bits & ((1u << boxes_) - 1);
    }

private:
    const T* rows_;
    int places_, boxes_;
};

}  // namespace hedgerow
