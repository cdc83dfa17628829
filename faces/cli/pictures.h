/// The flat pictures that `draw` makes, as SVG and HTML.
#pragma once

#include <string>
#include <vector>

#include "flat.h"
#include "ray_table.h"
#include "tree_picture.h"

namespace hedgerow::cli {

/// What a picture shows, beside structures. The frame is of everything that is to be seen.
struct FlatScene {
    std::string title;
    std::vector<FlatPrimitive> primitives;
    int width, height;
};
/// `tree`: empty if none is to be drawn.
struct NamedStructure {
    std::string name;
    std::vector<std::string> facts;  // a line each
    FlatStructure flat;
    TreeShape tree = {};
};

/// Structures over the same primitives, two in a row: cells coloured by level, with a legend; what siblings
/// share is hatched, and what is empty in grey. Where there are trees, each stands beside its cells.
std::string cells_picture(const FlatScene& scene, const std::vector<NamedStructure>& structures);

/// A structure and what a ray visits in it.
struct RayView {
    NamedStructure structure;
    TraceTable table;
};

/// The cells that a ray visits in each structure, numbered in order, over all others; the primitives that
/// were tested, and where the ray hits. With a legend.
std::string ray_picture(const FlatScene& scene, const std::vector<RayView>& views);
/// A page that steps through one structure's walk: its cells, its tree and the table, with the current node,
/// box and interval; by buttons, arrow keys and clicks.
std::string ray_page(const FlatScene& scene, const RayView& view);

}  // namespace hedgerow::cli
