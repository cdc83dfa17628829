/// The pictures that `draw` makes, each in a file of its own, and what several of them share.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json_fwd.hpp>

#include <hedgerow/error.h>
#include <hedgerow/io/image.h>

#include "pictures.h"
#include "view.h"

namespace hedgerow::cli {

struct DrawArguments : Common {
    std::string structure = "bvh", slice, heat;
    std::vector<std::string> beside;
    ViewArguments view;
    std::vector<double> ray;
    bool frames = false, tree = false, log = false, stop_at_first = false;
    int levels = 0;
    std::optional<int> height;
    unsigned threads = 0;
    std::uint64_t scale = 0;
};

/// All structures that are drawn: the first and those beside it.
std::vector<std::string> structures_of(const DrawArguments& a);

/// Throws UsageError for what is wrong with the options, whatever the scene holds.
void check_cells(const DrawArguments& a);
template <class T>
void check_ray(const DrawArguments& a);

/// The cells of some structures: of a flat scene, or in a slice.
template <class T>
int draw_cells(const DrawArguments& a, const Scene<T>& scene);
/// What one ray visits in some structures.
template <class T>
int draw_ray(const DrawArguments& a, const Scene<T>& scene);
/// The boxes of some structures, as lines over a view of a scene in space.
template <class T>
int draw_wireframe(const DrawArguments& a, const Scene<T>& scene);
/// What the rays of a view of a scene in space cost.
template <class T>
int draw_heat(const DrawArguments& a, const Scene<T>& scene);

/// Throws UsageError unless the output ends as what is written there does.
void expect_ending(const DrawArguments& a, const std::string& ending, const std::string& what);

/// Beyond this a picture of lines shows nothing, and no viewer opens it.
inline constexpr std::size_t most_shapes = 200'000;
/// The cells as they are; throws InputError if there are more than can be seen.
template <int D>
std::vector<OutlineCell<D>> few(std::vector<OutlineCell<D>> cells) {
    if (cells.size() > most_shapes)
        throw InputError(
            fmt::format("{} cells are too many to be seen: limit the levels by --depth, or draw a "
                        "smaller scene; at most {}",
                        cells.size(), most_shapes));
    return cells;
}

/// What is reported of a structure that was drawn.
nlohmann::ordered_json facts_of(const NamedStructure& s, std::size_t cells, std::size_t leaves, int depth);

/// Calls f with a set that lies in space and with what can be seen of it, of points small spheres; 1 if the
/// scene is flat.
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

/// Pixels a dot of the letters on a picture.
int letter_scale(const Image& image);
/// As `draw_note` can hold them in so many pixels of the picture's width; 0: all.
std::vector<std::string> note_lines(const Image& image, const std::vector<std::string>& texts, int width = 0);

/// The tree of an outline for the picture, if there is one; throws InputError, where the user asked for it,
/// if the structure has none.
template <int D>
TreeShape tree_for(const std::string& structure, const std::vector<OutlineCell<D>>& cells, bool asked) {
    TreeShape tree = tree_of(cells);
    if (asked && tree.nodes.empty())
        throw InputError(structure + " is no tree, or is empty: draw it without --tree");
    return tree;
}

}  // namespace hedgerow::cli
