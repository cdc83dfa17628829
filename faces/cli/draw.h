/// The kinds of pictures that `draw` makes, each implemented in its own file, and code that several share.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json_fwd.hpp>

#include <hedgerow/base/error.h>
#include <hedgerow/io/image.h>

#include "pictures.h"
#include "view.h"

namespace hedgerow::cli {

struct DrawArguments : Common {
    std::string structure = "wide", slice, heat, field, hausdorff;
    std::vector<std::string> beside;
    ViewArguments view;
    std::vector<double> ray, forces_at;
    double accuracy = 1e-3, angle = 60, cone = 0;
    bool frames = false, tree = false, log = false, stop_at_first = false, beam = false;
    int levels = 0, width = 1024, fan = 0;
    std::optional<int> height;
    unsigned threads = 0;
    std::uint64_t scale = 0;
};

/// The names of all structures that are drawn: --structure, then each --beside.
std::vector<std::string> structures_of(const DrawArguments& a);

/// Throw UsageError for options that are wrong whatever the scene holds.
void check_cells(const DrawArguments& a);
void check_field(const DrawArguments& a);
template <class T>
void check_ray(const DrawArguments& a);

/// Draws the cells of the structures: of a flat scene, or in a slice. Returns the exit code.
template <class T>
int draw_cells(const DrawArguments& a, const Scene<T>& scene);
/// Draws the cells that one ray visits in the structures. Returns the exit code.
template <class T>
int draw_ray(const DrawArguments& a, const Scene<T>& scene);
/// Draws where the rays of a fan end in the structures, or how they divide as a beam. Returns the exit code.
/// Throws InputError for a beam in a scene without segments.
template <class T>
int draw_fan(const DrawArguments& a, const Scene<T>& scene);
/// Draws a cone around the ray, and its footprint where the ray hits, over a view of a scene in space.
/// Returns the exit code. Throws InputError for a flat scene, and where the ray hits nothing.
template <class T>
int draw_cone(const DrawArguments& a, const Scene<T>& scene);
/// Draws the outlines of two scenes in a plane through the points where they are farthest from each other.
/// Returns the exit code. Throws InputError for scenes without a Hausdorff distance.
template <class T>
int draw_hausdorff(const DrawArguments& a, const Scene<T>& scene);
/// Draws the boxes of the structures as lines over a view of a scene in space. Returns the exit code; 1 for a
/// flat scene.
template <class T>
int draw_wireframe(const DrawArguments& a, const Scene<T>& scene);
/// Draws a heat map: the cost of the rays of a view of a scene in space. Returns the exit code; 1 for a flat
/// scene.
template <class T>
int draw_heat(const DrawArguments& a, const Scene<T>& scene);

/// Draws the cells that act on the particle that is nearest to --forces-at. Returns the exit code.
int draw_forces(const DrawArguments& a);

/// Draws a field over a plane through a scene in space: distances, winding numbers or counts. Returns the
/// exit code. Throws InputError for scenes without such a field.
template <class T>
int draw_field(const DrawArguments& a, const Scene<T>& scene);

/// Throws UsageError unless the output has the extension `ending`. `what` names the picture in the message.
void expect_ending(const DrawArguments& a, const std::string& ending, const std::string& what);

/// The most shapes of a picture. With more, a picture of lines shows nothing, and no viewer opens it.
inline constexpr std::size_t most_shapes = 200'000;
/// Returns the cells unchanged. Throws InputError if there are more than `most_shapes`.
template <int D>
std::vector<OutlineCell<D>> few(std::vector<OutlineCell<D>> cells) {
    if (cells.size() > most_shapes)
        throw InputError(
            fmt::format("{} cells are too many to be seen: limit the levels by --depth, or draw a "
                        "smaller scene; at most {}",
                        cells.size(), most_shapes));
    return cells;
}

/// The report on a drawn structure, for --json.
nlohmann::ordered_json facts_of(const NamedStructure& s, std::size_t cells, std::size_t leaves, int depth);

/// Returns f(set, seen) for a set in space; returns 1 for a flat scene. `seen` is what a picture shows: small
/// spheres for points, else the set itself.
template <class T, class F>
int in_space(const DrawArguments& a, const Scene<T>& scene, F f) {
    return std::visit(
        [&]<class P>(const P& set) {
            if constexpr (P::dimension == 2)
                return 1;
            else if constexpr (requires { set.points; })
                return f(set, spheres_at(set, a.view.radius));
            else
                return f(set, set);
        },
        scene);
}

/// The size in pixels of a dot of the letters on a picture.
int letter_scale(const Image& image);
/// Breaks texts into lines that fit into a note (draw_note) of `width` pixels; 0: of the picture's width.
std::vector<std::string> note_lines(const Image& image, const std::vector<std::string>& texts, int width = 0);

/// The tree of an outline. Empty if the structure is no tree or is empty; throws InputError in that case if
/// the user asked for a tree.
template <int D>
TreeShape tree_for(const std::string& structure, const std::vector<OutlineCell<D>>& cells, bool asked) {
    TreeShape tree = tree_of(cells);
    if (asked && tree.nodes.empty())
        throw InputError(structure + " is no tree, or is empty: draw it without --tree");
    return tree;
}

}  // namespace hedgerow::cli
