/// Top-down building: one recursion for all splitters.
#pragma once

#include <concepts>

#include <hedgerow/structures/bvh/build_tree.h>

namespace hedgerow {

/// A node to be split: its part of the references, its box, and the box of its centers (times 2).
template <std::floating_point T, int D>
struct Range {
    std::uint32_t first = 0, last = 0;
    LaneBox<T> box = LaneBox<T>::none(), centers2 = LaneBox<T>::none();
    /// Spare places behind the range, for references that splits may add.
    std::uint32_t room = 0;

    std::uint32_t size() const { return last - first; }
    std::uint32_t capacity() const { return size() + room; }
    template <class References>
    static Range over(const References& references, std::uint32_t first, std::uint32_t last) {
        Range r;
        r.first = first, r.last = last;
        for (std::uint32_t i = first; i < last; ++i) r.add(references[i]);
        return r;
    }
    void add(const Reference<T, D>& r) {
        box.expand(r.lanes());
        centers2.expand(r.center2());
    }
};

/// What divides the nodes of a tree that is built from the root down.
///
/// - `references` lists the references, and `root` is the range over all of them.
/// - `split` returns true if it has arranged the references of a range so that `left` comes before `right`.
///   Where it returns false, the range becomes a leaf, or is halved if a leaf would be too large.
/// - `halve` splits by count, and always succeeds.
/// - A splitter whose ranges have room also has `share_room(range, left, right)`.
template <class S, class T, int D>
concept Splitter = requires(S& s, const Range<T, D>& range, Range<T, D>& left, Range<T, D>& right) {
    { s.references()[0] } -> std::convertible_to<const Reference<T, D>&>;
    { s.root() } -> std::same_as<Range<T, D>>;
    { s.split(range, left, right) } -> std::same_as<bool>;
    s.halve(range, left, right);
};

/// Builds a tree from the root down. A subtree over a capacity of n owns 2n − 1 places in the list of nodes,
/// so the tree is the same however many threads build it. A small subtree is built by one thread, and fills
/// its places without gaps.
template <std::floating_point T, int D, Splitter<T, D> S>
class TopDown {
public:
    TopDown(S& splitter, std::uint32_t max_leaf_size, Executor& executor)
        : splitter_(splitter), max_leaf_size_(max_leaf_size), executor_(executor) {}

    BuildTree<T, D> build() {
        const Range<T, D> root = splitter_.root();
        if (root.size() == 0) return std::move(tree_);
        tree_.nodes.resize(2 * std::size_t(root.capacity()) - 1);
        tree_.leaves = grow(root, 0, 1);
        tree_.items.reserve(root.capacity());
        if (root.room == 0)
            for (const auto& r : splitter_.references()) tree_.items.push_back(r.id());
        else
            gather_items(tree_.nodes[0]);
        return std::move(tree_);
    }

private:
    /// Writes the subtree of a range, its nodes from `at` on. Returns how many leaves it has.
    std::uint32_t grow(const Range<T, D>& range, std::uint32_t at, int depth) {
        // Make a leaf if the range is not divided.
        BuildNode<T, D>& node = tree_.nodes[at];
        node.set(range.box.template box<D>());
        node.count = 0;
        Range<T, D> left, right;
        if (!divide(range, depth, left, right)) {
            node.first = range.first, node.count = range.size();
            return 1;
        }
        // Write both children, as two tasks if the range is large.
        node.left = at + 1;
        std::uint32_t on_left = 0, on_right = 0;
        if (range.size() > worth_a_task) {
            node.right = at + 2 * left.capacity();
            executor_.both([&] { on_left = grow_task(left, node.left, depth + 1); },
                           [&] { on_right = grow_task(right, node.right, depth + 1); });
        } else {
            on_left = grow(left, node.left, depth + 1);
            node.right = at + 2 * on_left;  // behind 2 · on_left − 1 nodes
            on_right = grow(right, node.right, depth + 1);
        }
        return node.first = on_left + on_right;
    }

    std::uint32_t grow_task(const Range<T, D>& range, std::uint32_t at, int depth) {
        const std::uint32_t leaves = grow(range, at, depth);
        if (range.size() <= worth_a_task) executor_.advance(range.size());
        return leaves;
    }

    bool divide(const Range<T, D>& range, int depth, Range<T, D>& left, Range<T, D>& right) {
        if (!divide_references(range, depth, left, right)) return false;
        if (left.size() + right.size() < range.capacity()) share_room(range, left, right);
        return true;
    }
    bool divide_references(const Range<T, D>& range, int depth, Range<T, D>& left, Range<T, D>& right) {
        if (range.size() == 1) return false;
        // Only halve where the halvings that are still needed reach the bound on depth.
        if (!bvh_must_halve(depth, range.size()) && splitter_.split(range, left, right)) return true;
        if (range.size() <= max_leaf_size_) return false;
        splitter_.halve(range, left, right);
        return true;
    }

    void share_room(const Range<T, D>& range, Range<T, D>& left, Range<T, D>& right) {
        if constexpr (requires { splitter_.share_room(range, left, right); })
            splitter_.share_room(range, left, right);
    }

    /// Gathers the items leaf by leaf: unused room leaves gaps between leaves.
    void gather_items(BuildNode<T, D>& node) {
        if (node.count == 0)
            return gather_items(tree_.nodes[node.left]), gather_items(tree_.nodes[node.right]);
        const auto first = static_cast<std::uint32_t>(tree_.items.size());
        for (std::uint32_t i = 0; i < node.count; ++i)
            tree_.items.push_back(splitter_.references()[node.first + i].id());
        node.first = first;
    }

    S& splitter_;
    std::uint32_t max_leaf_size_;
    Executor& executor_;
    BuildTree<T, D> tree_;
};

/// The base of splitters that arrange one array of references.
template <std::floating_point T, int D>
class ReferenceSplitter {
public:
    explicit ReferenceSplitter(ReferenceList<T, D> references) : references_(std::move(references)) {}
    const ReferenceList<T, D>& references() const { return references_; }
    Range<T, D> root() const {
        return Range<T, D>::over(references_, 0, static_cast<std::uint32_t>(references_.size()));
    }

    /// Splits into equal counts, in the order of the centers along their widest axis. Ids order equal
    /// centers.
    void halve(const Range<T, D>& range, Range<T, D>& left, Range<T, D>& right) {
        const int axis = max_axis(range.centers2.template box<D>().extent());
        const std::uint32_t middle = range.first + range.size() / 2;
        const auto at = [&](std::uint32_t i) { return references_.begin() + static_cast<std::ptrdiff_t>(i); };
        std::nth_element(at(range.first), at(middle), at(range.last), [axis](const auto& a, const auto& b) {
            return a.center2(axis) != b.center2(axis) ? a.center2(axis) < b.center2(axis) : a.id() < b.id();
        });
        // nth_element decides the half of each element, but not its place there: sorting decides the place.
        const auto by_id = [](const auto& a, const auto& b) { return a.id() < b.id(); };
        std::sort(at(range.first), at(middle), by_id);
        std::sort(at(middle), at(range.last), by_id);
        left = Range<T, D>::over(references_, range.first, middle);
        right = Range<T, D>::over(references_, middle, range.last);
    }

    /// Divides the room that a split has left between its sides by their sizes. The left side's room lies
    /// before the right side, which moves up.
    void share_room(const Range<T, D>& range, Range<T, D>& left, Range<T, D>& right) {
        const std::uint32_t taken = left.size() + right.size(), room = range.capacity() - taken;
        left.room = static_cast<std::uint32_t>(std::uint64_t(room) * left.size() / taken);
        right.room = room - left.room;
        const std::uint32_t moved = std::min(left.room, right.size());
        const auto at = [&](std::uint32_t i) { return references_.begin() + static_cast<std::ptrdiff_t>(i); };
        std::copy(at(right.first), at(right.first + moved), at(right.last + left.room - moved));
        right.first += left.room, right.last += left.room;
    }

protected:
    /// Moves references that go left before the others. Computes the boxes of both sides' centers, but not of
    /// their references. Returns false if all are on one side. (Lomuto's partition, without a branch: a
    /// processor would predict the side of a primitive wrongly as often as not.)
    template <class GoesLeft>
    bool partition(const Range<T, D>& range, Range<T, D>& left, Range<T, D>& right, GoesLeft goes_left) {
        constexpr T infinity = std::numeric_limits<T>::infinity();
        // A center is added with apart = 0 and skipped with infinity: apart[goes] is for the left side's box,
        // and apart[1 + goes] for the right side's.
        constexpr T apart[] = {infinity, T(0), infinity};
        left = {range.first, range.first};
        right = {range.last, range.last};
        auto on_left = left.centers2, on_right = right.centers2;
        // Swap each reference to the border, and move the border on if the reference goes left.
        std::uint32_t border = range.first;
        for (std::uint32_t i = range.first; i < range.last; ++i) {
            const Reference<T, D> r = references_[i];
            const bool goes = goes_left(r);
            references_[i] = references_[border];
            references_[border] = r;
            border += goes;
            on_left.expand(r.center2(), apart[goes]);
            on_right.expand(r.center2(), apart[1 + goes]);
        }
        left.last = right.first = border;
        left.centers2 = on_left, right.centers2 = on_right;
        return left.size() > 0 && right.size() > 0;
    }

    ReferenceList<T, D> references_;
};

}  // namespace hedgerow
