/// Pictures of structures side by side, as cells and as trees.
#include <algorithm>
#include <cmath>
#include <map>

#include "picture_parts.h"
#include "tree_picture.h"

namespace hedgerow::cli {

namespace {

bool is_void(const FlatCell& c) {
    return c.leaf && c.items == 0;
}
std::string class_of(const FlatCell& c) {
    return fmt::format("class=\"cell{} l{}\"", c.leaf ? (is_void(c) ? " leaf void" : " leaf") : "", c.level);
}

/// Draws the deepest cells first, so that the lines of the first levels lie on top.
void draw_cells(Svg& svg, const Panel& panel, const FlatStructure& flat) {
    std::vector<const FlatCell*> order;
    for (const auto& c : flat.cells) order.push_back(&c);
    std::stable_sort(order.begin(), order.end(), [](auto* a, auto* b) { return a->level > b->level; });
    if (order.size() <= most_with_hints) {
        for (const auto* c : order) svg.polygon(panel(c->corners), class_of(*c), hint_of(*c));
    } else {
        std::map<std::pair<int, std::string>, Path> paths;  // by level, the deepest first
        for (const auto* c : order) paths[{-c->level, class_of(*c)}].polygon(panel(c->corners));
        for (const auto& [key, path] : paths) svg.path(path, key.second);
    }
    for (const auto& s : flat.shared) svg.polygon(panel(s), "class=\"shared\"");
}

/// The frame of all panels. One structure is shown as a whole. Of several the frame has what they hold, so
/// that a structure whose empty cells reach farther, as an octree's do, does not make the others small.
Box2d shown_of(const FlatScene& scene, const std::vector<NamedStructure>& structures) {
    std::vector<FlatStructure> parts;
    for (const auto& s : structures) {
        parts.push_back(s.flat);
        auto& cells = parts.back().cells;
        const bool prunes = std::ranges::any_of(cells, is_void);
        if (structures.size() > 1 && prunes)
            std::erase_if(cells, [](const FlatCell& c) { return !c.leaf || is_void(c); });
    }
    std::vector<const FlatStructure*> all;
    for (const auto& p : parts) all.push_back(&p);
    return frame_of(scene, all);
}

/// Draws the frame and the coordinates of its corners, so that sizes can be read off.
void draw_corners(Svg& svg, const Panel& panel, const Box2d& shown) {
    const Box2d f = panel.frame();
    svg.rect(f, "fill=\"none\" stroke=\"#c8ccd4\" stroke-width=\"1\"");
    const auto at = [](const Vec2d& p) { return fmt::format("{:.4g}, {:.4g}", p[0], p[1]); };
    svg.text({f.low[0], f.high[1] + 13}, at(shown.low), "class=\"quiet\"");
    svg.text({f.high[0], f.low[1] - 5}, at(shown.high), "class=\"quiet\" text-anchor=\"end\"");
}

/// Opens a group of which only what lies in the panel's frame is seen.
void open_clip(Svg& svg, const Panel& panel, std::size_t number) {
    svg.raw(fmt::format("<clipPath id=\"frame{}\">", number));
    svg.rect(panel.frame(), "");
    svg.raw("</clipPath>\n");
    svg.open_group(fmt::format("clip-path=\"url(#frame{})\"", number));
}

/// Draws a swatch for each level, with the number of its cells in each structure if there are at most two,
/// and swatches for the hatchings.
void draw_legend(Svg& svg, const Layout& layout, const std::vector<NamedStructure>& structures, int levels) {
    // Count the cells of each level, and the empty leaves.
    std::vector<std::vector<std::size_t>> counts(static_cast<std::size_t>(levels),
                                                 std::vector<std::size_t>(structures.size()));
    std::size_t empty = 0;
    bool shared = false;
    for (std::size_t s = 0; s < structures.size(); ++s) {
        for (const auto& c : structures[s].flat.cells) {
            ++counts[static_cast<std::size_t>(c.level - 1)][s];
            empty += is_void(c);
        }
        shared = shared || !structures[s].flat.shared.empty();
    }
    // Draw the levels within the height. If they are too close for a label each, only every `every`-th has
    // one.
    const bool counted = structures.size() <= 2;
    const Vec2d at = layout.legend();
    const double room = layout.legend_height() - 60, step = std::clamp(room / levels, 1.0, 18.0);
    const int every = static_cast<int>(std::ceil(13 / step));
    svg.text(at + Vec2d(0, 2), counted ? "level: cells" : "level", "class=\"quiet\"");
    for (int k = 0; k < levels; ++k) {
        const double y = at[1] + 12 + step * k, high = std::max(1.0, step - 3);
        svg.rect({{at[0], y}, {at[0] + 22, y + high}},
                 fmt::format("fill=\"{0}\" fill-opacity=\".55\" stroke=\"{0}\"", level_colour(k, levels)));
        if (k % every != 0) continue;
        std::string text = fmt::format("{}", k + 1);
        for (std::size_t s = 0; s < structures.size() && counted; ++s)
            text += fmt::format("{} {}", s > 0 ? " |" : ":", counts[static_cast<std::size_t>(k)][s]);
        svg.text({at[0] + 30, y + high / 2 + 4}, text, "class=\"legend\"");
    }
    // Explain the hatchings that are in the picture.
    Legend rest(svg, at + Vec2d(0, 24 + step * levels));
    const auto swatch = [&](const char* look) {
        return [&svg, look](const Box2d& box) { svg.rect(box, look); };
    };
    if (empty > 0)
        rest.line(
            counted && structures.size() == 1 ? fmt::format("empty: {}, pruned", empty) : "empty: pruned",
            swatch("fill=\"url(#void)\" stroke=\"#c8ccd4\""));
    if (shared) rest.line("siblings share", swatch("class=\"shared\""));
}

}  // namespace

std::string cells_picture(const FlatScene& scene, const std::vector<NamedStructure>& structures) {
    // Find what all panels share: the frame, the number of levels, the width of lines.
    int levels = 1;
    std::size_t cells = 0;
    bool trees = false, cut = false;
    const Box2d shown = shown_of(scene, structures);
    for (const auto& s : structures) {
        cut = cut || !shown.contains(frame_of(scene, {&s.flat}));
        cells = std::max(cells, s.flat.cells.size());
        for (const auto& c : s.flat.cells) levels = std::max(levels, c.level);
        trees = trees || !s.tree.nodes.empty();
    }
    const Layout layout(scene.width, scene.height, structures, trees ? 1 : 0);
    const auto cells_area = [&](std::size_t s) {
        return trees ? cells_part(layout.area(s)) : layout.area(s);
    };
    const Panel first(shown, cells_area(0));
    Svg svg(scene.width, scene.height,
            std::string(plain_style()) + level_style(levels, crowding(cells, first)) +
                std::string(trees ? tree_style() : ""));
    add_definitions(svg);
    svg.text({picture_margin, 32}, scene.title, "class=\"title\"");
    const double size = crowding(scene.primitives.size(), first);
    for (std::size_t s = 0; s < structures.size(); ++s) {
        // Draw the cells with the primitives over them.
        const Panel panel(shown, cells_area(s));
        draw_corners(svg, panel, shown);
        if (cut) open_clip(svg, panel, s);
        draw_cells(svg, panel, structures[s].flat);
        if (cut) svg.close_group();
        draw_primitives(svg, panel, scene.primitives, size, "");
        layout.draw_caption(svg, s);
        if (structures[s].tree.nodes.empty()) continue;
        // Draw the tree beside the cells; numbers connect its leaves with theirs.
        number_leaves(svg, panel, structures[s].flat);
        const TreePanel tree(structures[s].tree, tree_part(layout.area(s)));
        tree.draw_links(svg);
        for (std::size_t i = 0; i < structures[s].tree.nodes.size(); ++i) tree.draw_node(svg, i);
        tree.draw_note(svg);
    }
    draw_legend(svg, layout, structures, levels);
    return svg.finished();
}

}  // namespace hedgerow::cli
