#include "fan_picture.h"

#include <algorithm>

#include "picture_parts.h"

namespace hedgerow::cli {

namespace {

std::string style() {
    return std::string(plain_style()) +
           ".all{stroke:#d5d9e0;stroke-width:.6}.all.leaf{fill:none}.all.void{fill:url(#void);fill-opacity:1}"
           "\n"
           ".passed{fill:#26629e;fill-opacity:.14;stroke:#26629e;stroke-width:.7;stroke-opacity:.5}\n"
           ".ended{fill:#e07b00;fill-opacity:.42;stroke:#b35f00;stroke-width:1.2}\n"
           ".way{stroke:#111;stroke-width:.9;stroke-opacity:.75}.gone{stroke-dasharray:5 "
           "4;stroke-opacity:.4}\n"
           ".stop{fill:#d0103a}.origin{fill:#111}.faint.line{stroke:#6f7682}.faint.dot{fill:#6f7682}\n"
           ".part{stroke-width:.8;fill-opacity:.38}.unseen{fill-opacity:.10;stroke-dasharray:4 3}\n"
           ".pair{stroke:#16181d;stroke-width:.5;stroke-opacity:.45}\n";
}
std::string look_of(const FanView& view, const FlatCell& cell) {
    const char* kind = "";
    if (view.ended.count(cell.id) > 0)
        kind = " ended";
    else if (view.looked_into.count(cell.id) > 0)
        kind = " passed";
    else if (cell.leaf && cell.items == 0)
        kind = " all leaf void";
    else
        kind = " all";
    return fmt::format("class=\"cell{}\"", kind);
}
/// Draws the cells that no ray visited first, and those in which rays ended last.
void draw_cells(Svg& svg, const Panel& panel, const FanView& view) {
    const auto rank = [&](const FlatCell& c) {
        return view.ended.count(c.id) > 0 ? 2 : view.looked_into.count(c.id) > 0 ? 1 : 0;
    };
    for (int wanted = 0; wanted < 3; ++wanted)
        for (const FlatCell& c : view.structure.flat.cells) {
            if (rank(c) != wanted) continue;
            std::string hint = hint_of(c);
            if (const auto rays = view.looked_into.find(c.id); rays != view.looked_into.end())
                hint += fmt::format("; {} rays look into it", rays->second);
            if (const auto rays = view.ended.find(c.id); rays != view.ended.end())
                hint += fmt::format(", {} end here", rays->second);
            svg.polygon(panel(c.corners), look_of(view, c), hint);
        }
}
void draw_eye(Svg& svg, const Panel& panel, const FlatFan& fan) {
    svg.circle(panel(fan.origin), 4, "class=\"origin\"");
}
Legend& swatch(Legend& legend, Svg& svg, std::string_view text, const std::string& look) {
    legend.line(text, [&](const Box2d& b) { svg.rect(b, look); });
    return legend;
}

}  // namespace

Box2d FlatFan::shown(const Box2d& scene) const {
    Box2d box = scene;
    box.expand(origin);
    for (std::size_t i = 0; i < directions.size(); ++i)
        if (hits[i]) box.expand(origin + directions[i] * *hits[i]);
    const Vec2d margin = Vec2d::all(0.02 * length(box.extent()));
    return {box.low - margin, box.high + margin};
}
Vec2d FlatFan::end(std::size_t ray, const Box2d& shown) const {
    const auto in = meet(Ray<double, 2>{origin, directions[ray]}, shown);
    return origin + directions[ray] * hits[ray].value_or(in ? in->exit : 0);
}

std::string fan_picture(const FlatScene& scene, const FlatFan& fan, const std::vector<FanView>& views) {
    std::vector<NamedStructure> captions;
    std::vector<const FlatStructure*> flats;
    for (const auto& v : views) captions.push_back(v.structure), flats.push_back(&v.structure.flat);
    const Layout layout(scene.width, scene.height, captions);
    const Box2d shown = fan.shown(frame_of(scene, flats));
    Svg svg(scene.width, scene.height, style());
    add_definitions(svg);
    svg.text({picture_margin, 32}, scene.title, "class=\"title\"");
    for (std::size_t s = 0; s < views.size(); ++s) {
        const Panel panel(shown, layout.area(s));
        draw_cells(svg, panel, views[s]);
        draw_primitives(svg, panel, scene.primitives, crowding(scene.primitives.size(), panel), " faint");
        for (std::size_t i = 0; i < fan.directions.size(); ++i) {
            const Vec2d end = panel(fan.end(i, shown));
            svg.line(panel(fan.origin), end, fan.hits[i] ? "class=\"way\"" : "class=\"way gone\"");
            if (fan.hits[i]) svg.circle(end, 2.6, "class=\"stop\"");
        }
        draw_eye(svg, panel, fan);
        layout.draw_caption(svg, s);
    }
    Legend legend(svg, layout.legend());
    legend.heading("leaves");
    swatch(legend, svg, "a ray ends here", "class=\"ended\"");
    swatch(legend, svg, "rays look into it", "class=\"passed\"");
    swatch(legend, svg, "empty", "fill=\"url(#void)\" stroke=\"#d5d9e0\"");
    swatch(legend, svg, "not visited", "fill=\"none\" stroke=\"#d5d9e0\"");
    legend.heading("rays");
    const auto ray = [&](std::string_view text, const std::string& look, bool hit) {
        legend.line(text, [&](const Box2d& b) {
            svg.line({b.low[0], b.center()[1]}, {b.high[0], b.center()[1]}, look);
            if (hit) svg.circle({b.high[0], b.center()[1]}, 2.6, "class=\"stop\"");
        });
    };
    ray("to its hit", "class=\"way\"", true);
    ray("hits nothing", "class=\"way gone\"", false);
    return svg.finished();
}

std::string beam_picture(const FlatScene& scene, const FlatFan& fan, const std::vector<BeamPart>& parts,
                         const std::string& fact) {
    using Sees = BeamPart::Sees;
    int levels = 1;
    for (const auto& p : parts) levels = std::max(levels, p.level + 1);
    const Layout layout(scene.width, scene.height, {{"", {fact}, {}}});
    const Box2d shown = fan.shown(frame_of(scene, {}));
    const Panel panel(shown, layout.area(0));
    Svg svg(scene.width, scene.height, style());
    svg.text({picture_margin, 32}, scene.title, "class=\"title\"");
    // Draw the parts. Two rays that are left of a beam are drawn as rays.
    std::vector<int> of_level(static_cast<std::size_t>(levels));
    int pairs = 0;
    const Vec2d eye = panel(fan.origin);
    for (const auto& p : parts) {
        const Vec2d low = panel(fan.end(p.first, shown)), high = panel(fan.end(p.last, shown));
        if (p.sees == Sees::undecided) {
            ++pairs;
            for (const Vec2d& end : {low, high}) svg.line(eye, end, "class=\"pair\"");
            continue;
        }
        ++of_level[static_cast<std::size_t>(p.level)];
        svg.polygon({eye, low, high},
                    fmt::format("class=\"part{0}\" fill=\"{1}\" stroke=\"{1}\"",
                                p.sees == Sees::nothing ? " unseen" : "", level_colour(p.level, levels)),
                    fmt::format("rays {} to {}, halved {} times", p.first, p.last, p.level));
    }
    draw_primitives(svg, panel, scene.primitives, 1.3, "");
    draw_eye(svg, panel, fan);
    layout.draw_caption(svg, 0);
    Legend legend(svg, layout.legend());
    legend.heading("parts, halved");
    for (int k = 0; k < levels; ++k)
        swatch(legend, svg, fmt::format("{} times: {}", k, of_level[static_cast<std::size_t>(k)]),
               fmt::format("class=\"part\" fill=\"{0}\" stroke=\"{0}\"", level_colour(k, levels)));
    swatch(legend, svg, "meets nothing", "class=\"part unseen\" fill=\"#555\" stroke=\"#555\"");
    legend.line(fmt::format("two rays alone: {}", pairs), [&](const Box2d& b) {
        for (const double y : {b.low[1] + 3, b.high[1] - 3})
            svg.line({b.low[0], b.center()[1]}, {b.high[0], y}, "class=\"pair\"");
    });
    return svg.finished();
}

}  // namespace hedgerow::cli
