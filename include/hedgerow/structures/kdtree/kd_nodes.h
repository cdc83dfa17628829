/// A kd-tree's nodes and leaf lists, as builders write them and walks read them.
#pragma once

#include <bit>

#include <hedgerow/structures/references.h>

namespace hedgerow {

/// 8 bytes (float) or 16 (double), as in Wald and Havran 2006. An inner node's low child follows it; `link`
/// is where its high child stands. A leaf's `link` is its count, and it begins at `first` in the items.
template <std::floating_point T>
class KdNode {
public:
    static constexpr std::uint32_t most = (1u << 30) - 1;  // of a link

    static KdNode inner(const AxisPlane<T>& plane) {
        return KdNode(std::bit_cast<Bits>(plane.position), static_cast<std::uint32_t>(plane.axis));
    }
    static KdNode leaf(std::uint32_t first, std::uint32_t count) {
        return KdNode(static_cast<Bits>(first), count << 2 | leaf_mark);
    }

    bool is_leaf() const { return (kind_and_link_ & 3u) == leaf_mark; }
    AxisPlane<T> plane() const { return {static_cast<int>(kind_and_link_ & 3u), std::bit_cast<T>(place_)}; }
    std::uint32_t first() const { return static_cast<std::uint32_t>(place_); }
    std::uint32_t link() const { return kind_and_link_ >> 2; }

    void set_link(std::uint32_t link) { kind_and_link_ = link << 2 | (kind_and_link_ & 3u); }
    void set_first(std::uint32_t first) { place_ = static_cast<Bits>(first); }

private:
    using Bits = std::conditional_t<sizeof(T) == 4, std::uint32_t, std::uint64_t>;
    static constexpr std::uint32_t leaf_mark = 3;

    KdNode(Bits place, std::uint32_t kind_and_link) : place_(place), kind_and_link_(kind_and_link) {}

    Bits place_;
    std::uint32_t kind_and_link_;
};
static_assert(sizeof(KdNode<float>) == 8 && sizeof(KdNode<double>) == 16);

/// A whole tree or a subtree of one, in depth-first order.
template <std::floating_point T>
struct KdNodes {
    std::vector<KdNode<T>> nodes;
    std::vector<PrimitiveId> items;
    int depth = 0;

    /// Puts another subtree behind this one.
    void append(const KdNodes& other) {
        const auto node_shift = static_cast<std::uint32_t>(nodes.size());
        const auto item_shift = static_cast<std::uint32_t>(items.size());
        if (nodes.size() + other.nodes.size() > KdNode<T>::most ||
            items.size() + other.items.size() > 0xFFFFFFFFu)
            throw InputError(
                "the kd-tree would hold more than 2^30 nodes or 2^32 items: let leaf_size be larger or "
                "max_depth smaller");
        for (KdNode<T> n : other.nodes) {
            if (n.is_leaf())
                n.set_first(n.first() + item_shift);
            else
                n.set_link(n.link() + node_shift);
            nodes.push_back(n);
        }
        items.insert(items.end(), other.items.begin(), other.items.end());
        depth = std::max(depth, other.depth);
    }
};

}  // namespace hedgerow
