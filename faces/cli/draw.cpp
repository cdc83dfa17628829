/// hedgerow draw: what a structure looks like, and where rays spend their steps.
#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <hedgerow/any_index.h>
#include <hedgerow/error.h>
#include <hedgerow/io/image.h>
#include <hedgerow/io/text_file.h>
#include <hedgerow/render/lettering.h>
#include <hedgerow/render/raycast.h>
#include <hedgerow/render/wireframe.h>

#include "pictures.h"
#include "svg.h"
#include "verbs.h"
#include "view.h"

namespace hedgerow::cli {

namespace {

using nlohmann::ordered_json;

struct DrawArguments : Common {
    std::string structure = "bvh", beside, slice, heat;
    ViewArguments view;
    std::vector<double> ray;
    bool frames = false;
    int levels = 0;
    unsigned threads = 0;
    std::uint64_t scale = 0;
};

/// Beyond this a picture of lines shows nothing, and no viewer opens it.
constexpr std::size_t most_shapes = 200'000;
/// So many boxes can be told apart in a wireframe; that is how its levels are chosen when nobody says.
constexpr std::size_t most_boxes = 250;
/// Cells that no ray visits are drawn behind those that it does, if there are no more.
constexpr std::size_t most_behind = 20'000;

void expect_ending(const DrawArguments& a, const std::string& ending, const std::string& what) {
    if (std::filesystem::path(a.output).extension() != ending)
        throw InputError(
            fmt::format("{}: {} is written as {}; let the output end so", a.output, what, ending));
}

// ---- The planes of pictures
// --------------------------------------------------------------------------------

Section<2> section_of(const DrawArguments& a, const Box2d&) {
    if (!a.slice.empty())
        throw InputError(a.scene + " is flat already, and has no slices: leave --slice out");
    return {};
}
/// Across an axis: "z=0.5" is a fraction of the scene's extent, "z=@12.5" a position.
Section<3> section_of(const DrawArguments& a, const Box3d& bounds) {
    const std::string_view text = a.slice;
    const auto bad = [&]() {
        return InputError(
            fmt::format("--slice {}: write x, y or z, then = and a fraction from 0 to 1, as z=0.5, or @ and "
                        "a position, as "
                        "z=@12.5",
                        a.slice));
    };
    if (text.size() < 3 || text[0] < 'x' || text[0] > 'z' || text[1] != '=') throw bad();
    const int axis = text[0] - 'x';
    const bool position = text[2] == '@';
    const std::string_view digits = text.substr(position ? 3 : 2);
    double value = 0;
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
    if (error != std::errc() || end != digits.data() + digits.size() || !std::isfinite(value)) throw bad();
    if (!position) {
        if (!(value >= 0 && value <= 1)) throw bad();
        value = bounds.low[axis] + value * bounds.extent()[axis];
    }
    Section<3> section;
    section.origin[axis] = section.within.low[axis] = section.within.high[axis] = value;
    section.right[axis == 0 ? 1 : 0] = 1;
    section.up[axis == 2 ? 1 : 2] = 1;
    return section;
}

template <class T>
Section<2> section_along(const Ray<T, 2>&, const Box2d&) {
    return {};
}
/// The plane that holds the ray and the scene's upward direction, or another where that runs along the ray.
template <class T>
Section<3> section_along(const Ray<T, 3>& ray, const Box3d& bounds) {
    Section<3> section;
    section.origin = Vec3d(ray.origin);
    section.right = normalized(Vec3d(ray.direction));
    Vec3d up(automatic_camera({Vec3f(bounds.low), Vec3f(bounds.high)}).up);
    if (std::abs(dot(up, section.right)) > 0.9) up = {up[2], up[0], up[1]};
    section.up = normalized(up - section.right * dot(up, section.right));
    return section;
}

// ---- Flat pictures
// -----------------------------------------------------------------------------------------

template <class T, int D>
Box<double, D> bounds_of(const AnyIndex<T, D>& index) {
    if (index.bounds().empty()) return {Vec<double, D>(), Vec<double, D>()};
    return {Vec<double, D>(index.bounds().low), Vec<double, D>(index.bounds().high)};
}
template <class P, int D>
FlatScene flat_scene(const DrawArguments& a, const P& set, const Section<D>& section,
                     const Box<double, D>& bounds) {
    FlatScene scene;
    scene.primitives = flat_primitives(set, section, 0.01 * length(bounds.extent()));
    std::tie(scene.width, scene.height) = parse_size(a.view.size);
    scene.title = std::filesystem::path(a.scene).filename().string();
    if (scene.primitives.size() > most_shapes)
        throw InputError(fmt::format("{} primitives are too many to be seen: draw fewer, at most {}",
                                     scene.primitives.size(), most_shapes));
    return scene;
}
template <int D>
std::vector<OutlineCell<D>> few(std::vector<OutlineCell<D>> cells) {
    if (cells.size() > most_shapes)
        throw InputError(
            fmt::format("{} cells are too many to be seen: limit the levels by --depth, or draw a "
                        "smaller scene; at most {}",
                        cells.size(), most_shapes));
    return cells;
}

ordered_json facts_of(const NamedStructure& s, std::size_t leaves, int depth) {
    ordered_json facts = {
        {"structure", s.name}, {"cells_drawn", s.flat.cells.size()}, {"leaves", leaves}, {"depth", depth}};
    if (s.flat.overlap) facts["sibling_overlap"] = *s.flat.overlap;
    return facts;
}

template <class P>
int draw_cells(const DrawArguments& a, const P& set) {
    constexpr int D = P::dimension;
    expect_ending(a, ".svg", D == 2 ? "a flat scene" : "a slice");
    std::vector<std::string> specs = {a.structure};
    if (!a.beside.empty()) specs.push_back(a.beside);
    std::vector<NamedStructure> structures;
    FlatScene scene;
    ordered_json report = ordered_json::array();
    for (const auto& spec : specs) {
        const auto index = build_any(spec, set);
        const auto bounds = bounds_of(*index);
        const auto section = section_of(a, bounds);
        const auto limits = section.limits(a.levels > 0 ? a.levels : OutlineLimits<D>().levels);
        const auto cells = few(index->outline(limits));
        NamedStructure s{spec, {}, flat_structure(cells, section)};
        if (!a.beside.empty()) {
            // The figure is of the whole tree, whatever the picture shows of it.
            FlatStructure whole;
            add_shared(index->outline(), section, whole);
            add_shared(cells, section, s.flat);
            s.flat.overlap = whole.overlap;
        }
        s.facts = {fmt::format("{} cells here; {} leaves, depth {}, {} items of {} primitives",
                               s.flat.cells.size(), index->leaf_count(), index->depth(), index->item_count(),
                               index->size())};
        if (s.flat.overlap.value_or(0) > 0)
            s.facts.push_back(fmt::format("siblings share {:.2f}% of their parents' {}",
                                          100 * *s.flat.overlap, D == 2 ? "area" : "volume"));
        report.push_back(facts_of(s, index->leaf_count(), index->depth()));
        if (scene.primitives.empty()) scene = flat_scene(a, set, section, bounds);
        structures.push_back(std::move(s));
    }
    if (D == 3) scene.title += ", slice " + a.slice;
    if (a.levels > 0) scene.title += fmt::format(", first {} levels", a.levels);
    save_text(a.output, cells_picture(scene, structures));
    if (a.json)
        fmt::print("{}\n", ordered_json{{"output", a.output}, {"structures", report}}.dump(2));
    else if (!a.quiet)
        for (const auto& s : structures) fmt::print("{}: {}\n", s.name, fmt::join(s.facts, "; "));
    return 0;
}

// ---- One ray
// -----------------------------------------------------------------------------------------------

template <class T, int D>
Ray<T, D> ray_of(const DrawArguments& a) {
    if (a.ray.size() != 2 * D)
        throw InputError(
            fmt::format("--ray has {} numbers: {} are needed, the origin's and the direction's, as {}",
                        a.ray.size(), 2 * D, D == 2 ? "-1,0.5,1,0.1" : "-1,0.5,0.5,1,0.1,0"));
    Ray<T, D> ray;
    for (int k = 0; k < D; ++k) {
        ray.origin[k] = static_cast<T>(a.ray[static_cast<std::size_t>(k)]);
        ray.direction[k] = static_cast<T>(a.ray[static_cast<std::size_t>(k + D)]);
    }
    if (!(length(Vec<double, D>(ray.direction)) > 0) || !finite(ray.origin) || !finite(ray.direction))
        throw InputError("--ray: the direction must be finite and not zero, the origin finite");
    return ray;
}

template <int D>
std::vector<double> list_of(const Vec<double, D>& v) {
    return {v.data, v.data + D};
}
template <class T, int D>
TraceTable table_of(const std::string& structure, const Ray<T, D>& ray, const Trace<T, D>& trace,
                    const Section<D>& section) {
    TraceTable table;
    table.structure = structure;
    const Vec<double, D> origin(ray.origin), direction(ray.direction);
    table.origin = list_of(origin), table.direction = list_of(direction);
    table.flat_origin = section.flat(origin);
    table.flat_direction = section.flat(origin + direction) - table.flat_origin;
    table.visits = trace.visits;
    if (trace.hit) table.hit = {trace.hit->element, static_cast<double>(trace.hit->t)};
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
    return {{"structure", table.structure},
            {"origin", table.origin},
            {"direction", table.direction},
            {"hit", hit},
            {"nodes", table.visits.nodes},
            {"leaves", table.visits.leaves},
            {"primitives", table.visits.primitives},
            {"skipped", table.visits.skipped},
            {"steps", steps}};
}

template <class P>
int draw_ray(const DrawArguments& a, const P& set) {
    using T = typename P::Scalar;
    constexpr int D = P::dimension;
    expect_ending(a, a.frames ? ".html" : ".svg", a.frames ? "a page of frames" : "a ray's way");
    const auto ray = ray_of<T, D>(a);
    const auto index = build_any(a.structure, set);
    const auto bounds = bounds_of(*index);
    const auto section = section_along(ray, bounds);
    const auto table = table_of(a.structure, ray, index->trace(ray), section);
    FlatScene scene = flat_scene(a, set, section, bounds);
    scene.title += D == 2 ? ": what a ray visits" : ": what a ray visits, in a plane along it";
    FlatStructure all;
    auto cells = index->outline(section.limits(a.levels > 0 ? a.levels : OutlineLimits<D>().levels));
    if (cells.size() <= most_behind) all = flat_structure(cells, section);
    save_text(a.output, a.frames ? ray_page(scene, all, table) : ray_picture(scene, all, table));
    if (a.json)
        fmt::print("{}\n", json_of(table).dump(2));
    else if (!a.quiet)
        fmt::print("{}", text_of(table));
    return 0;
}

// ---- Pictures in space
// -------------------------------------------------------------------------------------

Image::Pixel pixel_of(const std::string& colour) {
    Image::Pixel p;
    for (std::size_t k = 0; k < 3; ++k)
        p[k] = static_cast<std::uint8_t>(std::stoi(colour.substr(1 + 2 * k, 2), nullptr, 16));
    return p;
}

/// The boxes of the levels that are wanted, or of as many as can be told apart. Empty ones are left out.
template <class T>
std::vector<OutlineCell<3>> boxes_of(const AnyIndex<T, 3>& index, int wanted, int& levels) {
    const auto first_levels = [&](int n) {
        auto cells = index.outline({n});
        std::erase_if(cells, [](const auto& c) { return c.leaf && c.items.empty(); });
        return cells;
    };
    levels = wanted > 0 ? std::min(wanted, std::max(1, index.depth())) : 1;
    auto cells = first_levels(levels);
    while (wanted == 0 && levels < index.depth()) {
        auto more = first_levels(levels + 1);
        if (more.size() > most_boxes) break;
        cells = std::move(more);
        ++levels;
    }
    return few(std::move(cells));
}

void draw_edges(const OutlineCell<3>& cell, const Image::Pixel& colour, float width, Wireframe& wires) {
    const Polytope<3> region = cell.region();
    std::vector<std::pair<Vec3d, Vec3d>> edges;
    const auto before = [](const Vec3d& p, const Vec3d& q) {
        return std::lexicographical_compare(p.data, p.data + 3, q.data, q.data + 3);
    };
    for (const auto& face : region.faces())
        for (std::size_t i = 0; i < face.size(); ++i) {
            const Vec3d &p = face[i], &q = face[(i + 1) % face.size()];
            const auto edge = before(p, q) ? std::pair(p, q) : std::pair(q, p);
            // Each belongs to two faces.
            if (std::find(edges.begin(), edges.end(), edge) == edges.end()) edges.push_back(edge);
        }
    for (const auto& [p, q] : edges) wires.draw({Vec3f(p), Vec3f(q), colour, width});
}
int letter_scale(const Image& image) {
    return std::max(1, image.height / 600);
}
/// As `draw_note` can hold them in the picture's width.
std::vector<std::string> note_lines(const Image& image, const std::vector<std::string>& texts) {
    const int letters = image.width / (letter_width * letter_scale(image)) - 2;
    std::vector<std::string> lines;
    for (const auto& text : texts)
        for (auto& line : wrapped(text, static_cast<std::size_t>(std::max(8, letters))))
            lines.push_back(std::move(line));
    return lines;
}
/// A title and below it a swatch and a number a level, from the upper left corner.
void draw_level_legend(Image& image, const std::vector<std::string>& title, int levels) {
    const int unit = letter_scale(image), row = letter_height * unit;
    std::vector<std::string> lines = note_lines(image, title);
    const int first = static_cast<int>(lines.size());
    for (int k = 0; k < levels; ++k) lines.push_back(fmt::format("     level {}", k + 1));
    draw_note(image, 0, 0, lines, unit);
    for (int k = 0; k < levels; ++k) {
        const auto colour = pixel_of(level_colour(k, levels));
        const int top = (first + k) * row + 4 * unit;
        for (int y = top; y < top + 8 * unit && y < image.height; ++y)
            for (int x = 6 * unit; x < 28 * unit && x < image.width; ++x) image.at(x, y) = colour;
    }
}

/// One structure's boxes over the picture of what can be seen.
template <class T, class Seen>
Image wireframe(const AnyIndex<T, 3>& index, const AnyIndex<T, 3>& seen_index, const Seen& seen,
                const RenderOptions& options, int wanted, std::string& facts) {
    auto picture = raycast(seen_index, seen, options, default_executor());
    for (auto& pixel : picture.image.pixels)
        for (auto& c : pixel)
            c = static_cast<std::uint8_t>(255 - (255 - c) * 9 / 20);  // pale, under the lines
    const RayMaker maker(options.camera, options.width, options.height);
    const auto surface = depths(seen_index, maker, options.width, options.height, default_executor());
    int levels = 0;
    auto cells = boxes_of(index, wanted, levels);
    std::stable_sort(cells.begin(), cells.end(),
                     [](const auto& a, const auto& b) { return a.level > b.level; });
    Wireframe wires(picture.image, surface, maker);
    const float unit = static_cast<float>(options.height) / 768;
    for (const auto& c : cells)
        draw_edges(c, pixel_of(level_colour(c.level - 1, levels)),
                   unit * std::max(1.1f, 2.8f * std::pow(0.85f, static_cast<float>(c.level - 1))), wires);
    facts = fmt::format("{} cells of the first {} levels of {}", cells.size(), levels, index.depth());
    draw_level_legend(picture.image, {std::string(index.structure()), facts}, levels);
    return picture.image;
}
Image joined(const Image& left, const Image& right) {
    Image both(left.width + right.width + 4, left.height, {255, 255, 255});
    for (int y = 0; y < left.height; ++y) {
        for (int x = 0; x < left.width; ++x) both.at(x, y) = left.at(x, y);
        for (int x = 0; x < right.width; ++x) both.at(left.width + 4 + x, y) = right.at(x, y);
    }
    return both;
}

/// `seen`: what the picture is of, and `set` what the structure holds; of points they differ.
template <class P, class Seen>
int draw_wireframe(const DrawArguments& a, const P& set, const Seen& seen) {
    expect_ending(a, ".png", "a picture in space");
    RenderOptions options;
    std::tie(options.width, options.height) = parse_size(a.view.size);
    options.samples = 4, options.seed = a.seed;
    std::vector<std::string> specs = {a.structure};
    if (!a.beside.empty()) {
        specs.push_back(a.beside);
        options.width = std::max(1, (options.width - 4) / 2);
    }
    const auto seen_index = build_any("bvh", seen);
    options.camera =
        camera_of(a.view, a, Box3f{Vec3f(seen_index->bounds().low), Vec3f(seen_index->bounds().high)});
    std::optional<Image> image;
    ordered_json report = ordered_json::array();
    std::string text;
    for (const auto& spec : specs) {
        const auto index = build_any(spec, set);
        std::string facts;
        const Image one = wireframe(*index, *seen_index, seen, options, a.levels, facts);
        image = image ? joined(*image, one) : one;
        NamedStructure s{spec, {facts}, {}};
        if (!a.beside.empty()) {
            add_shared(index->outline(), Section<3>{{}, {1, 0, 0}, {0, 1, 0}}, s.flat);
            if (s.flat.overlap.value_or(0) > 0)
                facts +=
                    fmt::format("; siblings share {:.2f}% of their parents' volume", 100 * *s.flat.overlap);
        }
        report.push_back(facts_of(s, index->leaf_count(), index->depth()));
        text += fmt::format("{}: {}\n", spec, facts);
    }
    save_png(a.output, *image);
    if (a.json)
        fmt::print("{}\n", ordered_json{{"output", a.output}, {"structures", report}}.dump(2));
    else if (!a.quiet)
        fmt::print("{}", text);
    return 0;
}

/// What the scale ends at when nobody says: the same for every structure and scene, so that pictures compare.
std::uint64_t usual_scale(Shading shading) {
    return shading == Shading::steps ? 200 : (shading == Shading::tests ? 60 : 4000);
}
template <class P>
int draw_heat(const DrawArguments& a, const P& set) {
    RenderOptions options;
    options.layers = asks_for_layers(a.output);
    std::tie(options.width, options.height) = parse_size(a.view.size);
    options.seed = a.seed;
    options.shading = parse_shading(a.heat);
    options.steps_max = a.scale > 0 ? a.scale : usual_scale(options.shading);
    const auto index = build_any(a.structure, set);
    options.camera = camera_of(a.view, a, Box3f{Vec3f(index->bounds().low), Vec3f(index->bounds().high)});
    Picture picture;
    {
        ProgressLine line("casting rays", a.quiet);
        picture = raycast(*index, set, options, default_executor(), line.progress());
    }
    const std::string unit =
        a.heat == "time" ? "nanoseconds" : (a.heat == "tests" ? "primitives tested" : a.heat);
    draw_note(
        picture.image, 0, 0,
        note_lines(picture.image, {std::filesystem::path(a.scene).filename().string() + ", " + a.structure,
                                   fmt::format("{} a ray: {:.1f} on average, at most {:.0f}", unit,
                                               picture.mean, picture.most)}),
        letter_scale(picture.image));
    save(a.output, picture);
    const double pixels = double(options.width) * double(options.height);
    if (a.json)
        fmt::print("{}\n", ordered_json{{"output", a.output},
                                        {"structure", a.structure},
                                        {"heat", a.heat},
                                        {"scale", options.steps_max},
                                        {"mean", picture.mean},
                                        {"most", picture.most},
                                        {"share_beyond_scale", double(picture.beyond) / pixels},
                                        {"finished", !interrupted.load()}}
                               .dump(2));
    else if (!a.quiet)
        fmt::print(
            "{}: {} a ray: {:.1f} on average, at most {:.0f}; the scale ends at {}, and {:.2f}% of the "
            "pixels lie beyond\n",
            a.structure, unit, picture.mean, picture.most, options.steps_max,
            100 * double(picture.beyond) / pixels);
    return interrupted ? 130 : 0;
}

// ---- The verb
// ----------------------------------------------------------------------------------------------

template <class P>
int draw(const DrawArguments& a, const P& set) {
    const ThreadLimit limit(a.threads);
    constexpr bool flat = P::dimension == 2;
    if (!a.ray.empty()) return draw_ray(a, set);
    if (flat && !a.heat.empty())
        throw InputError(a.scene +
                         " is flat: heat maps are views of what lies in space. Draw its cells, or a ray");
    if (flat || !a.slice.empty()) return draw_cells(a, set);
    if constexpr (!flat) {
        if constexpr (requires { set.points; }) {
            const auto spheres = spheres_at(set, a.view.radius);
            return a.heat.empty() ? draw_wireframe(a, set, spheres) : draw_heat(a, spheres);
        } else {
            return a.heat.empty() ? draw_wireframe(a, set, set) : draw_heat(a, set);
        }
    }
    return 1;
}

}  // namespace

Run add_draw(CLI::App& verb) {
    auto a = std::make_shared<DrawArguments>();
    add_common(verb, *a, true);
    verb.add_option("--structure", a->structure, "NAME[:OPTION=VALUE,...]")->capture_default_str();
    auto* const beside = verb.add_option(
        "--beside", a->beside, "a second structure, drawn beside the first; shows what siblings share");
    auto* const slice = verb.add_option(
        "--slice", a->slice,
        "x, y or z=FRACTION of the scene, or =@POSITION: the cells that a plane cuts, as SVG");
    verb.add_option("--depth", a->levels, "draw the first so many levels; 0: all, or as many as can be seen")
        ->check(CLI::Range(0, 128));
    auto* const ray = verb.add_option("--ray", a->ray,
                                      "origin and direction, ox,oy,oz,dx,dy,dz (flat: four numbers): "
                                      "the cells that the ray visits")
                          ->delimiter(',')
                          ->expected(4, 6);
    verb.add_flag("--frames", a->frames, "with --ray: a page, .html, that goes through it step by step")
        ->needs(ray);
    auto* const heat =
        verb.add_option("--heat", a->heat,
                        "steps, tests or time (in nanoseconds) of a view's rays, as .png or .exr")
            ->check(CLI::IsMember({"steps", "tests", "time"}));
    verb.add_option("--scale", a->scale, "where the heat's scale ends; 0: steps 200, tests 60, time 4000")
        ->needs(heat);
    ray->excludes(slice)->excludes(heat)->excludes(beside);
    heat->excludes(slice)->excludes(beside);
    verb.add_option("--threads", a->threads, "0: all cores")->check(CLI::Range(0, 1024));
    add_view(verb, a->view);
    return [a] {
        parse_size(a->view.size);
        check_writable(a->output);
        return in_precision(*a, [&]<class T>(T) {
            return std::visit([&](const auto& set) { return draw(*a, set); }, load<T>(*a));
        });
    };
}

}  // namespace hedgerow::cli
