/// Full-sweep SAH (Wald, Boulos, Shirley, TOG 2007): sorts the centers once along each axis, considers every
/// border between two primitives, and keeps the orders sorted by a stable partition. O(n log n).
#pragma once

#include <algorithm>

#include <hedgerow/parallel/sort.h>
#include <hedgerow/structures/bvh/builders/top_down.h>

namespace hedgerow {

template <std::floating_point T, int D>
class SweepSplitter {
public:
    SweepSplitter(ReferenceList<T, D> references, const SahOptions& options, Executor& executor)
        : options_(options),
          references_(std::move(references)),
          right_cost_(references_.size()),
          goes_left_(references_.size()),
          scratch_(references_.size()) {
        for (int k = 0; k < D; ++k) {
            auto& order = order_[k];
            order.resize(references_.size());
            for (std::size_t i = 0; i < order.size(); ++i) order[i] = static_cast<std::uint32_t>(i);
            sort_watched(order.begin(), order.end(), executor, [&](std::uint32_t a, std::uint32_t b) {
                const T x = references_[a].center2(k), y = references_[b].center2(k);
                return x != y ? x < y : a < b;
            });
        }
    }

    /// A view of the references in the order along the first axis, which the items of leaves keep.
    struct Ordered {
        const SweepSplitter& all;
        std::size_t size() const { return all.references_.size(); }
        const Reference<T, D>& operator[](std::size_t i) const { return all.references_[all.order_[0][i]]; }
        struct Iterator {
            const Ordered& ordered;
            std::size_t i;
            const Reference<T, D>& operator*() const { return ordered[i]; }
            Iterator& operator++() { return ++i, *this; }
            bool operator!=(const Iterator& o) const { return i != o.i; }
        };
        Iterator begin() const { return {*this, 0}; }
        Iterator end() const { return {*this, size()}; }
    };
    Ordered references() const { return {*this}; }
    Range<T, D> root() const {
        return Range<T, D>::over(references_, 0, static_cast<std::uint32_t>(references_.size()));
    }

    bool split(const Range<T, D>& range, Range<T, D>& left, Range<T, D>& right) {
        double best = std::numeric_limits<double>::infinity();
        int axis = 0;
        std::uint32_t border = 0;
        for (int k = 0; k < D; ++k) sweep(range, k, best, axis, border);
        const double area = static_cast<double>(range.box.template box<D>().half_area());
        const double split_cost = options_.traversal_cost * area + options_.intersection_cost * best;
        const bool all_alike = !(max_component(range.centers2.template box<D>().extent()) > 0);
        if (all_alike || options_.makes_leaf(range.size(), area, split_cost)) return false;
        divide(range, axis, border, left, right);
        return true;
    }
    void halve(const Range<T, D>& range, Range<T, D>& left, Range<T, D>& right) {
        divide(range, max_axis(range.centers2.template box<D>().extent()), range.first + range.size() / 2,
               left, right);
    }

private:
    void sweep(const Range<T, D>& range, int k, double& best, int& axis, std::uint32_t& border) {
        const auto& order = order_[k];
        auto box = LaneBox<T>::none();
        for (std::uint32_t i = range.last - 1; i > range.first; --i) {
            box.expand(references_[order[i]].lanes());
            right_cost_[i] = area(box) * options_.tests(range.last - i);
        }
        box = LaneBox<T>::none();
        for (std::uint32_t i = range.first + 1; i < range.last; ++i) {
            box.expand(references_[order[i - 1]].lanes());
            const double c = area(box) * options_.tests(i - range.first) + right_cost_[i];
            if (c < best) best = c, axis = k, border = i;
        }
    }
    void divide(const Range<T, D>& range, int axis, std::uint32_t border, Range<T, D>& left,
                Range<T, D>& right) {
        for (std::uint32_t i = range.first; i < range.last; ++i) goes_left_[order_[axis][i]] = i < border;
        for (int k = 0; k < D; ++k) {
            std::uint32_t to = range.first, rest = 0;
            for (std::uint32_t i = range.first; i < range.last; ++i) {
                const std::uint32_t r = order_[k][i];
                if (goes_left_[r])
                    order_[k][to++] = r;
                else
                    scratch_[range.first + rest++] = r;
            }
            std::copy_n(scratch_.begin() + range.first, rest, order_[k].begin() + to);
        }
        left = Range<T, D>::over(references(), range.first, border);
        right = Range<T, D>::over(references(), border, range.last);
    }
    static double area(const LaneBox<T>& box) {
        return static_cast<double>(box.template box<D>().half_area());
    }

    SahOptions options_;
    ReferenceList<T, D> references_;
    std::vector<std::uint32_t> order_[D];
    std::vector<double> right_cost_;
    std::vector<std::uint8_t> goes_left_;  // bytes, not bits: threads write theirs at the same time
    std::vector<std::uint32_t> scratch_;
};

}  // namespace hedgerow
