#include "ray_drawing.h"

#include <algorithm>
#include <cmath>

namespace hedgerow::cli {

namespace {

/// t where the drawn ray ends in a structure: at the hit, or at `beyond` without a hit.
double end_of(const TraceTable& table, double beyond) {
    return table.hit ? table.hit->second : beyond;
}
Box2d around_point(const Vec2d& p, double reach) {
    return {p - Vec2d::all(reach), p + Vec2d::all(reach)};
}

/// Writes ascending numbers as runs: "3-5 8" for 3, 4, 5, 8.
std::string runs_text(const std::vector<std::size_t>& numbers) {
    std::string text;
    for (std::size_t i = 0, end; i < numbers.size(); i = end) {
        for (end = i + 1; end < numbers.size() && numbers[end] == numbers[end - 1] + 1;) ++end;
        text += fmt::format("{}{}", text.empty() ? "" : " ", numbers[i]);
        if (end - i > 1) text += fmt::format("-{}", numbers[end - 1]);
    }
    return text;
}

}  // namespace

RayFrame::RayFrame(const FlatScene& scene, const std::vector<RayView>& views) {
    // Show all cells, also the visited ones where the others are not drawn.
    std::vector<const FlatStructure*> flats;
    flats.reserve(views.size());
    for (const auto& v : views) flats.push_back(&v.structure.flat);
    shown = frame_of(scene, flats);
    for (const auto& v : views)
        for (const auto& row : v.table.rows)
            for (const auto& p : row.corners) shown.expand(p);
    // Intersect the ray with the box shown. All views have the same ray.
    const TraceTable& table = views.front().table;
    const double speed = std::max(length(table.flat_direction), 1e-300), wide = length(shown.extent());
    double enter = 0, leave = 0;
    if (const auto in = meet(Ray<double, 2>{table.flat_origin, table.flat_direction}, shown))
        enter = in->entry, leave = in->exit;
    // Begin shortly before the scene if the origin is far from it, and end at the farthest hit or beyond the
    // scene.
    first = enter * speed > 0.3 * wide ? enter - 0.1 * wide / speed : 0;
    const double beyond = leave + 0.04 * wide / speed;
    last = end_of(table, beyond);
    for (const auto& v : views) last = std::max(last, end_of(v.table, beyond));
    shown.expand(table.at(first)).expand(table.at(last));
}

RayDrawing::RayDrawing(Svg& svg, const FlatScene& scene, const RayView& view, const RayFrame& frame,
                       const Box2d& area)
    : svg_(svg),
      scene_(scene),
      all_(view.structure.flat),
      table_(view.table),
      frame_(frame),
      last_(end_of(view.table, frame.last)),
      cells_area_(view.structure.tree.nodes.empty() ? area : cells_part(area)),
      panel_(frame.shown, cells_area_),
      tree_(view.structure.tree) {
    for (const auto& p : scene.primitives) primitives_[p.id] = &p;
    if (!tree_.nodes.empty()) tree_panel_.emplace(tree_, tree_part(area));
}

std::string RayDrawing::style() {
    return std::string(plain_style()) + std::string(tree_style()) +
           ".all{stroke:#d5d9e0;stroke-width:.6}.faint.line{stroke:#9aa1ad}.faint.dot{fill:#9aa1ad}\n"
           ".all.leaf{fill:none}.all.void{fill:url(#void);fill-opacity:1}.node.off{stroke:#b6bcc8}\n"
           ".visited{stroke-width:1.6}.ray{stroke:#111;stroke-width:1.4}.origin{fill:#111}\n"
           ".part{stroke:#111;stroke-width:4;stroke-opacity:.55;stroke-linecap:round}\n"
           ".tested.line{stroke:#e07b00}.tested.dot{fill:#e07b00}.met.line{stroke:#d0103a}\n"
           ".hit,.nearest{fill:none;stroke:#d0103a;stroke-width:2}.nearest{stroke:#0a7d32}.leader{stroke:#"
           "888;stroke-width:.7}\n"
           ".badge{fill:#fff;stroke-width:1.2}.number{font-size:9px;text-anchor:middle}\n"
           ".t{font-size:10px;text-anchor:middle;paint-order:stroke;stroke:#fff;stroke-width:3px}\n";
}

void RayDrawing::add_legend(Svg& svg, const Vec2d& at, bool numbers, bool tree) {
    Legend legend(svg, at);
    const auto box = [&](const std::string& look) {
        return [&svg, look](const Box2d& b) { svg.rect(b, look); };
    };
    const auto line = [&](const std::string& look) {
        return [&svg, look](const Box2d& b) {
            svg.line({b.low[0], b.high[1] - 2}, {b.high[0], b.low[1] + 2}, look);
        };
    };
    legend.heading("cells");
    legend.line("visited, first to last", [&](const Box2d& b) {
        const double wide = b.extent()[0] / 6;
        for (int k = 0; k < 6; ++k)
            svg.rect({{b.low[0] + wide * k, b.low[1]}, {b.low[0] + wide * (k + 1), b.high[1]}},
                     fmt::format("fill=\"{}\"", level_colour(k, 6)));
    });
    legend.line("leaf, looked into",
                box("fill=\"#26629e\" fill-opacity=\".25\" stroke=\"#26629e\" stroke-width=\"1.6\""));
    legend.line("node, opened", box("fill=\"none\" stroke=\"#26629e\" stroke-width=\"1.6\""));
    legend.line("empty, pruned", box("fill=\"url(#void)\" stroke=\"#d5d9e0\""));
    legend.line("not visited", box("fill=\"none\" stroke=\"#d5d9e0\""));
    const auto numbered = [&](std::string_view text, std::string_view colour) {
        return [&svg, text, colour](const Box2d& b) {
            svg.rounded(b, 6, fmt::format("fill=\"#fff\" stroke=\"{}\"", colour));
            svg.text(b.center() + Vec2d(0, 3.4), text, "class=\"number\"");
        };
    };
    if (numbers) {
        legend.line("step in a leaf", numbered("7", "#26629e"));
        legend.line("steps at nodes", numbered("1-4", "#b6bcc8"));
    }
    legend.heading("primitives");
    legend.line("tested, met", line("stroke=\"#d0103a\" stroke-width=\"2.2\""));
    legend.line("tested, missed", line("stroke=\"#e07b00\" stroke-width=\"2.2\""));
    legend.line("not tested", line("stroke=\"#9aa1ad\" stroke-width=\"1.3\""));
    legend.line("the hit", [&](const Box2d& b) {
        svg.circle(b.center(), 5, "fill=\"none\" stroke=\"#d0103a\" stroke-width=\"2\"");
        svg.circle(b.center(), 1.6, "fill=\"#d0103a\"");
    });
    if (!tree) return;
    legend.heading("tree");
    legend.line("node, split at",
                [&](const Box2d& b) { svg.circle(b.center(), 6, "fill=\"#fff\" stroke=\"#555\""); });
    legend.line("leaf, primitives", [&](const Box2d& b) {
        svg.rect(around_point(b.center(), 5.5), "fill=\"#fff\" stroke=\"#555\"");
    });
    legend.line("not visited",
                [&](const Box2d& b) { svg.circle(b.center(), 6, "fill=\"#fff\" stroke=\"#b6bcc8\""); });
}

Vec2d RayDrawing::at(double t) const {
    return panel_(table_.at(std::clamp(t, frame_.first, last_)));
}
std::string RayDrawing::colour(std::size_t step) const {
    return level_colour(static_cast<int>(step), static_cast<int>(table_.rows.size()));
}

void RayDrawing::ground() {
    // Draw the cells, as two paths if they are too many for hints.
    const auto look = [](const FlatCell& c) {
        return c.leaf && c.items == 0 ? "class=\"cell all leaf void\"" : "class=\"cell all\"";
    };
    if (all_.cells.size() <= most_with_hints) {
        for (const auto& c : all_.cells) svg_.polygon(panel_(c.corners), look(c), hint_of(c));
    } else {
        Path empty, others;
        for (const auto& c : all_.cells) (c.leaf && c.items == 0 ? empty : others).polygon(panel_(c.corners));
        svg_.path(empty, "class=\"cell all leaf void\"");
        svg_.path(others, "class=\"cell all\"");
    }
    draw_primitives(svg_, panel_, scene_.primitives, crowding(scene_.primitives.size(), panel_), " faint");
    // Draw the tree.
    if (!tree_panel_) return;
    tree_panel_->draw_links(svg_);
    for (std::size_t i = 0; i < tree_.nodes.size(); ++i)
        tree_panel_->draw_node(svg_, i, "class=\"node off\"");
    tree_panel_->draw_note(svg_);
}
void RayDrawing::cell(std::size_t i) {
    const TraceRow& row = table_.rows[i];
    const double opacity = row.tests.empty() ? 0.12 : 0.3;
    svg_.polygon(
        panel_(row.corners),
        fmt::format("class=\"cell visited\" stroke=\"{0}\"{1}", colour(i),
                    row.leaf ? fmt::format(" style=\"fill:{};fill-opacity:{}\"", colour(i), opacity) : ""),
        fmt::format("step {}: {} {}, t in {}", i + 1, row.leaf ? "leaf" : "node", row.node,
                    interval_text(row.inside)));
}
void RayDrawing::tests(std::size_t i) {
    for (const auto& t : table_.rows[i].tests)
        if (const auto p = primitives_.find(t.id); p != primitives_.end() && !t.skipped)
            draw_primitive(svg_, panel_, *p->second, 1.8, t.t ? " met" : " tested");
}
void RayDrawing::interval(std::size_t i) {
    const Interval<double> in = table_.rows[i].inside;
    const Vec2d enter = at(in.entry), leave = at(in.exit);
    svg_.line(enter, leave, "class=\"part\"");
    const Vec2d along = normalized(at(last_) - at(frame_.first)), side(along[1], -along[0]);
    Labels labels(cells_area_);
    labels.block(Box2d().expand(enter).expand(leave));
    const auto mark = [&](const Vec2d& p, double t, const Vec2d& wanted) {
        svg_.line(p - side * 7.0, p + side * 7.0, "class=\"ray\"");
        const auto text = fmt::format("t = {:.3g}", t);
        if (const auto place = labels.place(wanted, {6.2 * double(text.size()), 13}))
            svg_.text(*place + Vec2d(0, 4), text, "class=\"t\"");
    };
    mark(enter, in.entry, enter + side * 18.0);
    mark(leave, in.exit, leave - side * 18.0);
}
void RayDrawing::node(std::size_t i) {
    if (!tree_panel_) return;
    const auto found = tree_.find(table_.rows[i].node);
    if (!found) return;
    tree_panel_->draw_node(svg_, *found,
                           fmt::format("class=\"node\" stroke=\"{0}\" style=\"stroke-width:2.4;fill:{0};"
                                       "fill-opacity:.3\"",
                                       colour(i)));
    if (tree_panel_->radius() >= 5)
        svg_.text(tree_panel_->at(*found) - Vec2d(tree_panel_->radius() + 3, tree_panel_->radius()),
                  fmt::format("{}", i + 1), fmt::format("class=\"number\" style=\"fill:{}\"", colour(i)));
}
void RayDrawing::ray() {
    svg_.line(at(frame_.first), at(last_), "class=\"ray\" marker-end=\"url(#arrow)\"");
    if (frame_.first <= 0) svg_.circle(at(0), 3.5, "class=\"origin\"");
}
void RayDrawing::hit() {
    if (!table_.hit) return;
    svg_.circle(at(table_.hit->second), 5, "class=\"hit\"");
    svg_.circle(at(table_.hit->second), 1.6, "fill=\"#d0103a\"");
    if (!table_.wrong()) return;
    svg_.circle(at(table_.nearest->second), 5, "class=\"nearest\"");
    svg_.text(at(table_.nearest->second) + Vec2d(0, -9), "nearest", "class=\"t\" style=\"fill:#0a7d32\"");
}

void RayDrawing::numbers() {
    struct Entered {
        Vec2d at;
        std::vector<std::size_t> steps;
    };
    // Keep the labels off the ends of the ray.
    Labels labels(cells_area_);
    labels.block(around_point(at(last_), 7));
    if (frame_.first <= 0) labels.block(around_point(at(0), 4));
    // Group inner nodes that the ray enters within 12 pixels of each other.
    std::vector<Entered> nodes;
    for (std::size_t i = 0; i < table_.rows.size(); ++i) {
        if (table_.rows[i].leaf) continue;
        const Vec2d p = at(table_.rows[i].inside.entry);
        const auto near =
            std::find_if(nodes.begin(), nodes.end(), [&](const auto& e) { return length(e.at - p) < 12; });
        if (near != nodes.end())
            near->steps.push_back(i + 1);
        else
            nodes.push_back({p, {i + 1}});
    }
    for (const auto& e : nodes) svg_.circle(e.at, 2, "fill=\"#555\"");
    // Number the leaves in the middle of the ray's part in them.
    for (std::size_t i = 0; i < table_.rows.size(); ++i) {
        const Interval<double> in = table_.rows[i].inside;
        const Vec2d middle = at(in.entry) * 0.5 + at(in.exit) * 0.5;
        if (table_.rows[i].leaf)
            labels.draw(svg_, middle, middle, fmt::format("{}", i + 1),
                        fmt::format("class=\"badge\" stroke=\"{}\"", colour(i)));
    }
    // Number the groups beside the ray.
    const Vec2d along = normalized(at(last_) - at(frame_.first)), side(along[1], -along[0]);
    for (const auto& e : nodes)
        labels.draw(svg_, e.at, e.at - side * 14.0, runs_text(e.steps), "class=\"badge\" stroke=\"#b6bcc8\"");
}

}  // namespace hedgerow::cli
