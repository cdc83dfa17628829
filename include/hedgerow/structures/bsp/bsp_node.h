/// A BSP tree's node.
#pragma once

#include <hedgerow/structures/cut_tree.h>

namespace hedgerow {

/// A plane in the scene's own scalar, so that the plane that cuts is exactly the plane that is stored. `axis`
/// is −1 unless the plane lies across an axis.
template <std::floating_point T, int D>
struct BspPlane {
    Vec<T, D> normal;
    T offset = T(0);
    int axis = -1;

    static BspPlane across(int axis, T position) {
        BspPlane p{{}, position, axis};
        p.normal[axis] = T(1);
        return p;
    }
    CutPlane<D> in_double(double margin_per_reach) const {
        CutPlane<D> p{Vec<double, D>(normal), static_cast<double>(offset), 0};
        p.margin = product(p.reach(), margin_per_reach);
        return p;
    }
};

/// 24 bytes (float, 3D), 40 (double).
template <std::floating_point T, int D>
class BspNode {
public:
    static constexpr std::uint32_t most = (1u << 29) - 1;  // the largest link

    static BspNode inner(const BspPlane<T, D>& plane) {
        BspNode n;
        n.normal_ = plane.normal;
        n.offset_ = plane.offset;
        n.kind_and_link_ = plane.axis >= 0 ? static_cast<std::uint32_t>(plane.axis) : any_plane;
        return n;
    }
    static BspNode leaf(std::uint32_t first, std::uint32_t count) {
        BspNode n;
        n.first_ = first;
        n.kind_and_link_ = count << 3 | leaf_mark;
        return n;
    }

    bool is_leaf() const { return kind() == leaf_mark; }
    bool is_empty() const { return kind_and_link_ == leaf_mark; }  // a count of 0
    bool across_axis() const { return kind() < 3; }
    BspPlane<T, D> plane() const { return {normal_, offset_, across_axis() ? static_cast<int>(kind()) : -1}; }
    AxisPlane<T> axis_plane() const { return {static_cast<int>(kind()), offset_}; }
    std::uint32_t first() const { return first_; }
    std::uint32_t link() const { return kind_and_link_ >> 3; }

    void set_link(std::uint32_t link) { kind_and_link_ = link << 3 | kind(); }
    void set_first(std::uint32_t first) { first_ = first; }

private:
    static constexpr std::uint32_t leaf_mark = 3, any_plane = 4;
    std::uint32_t kind() const { return kind_and_link_ & 7u; }

    Vec<T, D> normal_;
    T offset_ = T(0);
    std::uint32_t first_ = 0;
    std::uint32_t kind_and_link_ = leaf_mark;
};
static_assert(sizeof(BspNode<float, 3>) == 24 && sizeof(BspNode<double, 3>) == 40);

}  // namespace hedgerow
