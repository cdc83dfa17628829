/// Wireframes: the cells of a structure as lines over a view of the scene, as PNG.
#include <algorithm>
#include <tuple>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <hedgerow/any_index.h>
#include <hedgerow/geometry/elementary.h>
#include <hedgerow/render/lettering.h>
#include <hedgerow/render/render.h>
#include <hedgerow/render/wireframe.h>
#include <hedgerow/structures/bvh/volumes/region.h>

#include "background.h"
#include "draw.h"
#include "picture_notes.h"
#include "report/svg.h"

namespace hedgerow::cli {

namespace {

using nlohmann::ordered_json;

/// The most boxes that a reader can distinguish in a wireframe. It limits the levels that are drawn without
/// --depth.
constexpr std::size_t most_boxes = 250;

/// The boxes of the first `wanted` levels; 0: of as many levels as have at most `most_boxes` (the first level
/// always). Empty leaves are left out. Sets `levels` to the number of levels. Throws InputError as `few`
/// does.
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

/// The corners of all triangles, or of the boxes of other primitives.
template <class P>
std::vector<Vec3d> corners_of(const P& set) {
    std::vector<Vec3d> points;
    const auto view = set.view();
    for (PrimitiveId id = 0; id < view.size(); ++id)
        if constexpr (requires { view.corners(id); }) {
            for (const auto& corner : view.corners(id)) points.push_back(Vec3d(corner));
        } else {
            const auto box = view.bounds(id);
            for (int i = 0; i < 8; ++i)
                points.push_back(Vec3d((i & 1 ? box.high : box.low)[0], (i & 2 ? box.high : box.low)[1],
                                       (i & 4 ? box.high : box.low)[2]));
        }
    return points;
}
/// Sets the shape of the first cell of a BVH whose volumes are no boxes. The tree has only a box there, since
/// its nodes store the volumes of their children.
template <class P>
void set_first_volume(const std::string& spec, const P& set, std::vector<OutlineCell<3>>& cells) {
    const auto at = spec.find("volume=");
    if (at == spec.npos || cells.empty()) return;
    const auto name = spec.substr(at + 7, spec.find(',', at) - at - 7);
    const auto kind = static_cast<Volume>(std::ranges::find(volume_names, name) - std::begin(volume_names));
    if (kind == Volume::box) return;
    auto volumes = list_of<double, 3>(kind);
    const std::vector<Vec3d> points = corners_of(set);
    std::visit([&](auto& list) { list.resize(1), list.fit(0, points, 0); }, volumes);
    const Box3d& box = cells[0].box;
    cells[0].shape =
        region_in(AnyVolume<double, 3>{volumes, 0}, {box.low - box.extent(), box.high + box.extent()});
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
            // Add an edge once: it belongs to two faces.
            if (std::find(edges.begin(), edges.end(), edge) == edges.end()) edges.push_back(edge);
        }
    for (const auto& [p, q] : edges) wires.draw({Vec3f(p), Vec3f(q), colour, width});
}
/// Draws a title in the upper left corner, and below it a swatch and a number for each level.
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

/// Draws the boxes of cells over the background, the deepest first, so that the first levels lie on top.
Image wireframe(std::vector<OutlineCell<3>> cells, const std::vector<std::string>& title, int levels,
                const Background& background) {
    std::stable_sort(cells.begin(), cells.end(),
                     [](const auto& a, const auto& b) { return a.level > b.level; });
    Image image = background.image;
    Wireframe wires(image, background.surface, background.maker);
    const float unit = static_cast<float>(image.height) / 768;
    for (const auto& c : cells)
        draw_edges(c, pixel_of(level_colour(c.level - 1, levels)),
                   unit * std::max(1.1f, static_cast<float>(2.8 * power(0.85, c.level - 1))), wires);
    draw_level_legend(image, title, levels);
    return image;
}
constexpr int between_pictures = 4;  // pixels between pictures

/// How many of so many pictures are in a row, and how many rows there are.
std::pair<int, int> columns_and_rows(std::size_t pictures) {
    const int columns = pictures > 4 ? 3 : pictures > 1 ? 2 : 1;
    return {columns, (static_cast<int>(pictures) + columns - 1) / columns};
}
/// Joins pictures of one size into one, row by row.
Image joined(const std::vector<Image>& parts) {
    const auto [columns, rows] = columns_and_rows(parts.size());
    const int wide = parts[0].width + between_pictures, high = parts[0].height + between_pictures;
    Image all(columns * wide - between_pictures, rows * high - between_pictures, {255, 255, 255});
    for (std::size_t i = 0; i < parts.size(); ++i) {
        const int left = static_cast<int>(i) % columns * wide, top = static_cast<int>(i) / columns * high;
        for (int y = 0; y < parts[i].height; ++y)
            for (int x = 0; x < parts[i].width; ++x) all.at(left + x, top + y) = parts[i].at(x, y);
    }
    return all;
}

/// The structures are built over `set`, and the picture shows `seen`. For points these differ: points are
/// seen as spheres.
template <class P, class Seen>
int draw_wireframe_of(const DrawArguments& a, const P& set, const Seen& seen) {
    expect_ending(a, ".png", "a picture in space");
    RenderOptions options;
    std::tie(options.width, options.height) = parse_size(a.view.size);
    options.samples = 4, options.seed = a.seed;
    // Divide the picture among the structures.
    const auto specs = structures_of(a);
    const auto [columns, rows] = columns_and_rows(specs.size());
    const auto part_of = [](int size, int parts) {
        return std::max(1, (size - (parts - 1) * between_pictures) / parts);
    };
    options.width = part_of(options.width, columns), options.height = part_of(options.height, rows);
    // Render the background, which all structures share.
    const auto seen_index = build_shown(a, "bvh", seen);
    const Upright upright = upright_of(a.view, a, set);
    options.camera = camera_of(
        a.view, a, Box3f{Vec3f(seen_index->bounds().low), Vec3f(seen_index->bounds().high)}, upright);
    const Background background(a, *seen_index, seen, options);
    std::vector<Image> images;
    ordered_json report = ordered_json::array();
    std::string text;
    for (const auto& spec : specs) {
        // Draw the boxes of a structure.
        const auto index = build_shown(a, spec, set);
        int levels = 0;
        auto cells = boxes_of(*index, a.levels, levels);
        set_first_volume(spec, set, cells);
        const std::size_t drawn = cells.size();
        std::string facts =
            fmt::format("{} cells of the first {} levels of {}", drawn, levels, index->depth());
        images.push_back(wireframe(std::move(cells), {spec, facts}, levels, background));
        // Compute the overlap of siblings over the whole structure.
        NamedStructure s{spec, {facts}, {}};
        if (!a.beside.empty()) {
            add_shared(index->outline(), Section<3>{{}, {1, 0, 0}, {0, 1, 0}}, s.flat);
            if (s.flat.overlap.value_or(0) > 0)
                facts +=
                    fmt::format("; siblings share {:.2f}% of their parents' volume", 100 * *s.flat.overlap);
        }
        report.push_back(facts_of(s, drawn, index->leaf_count(), index->depth()));
        text += fmt::format("{}: {}\n", spec, facts);
    }
    // Save the picture and report.
    save_png(a.output, joined(images), {}, picture_notes(a.seed));
    if (a.json)
        print_json({{"output", a.output}, {"structures", report}});
    else if (!a.quiet)
        fmt::print("{}{}", text, up_text(a.view, a, upright));
    return 0;
}

}  // namespace

template <class T>
int draw_wireframe(const DrawArguments& a, const Scene<T>& scene) {
    return in_space(a, scene,
                    [&](const auto& set, const auto& seen) { return draw_wireframe_of(a, set, seen); });
}
template int draw_wireframe(const DrawArguments&, const Scene<float>&);
template int draw_wireframe(const DrawArguments&, const Scene<double>&);

}  // namespace hedgerow::cli
