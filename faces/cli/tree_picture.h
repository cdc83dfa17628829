/// A structure's tree as nodes and links: inner nodes as circles with where they are split, leaves as squares
/// with their primitives below.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include <hedgerow/structures/outline.h>

#include "flat.h"
#include "svg.h"

namespace hedgerow::cli {

struct TreeNode {
    NodeId id;
    int level;
    bool leaf;
    std::size_t items;
    /// "x 0.42" of a node that a plane across x divides, "3 14" of a leaf with two primitives.
    std::string text;
    std::vector<std::size_t> children;
};

/// Parents before their children; empty for what is no tree, as a grid. `levels_left_out`: those of a tree
/// that is too wide for the picture.
struct TreeShape {
    std::vector<TreeNode> nodes;
    int levels_left_out = 0;

    std::optional<std::size_t> find(NodeId id) const;
    std::size_t end_count() const;  ///< nodes without a child
};

namespace detail {

/// Where a plane across an axis divides a cell into two; nothing for any other division.
template <int D>
std::string split_text(const OutlineCell<D>& cell, const OutlineCell<D>& one, const OutlineCell<D>& other) {
    if (!cell.shape.empty() || !one.shape.empty()) return {};
    std::string text;
    for (int k = 0; k < D; ++k) {
        const bool whole = one.box.low[k] == cell.box.low[k] && one.box.high[k] == cell.box.high[k] &&
                           other.box.low[k] == cell.box.low[k] && other.box.high[k] == cell.box.high[k];
        if (whole) continue;
        if (!text.empty() || one.box.high[k] != other.box.low[k]) return {};
        text = fmt::format("{} {:.3g}", static_cast<char>('x' + k), one.box.high[k]);
    }
    return text;
}
template <int D>
std::string items_text(const OutlineCell<D>& cell) {
    if (cell.items.size() > 4) return fmt::format("{} items", cell.items.size());
    std::string text;
    for (const auto id : cell.items) text += fmt::format("{}{}", text.empty() ? "" : " ", id);
    return text;
}

}  // namespace detail

template <int D>
TreeShape tree_of(const std::vector<OutlineCell<D>>& cells) {
    TreeShape tree;
    std::unordered_map<NodeId, std::size_t> at;
    for (std::size_t i = 0; i < cells.size(); ++i) {
        const auto& c = cells[i];
        if (i > 0 && c.level == 1) return {};  // many roots
        at[c.id] = i;
        tree.nodes.push_back(
            {c.id, c.level, c.leaf, c.items.size(), c.leaf ? detail::items_text(c) : std::string(), {}});
        if (i > 0) tree.nodes[at.at(c.parent)].children.push_back(i);
    }
    for (std::size_t i = 0; i < cells.size(); ++i)
        if (const auto& below = tree.nodes[i].children; below.size() == 2)
            tree.nodes[i].text = detail::split_text(cells[i], cells[below[0]], cells[below[1]]);
    return tree;
}

/// Without the deepest levels, until no more nodes without a child are left than can be told apart.
TreeShape cropped(TreeShape tree, std::size_t most_ends = 160);
/// The nodes that are wanted, with their ancestors and the children of both. `wanted`: by node id.
TreeShape around(const TreeShape& tree, const std::unordered_map<NodeId, bool>& wanted);

std::string_view tree_style();

/// Where the nodes of a tree lie: leaves side by side, a parent over the middle of its children.
class TreePanel {
public:
    TreePanel(const TreeShape& tree, const Box2d& area);

    void draw_links(Svg& svg) const;
    /// `look`: attributes of the node's shape; by default the colour of its level.
    void draw_node(Svg& svg, std::size_t i, std::string_view look = {}) const;
    /// What was left out.
    void draw_note(Svg& svg) const;
    Vec2d at(std::size_t i) const { return at_[i]; }
    double radius() const { return radius_; }

private:
    double place(std::size_t i, double& next);
    /// A leaf's primitives, one a line.
    void draw_items(Svg& svg, std::size_t i) const;
    /// Pixels from a node's middle to its neighbour at the right.
    double room_beside(std::size_t i) const;

    const TreeShape& tree_;
    Box2d area_;
    std::vector<Vec2d> at_;
    int levels_ = 1;
    double step_, radius_;
};

/// The numbers of leaves in their cells, where they fit.
void number_leaves(Svg& svg, const Panel& panel, const FlatStructure& flat);

}  // namespace hedgerow::cli
