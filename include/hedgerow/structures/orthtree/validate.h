/// Finds faults in an orthtree.
#pragma once

#include <string>

#include <hedgerow/structures/orthtree/growth.h>

namespace hedgerow {

/// Checks every node and item once, then looks for every primitive in each cell that it must be in. That is
/// about the work of a build, serial.
template <class S, PrimitiveSet P>
class OrthtreeInspection {
public:
    using T = typename P::Scalar;
    static constexpr int D = P::dimension;

    OrthtreeInspection(const S& tree, const P& set) : tree_(tree), set_(set), standing_(set) {}

    /// The first fault; empty if nothing is wrong.
    std::string fault() {
        if (tree_.id_end() > set_.size()) return "not built over these primitives";
        look_at(tree_.root(), tree_.cell(), 0);
        if (groups_ != tree_.store().groups_in_use()) found("a group of children that nothing leads to");
        for (PrimitiveId id = 0; fault_.empty() && id < tree_.id_end(); ++id)
            if (tree_.holds(id)) look_for(id);
        return fault_;
    }

private:
    void found(const std::string& fault) {
        if (fault_.empty()) fault_ = fault;
    }

    void look_at(OrthantNode n, const Cube<T, D>& cell, int depth) {
        if (!fault_.empty()) return;
        if (depth > S::max_depth) return found("deeper than its bound");
        if (!n.inner()) return look_at_leaf(n, cell);
        if (n.first >= tree_.store().group_count() || ++groups_ > tree_.store().groups_in_use())
            return found("a child that is not there");
        if (!cell.divisible()) return found("a cell that cannot be divided is");
        unsigned occupied = 0;
        bool lowest = true;
        std::vector<PrimitiveId> below;
        for (unsigned i = 0; i < S::width; ++i) {
            const OrthantNode child = tree_.children(n)[i];
            look_at(child, cell.orthant(i), depth + 1);
            if (!child.empty()) occupied |= 1u << i;
            lowest = lowest && !child.inner();
            if (lowest && fault_.empty()) tree_.gather(child, below);
        }
        if (occupied != n.occupied()) found("a node is wrong about which of its children hold anything");
        if (lowest && !tree_.is_more_than_a_leaf(below)) found("leaves that fit in one");
    }
    void look_at_leaf(OrthantNode leaf, const Cube<T, D>& cell) {
        if (leaf.empty()) return;
        if (leaf.first + std::uint64_t(leaf.count) > tree_.store().list().size())
            return found("a leaf's items are not there");
        auto ids = tree_.store().items(leaf);
        std::vector<PrimitiveId> sorted(ids.begin(), ids.end());
        std::sort(sorted.begin(), sorted.end());
        if (std::adjacent_find(sorted.begin(), sorted.end()) != sorted.end())
            found("a leaf has an item twice");
        for (const PrimitiveId id : ids) {
            if (!tree_.holds(id)) return found("an item that is not held");
            const Box<T, D> box = set_.bounds(id);
            if (!overlap(enlarged(box, standing_.margin(box)), cell.box()))
                found("primitive " + std::to_string(id) + " is in a leaf that it does not meet");
        }
    }

    void look_for(PrimitiveId id) {
        const Box<T, D> box = set_.bounds(id);
        if (!tree_.bounds().contains(box) || !tree_.cell().box().contains(box))
            return found("primitive " + std::to_string(id) + " reaches out of the scene");
        look_for(id, tree_.root(), tree_.cell());
    }
    void look_for(PrimitiveId id, OrthantNode n, const Cube<T, D>& cell) {
        if (!n.inner()) {
            const auto items = tree_.store().items(n);
            if (std::find(items.begin(), items.end(), id) == items.end())
                found("primitive " + std::to_string(id) + " is missing from a cell that it meets");
            return;
        }
        for (unsigned left = standing_(id, cell); left != 0; left &= left - 1) {
            const auto i = static_cast<unsigned>(std::countr_zero(left));
            look_for(id, tree_.children(n)[i], cell.orthant(i));
        }
    }

    const S& tree_;
    const P& set_;
    OrthantStanding<P> standing_;
    std::string fault_;
    std::size_t groups_ = 0;
};

}  // namespace hedgerow
