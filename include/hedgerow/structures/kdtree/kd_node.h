/// A kd-tree's node.
#pragma once

#include <bit>

#include <hedgerow/structures/cut_tree.h>

namespace hedgerow {

/// 8 bytes (float) or 16 (double), as in Wald and Havran 2006.
template <std::floating_point T>
class KdNode {
public:
    static constexpr std::uint32_t most = (1u << 30) - 1;  // the largest link

    static KdNode inner(const AxisPlane<T>& plane) {
        return KdNode(std::bit_cast<Bits>(plane.position), static_cast<std::uint32_t>(plane.axis));
    }
    static KdNode leaf(std::uint32_t first, std::uint32_t count) {
        return KdNode(static_cast<Bits>(first), count << 2 | leaf_mark);
    }

    bool is_leaf() const { return (kind_and_link_ & 3u) == leaf_mark; }
    bool is_empty() const { return kind_and_link_ == leaf_mark; }  // a count of 0
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

}  // namespace hedgerow
