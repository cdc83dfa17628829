/// Top-down building: one recursion, whatever decides the splits.
#pragma once

#include <bit>

#include <hedgerow/structures/bvh/build_tree.h>

namespace hedgerow {

/// A node to be split: its part of the references, its box, and the box of its centers (times 2).
template <std::floating_point T, int D>
struct Range {
    std::uint32_t first = 0, last = 0;
    LaneBox<T> box = LaneBox<T>::none(), centers2 = LaneBox<T>::none();

    std::uint32_t size() const { return last - first; }
    template <class References>
    static Range over(const References& references, std::uint32_t first, std::uint32_t last) {
        Range r{first, last};
        for (std::uint32_t i = first; i < last; ++i) r.add(references[i]);
        return r;
    }
    void add(const Reference<T, D>& r) {
        box.expand(r.lanes());
        centers2.expand(r.center2());
    }
};

/// `Splitter` has `references()`, `split(range, left, right) -> bool` (false: make a leaf; otherwise it has
/// arranged its references so that `left` comes before `right`) and `halve(range, left, right)`, which splits
/// by count and always succeeds. Subtrees of n primitives own 2n − 1 places in the list of nodes, so the tree
/// is the same however many threads build it.
template <std::floating_point T, int D, class Splitter>
class TopDown {
public:
    TopDown(Splitter& splitter, std::uint32_t max_leaf_size, Executor& executor)
        : splitter_(splitter), max_leaf_size_(max_leaf_size), executor_(executor) {}

    BuildTree<T, D> build() {
        const auto n = static_cast<std::uint32_t>(splitter_.references().size());
        if (n > 0) {
            tree_.nodes.resize(2 * std::size_t(n) - 1);
            tree_.leaves = grow(Range<T, D>::over(splitter_.references(), 0, n), 0, 1);
        }
        tree_.items.reserve(n);
        for (const auto& r : splitter_.references()) tree_.items.push_back(r.id());
        return std::move(tree_);
    }

private:
    /// Returns how many leaves there are below.
    std::uint32_t grow(const Range<T, D>& range, std::uint32_t at, int depth) {
        BuildNode<T, D>& node = tree_.nodes[at];
        node.set(range.box.template box<D>());
        node.count = 0;
        Range<T, D> left, right;
        if (!divide(range, depth, left, right)) {
            node.first = range.first, node.count = range.size();
            return 1;
        }
        node.left = at + 1;
        node.right = at + 2 * left.size();
        std::uint32_t on_left = 0, on_right = 0;
        const auto grow_left = [&] { on_left = grow(left, node.left, depth + 1); };
        const auto grow_right = [&] { on_right = grow(right, node.right, depth + 1); };
        if (range.size() > 4096) {
            executor_.both(grow_left, grow_right);
        } else {
            grow_left();
            grow_right();
        }
        return node.first = on_left + on_right;
    }

    bool divide(const Range<T, D>& range, int depth, Range<T, D>& left, Range<T, D>& right) {
        if (range.size() == 1) return false;
        const int halvings = static_cast<int>(std::bit_width(range.size()));
        const bool deep = depth + halvings >= bvh_max_depth;
        if (!deep && splitter_.split(range, left, right)) return true;
        if (range.size() <= max_leaf_size_) return false;
        splitter_.halve(range, left, right);
        return true;
    }

    Splitter& splitter_;
    std::uint32_t max_leaf_size_;
    Executor& executor_;
    BuildTree<T, D> tree_;
};

/// What the splitters over one array of references share.
template <std::floating_point T, int D>
class ReferenceSplitter {
public:
    explicit ReferenceSplitter(ReferenceList<T, D> references) : references_(std::move(references)) {}
    const ReferenceList<T, D>& references() const { return references_; }

    /// Equal counts, in the order of the centers on their widest axis; ids decide between equal ones.
    void halve(const Range<T, D>& range, Range<T, D>& left, Range<T, D>& right) {
        const int axis = max_axis(range.centers2.template box<D>().extent());
        const std::uint32_t middle = range.first + range.size() / 2;
        const auto at = [&](std::uint32_t i) { return references_.begin() + static_cast<std::ptrdiff_t>(i); };
        std::nth_element(at(range.first), at(middle), at(range.last), [axis](const auto& a, const auto& b) {
            return a.center2(axis) != b.center2(axis) ? a.center2(axis) < b.center2(axis) : a.id() < b.id();
        });
        // Which of two halves an element falls in is certain; its place there is not until it is sorted.
        const auto by_id = [](const auto& a, const auto& b) { return a.id() < b.id(); };
        std::sort(at(range.first), at(middle), by_id);
        std::sort(at(middle), at(range.last), by_id);
        left = Range<T, D>::over(references_, range.first, middle);
        right = Range<T, D>::over(references_, middle, range.last);
    }

protected:
    /// Brings those that go left before the others and gathers both sides' centers, but not their boxes.
    /// False if all are on one side.
    template <class GoesLeft>
    bool partition(const Range<T, D>& range, Range<T, D>& left, Range<T, D>& right, GoesLeft goes_left) {
        left = {range.first, range.first};
        right = {range.last, range.last};
        while (true) {
            while (left.last < right.first && goes_left(references_[left.last]))
                left.centers2.expand(references_[left.last++].center2());
            while (left.last < right.first && !goes_left(references_[right.first - 1]))
                right.centers2.expand(references_[--right.first].center2());
            if (left.last == right.first) return left.size() > 0 && right.size() > 0;
            std::swap(references_[left.last], references_[right.first - 1]);
        }
    }

    ReferenceList<T, D> references_;
};

}  // namespace hedgerow
