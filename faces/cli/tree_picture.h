/// Pictures of a structure's tree as nodes and links. Inner nodes are circles with their split beside them,
/// leaves are squares with their primitives below.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include <hedgerow/walks/outline.h>

#include "flat.h"
#include "report/svg.h"

namespace hedgerow::cli {

struct TreeNode {
    NodeId id;
    int level;
    bool leaf;
    std::size_t items;
    /// "x 0.42" for a node that a plane perpendicular to x splits, "3 14" for a leaf with two primitives.
    std::string text;
    std::vector<std::size_t> children;
};

/// The nodes of a tree, parents before their children; empty for a structure that is no tree, such as a grid.
/// `levels_left_out` is the number of deepest levels that `cropped` removed.
struct TreeShape {
    std::vector<TreeNode> nodes;
    int levels_left_out = 0;

    std::optional<std::size_t> find(NodeId id) const;
    std::size_t end_count() const;  ///< nodes without a child
};

namespace detail {

/// "x 0.42" if a plane perpendicular to an axis splits a cell into the two children; empty for any other
/// split.
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

/// The tree of an outline, whose cells have parents before their children. Empty if it has several roots.
/// O(cells).
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

/// Removes the deepest levels until at most `most_ends` nodes have no child, or one level is left. More ends
/// cannot be distinguished in a picture.
TreeShape cropped(TreeShape tree, std::size_t most_ends = 160);
/// The part of a tree with the root, the wanted nodes, their ancestors, and the children of all of these.
/// `wanted` has the ids of the wanted nodes as keys; its values are ignored.
TreeShape around(const TreeShape& tree, const std::unordered_map<NodeId, bool>& wanted);

std::string_view tree_style();

/// Draws a tree into an area: leaves are side by side, a parent is above the middle of its children.
class TreePanel {
public:
    TreePanel(const TreeShape& tree, const Box2d& area);

    void draw_links(Svg& svg) const;
    /// `look`: attributes of the node's shape; by default the colour of its level.
    void draw_node(Svg& svg, std::size_t i, std::string_view look = {}) const;
    /// Says how many levels were left out, if any.
    void draw_note(Svg& svg) const;
    Vec2d at(std::size_t i) const { return at_[i]; }
    double radius() const { return radius_; }

private:
    /// Places the nodes below i and then i, and returns the column of i. `next` is the first free column.
    double place(std::size_t i, double& next);
    /// Writes a leaf's primitives below it, one a line.
    void draw_items(Svg& svg, std::size_t i) const;
    /// Pixels from a node's middle to its right neighbour on the level, or to the end of the area and the
    /// gap.
    double room_beside(std::size_t i) const;

    const TreeShape& tree_;
    Box2d area_;
    std::vector<Vec2d> at_;
    int levels_ = 1;
    double step_, radius_;
};

/// Writes the ids of leaves into their cells, where they fit.
void number_leaves(Svg& svg, const Panel& panel, const FlatStructure& flat);

}  // namespace hedgerow::cli
