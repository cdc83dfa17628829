/// Inserts single primitives into a BVH, and erases them.
#pragma once

#include <algorithm>
#include <bit>
#include <span>

#include <hedgerow/geometry/box_pair.h>
#include <hedgerow/structures/bvh/build_tree.h>
#include <hedgerow/walks/volumes.h>

namespace hedgerow {

template <std::floating_point T, int D>
struct alignas(D == 3 && sizeof(T) == 4 ? 64 : 16) BvhNode {  // a cache line, if a node fits
    BoxPair<T, D> boxes;
    NodeRef child[2];
};

/// The part of a BVH that walks read.
template <std::floating_point T, int D>
struct BvhTree {
    NodeRef root;
    Box<T, D> bounds;
    BareVector<BvhNode<T, D>> nodes;
    std::vector<PrimitiveId> items;
};

/// What insert and erase need beside the tree. The first change makes it, in O(n).
struct BvhEdits {
    std::vector<bool> held;                 // by primitive: whether it is in the tree
    std::size_t count = 0;                  // primitives in the tree
    std::vector<std::uint8_t> height;       // by node: 1 above two leaves
    std::vector<std::uint32_t> free_nodes;  // unused places in the lists, to be used next
    std::vector<std::uint32_t> free_items;
    std::vector<std::uint32_t> placed;  // the places in `items` that the last change overwrote

    std::size_t bytes() const {
        return held.capacity() / 8 + height.capacity() +
               4 * (free_nodes.capacity() + free_items.capacity() + placed.capacity());
    }
};

/// An insertion descends to where a new leaf costs the least by the SAH: at each node, above the whole node
/// or in the child whose box grows the least (Goldsmith and Salmon 1987, greedily as Catto, Dynamic bounding
/// volume hierarchies, GDC 2019). On the way back each node exchanges a child with a grandchild where that
/// makes the other child's box smaller (tree rotations: Kensler 2008), so that primitives inserted in spatial
/// order form no chain. An erasure descends into each child whose box may contain the primitive. A node with
/// one child left is replaced by that child. Where a tree would grow too deep, the lowest subtree that is
/// more than twice as high as a balanced one is built anew (as in scapegoat trees, Galperin and Rivest 1993):
/// O(log n) amortized.
template <std::floating_point T, int D>
class BvhEditor {
public:
    using Node = BvhNode<T, D>;

    BvhEditor(BvhTree<T, D>& tree, BvhEdits& edits) : tree_(tree), edits_(edits) {}

    /// To be called before the first change, on a tree that contains primitives 0 to count − 1.
    void begin(std::size_t count) {
        edits_.held.assign(count, true);
        edits_.count = count;
        edits_.height.assign(tree_.nodes.size(), 0);
        measure(tree_.root);
    }

    template <class Count>
    void insert(PrimitiveId id, const Box<T, D>& box, Count& count) {
        edits_.placed.clear();
        if (id >= edits_.held.size()) edits_.held.resize(std::size_t(id) + 1);
        edits_.held[id] = true;
        ++edits_.count;
        // Put a new leaf at the cheapest place.
        const std::vector<ChildRef> path = path_to_cheapest(box, count);
        put(path.back(), new_leaf(id), box);
        tree_.bounds.expand(box);
        // Grow the boxes on the path and rotate, from the leaf upward.
        for (std::size_t i = path.size(); i-- > 1;) {
            Node& n = tree_.nodes[path[i].node];
            n.boxes.set(path[i].child, merged(n.boxes[path[i].child], box));
            set_height(path[i].node);
            rotate(path[i].node);
        }
        // Rebuild subtrees until the tree is within the bound on depth.
        while (height_of(tree_.root) >= bvh_max_depth) balance(highest_path());
    }
    /// Erases a primitive with this box. `exclusive`: each primitive is in one leaf. Otherwise parts of it
    /// may be in several leaves.
    template <PrimitiveSet P, class Count>
    void erase(const P& set, PrimitiveId id, const Box<T, D>& box, bool exclusive, Count& count) {
        edits_.placed.clear();
        edits_.held[id] = false;
        --edits_.count;
        const auto from = [&](auto& self, NodeRef& ref, const Box<T, D>& whole) -> Box<T, D> {
            if (ref.leaf()) {
                count.leaf(ref.count);
                return erase_from_leaf(set, ref, whole, id, exclusive);
            }
            count.node();
            Node& n = tree_.nodes[ref.first];
            // Erase the primitive from each child that may contain it.
            for (int i = 0; i < 2; ++i) {
                const Box<T, D> child = n.boxes[i];
                if (exclusive ? child.contains(box) : overlap(child, box))
                    n.boxes.set(i, self(self, n.child[i], child));
            }
            // Replace a node that has an empty child by its other child.
            for (const int i : {0, 1})
                if (n.child[i].empty()) {
                    const NodeRef left = n.child[1 - i];
                    free_node(ref.first);
                    ref = left;
                    return n.boxes[1 - i];
                }
            set_height(ref.first);
            return merged(n.boxes[0], n.boxes[1]);
        };
        tree_.bounds = from(from, tree_.root, tree_.bounds);
    }

private:
    /// A child, named by its parent and its index. The root's parent is `nobody`.
    struct ChildRef {
        std::uint32_t node;
        int child;
    };
    struct Part {
        NodeRef ref;
        Box<T, D> box;
    };
    static constexpr std::uint32_t nobody = NodeRef::nowhere;

    NodeRef& ref_at(ChildRef p) { return p.node == nobody ? tree_.root : tree_.nodes[p.node].child[p.child]; }
    Box<T, D> box_at(ChildRef p) const {
        return p.node == nobody ? tree_.bounds : tree_.nodes[p.node].boxes[p.child];
    }
    int height_of(NodeRef r) const { return r.leaf() ? 0 : edits_.height[r.first]; }
    void set_height(std::uint32_t node) {
        const Node& n = tree_.nodes[node];
        edits_.height[node] =
            static_cast<std::uint8_t>(1 + std::max(height_of(n.child[0]), height_of(n.child[1])));
    }
    void measure(NodeRef r) {
        if (r.empty() || r.leaf()) return;
        for (const NodeRef child : tree_.nodes[r.first].child) measure(child);
        set_height(r.first);
    }

    NodeRef new_leaf(PrimitiveId id) {
        std::uint32_t at;
        if (edits_.free_items.empty()) {
            at = static_cast<std::uint32_t>(tree_.items.size());
            tree_.items.push_back(id);
        } else {
            at = edits_.free_items.back();
            edits_.free_items.pop_back();
            tree_.items[at] = id;
        }
        edits_.placed.push_back(at);
        return {at, 1};
    }
    std::uint32_t new_node() {
        if (!edits_.free_nodes.empty()) {
            const std::uint32_t at = edits_.free_nodes.back();
            edits_.free_nodes.pop_back();
            return at;
        }
        tree_.nodes.emplace_back();
        edits_.height.push_back(0);
        return static_cast<std::uint32_t>(tree_.nodes.size() - 1);
    }

    void free_node(std::uint32_t node) {
        tree_.nodes[node].child[0] = tree_.nodes[node].child[1] = NodeRef();
        edits_.free_nodes.push_back(node);
    }

    /// The places from the root down to the one beside whose subtree a new leaf costs the least.
    template <class Count>
    std::vector<ChildRef> path_to_cheapest(const Box<T, D>& box, Count& count) {
        std::vector<ChildRef> path = {{nobody, 0}};
        while (true) {
            const NodeRef ref = ref_at(path.back());
            if (ref.empty() || ref.leaf()) return path;
            count.node();
            const Node& n = tree_.nodes[ref.first];
            const Box<T, D> whole = box_at(path.back());
            double least = area(merged(whole, box));  // of a new node above this one
            const double growth = least - area(whole);
            int cheapest = -1;
            for (int i = 0; i < 2; ++i) {
                // This node's box grows. So does the child's; but a leaf child gets a new node above it.
                const double with = area(merged(n.boxes[i], box));
                const double cost = growth + with - (n.child[i].leaf() ? 0 : area(n.boxes[i]));
                if (cost < least) least = cost, cheapest = i;
            }
            // Stop where a new node above this one costs the least.
            if (cheapest < 0) return path;
            path.push_back({ref.first, cheapest});
        }
    }
    void put(ChildRef at, NodeRef leaf, const Box<T, D>& box) {
        const NodeRef beside = ref_at(at);
        const NodeRef joined = beside.empty() ? leaf : join({beside, box_at(at)}, {leaf, box}).ref;
        ref_at(at) = joined;  // last, since `join` may move the list of nodes
    }
    Part join(const Part& a, const Part& b) {
        const std::uint32_t node = new_node();
        Node& n = tree_.nodes[node];
        n.child[0] = a.ref, n.child[1] = b.ref;
        n.boxes.set(0, a.box), n.boxes.set(1, b.box);
        set_height(node);
        return {{node, 0}, merged(a.box, b.box)};
    }

    /// Exchanges one child with a child of the other where that shrinks the other's box, by the exchange that
    /// saves the most area.
    void rotate(std::uint32_t node) {
        Node& n = tree_.nodes[node];
        // Find the exchange that gains the most area.
        double best = 0;
        int from = -1, with = 0;  // the child whose own child is exchanged, and that one's index
        for (int i = 0; i < 2; ++i) {
            if (n.child[i].leaf()) continue;
            const Node& below = tree_.nodes[n.child[i].first];
            for (int k = 0; k < 2; ++k) {
                const double less = area(n.boxes[i]) - area(merged(n.boxes[1 - i], below.boxes[1 - k]));
                if (less > best) best = less, from = i, with = k;
            }
        }
        if (from < 0) return;
        // Exchange the two, and fit the box and height of the child that has a new child.
        Node& below = tree_.nodes[n.child[from].first];
        const Box<T, D> down = n.boxes[1 - from], up = below.boxes[with];
        std::swap(n.child[1 - from], below.child[with]);
        n.boxes.set(1 - from, up);
        below.boxes.set(with, down);
        n.boxes.set(from, merged(down, below.boxes[1 - with]));
        set_height(n.child[from].first);
        set_height(node);
    }

    /// Erases `id` from a leaf, if it is there, and returns the box of what is left. A leaf that may have
    /// parts of primitives keeps its box, `whole`.
    template <PrimitiveSet P>
    Box<T, D> erase_from_leaf(const P& set, NodeRef& ref, const Box<T, D>& whole, PrimitiveId id,
                              bool exclusive) {
        // Replace the primitive by the last one of the leaf, whose place becomes free.
        const auto begin = tree_.items.begin() + ref.first, end = begin + ref.count;
        const auto found = std::find(begin, end, id);
        if (found == end) return whole;
        if (*found != *(end - 1)) {
            *found = *(end - 1);
            edits_.placed.push_back(static_cast<std::uint32_t>(found - tree_.items.begin()));
        }
        edits_.free_items.push_back(ref.first + ref.count - 1);
        if (--ref.count == 0) {
            ref = NodeRef();
            return {};
        }
        // The boxes of parts are not stored, so a leaf can be fitted only to whole primitives.
        if (!exclusive) return whole;
        Box<T, D> left;
        for (std::uint32_t i = 0; i < ref.count; ++i) left.expand(set.bounds(tree_.items[ref.first + i]));
        return left;
    }

    /// The places from the root down to a deepest leaf.
    std::vector<ChildRef> highest_path() const {
        std::vector<ChildRef> path = {{nobody, 0}};
        for (NodeRef ref = tree_.root; !ref.leaf();) {
            const auto& child = tree_.nodes[ref.first].child;
            path.push_back({ref.first, height_of(child[1]) > height_of(child[0])});
            ref = child[path.back().child];
        }
        return path;
    }
    /// Rebuilds the lowest subtree on the path that is too high for its number of leaves.
    void balance(const std::vector<ChildRef>& path) {
        std::vector<Part> leaves;
        NodeRef gathered;
        for (std::size_t i = path.size(); i-- > 0;) {
            const NodeRef ref = ref_at(path[i]);
            if (ref.leaf()) continue;
            gather(ref, gathered, leaves);
            gathered = ref;
            if (height_of(ref) <= 2 * static_cast<int>(std::bit_width(leaves.size())) + 1) continue;
            free_nodes_of(ref);
            const NodeRef anew = balanced(leaves).ref;
            ref_at(path[i]) = anew;
            for (std::size_t above = i; above > 0; --above) set_height(path[above].node);
            return;
        }
    }
    /// Appends the leaves below `ref`, except those below `but`, which are in the list already.
    void gather(NodeRef ref, NodeRef but, std::vector<Part>& leaves) const {
        const Node& n = tree_.nodes[ref.first];
        for (int i = 0; i < 2; ++i) {
            if (n.child[i].leaf())
                leaves.push_back({n.child[i], n.boxes[i]});
            else if (n.child[i].first != but.first)
                gather(n.child[i], but, leaves);
        }
    }
    void free_nodes_of(NodeRef ref) {
        for (const NodeRef child : {tree_.nodes[ref.first].child[0], tree_.nodes[ref.first].child[1]})
            if (!child.leaf()) free_nodes_of(child);
        free_node(ref.first);
    }
    /// A balanced subtree over the leaves, halved at each level by the middles of their boxes on the widest
    /// axis.
    Part balanced(std::span<Part> leaves) {
        if (leaves.size() == 1) return leaves[0];
        Box<T, D> centers;
        for (const Part& p : leaves) centers.expand(p.box.center());
        const int axis = max_axis(centers.extent());
        const std::size_t half = leaves.size() / 2;
        std::nth_element(leaves.begin(), leaves.begin() + static_cast<std::ptrdiff_t>(half), leaves.end(),
                         [axis](const Part& a, const Part& b) {
                             const T x = a.box.center()[axis], y = b.box.center()[axis];
                             return x != y ? x < y : a.ref.first < b.ref.first;
                         });
        const Part low = balanced(leaves.first(half));
        return join(low, balanced(leaves.subspan(half)));
    }

    static Box<T, D> merged(Box<T, D> a, const Box<T, D>& b) { return a.expand(b); }
    static double area(const Box<T, D>& b) { return static_cast<double>(b.half_area()); }

    BvhTree<T, D>& tree_;
    BvhEdits& edits_;
};

}  // namespace hedgerow
