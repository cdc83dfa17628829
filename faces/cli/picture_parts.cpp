#include "picture_parts.h"

#include <algorithm>
#include <cmath>

#include "common.h"

namespace hedgerow::cli {

std::string_view plain_style() {
    return "text{font-family:'DejaVu Sans',Helvetica,Arial,sans-serif;font-size:12px;fill:#333}\n"
           ".title{font-size:17px;font-weight:bold;fill:#111}.name{font-weight:bold}\n"
           ".quiet,.legend{fill:#777;font-size:11px}.legend{fill:#333}\n"
           ".cell{fill:none;stroke-linejoin:round}.shared{fill:url(#hatch);stroke:none}\n"
           ".leaf{fill-opacity:.20}.leaf.l1{stroke-width:.9 "
           "!important}.leaf.void{fill:url(#void);fill-opacity:1}\n"
           ".dot{fill:#16181d}.line{stroke:#16181d;fill:none;stroke-linecap:round}\n";
}

void add_definitions(Svg& svg) {
    svg.raw(
        "<defs><pattern id=\"hatch\" width=\"6\" height=\"6\" patternUnits=\"userSpaceOnUse\" "
        "patternTransform=\"rotate(45)\"><rect width=\"6\" height=\"6\" fill=\"#d0103a\" "
        "fill-opacity=\".10\"/><line x1=\"0\" y1=\"0\" x2=\"0\" y2=\"6\" stroke=\"#d0103a\" "
        "stroke-width=\"1.6\" stroke-opacity=\".6\"/></pattern>\n"
        "<pattern id=\"void\" width=\"5\" height=\"5\" patternUnits=\"userSpaceOnUse\" "
        "patternTransform=\"rotate(-45)\"><line x1=\"0\" y1=\"0\" x2=\"0\" y2=\"5\" stroke=\"#dfe2e8\" "
        "stroke-width=\"1.4\"/></pattern>\n"
        "<marker id=\"arrow\" markerWidth=\"9\" markerHeight=\"8\" refX=\"8\" refY=\"4\" orient=\"auto\">"
        "<path d=\"M0,0 L9,4 L0,8 z\" fill=\"#111\"/></marker></defs>\n");
}

std::string level_style(int levels, double thin) {
    std::string css;
    for (int k = 1; k <= levels; ++k) {
        const auto colour = level_colour(k - 1, levels);
        css += fmt::format(".l{0}{{stroke:{1};stroke-width:{2:.2f}}}.leaf.l{0}:not(.void){{fill:{1}}}\n", k,
                           colour, std::max(0.35, 2.6 * std::pow(0.8, k - 1)) * thin);
    }
    return css;
}

namespace {

constexpr double cells_share = 0.46;  // share of the width that cells take beside their tree

}  // namespace

Box2d cells_part(const Box2d& area) {
    Box2d left = area;
    left.high[0] = area.low[0] + cells_share * area.extent()[0];
    return left;
}
Box2d tree_part(const Box2d& area) {
    Box2d right = area;
    right.low[0] = cells_part(area).high[0] + picture_margin;
    return right;
}

Caption::Caption(std::string_view name_text, const std::vector<std::string>& facts_text, double width) {
    const auto letters = [&](double each) { return static_cast<std::size_t>(std::max(12.0, width / each)); };
    name = wrapped(name_text, letters(7.6));
    for (const auto& fact : facts_text)
        for (auto& line : wrapped(fact, letters(6.6))) facts.push_back(std::move(line));
}
void Caption::draw(Svg& svg, Vec2d at) const {
    for (const auto& line : name) svg.text(at, line, "class=\"name\""), at[1] += 16;
    for (const auto& line : facts) svg.text(at, line), at[1] += 16;
}

Layout::Layout(int width, int height, const std::vector<NamedStructure>& structures, std::size_t columns) {
    const std::size_t n = structures.size();
    if (columns == 0) columns = n < 2 ? 1 : 2;
    const std::size_t rows = (n + columns - 1) / columns;
    const double wide = (width - legend_width - picture_margin) / double(columns);
    // Wrap the captions. A row of panels needs the height of its highest caption.
    std::vector<double> feet(rows);
    for (std::size_t i = 0; i < n; ++i) {
        captions_.emplace_back(structures[i].name, structures[i].facts, wide - picture_margin);
        feet[i / columns] = std::max(feet[i / columns], captions_.back().height());
    }
    for (std::size_t r = 0; r + 1 < rows; ++r) feet[r] += 18;  // for the coordinates above the next row
    // Share the height that is left equally among the rows.
    double all_feet = 0;
    for (const double foot : feet) all_feet += foot;
    const double high = (height - picture_head - all_feet) / double(rows);
    double top = picture_head;
    for (std::size_t i = 0; i < n; ++i) {
        const double left = picture_margin + wide * double(i % columns);
        areas_.push_back({{left, top}, {left + wide - picture_margin, top + high}});
        if (i % columns + 1 == columns) top += high + feet[i / columns];
    }
    legend_ = {width - legend_width + 6, picture_head};
    legend_height_ = height - picture_head - (rows > 0 ? feet.back() : 0);
}
void Layout::draw_caption(Svg& svg, std::size_t i) const {
    captions_[i].draw(svg, {areas_[i].low[0], areas_[i].high[1] + 32});
}

Box2d frame_of(const FlatScene& scene, const std::vector<const FlatStructure*>& structures) {
    Box2d box;
    const auto expand = [&](const Corners& points) {
        for (const auto& p : points) box.expand(p);
    };
    for (const auto* s : structures)
        for (const auto& c : s->cells) expand(c.corners);
    for (const auto& p : scene.primitives) {
        expand(p.points);
        for (const double side : {-p.radius, p.radius}) box.expand(p.points[0] + Vec2d::all(side));
    }
    if (box.empty()) box = {{-1, -1}, {1, 1}};
    return box;
}

double crowding(std::size_t count, const Panel& panel) {
    const Vec2d e = panel.frame().extent();
    return std::clamp(std::sqrt(e[0] * e[1] / (double(count) + 1)) / 16, 0.3, 1.0);
}

void draw_primitive(Svg& svg, const Panel& panel, const FlatPrimitive& p, double size,
                    std::string_view more) {
    const auto line = [&](double width) {
        return fmt::format("class=\"line{}\" stroke-width=\"{:.2f}\"", more, width * size);
    };
    if (p.radius > 0)
        svg.circle(panel(p.points[0]), panel.pixels(p.radius), line(1));
    else if (p.points.size() == 1)
        svg.circle(panel(p.points[0]), 1.7 * size, fmt::format("class=\"dot{}\"", more));
    else if (p.points.size() == 2)
        svg.line(panel(p.points[0]), panel(p.points[1]), line(1.3));
    else
        svg.polygon(panel(p.points), line(1.3));
}
void draw_primitives(Svg& svg, const Panel& panel, const std::vector<FlatPrimitive>& all, double size,
                     std::string_view more) {
    if (all.size() <= most_with_hints) {
        for (const auto& p : all) draw_primitive(svg, panel, p, size, more);
        return;
    }
    Path dots, lines;
    for (const auto& p : all) {
        if (p.radius > 0)
            lines.circle(panel(p.points[0]), panel.pixels(p.radius));
        else if (p.points.size() == 1)
            dots.dot(panel(p.points[0]));
        else
            lines.polygon(panel(p.points));
    }
    svg.path(dots, fmt::format("class=\"line{}\" stroke-width=\"{:.2f}\"", more, 3.4 * size));
    svg.path(lines, fmt::format("class=\"line{}\" stroke-width=\"{:.2f}\"", more, 1.3 * size));
}

std::string hint_of(const FlatCell& c) {
    return c.leaf ? fmt::format("leaf {}, level {}, {} primitives", c.id, c.level, c.items)
                  : fmt::format("node {}, level {}", c.id, c.level);
}

}  // namespace hedgerow::cli
