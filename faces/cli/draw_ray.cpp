/// The walk of one ray, as SVG or as a page that steps through it.
#include <cmath>
#include <optional>
#include <unordered_map>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <hedgerow/any_index.h>
#include <hedgerow/base/error.h>
#include <hedgerow/io/text_file.h>

#include "draw.h"
#include "ray_option.h"
#include "section.h"

namespace hedgerow::cli {

namespace {

using nlohmann::ordered_json;

template <int D>
std::vector<double> list_of(const Vec<double, D>& v) {
    return {v.data, v.data + D};
}
template <class T, int D>
TraceTable table_of(const std::string& structure, const Ray<T, D>& ray, const Trace<T, D>& trace,
                    const Section<D>& section) {
    TraceTable table;
    table.structure = structure;
    // The ray, in space and in the plane of the picture.
    const Vec<double, D> origin(ray.origin), direction(ray.direction);
    table.origin = list_of(origin), table.direction = list_of(direction);
    table.flat_origin = section.flat(origin);
    table.flat_direction = section.flat(origin + direction) - table.flat_origin;
    table.visits = trace.visits;
    if (trace.hit) table.hit = {trace.hit.element, static_cast<double>(trace.hit.t)};
    // A row for each step, with the cell's part in the plane.
    for (const auto& s : trace.steps) {
        TraceRow row{s.cell.id,
                     s.cell.parent,
                     s.cell.level,
                     s.cell.leaf,
                     list_of(s.cell.box.low),
                     list_of(s.cell.box.high),
                     {static_cast<double>(s.inside.entry), static_cast<double>(s.inside.exit)},
                     static_cast<double>(s.limit),
                     {},
                     section.part(s.cell)};
        for (const auto& t : s.tests)
            row.tests.push_back(
                {t.id, t.skipped, t.t ? std::optional(static_cast<double>(*t.t)) : std::nullopt});
        table.rows.push_back(std::move(row));
    }
    return table;
}
ordered_json json_of(const TraceTable& table) {
    ordered_json steps = ordered_json::array();
    for (const auto& r : table.rows) {
        ordered_json tests = ordered_json::array();
        for (const auto& t : r.tests) {
            ordered_json test = {{"primitive", t.id}, {"skipped", t.skipped}};
            if (t.t) test["t"] = *t.t;
            tests.push_back(test);
        }
        steps.push_back({{"node", r.node},
                         {"parent", r.parent},
                         {"level", r.level},
                         {"leaf", r.leaf},
                         {"low", r.low},
                         {"high", r.high},
                         {"t", {r.inside.entry, r.inside.exit}},
                         {"limit", r.limit},
                         {"tests", tests}});
    }
    ordered_json hit;
    if (table.hit) hit = {{"primitive", table.hit->first}, {"t", table.hit->second}};
    ordered_json all = {{"structure", table.structure},
                        {"origin", table.origin},
                        {"direction", table.direction},
                        {"hit", hit},
                        {"nodes", table.visits.nodes},
                        {"leaves", table.visits.leaves},
                        {"primitives", table.visits.primitives},
                        {"skipped", table.visits.skipped},
                        {"steps", steps}};
    if (table.nearest) all["nearest"] = {{"primitive", table.nearest->first}, {"t", table.nearest->second}};
    return all;
}

/// A tree with more ends than this (nodes without children) is drawn only around the nodes that the ray
/// visits.
constexpr std::size_t most_leaves = 48;

template <class P, int D>
RayView view_of(const DrawArguments& a, const std::string& spec, const P& set,
                const Ray<typename P::Scalar, D>& ray, const Section<D>& section, Box<double, D>& bounds) {
    const auto index = build_shown(a, spec, set);
    bounds = bounds_of(*index);
    RayView view{{spec, {}, {}}, table_of(spec, ray, trace(*index, ray), section)};
    if (a.stop_at_first) view.table.stop_at_first_hit();
    const auto cells = index->outline(section.limits(a.levels > 0 ? a.levels : OutlineLimits<D>().levels));
    if (cells.size() <= most_behind) view.structure.flat = flat_structure(cells, section);
    if (!a.tree && !a.frames) return view;
    // Show the tree, or the part of it around the ray.
    TreeShape tree = tree_for(spec, cells, a.tree);
    if (tree.end_count() > most_leaves) {
        std::unordered_map<NodeId, bool> visited;
        for (const auto& row : view.table.rows) visited[row.node] = true;
        tree = around(tree, visited);
    }
    view.structure.tree = cropped(std::move(tree));
    return view;
}

template <class P>
int draw_ray_in(const DrawArguments& a, const P& set) {
    constexpr int D = P::dimension;
    expect_ending(a, a.frames ? ".html" : ".svg", a.frames ? "a page of frames" : "a ray's way");
    const auto ray = ray_of<typename P::Scalar, D>(a);
    const auto section = section_along(ray, upright_of(a.view, a, set));
    // Trace the ray in each structure.
    std::vector<RayView> views;
    Box<double, D> bounds;
    for (const auto& spec : structures_of(a)) views.push_back(view_of(a, spec, set, ray, section, bounds));
    // Save the picture or the page, and report.
    FlatScene scene = flat_scene(a, set, section, bounds);
    scene.title += D == 2 ? ": what a ray visits" : ": what a ray visits, in a plane along it";
    save_text(a.output, a.frames ? ray_page(scene, views.front()) : ray_picture(scene, views));
    if (a.json) {
        ordered_json all = ordered_json::array();
        for (const auto& v : views) all.push_back(json_of(v.table));
        print_json(all.size() == 1 ? all[0] : ordered_json{{"output", a.output}, {"structures", all}});
    } else if (!a.quiet) {
        for (const auto& v : views)
            fmt::print("{}{}", views.size() > 1 ? v.structure.name + ":\n" : "", text_of(v.table));
    }
    return 0;
}

}  // namespace

template <class T>
void check_ray(const DrawArguments& a) {
    if (a.ray.size() == 4)
        ray_of<T, 2>(a);
    else if (a.ray.size() == 6)
        ray_of<T, 3>(a);
    else
        throw UsageError(
            fmt::format("--ray has {} numbers: a flat scene takes 4, one in space 6", a.ray.size()));
}
template void check_ray<float>(const DrawArguments&);
template void check_ray<double>(const DrawArguments&);

template <class T>
int draw_ray(const DrawArguments& a, const Scene<T>& scene) {
    return std::visit([&](const auto& set) { return draw_ray_in(a, set); }, scene);
}
template int draw_ray(const DrawArguments&, const Scene<float>&);
template int draw_ray(const DrawArguments&, const Scene<double>&);

}  // namespace hedgerow::cli
