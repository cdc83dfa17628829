/// hedgerow draw: pictures of structures, of where rays spend their steps, and of fields.
#include <algorithm>
#include <filesystem>
#include <memory>
#include <variant>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <hedgerow/base/error.h>
#include <hedgerow/parallel/executor.h>
#include <hedgerow/render/lettering.h>

#include "draw.h"
#include "verbs.h"
#include "view.h"

namespace hedgerow::cli {

namespace {

template <class T>
int draw(const DrawArguments& a, const Scene<T>& scene) {
    const ThreadLimit limit(a.threads);
    if (a.cone > 0) return draw_cone(a, scene);
    if (a.fan > 0) return draw_fan(a, scene);
    if (!a.ray.empty()) return draw_ray(a, scene);
    if (!a.hausdorff.empty()) return draw_hausdorff(a, scene);
    if (!a.field.empty()) return draw_field(a, scene);
    const bool flat = std::visit([]<class P>(const P&) { return P::dimension == 2; }, scene);
    if (flat && !a.heat.empty())
        throw InputError(a.scene +
                         " is flat: heat maps are views of what lies in space. Draw its cells, or a ray");
    if (flat || !a.slice.empty()) return draw_cells(a, scene);
    return a.heat.empty() ? draw_wireframe(a, scene) : draw_heat(a, scene);
}

/// Checks options that do not depend on the scene, before it is loaded. Throws UsageError, MemoryShort for
/// too large a picture, and OutputError for an output that cannot be written.
template <class T>
void check(const DrawArguments& a) {
    const bool wires = ending_of(a.output) == ".png";
    if (a.beside.size() > (wires ? 5 : 3))
        throw UsageError(std::string("--beside: one picture has room for ") +
                         (wires ? "six structures" : "four structures, or for six as .png"));
    if (a.ray.empty())
        check_cells(a);
    else
        check_ray<T>(a);
    if (!a.field.empty()) check_field(a);
    const std::string ending = ending_of(a.output);
    if (wires && (a.tree || a.height))
        throw UsageError(fmt::format("{} is about flat pictures, as .svg: add --slice, or draw a flat scene",
                                     a.tree ? "--tree" : "--height"));
    if (!a.field.empty())
        check_picture_memory(fmt::format("{0}x{0}", a.width), true);
    else if (ending == ".svg" || ending == ".html")
        parse_size(a.view.size);
    else
        check_picture_memory(a.view.size, ending == ".exr");
    check_writable(a.output);
}

}  // namespace

void expect_ending(const DrawArguments& a, const std::string& ending, const std::string& what) {
    if (ending_of(a.output) != ending)
        throw UsageError(
            fmt::format("{}: {} is written as {}; let the output end so", a.output, what, ending));
}

nlohmann::ordered_json facts_of(const NamedStructure& s, std::size_t cells, std::size_t leaves, int depth) {
    nlohmann::ordered_json facts = {
        {"structure", s.name}, {"cells_drawn", cells}, {"leaves", leaves}, {"depth", depth}};
    if (s.flat.overlap) facts["sibling_overlap"] = *s.flat.overlap;
    return facts;
}

std::vector<std::string> structures_of(const DrawArguments& a) {
    std::vector<std::string> all = {a.structure};
    all.insert(all.end(), a.beside.begin(), a.beside.end());
    return all;
}

int letter_scale(const Image& image) {
    return std::max(1, image.height / 600);
}
std::vector<std::string> note_lines(const Image& image, const std::vector<std::string>& texts, int width) {
    const auto letters = static_cast<std::size_t>(
        std::max(8, (width > 0 ? width : image.width) / (letter_width * letter_scale(image)) - 2));
    std::vector<std::string> lines;
    for (const auto& text : texts)
        for (auto& line : wrapped(text, letters)) {
            // Break the options of a structure, which are one long word.
            for (; line.size() > letters; line.erase(0, letters)) lines.push_back(line.substr(0, letters));
            lines.push_back(std::move(line));
        }
    return lines;
}

Run add_draw(CLI::App& verb) {
    auto a = std::make_shared<DrawArguments>();
    add_common(verb, *a, true);
    auto* const structure =
        verb.add_option("--structure", a->structure, "NAME[:OPTION=VALUE,...]")->capture_default_str();
    auto* const beside =
        verb.add_option(
                "--beside", a->beside,
                "another structure, drawn beside the first; up to three times, in space five times. Shows "
                "what siblings share")
            ->expected(1)
            ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
    auto* const tree = verb.add_flag("--tree", a->tree, "flat pictures: the tree too, beside its cells");
    auto* const slice = verb.add_option(
        "--slice", a->slice,
        "x, y or z=FRACTION of the scene, or =@POSITION: the cells that a plane cuts, as SVG, or the plane "
        "of --field");
    auto* const depth = verb.add_option("--depth", a->levels,
                                        "draw the first so many levels; 0: all, or as many as can be seen");
    depth->check(CLI::Range(0, 128));
    auto* const ray = verb.add_option("--ray", a->ray,
                                      "origin and direction, ox,oy,oz,dx,dy,dz (flat: four numbers): "
                                      "the cells that the ray visits")
                          ->delimiter(',')
                          ->expected(4, 6);
    verb.add_flag("--frames", a->frames, "with --ray: a page, .html, that goes through it step by step")
        ->needs(ray)
        ->excludes(beside);
    verb.add_flag("--stop-at-first", a->stop_at_first,
                  "with --ray: stop at the first hit, wherever it lies: often not the nearest")
        ->needs(ray);
    auto* const height =
        verb.add_option("--height", a->height,
                        "flat pictures: only cells with at most so many levels below them, as a tree grows "
                        "from its leaves")
            ->check(CLI::Range(0, 128))
            ->excludes(ray)
            ->excludes(tree);
    auto* const heat =
        verb.add_option("--heat", a->heat,
                        "steps, tests or time (in nanoseconds) of a view's rays, as .png or .exr")
            ->check(CLI::IsMember({"steps", "tests", "time"}));
    verb.add_option(
            "--scale", a->scale,
            "where the heat's scale ends; 0: steps 200, tests 60, time 4000, with --log the most of all rays")
        ->needs(heat);
    verb.add_flag("--log", a->log, "the heat's scale is logarithmic")->needs(heat);
    auto* const fan = verb.add_option("--fan", a->fan,
                                      "with --ray: so many rays beside each other, and the cells in which "
                                      "they end")
                          ->check(CLI::Range(2, 4096))
                          ->needs(ray);
    for (const char* other : {"--frames", "--stop-at-first", "--tree"}) fan->excludes(verb.get_option(other));
    verb.add_option("--angle", a->angle, "of the fan, in degrees")
        ->capture_default_str()
        ->check(CLI::Range(0.001, 160.0))
        ->needs(fan);
    verb.add_flag(
            "--beam", a->beam,
            "with --fan, over flat segments: the rays as one beam, halved until each part sees one thing")
        ->needs(fan)
        ->excludes(structure)
        ->excludes(beside)
        ->excludes(depth);
    auto* const cone =
        verb.add_option(
                "--cone", a->cone,
                "with --ray: a cone of so many degrees around it, and its footprint on the surface, as "
                ".png")
            ->check(CLI::Range(0.001, 90.0))
            ->needs(ray);
    for (auto* other : {structure, beside, tree, depth, fan}) cone->excludes(other);
    for (const char* other : {"--frames", "--stop-at-first"}) cone->excludes(verb.get_option(other));
    ray->excludes(slice)->excludes(heat);
    heat->excludes(slice)->excludes(beside)->excludes(tree)->excludes(height);
    auto* const field =
        verb.add_option("--field", a->field,
                        "distance, signed-distance, winding or count (of primitives within --radius) over "
                        "the plane of --slice, by default through the middle, as .png")
            ->check(CLI::IsMember({"distance", "signed-distance", "winding", "count"}));
    verb.add_option("--width", a->width, "of the picture of a field, in pixels; its height follows")
        ->capture_default_str()
        ->check(CLI::Range(240, 16384))
        ->needs(field);
    field->excludes(structure)->excludes(beside)->excludes(tree)->excludes(depth)->excludes(ray);
    field->excludes(height)->excludes(heat);
    verb.add_option("--threads", a->threads, "that build and cast rays; 0: all cores")
        ->capture_default_str()
        ->check(CLI::Range(0, 1024));
    add_view(verb, a->view);
    field->excludes(verb.get_option("--size"));
    verb.get_option("--radius")
        ->description(
            "of points, drawn as spheres; 0: by their number. With --field count: within which primitives "
            "are counted; 0: a twentieth of the scene's diagonal");
    auto* const forces_at =
        verb.add_option("--forces-at", a->forces_at,
                        "x,y,z: of particles, the cells that act on the one nearest to this place, as SVG")
            ->delimiter(',')
            ->expected(3);
    verb.add_option("--accuracy", a->accuracy, "of the forces")->needs(forces_at)->capture_default_str();
    auto* const hausdorff =
        verb.add_option("--hausdorff", a->hausdorff,
                        "another scene: the two outlines where they are farthest from each other, as SVG");
    for (auto* other : {structure, beside, tree, slice, depth, ray, heat, field})
        forces_at->excludes(other), hausdorff->excludes(other);
    hausdorff->excludes(forces_at)->excludes(height);
    return [a] {
        if (!a->forces_at.empty()) {
            check_writable(a->output);
            return draw_forces(*a);
        }
        return in_precision(*a, [&]<class T>(T) {
            check<T>(*a);
            return draw(*a, load<T>(*a));
        });
    };
}

}  // namespace hedgerow::cli
