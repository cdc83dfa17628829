/// A wide BVH as it lies in memory: nodes of 4, 8 or 16 boxes in rows, so that one instruction computes with
/// a plane of every child.
#pragma once

#include <hedgerow/base/stored.h>
#include <hedgerow/geometry/box_rows.h>
#include <hedgerow/primitives/concepts.h>
#include <hedgerow/walks/volumes.h>

namespace hedgerow {

/// A leaf has at most this many primitives, and its items begin at a multiple of this number.
inline constexpr std::uint32_t wide_leaf_size = 8;
/// The widths (children per node) that a tree may have, and the greatest.
inline constexpr int wide_widths[] = {4, 8, 16};
inline constexpr int most_wide = BoxRows<float, 3>::width;

/// Where a child leads, in one word: the number of an inner node, or the number of a leaf's block of items
/// with the highest bit set. Without a child the word is all ones, and the child's box is empty.
struct WideChild {
    std::uint32_t word;

    static constexpr std::uint32_t leaf_bit = 0x80000000u;
    static constexpr WideChild none() { return {0xFFFFFFFFu}; }
    static constexpr WideChild of_leaf(std::uint32_t block) { return {block | leaf_bit}; }

    bool empty() const { return word == none().word; }
    bool leaf() const { return (word & leaf_bit) != 0; }
    std::uint32_t block() const { return word & ~leaf_bit; }
};

/// Nodes of `width` children. Each node begins at a cache line and stores 2·D rows of planes, a row of
/// WideChild and a row of the number of primitives below each child. Bytes of a node: width ·
/// (2·D·sizeof(T) + 8), rounded up to a multiple of 64; in space with float 32 a child.
template <std::floating_point T, int D>
class WideNodes {
public:
    /// A cache line.
    struct alignas(64) Line {
        std::byte bytes[64];
    };

    WideNodes() = default;
    WideNodes(int width, std::size_t count)
        : WideNodes(width, Stored<Line>(count * stride_of(width) / sizeof(Line))) {}
    /// Takes nodes that are already filled.
    WideNodes(int width, Stored<Line> lines)
        : width_(width),
          stride_(stride_of(width)),
          count_(lines.bytes() / stride_),
          lines_(std::move(lines)) {}

    /// Bytes of a node that hold data, and bytes from one node to the next.
    static constexpr std::size_t used_of(int width) {
        return static_cast<std::size_t>(width) * (2 * D * sizeof(T) + 8);
    }
    static constexpr std::size_t stride_of(int width) {
        return (used_of(width) + sizeof(Line) - 1) / sizeof(Line) * sizeof(Line);
    }
    int width() const { return width_; }
    std::size_t size() const { return count_; }
    std::size_t stride() const { return stride_; }
    std::size_t bytes() const { return lines_.bytes(); }
    const std::byte* data() const { return reinterpret_cast<const std::byte*>(lines_.data()); }
    const std::byte* at(std::size_t node) const { return data() + node * stride_; }

    /// The boxes of a node's children, which come first in the rows.
    BoxRows<T, D> boxes(std::size_t node) const {
        return {reinterpret_cast<const T*>(at(node)), width_, children(node)};
    }
    /// The number of children. Counts from the end, since most nodes are full.
    int children(std::size_t node) const {
        int n = width_;
        while (n > 0 && child(node, n - 1).empty()) --n;
        return n;
    }
    WideChild child(std::size_t node, int i) const { return {words(node)[i]}; }
    /// The number of primitives below child i.
    std::uint32_t count(std::size_t node, int i) const { return words(node)[width_ + i]; }
    /// The number of primitives below a node.
    std::uint32_t count(std::size_t node) const {
        std::uint32_t sum = 0;
        for (int i = 0; i < width_; ++i) sum += count(node, i);
        return sum;
    }

    void set_box(std::size_t node, int i, const Box<T, D>& b) {
        T* const rows = reinterpret_cast<T*>(place(node));
        for (int k = 0; k < D; ++k)
            rows[2 * k * width_ + i] = b.low[k], rows[(2 * k + 1) * width_ + i] = b.high[k];
    }
    void set_count(std::size_t node, int i, std::uint32_t count) {
        reinterpret_cast<std::uint32_t*>(place(node) + boxes_bytes())[width_ + i] = count;
    }
    void set(std::size_t node, int i, const Box<T, D>& box, WideChild child, std::uint32_t count) {
        set_box(node, i, box);
        std::uint32_t* const w = reinterpret_cast<std::uint32_t*>(place(node) + boxes_bytes());
        w[i] = child.word, w[width_ + i] = count;
    }

private:
    std::size_t boxes_bytes() const { return static_cast<std::size_t>(width_) * 2 * D * sizeof(T); }
    std::byte* place(std::size_t node) {
        return reinterpret_cast<std::byte*>(lines_.data()) + node * stride_;
    }
    const std::uint32_t* words(std::size_t node) const {
        return reinterpret_cast<const std::uint32_t*>(at(node) + boxes_bytes());
    }

    int width_ = most_wide;
    std::size_t stride_ = 0, count_ = 0;
    Stored<Line> lines_;
};

/// The whole tree. Node 0 is the root, and parents come before their children. The items of leaf b begin at
/// items[8·b]; places that it does not fill are `no_primitive`. An empty tree has no nodes. Any other tree
/// has an inner node as its root, if need be with a single child.
template <std::floating_point T, int D>
struct WideTree {
    WideNodes<T, D> nodes;
    Stored<PrimitiveId> items;
    Box<T, D> bounds;
    int depth = 0;  // levels, leaves counted
    /// Whether more points are at one place than a search should look at, and nodes at one place have their
    /// points ascending by id, leaf after leaf. Only a build tells; a refit and a file forget it.
    bool crowded = false;

    bool empty() const { return nodes.size() == 0; }
    std::size_t leaf_count() const { return items.size() / wide_leaf_size; }
};

}  // namespace hedgerow
