/// What acts on one particle in `forces`: cells as a whole or by pairs, projected along z, as SVG.
#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <hedgerow/base/error.h>
#include <hedgerow/nbody/acting_cells.h>

#include "draw.h"
#include "nbody.h"
#include "picture_parts.h"

namespace hedgerow::cli {

namespace {

struct Look {
    ActsBy by;
    std::string_view name, colour, meaning;
};
constexpr std::array looks{
    Look{ActsBy::conversion, "conversion", "#2f6fb4", "as a whole, on a cell of targets"},
    Look{ActsBy::multipole, "multipole", "#1f9a8c", "as a whole, on the target"},
    Look{ActsBy::points, "points", "#b07a12", "one by one, on a cell of targets"},
    Look{ActsBy::pairs, "pairs", "#d0103a", "one by one, on the target"},
};

std::size_t nearest_to(const std::vector<Vec3d>& places, const Vec3d& at) {
    std::size_t best = 0;
    for (std::size_t i = 1; i < places.size(); ++i)
        if (length2(places[i] - at) < length2(places[best] - at)) best = i;
    return best;
}
/// The box around all places but the outermost hundredth along each axis.
Box2d frame_of(const std::vector<Vec3d>& places) {
    Box2d frame;
    for (int k = 0; k < 2; ++k) {
        std::vector<double> along;
        along.reserve(places.size());
        for (const Vec3d& p : places) along.push_back(p[k]);
        std::sort(along.begin(), along.end());
        const std::size_t out = along.size() / 100;
        frame.low[k] = along[out], frame.high[k] = along[along.size() - 1 - out];
    }
    const Vec2d margin = Vec2d::all(std::max(0.05 * std::max(frame.extent()[0], frame.extent()[1]), 1e-9));
    return {frame.low - margin, frame.high + margin};
}

}  // namespace

int draw_forces(const DrawArguments& a) {
    expect_ending(a, ".svg", "a picture of what acts on a place");
    if (a.drop_bad)
        throw UsageError("--forces-at has no --drop-bad: without some particles all forces would be others");
    const auto [width, height] = parse_size(a.view.size);
    NbodyArguments particles;
    static_cast<Common&>(particles) = a;
    const Particles all = load_particles(particles).particles;
    if (all.size() == 0) throw InputError(a.scene + ": there is no particle on which anything acts");
    const std::size_t target = nearest_to(all.places, {a.forces_at[0], a.forces_at[1], a.forces_at[2]});
    const auto cells = acting_cells<double>({all.places, all.masses}, target, {.accuracy = a.accuracy});
    // Draw particles below, then the boxes of cells by kind, the target last.
    Svg svg(width, height, plain_style());
    svg.text({24, 32},
             fmt::format("{} particles of {}: what acts on the one at ({:.3g}, {:.3g}, {:.3g})", all.size(),
                         a.scene, all.places[target][0], all.places[target][1], all.places[target][2]),
             "class=\"title\"");
    const Panel panel(frame_of(all.places),
                      {{picture_margin, picture_head}, {width - picture_margin, height - 96.0}});
    const Box2d shown = panel.frame();
    const auto flat = [&](const Vec3d& p) { return panel(Vec2d(p[0], p[1])); };
    Path dots;
    for (const Vec3d& p : all.places)
        if (shown.contains(flat(p))) dots.dot(flat(p));
    svg.raw(
        fmt::format("<clipPath id=\"frame\"><rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" "
                    "height=\"{:.1f}\"/></clipPath>\n",
                    shown.low[0], shown.low[1], shown.extent()[0], shown.extent()[1]));
    svg.open_group("clip-path=\"url(#frame)\"");
    svg.path(dots, "stroke=\"#9aa0aa\" stroke-width=\"1\" stroke-linecap=\"round\" fill=\"none\"");
    nlohmann::ordered_json counts;
    std::array<std::pair<std::size_t, std::size_t>, looks.size()> of_kind{};  // cells and particles
    for (std::size_t k = 0; k < looks.size(); ++k) {
        svg.open_group(fmt::format("fill=\"{0}\" fill-opacity=\".10\" stroke=\"{0}\" stroke-width=\"1\"",
                                   looks[k].colour));
        for (const ActingCell& cell : cells) {
            if (cell.by != looks[k].by) continue;
            ++of_kind[k].first, of_kind[k].second += cell.count;
            const Vec2d p = flat(cell.box.low), q = flat(cell.box.high);
            svg.polygon({{p[0], p[1]}, {q[0], p[1]}, {q[0], q[1]}, {p[0], q[1]}}, "",
                        fmt::format("{} particles, {}", cell.count, looks[k].meaning));
        }
        svg.close_group();
        counts.push_back(
            {{"by", looks[k].name}, {"cells", of_kind[k].first}, {"particles", of_kind[k].second}});
    }
    svg.circle(flat(all.places[target]), 4, "fill=\"#111\" stroke=\"#fff\" stroke-width=\"1.5\"");
    svg.close_group();
    // The legend.
    for (std::size_t k = 0; k < looks.size(); ++k) {
        const std::size_t column = k % 2, row = k / 2;
        const double x = picture_margin + static_cast<double>(column) * (width / 2.0 - 24),
                     y = height - 62.0 + 26.0 * static_cast<double>(row);
        svg.rect({{x, y - 11}, {x + 14, y + 3}},
                 fmt::format("fill=\"{0}\" fill-opacity=\".25\" stroke=\"{0}\"", looks[k].colour));
        svg.text({x + 22, y}, fmt::format("{}: {} cells, {} particles", looks[k].meaning, of_kind[k].first,
                                          of_kind[k].second));
    }
    save_text(a.output, svg.finished());
    if (a.json)
        print_json(
            {{"output", a.output}, {"particle", target}, {"accuracy", a.accuracy}, {"acting", counts}});
    else if (!a.quiet)
        fmt::print("{}\n", a.output);
    return 0;
}

}  // namespace hedgerow::cli
