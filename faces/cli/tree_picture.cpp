#include "tree_picture.h"

#include <algorithm>

#include "common.h"

namespace hedgerow::cli {

std::optional<std::size_t> TreeShape::find(NodeId id) const {
    for (std::size_t i = 0; i < nodes.size(); ++i)
        if (nodes[i].id == id) return i;
    return std::nullopt;
}
std::size_t TreeShape::end_count() const {
    return static_cast<std::size_t>(
        std::count_if(nodes.begin(), nodes.end(), [](const auto& n) { return n.children.empty(); }));
}

namespace {

constexpr double letter = 5.3;     // width of a letter of font size 8.5, in pixels
constexpr double legend_gap = 24;  // pixels right of the area that texts may use

/// The tree of the nodes that `keep` marks. The parents of marked nodes must be marked too.
TreeShape kept(const TreeShape& tree, const std::vector<bool>& keep) {
    TreeShape part;
    part.levels_left_out = tree.levels_left_out;
    std::vector<std::size_t> moved(tree.nodes.size());
    for (std::size_t i = 0; i < tree.nodes.size(); ++i)
        if (keep[i]) moved[i] = part.nodes.size(), part.nodes.push_back(tree.nodes[i]);
    for (auto& node : part.nodes) {
        const auto all = std::move(node.children);
        node.children.clear();
        for (const std::size_t child : all)
            if (keep[child]) node.children.push_back(moved[child]);
    }
    return part;
}

}  // namespace

TreeShape cropped(TreeShape tree, std::size_t most_ends) {
    while (tree.end_count() > most_ends) {
        int deepest = 1;
        for (const auto& n : tree.nodes) deepest = std::max(deepest, n.level);
        std::vector<bool> keep;
        for (const auto& n : tree.nodes) keep.push_back(n.level < deepest);
        if (deepest == 1) break;
        ++tree.levels_left_out;
        tree = kept(tree, keep);
    }
    return tree;
}

TreeShape around(const TreeShape& tree, const std::unordered_map<NodeId, bool>& wanted) {
    std::vector<bool> keep(tree.nodes.size());
    for (std::size_t i = tree.nodes.size(); i-- > 0;) {
        const auto& n = tree.nodes[i];
        const bool below = std::any_of(n.children.begin(), n.children.end(), [&](auto c) { return keep[c]; });
        keep[i] = i == 0 || below || wanted.contains(n.id);
    }
    std::vector<bool> beside = keep;
    for (std::size_t i = 0; i < tree.nodes.size(); ++i)
        if (keep[i])
            for (const std::size_t c : tree.nodes[i].children) beside[c] = true;
    return kept(tree, beside);
}

std::string_view tree_style() {
    return ".link{stroke:#9aa1ad;stroke-width:1;fill:none}.node{fill:#fff;stroke-width:1.4}\n"
           ".item{font-size:8.5px;text-anchor:middle;fill:#555}.split{font-size:8.5px;fill:#555}\n"
           ".nodeid{font-size:8.5px;text-anchor:middle}\n";
}

TreePanel::TreePanel(const TreeShape& tree, const Box2d& area)
    : tree_(tree), area_(area), at_(tree.nodes.size()) {
    for (const auto& n : tree.nodes) levels_ = std::max(levels_, n.level);
    const double ends = double(std::max<std::size_t>(1, tree.end_count()));
    step_ = area.extent()[0] / ends;
    const double row = std::min(64.0, (area.extent()[1] - 40) / levels_);
    radius_ = std::clamp(std::min(step_, row) * 0.42, 1.2, 10.0);
    for (std::size_t i = 0; i < tree.nodes.size(); ++i)
        at_[i][1] = area.low[1] + 12 + row * (tree.nodes[i].level - 1);
    double next = 0;
    if (!tree.nodes.empty()) place(0, next);
}
double TreePanel::place(std::size_t i, double& next) {
    const auto& children = tree_.nodes[i].children;
    double sum = 0;
    for (const std::size_t c : children) sum += place(c, next);
    const double x = children.empty() ? next + 0.5 : sum / double(children.size());
    if (children.empty()) next += 1;
    at_[i][0] = area_.low[0] + step_ * x;
    return x;
}

void TreePanel::draw_links(Svg& svg) const {
    for (std::size_t i = 0; i < tree_.nodes.size(); ++i)
        for (const std::size_t c : tree_.nodes[i].children) svg.line(at_[i], at_[c], "class=\"link\"");
}
void TreePanel::draw_node(Svg& svg, std::size_t i, std::string_view look) const {
    const auto& n = tree_.nodes[i];
    const Vec2d p = at_[i];
    const bool leaf = n.leaf;
    // Draw the shape, hatched for an empty leaf.
    const std::string_view fill = leaf && n.items == 0 ? " style=\"fill:url(#void)\"" : "";
    const std::string attributes =
        look.empty() ? fmt::format("class=\"node\" stroke=\"{}\"{}", level_colour(n.level - 1, levels_), fill)
                     : std::string(look);
    const double r = radius_;
    const Vec2d half(r * 0.9, r * 0.9);
    if (leaf)
        svg.rect({p - half, p + half}, attributes);
    else
        svg.circle(p, r, attributes);
    // Write the id into it, and the split or the items beside it, if they fit.
    const auto id = fmt::format("{}", n.id);
    if (r >= 2.8 * double(id.size())) svg.text(p + Vec2d(0, 3), id, "class=\"nodeid\"");
    if (leaf)
        draw_items(svg, i);
    else if (!n.text.empty() && room_beside(i) > r + 6 + letter * double(n.text.size()))
        svg.text(p + Vec2d(r + 4, -2), n.text, "class=\"split\"");
}
void TreePanel::draw_items(Svg& svg, std::size_t i) const {
    double y = at_[i][1] + radius_ + 9;
    for (const auto& word : wrapped(tree_.nodes[i].text, 1)) {
        if (letter * double(word.size()) > step_) return;
        svg.text({at_[i][0], y}, word, "class=\"item\"");
        y += 9;
    }
}
double TreePanel::room_beside(std::size_t i) const {
    double room = area_.high[0] + legend_gap - at_[i][0];
    for (std::size_t k = 0; k < at_.size(); ++k)
        if (tree_.nodes[k].level == tree_.nodes[i].level && at_[k][0] > at_[i][0])
            room = std::min(room, at_[k][0] - radius_ - at_[i][0]);
    return room;
}
void TreePanel::draw_note(Svg& svg) const {
    if (tree_.levels_left_out > 0)
        svg.text({area_.low[0], area_.high[1] + 13},
                 fmt::format("without its {} deepest levels", tree_.levels_left_out), "class=\"quiet\"");
}

void number_leaves(Svg& svg, const Panel& panel, const FlatStructure& flat) {
    for (const auto& c : flat.cells) {
        if (!c.leaf) continue;
        Box2d box;
        for (const auto& p : panel(c.corners)) box.expand(p);
        const auto id = fmt::format("{}", c.id);
        if (box.extent()[0] < 6.0 * double(id.size()) + 2 || box.extent()[1] < 10) continue;
        svg.text(box.center() + Vec2d(0, 3), id, "class=\"nodeid\"");
    }
}

}  // namespace hedgerow::cli
