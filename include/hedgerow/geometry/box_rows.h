/// The boxes of a wide node's children (up to 16), stored in rows, so that a probe tests four at a time.
#pragma once

#include <hedgerow/geometry/box.h>
#include <hedgerow/geometry/lanes.h>

namespace hedgerow {

/// A view of boxes stored in rows: for each axis the row of low planes, then the row of high planes. A row
/// has `places` numbers, a multiple of four, of which the first `boxes` are in use.
template <std::floating_point T, int D>
class BoxRows {
public:
    using Scalar = T;
    static constexpr int dimension = D;
    static constexpr int width = 16;  // the most boxes

    BoxRows(const T* rows, int places, int boxes) : rows_(rows), places_(places), boxes_(boxes) {}

    int size() const { return boxes_; }
    Box<T, D> operator[](int i) const {
        Box<T, D> b;
        for (int k = 0; k < D; ++k) b.low[k] = low(k)[i], b.high[k] = high(k)[i];
        return b;
    }
    /// The row of low planes and the row of high planes across an axis.
    const T* low(int axis) const { return rows_ + 2 * axis * places_; }
    const T* high(int axis) const { return low(axis) + places_; }

    /// Calls f(k) for each group of four boxes k..k+3 and concatenates the bits. Bits past the last box are
    /// 0.
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
