/// Finds the corners of a polygon in a region, while corners are removed.
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>
#include <numeric>
#include <span>
#include <vector>

#include <hedgerow/geometry/box.h>

namespace hedgerow::detail {

using Point = Vec<double, 2>;
using Corner = std::uint32_t;

/// A balanced kd-tree over all corners of a polygon. Its boxes contain only the corners in the set: those
/// that do not turn inwards. Its shape stays the same as corners leave the set.
class CornerTree {
public:
    explicit CornerTree(const std::vector<Point>& points)
        : points_(points),
          in_(points.size()),
          order_(points.size()),
          place_(points.size()),
          first_leaf_(std::bit_ceil((points.size() + leaf_size - 1) / leaf_size)),
          boxes_(2 * first_leaf_) {
        std::iota(order_.begin(), order_.end(), 0u);
        divide(0, first_leaf_ * leaf_size);
        for (std::size_t k = 0; k < order_.size(); ++k) place_[order_[k]] = static_cast<Corner>(k);
    }

    /// Puts a corner into the set or removes it, and updates the boxes above it.
    void set(Corner i, bool in) {
        if (in_[i] == in) return;
        in_[i] = in;
        std::size_t node = first_leaf_ + place_[i] / leaf_size;
        boxes_[node] = box_of_leaf(node);
        while (node >>= 1) {
            boxes_[node] = boxes_[2 * node];
            boxes_[node].expand(boxes_[2 * node + 1]);
        }
    }
    /// Whether `test` is true for a corner of the set in a box for which `enters` is true.
    template <class Enters, class Test>
    bool any(Enters enters, Test test) const {
        std::size_t stack[64], size = 0;  // at most two nodes per level are on the stack
        stack[size++] = 1;
        while (size > 0) {
            const std::size_t node = stack[--size];
            if (boxes_[node].empty() || !enters(boxes_[node])) continue;
            if (node < first_leaf_) {
                stack[size++] = 2 * node + 1;
                stack[size++] = 2 * node;
                continue;
            }
            for (const Corner i : corners_of(node))
                if (in_[i] && test(i)) return true;
        }
        return false;
    }

private:
    static constexpr std::size_t leaf_size = 8;

    /// Sorts places begin to end so that each half is on one side of a line, and then the halves likewise.
    /// Places beyond the last corner are empty.
    void divide(std::size_t begin, std::size_t end) {
        const std::size_t middle = (begin + end) / 2, last = std::min(end, order_.size());
        if (end - begin <= leaf_size || begin >= last) return;
        const auto at = [&](std::size_t k) { return order_.begin() + static_cast<std::ptrdiff_t>(k); };
        Box<double, 2> box;
        for (std::size_t k = begin; k < last; ++k) box.expand(points_[order_[k]]);
        const int axis = box.extent()[1] > box.extent()[0] ? 1 : 0;
        if (middle < last)
            std::nth_element(at(begin), at(middle), at(last),
                             [&](Corner a, Corner b) { return points_[a][axis] < points_[b][axis]; });
        divide(begin, middle);
        divide(middle, end);
    }
    std::span<const Corner> corners_of(std::size_t leaf) const {
        const std::size_t begin = std::min((leaf - first_leaf_) * leaf_size, order_.size());
        return std::span(order_).subspan(begin, std::min(leaf_size, order_.size() - begin));
    }
    Box<double, 2> box_of_leaf(std::size_t leaf) const {
        Box<double, 2> box;
        for (const Corner i : corners_of(leaf))
            if (in_[i]) box.expand(points_[i]);
        return box;
    }

    const std::vector<Point>& points_;
    std::vector<bool> in_;
    std::vector<Corner> order_, place_;
    std::size_t first_leaf_;
    std::vector<Box<double, 2>> boxes_;
};

}  // namespace hedgerow::detail
