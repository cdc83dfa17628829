/// The boxes of a wide node's children (up to 16), stored in rows, so that a probe tests four at a time.
#pragma once

#include <algorithm>
#include <limits>
#include <span>
#include <utility>

#include <hedgerow/geometry/box.h>
#include <hedgerow/geometry/lanes.h>

namespace hedgerow {

/// The least and the greatest of some rows of eight numbers. NaN is passed over. Infinite, the wrong way
/// round, if there is nothing else.
template <std::floating_point T>
std::pair<T, T> extremes(std::span<const T[8]> rows) {
    using L = Lanes<T>;
    constexpr T infinity = std::numeric_limits<T>::infinity();
    L low = L::all(infinity), high = L::all(-infinity);
    for (const auto& row : rows)
        for (const T* four : {row, row + 4}) low = min(L::load(four), low), high = max(L::load(four), high);
    T lows[4], highs[4];
    low.store(lows), high.store(highs);
    return {std::min(std::min(lows[0], lows[1]), std::min(lows[2], lows[3])),
            std::max(std::max(highs[0], highs[1]), std::max(highs[2], highs[3]))};
}

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
