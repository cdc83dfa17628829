/// Splits in the middle of the widest axis of the centers.
#pragma once

#include <hedgerow/structures/bvh/builders/top_down.h>

namespace hedgerow {

template <std::floating_point T, int D>
class MidpointSplitter : public ReferenceSplitter<T, D> {
public:
    MidpointSplitter(ReferenceList<T, D> references, const SahOptions& options)
        : ReferenceSplitter<T, D>(std::move(references)), max_leaf_size_(options.max_leaf_size) {}

    bool split(const Range<T, D>& range, Range<T, D>& left, Range<T, D>& right) {
        if (range.size() <= max_leaf_size_) return false;
        const Box<T, D> centers2 = range.centers2.template box<D>();
        const int axis = max_axis(centers2.extent());
        const T middle2 = centers2.center()[axis];
        if (!this->partition(range, left, right, [&](const auto& r) { return r.center2(axis) < middle2; }))
            return false;
        left = Range<T, D>::over(this->references_, left.first, left.last);
        right = Range<T, D>::over(this->references_, right.first, right.last);
        return true;
    }

private:
    std::uint32_t max_leaf_size_;
};

}  // namespace hedgerow
