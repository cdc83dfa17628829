/// The points of a batch, and the order in which they are asked.
#pragma once

#include <algorithm>
#include <cstdint>

#include <hedgerow/base/strided.h>
#include <hedgerow/geometry/box.h>
#include <hedgerow/geometry/morton_code.h>
#include <hedgerow/parallel/radix_sort.h>

namespace hedgerow {

/// Some points of a batch, in the order in which they are asked: the i-th is number `number(i)` of the batch.
template <std::floating_point T, int D>
class PointBatch {
public:
    /// All points, in the caller's order.
    PointBatch(const Strided<Vec<T, D>>& points) : PointBatch(points, nullptr, 0, points.size()) {}  // NOLINT
    /// Those numbered from `first` on, in the order that the low half of each key tells; without keys, in the
    /// caller's order.
    PointBatch(const Strided<Vec<T, D>>& points, const std::uint64_t* keys, std::size_t first,
               std::size_t count)
        : points_(points), keys_(keys), first_(first), size_(count) {}

    std::size_t size() const { return size_; }
    std::size_t number(std::size_t i) const {
        return keys_ == nullptr ? first_ + i : first_ + static_cast<std::uint32_t>(keys_[i]);
    }
    Vec<T, D> operator[](std::size_t i) const { return points_[number(i)]; }
    /// `count` points from the one at place `begin` on.
    PointBatch part(std::size_t begin, std::size_t count) const {
        if (keys_ == nullptr) return {points_, nullptr, first_ + begin, count};
        return {points_, keys_ + begin, first_, count};
    }

private:
    Strided<Vec<T, D>> points_;
    const std::uint64_t* keys_;
    std::size_t first_, size_;
};

/// Cells along a Morton curve, for points in and around a box: the box doubled, in cubes. Points beyond it
/// are in its outermost cells.
template <std::floating_point T, int D>
class CurveOfPoints {
public:
    static constexpr int bits_an_axis = D == 3 ? 11 : 16;

    explicit CurveOfPoints(const Box<T, D>& box) {
        const Vec<T, D> extent = box.extent();
        low_ = box.low - extent * T(0.5);
        const T scale = cells / (2 * max_component(extent));
        scale_ = scale <= std::numeric_limits<T>::max() ? scale : T(0);
    }
    /// The first 32 bits of the code.
    std::uint64_t code(const Vec<T, D>& p) const {
        std::uint64_t code = 0;
        for (int k = 0; k < D; ++k) {
            const T at = (p[k] - low_[k]) * scale_;
            const T cell = at > 0 ? std::min(at, cells - 1) : T(0);  // 0 for what is no number
            code |= spread_bits<D>(static_cast<std::uint64_t>(cell)) << k;
        }
        return code >> (bits_an_axis * D - 32);
    }

private:
    static constexpr T cells = T(1 << bits_an_axis);

    Vec<T, D> low_;
    T scale_;
};

/// Calls answer(part) for parts of a batch that together are all of its points, over the executor. Points in
/// the box of an index that needs `bytes` of memory are asked along a Morton curve where that pays: their
/// walks share what the caches hold. Needs 16 bytes a point, for at most four million points at once.
template <std::floating_point T, int D, class Answer>
void for_each_part(const Strided<Vec<T, D>>& points, const Box<T, D>& box, std::size_t bytes,
                   Executor& executor, Answer answer) {
    constexpr std::size_t piece = 1024, at_once = std::size_t(1) << 22;
    if (points.size() < 2 * piece || bytes < (std::size_t(1) << 18)) {
        executor.for_each_piece(points.size(), piece, [&](std::size_t begin, std::size_t end) {
            answer(PointBatch<T, D>(points).part(begin, end - begin));
        });
        return;
    }
    const CurveOfPoints<T, D> curve(box);
    for (std::size_t first = 0; first < points.size(); first += at_once) {
        const std::size_t count = std::min(at_once, points.size() - first);
        BareVector<std::uint64_t> keys(count);
        executor.for_each_piece(count, 4096, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) keys[i] = curve.code(points[first + i]) << 32 | i;
        });
        radix_sort(
            keys, [](std::uint64_t key) { return key; }, 31, 33, executor);
        const PointBatch<T, D> ordered(points, keys.data(), first, count);
        executor.for_each_piece(count, piece, [&](std::size_t begin, std::size_t end) {
            answer(ordered.part(begin, end - begin));
        });
    }
}

}  // namespace hedgerow
