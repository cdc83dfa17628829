/// Flat pictures of cells as SVG: the cells of a flat scene, or those that a slice cuts.
#include <unordered_map>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <hedgerow/any_index.h>
#include <hedgerow/base/error.h>
#include <hedgerow/io/text_file.h>

#include "draw.h"
#include "section.h"
#include "slice.h"

namespace hedgerow::cli {

namespace {

using nlohmann::ordered_json;

Section<2> section_of(const DrawArguments& a, const Box2d&, const Upright&) {
    if (!a.slice.empty())
        throw InputError(a.scene + " is flat already, and has no slices: leave --slice out");
    return {};
}
Section<3> section_of(const DrawArguments& a, const Box3d& bounds, const Upright& upright) {
    const Slice slice = slice_of(a.slice);
    return section_across(slice.axis, slice.position(bounds), upright);
}

/// The cells that have at most `most` levels of cells below them in the whole structure, which is given by
/// its outline `whole`.
template <int D>
std::vector<OutlineCell<D>> of_height(std::vector<OutlineCell<D>> cells,
                                      const std::vector<OutlineCell<D>>& whole, int most) {
    std::unordered_map<NodeId, int> height;
    // Walk backwards, so that children come before their parents.
    for (auto c = whole.rbegin(); c != whole.rend(); ++c) {
        const int own = height[c->id];
        if (c->level > 1) height[c->parent] = std::max(height[c->parent], own + 1);
    }
    std::erase_if(cells, [&](const auto& c) { return height[c.id] > most; });
    return cells;
}

template <class P>
int draw_cells_of(const DrawArguments& a, const P& set) {
    constexpr int D = P::dimension;
    expect_ending(a, ".svg", D == 2 ? "a flat scene" : "a slice");
    const auto specs = structures_of(a);
    std::vector<NamedStructure> structures;
    FlatScene scene;
    ordered_json report = ordered_json::array();
    for (const auto& spec : specs) {
        // Build, and list the cells that the plane of the picture reaches.
        const auto index = build_shown(a, spec, set);
        const auto bounds = bounds_of(*index);
        const auto section = section_of(a, bounds, upright_of(a.view, a, set));
        const auto limits = section.limits(a.levels > 0 ? a.levels : OutlineLimits<D>().levels);
        auto cells = index->outline(limits);
        // Make the whole outline only if heights, shared parts or the tree of a slice are computed from it.
        const bool needs_whole = a.height || !a.beside.empty() || (a.tree && D == 3);
        const auto whole = needs_whole ? index->outline() : decltype(cells)();
        if (a.height) cells = of_height(std::move(cells), whole, *a.height);
        cells = few(std::move(cells));
        NamedStructure s{spec, {}, flat_structure(cells, section)};
        if (a.tree) s.tree = cropped(tree_for(spec, D == 2 ? cells : whole, true));
        if (!a.beside.empty()) {
            // Compute the overlap over the whole tree, but the hatching from the cells in the picture.
            FlatStructure all;
            add_shared(whole, section, all);
            add_shared(cells, section, s.flat);
            s.flat.overlap = all.overlap;
        }
        // Describe the structure in the caption and in the report.
        s.facts = {fmt::format("{} cells here; {} leaves, depth {}, {} items of {} primitives",
                               s.flat.cells.size(), index->leaf_count(), index->depth(), index->item_count(),
                               index->size())};
        if (s.flat.overlap.value_or(0) > 0)
            s.facts.push_back(fmt::format("siblings share {:.2f}% of their parents' {}",
                                          100 * *s.flat.overlap, D == 2 ? "area" : "volume"));
        report.push_back(facts_of(s, s.flat.cells.size(), index->leaf_count(), index->depth()));
        if (scene.primitives.empty()) scene = flat_scene(a, set, section, bounds);
        structures.push_back(std::move(s));
    }
    // Save the picture and report.
    if (D == 3) scene.title += ", slice " + a.slice;
    if (a.levels > 0) scene.title += fmt::format(", first {} levels", a.levels);
    save_text(a.output, cells_picture(scene, structures));
    if (a.json)
        print_json({{"output", a.output}, {"structures", report}});
    else if (!a.quiet)
        for (const auto& s : structures) fmt::print("{}: {}\n", s.name, fmt::join(s.facts, "; "));
    return 0;
}

}  // namespace

void check_cells(const DrawArguments& a) {
    if (!a.slice.empty()) slice_of(a.slice);
    if (a.tree && a.beside.size() > 1)
        throw UsageError("--tree: one picture has room for the trees of two structures");
}

template <class T>
int draw_cells(const DrawArguments& a, const Scene<T>& scene) {
    return std::visit([&](const auto& set) { return draw_cells_of(a, set); }, scene);
}
template int draw_cells(const DrawArguments&, const Scene<float>&);
template int draw_cells(const DrawArguments&, const Scene<double>&);

}  // namespace hedgerow::cli
