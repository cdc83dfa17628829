/// Expansions of the winding numbers of an index, whatever its structure.
#pragma once

#include <hedgerow/engine/wide_bvh.h>
#include <hedgerow/engine/winding_expansion.h>

namespace hedgerow::detail {

/// The expansion of an index over the tree of a WideBvh: that of the index, or of one that is built. `Parts`
/// are what winding numbers are summed from (winding_parts.h). The index must outlive it.
template <class I, class Parts>
class ExpandedIndex {
public:
    using Scalar = typename I::Scalar;
    using Tree = WideBvh<Scalar, 3>;

    /// `parts_of(scale)` makes the parts.
    template <class PartsOf>
    ExpandedIndex(const I& index, PartsOf parts_of, Executor& executor)
        : index_(&index),
          own_(own_tree(index, executor)),
          own_blocks_(own_blocks(index, executor)),
          expansion_(tree().tree(), parts_of, executor) {}

    template <class Count>
    double winding_number(const Parts& parts, const Vec3d& point, double error, Count& count) const {
        return expansion_.winding_number(tree().tree(), parts, blocks(), point, error, count);
    }
    double scale() const { return expansion_.scale(); }
    std::size_t bytes() const { return expansion_.bytes() + own_.bytes() + own_blocks_.bytes(); }

private:
    static constexpr bool has_tree = std::same_as<typename I::Structure, Tree>;
    static constexpr bool in_blocks = std::same_as<Parts, WindingTriangles<TriangleMeshView<float>>>;

    static Tree own_tree(const I& index, Executor& executor) {
        return has_tree ? Tree() : Tree::build(index.primitives(), {}, executor);
    }
    TriangleBlocks<float> own_blocks(const I& index, Executor& executor) const {
        if constexpr (in_blocks && !has_tree)
            return own_.pack(index.primitives(), executor);
        else
            return {};
    }
    const Tree& tree() const {
        if constexpr (has_tree)
            return index_->structure();
        else
            return own_;
    }
    const TriangleBlock<float>* blocks() const {
        if constexpr (!in_blocks)
            return nullptr;
        else if constexpr (has_tree)
            return index_->packed().data();
        else
            return own_blocks_.data();
    }

    const I* index_;
    Tree own_;
    TriangleBlocks<float> own_blocks_;
    WindingExpansion<Scalar> expansion_;
};

}  // namespace hedgerow::detail
