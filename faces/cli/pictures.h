/// The flat pictures that `draw` makes, as SVG and HTML.
#pragma once

#include <string>
#include <vector>

#include "flat.h"
#include "ray_table.h"
#include "tree_picture.h"

namespace hedgerow::cli {

/// What a picture shows beside its structures. Its frame contains everything (frame_of). Width and height are
/// in pixels.
struct FlatScene {
    std::string title;
    std::vector<FlatPrimitive> primitives;
    int width, height;
};
/// A structure of a picture. `tree` is empty if no tree is drawn.
struct NamedStructure {
    std::string name;
    std::vector<std::string> facts;  // a line each
    FlatStructure flat;
    TreeShape tree = {};
};

/// An SVG of structures over the same primitives: cells coloured by level, with a legend. Intersections of
/// siblings are hatched in red, empty leaves in grey. Structures are two in a row; with trees, one in a row,
/// each tree beside its cells.
std::string cells_picture(const FlatScene& scene, const std::vector<NamedStructure>& structures);

/// A structure, and the walk of a ray in it.
struct RayView {
    NamedStructure structure;
    TraceTable table;
};

/// An SVG of the cells that a ray visits in each structure, numbered in order, over all other cells. It also
/// shows the tested primitives, the hit and a legend.
std::string ray_picture(const FlatScene& scene, const std::vector<RayView>& views);
/// An HTML page that steps through the walk in one structure by buttons, arrow keys and clicks. It shows
/// cells, tree and table, with the current node, box and interval.
std::string ray_page(const FlatScene& scene, const RayView& view);

}  // namespace hedgerow::cli
