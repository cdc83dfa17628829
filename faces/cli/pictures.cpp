#include "pictures.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <unordered_map>

#include "common.h"
#include "svg.h"

namespace hedgerow::cli {

namespace {

constexpr double margin = 24, head = 64, legend_width = 132;

/// A structure's name and what is said of it, below its panel, in lines as wide as that.
struct Caption {
    std::vector<std::string> name, facts;

    Caption(std::string_view name_text, const std::vector<std::string>& facts_text, double width) {
        const auto letters = static_cast<std::size_t>(std::max(12.0, width / 6.6));
        name = wrapped(name_text, letters);
        for (const auto& fact : facts_text)
            for (auto& line : wrapped(fact, letters)) facts.push_back(std::move(line));
    }
    /// Of the part of the picture below the panels.
    double height() const { return 26 + 16 * double(name.size() + facts.size()); }
    void draw(Svg& svg, Vec2d at) const {
        for (const auto& line : name) svg.text(at, line, "class=\"name\""), at[1] += 16;
        for (const auto& line : facts) svg.text(at, line), at[1] += 16;
    }
};

constexpr std::string_view plain_style =
    "text{font-family:'DejaVu Sans',Helvetica,Arial,sans-serif;font-size:12px;fill:#333}\n"
    ".title{font-size:17px;font-weight:bold;fill:#111}.name{font-weight:bold}.quiet{fill:#777;font-size:11px}"
    "\n"
    ".cell{fill:none;stroke-linejoin:round}.shared{fill:url(#hatch);stroke:none}\n"
    ".dot{fill:#16181d}.line{stroke:#16181d;fill:none;stroke-linecap:round}\n";

void expand(Box2d& box, const Corners& points) {
    for (const auto& p : points) box.expand(p);
}
Box2d frame_of(const FlatScene& scene, const std::vector<NamedStructure>& structures) {
    Box2d box;
    for (const auto& s : structures)
        for (const auto& c : s.flat.cells) expand(box, c.corners);
    for (const auto& p : scene.primitives) {
        expand(box, p.points);
        for (const double side : {-p.radius, p.radius}) box.expand(p.points[0] + Vec2d::all(side));
    }
    if (box.empty()) box = {{-1, -1}, {1, 1}};
    return box;
}

/// Thinner where there are many.
double crowding(std::size_t count, const Panel& panel) {
    const Vec2d e = panel.frame().extent();
    return std::clamp(std::sqrt(e[0] * e[1] / (double(count) + 1)) / 16, 0.3, 1.0);
}

void draw_primitive(Svg& svg, const Panel& panel, const FlatPrimitive& p, double size,
                    std::string_view more) {
    if (p.radius > 0)
        svg.circle(panel(p.points[0]), panel.pixels(p.radius),
                   fmt::format("class=\"line{}\" stroke-width=\"{:.2f}\"", more, size));
    else if (p.points.size() == 1)
        svg.circle(panel(p.points[0]), 1.7 * size, fmt::format("class=\"dot{}\"", more));
    else if (p.points.size() == 2)
        svg.line(panel(p.points[0]), panel(p.points[1]),
                 fmt::format("class=\"line{}\" stroke-width=\"{:.2f}\"", more, 1.3 * size));
    else
        svg.polygon(panel(p.points),
                    fmt::format("class=\"line{}\" stroke-width=\"{:.2f}\"", more, 1.3 * size));
}

std::string hint_of(const FlatCell& c) {
    return c.leaf ? fmt::format("leaf {}, level {}, {} primitives", c.id, c.level, c.items)
                  : fmt::format("node {}, level {}", c.id, c.level);
}

std::string level_style(int levels, double thin) {
    std::string css = ".leaf{fill-opacity:.20}.void{fill-opacity:.05}\n";
    for (int k = 1; k <= levels; ++k) {
        const auto colour = level_colour(k - 1, levels);
        css += fmt::format(".l{0}{{stroke:{1};stroke-width:{2:.2f}}}.leaf.l{0}{{fill:{1}}}\n", k, colour,
                           std::max(0.35, 2.6 * std::pow(0.8, k - 1)) * thin);
    }
    return css;
}

/// From the leaves up, so that the lines of the first levels lie on top.
void draw_cells(Svg& svg, const Panel& panel, const FlatStructure& flat) {
    std::vector<const FlatCell*> order;
    for (const auto& c : flat.cells) order.push_back(&c);
    std::stable_sort(order.begin(), order.end(), [](auto* a, auto* b) { return a->level > b->level; });
    for (const auto* c : order)
        svg.polygon(panel(c->corners),
                    fmt::format("class=\"cell{} l{}\"",
                                c->leaf ? (c->items > 0 ? " leaf" : " leaf void") : "", c->level),
                    hint_of(*c));
    for (const auto& s : flat.shared) svg.polygon(panel(s), "class=\"shared\"");
}

void draw_legend(Svg& svg, double left, const FlatScene& scene, const std::vector<NamedStructure>& structures,
                 int levels, double foot) {
    std::vector<std::vector<std::size_t>> counts(static_cast<std::size_t>(levels),
                                                 std::vector<std::size_t>(structures.size()));
    bool shared = false;
    for (std::size_t s = 0; s < structures.size(); ++s) {
        for (const auto& c : structures[s].flat.cells) ++counts[static_cast<std::size_t>(c.level - 1)][s];
        shared = shared || !structures[s].flat.shared.empty();
    }
    const double room = scene.height - head - foot - 40, step = std::clamp(room / levels, 1.0, 18.0);
    const int every = static_cast<int>(std::ceil(13 / step));
    svg.text({left, head + 2}, "level: cells", "class=\"quiet\"");
    for (int k = 0; k < levels; ++k) {
        const double y = head + 12 + step * k;
        svg.rect({{left, y}, {left + 22, y + std::max(1.0, step - 3)}},
                 fmt::format("fill=\"{0}\" fill-opacity=\".55\" stroke=\"{0}\"", level_colour(k, levels)));
        if (k % every != 0) continue;
        std::string text = fmt::format("{}:", k + 1);
        for (std::size_t s = 0; s < structures.size(); ++s)
            text += fmt::format("{}{}", s > 0 ? " | " : " ", counts[static_cast<std::size_t>(k)][s]);
        svg.text({left + 30, y + std::max(1.0, step - 3) / 2 + 4}, text);
    }
    if (!shared) return;
    const double y = head + 24 + step * levels;
    svg.rect({{left, y}, {left + 22, y + 12}}, "class=\"shared\"");
    svg.text({left + 30, y + 10}, "siblings share");
}

/// How far the frame reaches, so that sizes can be read off.
void draw_corners(Svg& svg, const Panel& panel, const Box2d& shown) {
    const Box2d f = panel.frame();
    svg.rect(f, "fill=\"none\" stroke=\"#c8ccd4\" stroke-width=\"1\"");
    const auto at = [](const Vec2d& p) { return fmt::format("{:.4g}, {:.4g}", p[0], p[1]); };
    svg.text({f.low[0], f.high[1] + 13}, at(shown.low), "class=\"quiet\"");
    svg.text({f.high[0], f.low[1] - 5}, at(shown.high), "class=\"quiet\" text-anchor=\"end\"");
}

constexpr std::string_view hatch =
    "<defs><pattern id=\"hatch\" width=\"6\" height=\"6\" patternUnits=\"userSpaceOnUse\" "
    "patternTransform=\"rotate(45)\"><rect width=\"6\" height=\"6\" fill=\"#d0103a\" fill-opacity=\".10\"/>"
    "<line x1=\"0\" y1=\"0\" x2=\"0\" y2=\"6\" stroke=\"#d0103a\" stroke-width=\"1.6\" "
    "stroke-opacity=\".6\"/></pattern></defs>\n";

}  // namespace

std::string cells_picture(const FlatScene& scene, const std::vector<NamedStructure>& structures) {
    int levels = 1;
    std::size_t cells = 0;
    for (const auto& s : structures) {
        cells = std::max(cells, s.flat.cells.size());
        for (const auto& c : s.flat.cells) levels = std::max(levels, c.level);
    }
    const Box2d shown = frame_of(scene, structures);
    const double wide = (scene.width - legend_width - margin) / double(structures.size());
    std::vector<Caption> captions;
    double foot = 0;
    for (const auto& s : structures) {
        captions.emplace_back(s.name, s.facts, wide - margin);
        foot = std::max(foot, captions.back().height());
    }
    const auto area = [&](std::size_t s) {
        const double left = margin + wide * double(s);
        return Box2d{{left, head}, {left + wide - margin, scene.height - foot}};
    };
    const Panel first(shown, area(0));
    Svg svg(scene.width, scene.height,
            std::string(plain_style) + level_style(levels, crowding(cells, first)));
    svg.raw(hatch);
    svg.text({margin, 32}, scene.title, "class=\"title\"");
    const double size = crowding(scene.primitives.size(), first);
    for (std::size_t s = 0; s < structures.size(); ++s) {
        const Panel panel(shown, area(s));
        draw_corners(svg, panel, shown);
        draw_cells(svg, panel, structures[s].flat);
        for (const auto& p : scene.primitives) draw_primitive(svg, panel, p, size, "");
        captions[s].draw(svg, {area(s).low[0], scene.height - foot + 36});
    }
    draw_legend(svg, scene.width - legend_width, scene, structures, levels, foot);
    return svg.finished();
}

std::size_t TraceRow::tested() const {
    return static_cast<std::size_t>(
        std::count_if(tests.begin(), tests.end(), [](const auto& t) { return !t.skipped; }));
}
std::string TraceTable::summary() const {
    const std::string cost =
        fmt::format("{} steps: {} nodes, {} leaves, {} primitives tested{}", rows.size(), visits.nodes,
                    visits.leaves, visits.primitives,
                    visits.skipped > 0 ? fmt::format(" ({} skipped, tested before)", visits.skipped) : "");
    return cost +
           (hit ? fmt::format("; hits primitive {} at t = {:.6g}", hit->first, hit->second) : "; no hit");
}

namespace {

std::string point_text(const std::vector<double>& p) {
    std::string text;
    for (const double x : p) text += fmt::format("{}{:.4g}", text.empty() ? "(" : ", ", x);
    return text + ")";
}
std::string number_text(double x) {
    return std::isfinite(x) ? fmt::format("{:.5g}", x) : std::string(x > 0 ? "inf" : "-inf");
}
std::string tests_text(const TraceRow& row) {
    std::string text;
    for (const auto& t : row.tests) {
        text += fmt::format("{}{}", text.empty() ? "" : " ", t.id);
        if (t.skipped) text += "(skipped)";
        if (t.t) text += fmt::format("(t={:.5g})", *t.t);
    }
    return text.empty() ? "-" : text;
}
std::vector<std::string> cells_of(const TraceRow& row, std::size_t step) {
    return {fmt::format("{}", step),
            fmt::format("{}", row.node),
            fmt::format("{}", row.level),
            row.leaf ? (row.tests.empty() ? "empty" : "leaf") : "node",
            point_text(row.low) + "-" + point_text(row.high),
            fmt::format("[{}, {}]", number_text(row.inside.entry), number_text(row.inside.exit)),
            number_text(row.limit),
            tests_text(row)};
}
constexpr std::string_view columns[] = {"step", "node",          "level",   "kind",
                                        "box",  "t in the cell", "t limit", "primitives tested"};

}  // namespace

std::string text_of(const TraceTable& table) {
    std::vector<std::vector<std::string>> lines = {{std::begin(columns), std::end(columns)}};
    for (std::size_t i = 0; i < table.rows.size(); ++i) lines.push_back(cells_of(table.rows[i], i + 1));
    std::vector<std::size_t> wide(std::size(columns));
    for (const auto& line : lines)
        for (std::size_t c = 0; c < wide.size(); ++c) wide[c] = std::max(wide[c], line[c].size());
    std::string text;
    for (const auto& line : lines) {
        for (std::size_t c = 0; c + 1 < wide.size(); ++c)
            text += fmt::format("{}{}  ", std::string(c < 3 ? wide[c] - line[c].size() : 0, ' ') + line[c],
                                std::string(c < 3 ? 0 : wide[c] - line[c].size(), ' '));
        text += line.back() + "\n";
    }
    return text + table.summary() + "\n";
}

namespace {

/// "3-5 8" of 3, 4, 5, 8.
std::string runs_text(const std::vector<std::size_t>& numbers) {
    std::string text;
    for (std::size_t i = 0, end; i < numbers.size(); i = end) {
        for (end = i + 1; end < numbers.size() && numbers[end] == numbers[end - 1] + 1;) ++end;
        text += fmt::format("{}{}", text.empty() ? "" : " ", numbers[i]);
        if (end - i > 1) text += fmt::format("-{}", numbers[end - 1]);
    }
    return text;
}

/// The ray's picture, part by part: the page puts its steps into groups of their own.
class RayDrawing {
public:
    RayDrawing(const FlatScene& scene, const FlatStructure& all, const TraceTable& table)
        : scene_(scene),
          all_(all),
          table_(table),
          caption_(table.structure, {table.summary()}, scene.width - 2 * margin),
          shown_(frame_with_ray()),
          panel_(shown_, {{margin, head}, {scene.width - margin, scene.height - caption_.height()}}),
          svg_(scene.width, scene.height, style()) {
        for (const auto& p : scene.primitives) primitives_[p.id] = &p;
    }

    void ground() {
        svg_.text({margin, 32}, scene_.title, "class=\"title\"");
        caption_.draw(svg_, {margin, scene_.height - caption_.height() + 36});
        for (const auto& c : all_.cells) svg_.polygon(panel_(c.corners), "class=\"cell all\"", hint_of(c));
        const double size = crowding(scene_.primitives.size(), panel_);
        for (const auto& p : scene_.primitives) draw_primitive(svg_, panel_, p, size, " faint");
    }
    void cell(std::size_t i) {
        const TraceRow& row = table_.rows[i];
        const auto colour = level_colour(static_cast<int>(i), static_cast<int>(table_.rows.size()));
        svg_.polygon(panel_(row.corners),
                     fmt::format("class=\"cell visited\" stroke=\"{0}\"{1}", colour,
                                 row.leaf ? fmt::format(" style=\"fill:{};fill-opacity:.22\"", colour) : ""),
                     fmt::format("step {}: {} {}, t in [{}, {}]", i + 1, row.leaf ? "leaf" : "node", row.node,
                                 number_text(row.inside.entry), number_text(row.inside.exit)));
    }
    void tests(std::size_t i) {
        for (const auto& t : table_.rows[i].tests)
            if (const auto p = primitives_.find(t.id); p != primitives_.end() && !t.skipped)
                draw_primitive(svg_, panel_, *p->second, 1.8, t.t ? " met" : " tested");
    }
    /// The ray's part in a cell.
    void part(std::size_t i) {
        const Interval<double> in = table_.rows[i].inside;
        svg_.line(at(in.entry), at(in.exit), "class=\"part\"");
    }
    void ray() {
        svg_.line(at(first_), at(last_), "class=\"ray\" marker-end=\"url(#arrow)\"");
        if (first_ <= 0) svg_.circle(at(0), 3.5, "class=\"origin\"");
    }
    void hit() {
        if (!table_.hit) return;
        svg_.circle(at(table_.hit->second), 5, "class=\"hit\"");
        svg_.circle(at(table_.hit->second), 1.6, "fill=\"#d0103a\"");
    }
    /// A leaf's number stands where the ray is in it; nodes are numbered where it enters them, those that it
    /// enters at one place together.
    void numbers() {
        struct Label {
            Vec2d at;
            std::vector<std::size_t> steps;
        };
        std::vector<Label> nodes;
        const Vec2d along = normalized(at(last_) - at(first_)), side(along[1], -along[0]);
        std::vector<Vec2d> taken;
        for (std::size_t i = 0; i < table_.rows.size(); ++i) {
            const TraceRow& row = table_.rows[i];
            const Interval<double> in = row.inside;
            if (!row.leaf) {
                const Vec2d p = at(in.entry);
                const auto near = std::find_if(nodes.begin(), nodes.end(),
                                               [&](const Label& l) { return length(l.at - p) < 12; });
                if (near != nodes.end())
                    near->steps.push_back(i + 1);
                else
                    nodes.push_back({p, {i + 1}});
                continue;
            }
            Vec2d p = at(in.entry) * 0.5 + at(in.exit) * 0.5;
            for (int tries = 0; tries < 12 && std::any_of(taken.begin(), taken.end(),
                                                          [&](const Vec2d& q) { return length(p - q) < 15; });
                 ++tries)
                p = p + side * 15.0;
            taken.push_back(p);
            svg_.circle(p, 7.5, "class=\"badge\"");
            svg_.text(p + Vec2d(0, 3.4), fmt::format("{}", i + 1), "class=\"number\"");
        }
        for (const auto& l : nodes) {
            svg_.circle(l.at, 2, "fill=\"#555\"");
            svg_.text(l.at - side * 14.0 + Vec2d(0, 4), runs_text(l.steps),
                      "class=\"quiet halo\" text-anchor=\"middle\"");
        }
    }
    void raw(std::string_view xml) { svg_.raw(xml); }
    void open_step(std::size_t i) { svg_.open_group(fmt::format("class=\"step\" id=\"step{}\"", i + 1)); }
    void close_step() { svg_.close_group(); }
    std::string finished() const { return svg_.finished(); }

private:
    static std::string style() {
        return std::string(plain_style) +
               ".all{stroke:#d5d9e0;stroke-width:.6}.faint.line{stroke:#9aa1ad}.faint.dot{fill:#9aa1ad}\n"
               ".visited{stroke-width:1.6}.ray{stroke:#111;stroke-width:1.4}.origin{fill:#111}\n"
               ".part{stroke:#111;stroke-width:4;stroke-opacity:.55;stroke-linecap:round}\n"
               ".tested.line{stroke:#e07b00}.tested.dot{fill:#e07b00}.met.line{stroke:#d0103a}\n"
               ".hit{fill:none;stroke:#d0103a;stroke-width:2}\n"
               ".badge{fill:#fff;stroke:#333;stroke-width:1}.number{font-size:9px;text-anchor:middle}\n"
               ".halo{paint-order:stroke;stroke:#fff;stroke-width:3px}\n";
    }
    /// What is seen, with the ray from its origin, if that is near, to a little beyond where it ends.
    Box2d frame_with_ray() {
        Box2d box = frame_of(scene_, {{"", {}, all_}});
        for (const auto& row : table_.rows) expand(box, row.corners);
        const double speed = std::max(length(table_.flat_direction), 1e-300), wide = length(box.extent());
        double enter = 0, leave = 0;
        if (const auto in = meet(Ray<double, 2>{table_.flat_origin, table_.flat_direction}, box))
            enter = in->entry, leave = in->exit;
        first_ = enter * speed > 0.3 * wide ? enter - 0.1 * wide / speed : 0;
        last_ = table_.hit ? table_.hit->second : leave + 0.04 * wide / speed;
        return box.expand(table_.at(first_)).expand(table_.at(last_));
    }
    Vec2d at(double t) const { return panel_(table_.at(std::clamp(t, first_, last_))); }

    const FlatScene& scene_;
    const FlatStructure& all_;
    const TraceTable& table_;
    Caption caption_;
    double first_ = 0, last_ = 0;  // t of the ray's ends in the picture
    Box2d shown_;
    Panel panel_;
    Svg svg_;
    std::unordered_map<PrimitiveId, const FlatPrimitive*> primitives_;
};

constexpr std::string_view arrow =
    "<defs><marker id=\"arrow\" markerWidth=\"9\" markerHeight=\"8\" refX=\"8\" refY=\"4\" orient=\"auto\">"
    "<path d=\"M0,0 L9,4 L0,8 z\" fill=\"#111\"/></marker></defs>\n";

constexpr std::string_view page_style = R"(<style>
body{font-family:'DejaVu Sans',Helvetica,Arial,sans-serif;margin:16px;color:#222}
main{display:flex;flex-wrap:wrap;gap:20px}
table{border-collapse:collapse;font-size:12px}
td,th{padding:2px 8px;text-align:left;white-space:nowrap;border-bottom:1px solid #eee}
td:last-child{white-space:normal}
tbody tr{cursor:pointer}tr.now{background:#ffe9b8}tr.later{color:#aaa}
.rows{max-height:760px;overflow:auto}
.step{visibility:hidden}.step.past{visibility:visible;opacity:.25}.step.now{visibility:visible}
.step.past .part,.step.past .tested{visibility:hidden}
</style>
)";
constexpr std::string_view page_script = R"(<script>
const rows = [...document.querySelectorAll('tbody tr')], slider = document.getElementById('slider');
let now = 1;
function show(step) {
  now = Math.max(1, Math.min(rows.length, step));
  rows.forEach((row, i) => {
    row.className = i + 1 < now ? 'past' : i + 1 > now ? 'later' : 'now';
    document.getElementById('step' + (i + 1)).setAttribute('class', 'step ' + row.className);
  });
  slider.value = now;
  document.getElementById('where').textContent = now + ' of ' + rows.length;
  if (rows.length) rows[now - 1].scrollIntoView({block: 'nearest'});
}
rows.forEach((row, i) => row.addEventListener('click', () => show(i + 1)));
slider.addEventListener('input', () => show(+slider.value));
document.getElementById('back').addEventListener('click', () => show(now - 1));
document.getElementById('next').addEventListener('click', () => show(now + 1));
document.addEventListener('keydown', e => {
  if (e.key === 'ArrowRight') show(now + 1); else if (e.key === 'ArrowLeft') show(now - 1); else return;
  e.preventDefault();
});
show(1);
</script>
)";

}  // namespace

std::string ray_picture(const FlatScene& scene, const FlatStructure& all, const TraceTable& table) {
    RayDrawing drawing(scene, all, table);
    drawing.raw(arrow);
    drawing.ground();
    for (std::size_t i = 0; i < table.rows.size(); ++i) drawing.cell(i);
    for (std::size_t i = 0; i < table.rows.size(); ++i) drawing.tests(i);
    drawing.ray();
    drawing.hit();
    drawing.numbers();
    return drawing.finished();
}

std::string ray_page(const FlatScene& scene, const FlatStructure& all, const TraceTable& table) {
    RayDrawing drawing(scene, all, table);
    drawing.raw(arrow);
    drawing.ground();
    drawing.ray();
    for (std::size_t i = 0; i < table.rows.size(); ++i) {
        drawing.open_step(i);
        drawing.cell(i);
        drawing.part(i);
        drawing.tests(i);
        drawing.close_step();
    }
    drawing.hit();
    std::string page = fmt::format(
        "<!DOCTYPE html>\n<html lang=\"en\"><head><meta "
        "charset=\"utf-8\"/><title>{}</title>\n{}</head><body>\n"
        "<p><button id=\"back\">back</button> <input id=\"slider\" type=\"range\" min=\"1\" max=\"{}\" "
        "value=\"1\"/> <button id=\"next\">next</button> step <span id=\"where\"></span> (arrow keys, or "
        "click "
        "a row)</p>\n<main>\n{}<div class=\"rows\"><table><thead><tr>",
        escaped(scene.title), page_style, std::max<std::size_t>(1, table.rows.size()), drawing.finished());
    for (const auto name : columns) page += fmt::format("<th>{}</th>", name);
    page += "</tr></thead><tbody>\n";
    for (std::size_t i = 0; i < table.rows.size(); ++i) {
        page += "<tr>";
        for (const auto& cell : cells_of(table.rows[i], i + 1))
            page += fmt::format("<td>{}</td>", escaped(cell));
        page += "</tr>\n";
    }
    return page + "</tbody></table></div>\n</main>\n" + std::string(page_script) + "</body></html>\n";
}

}  // namespace hedgerow::cli
