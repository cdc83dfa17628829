/// The structures' names and options, for people.
#include <hedgerow/any_index.h>

namespace hedgerow {

const std::vector<StructureInfo>& structure_list() {
    // What several structures have.
    static const OptionInfo mailbox = {"mailbox", "on|off", "on",
                                       "test a primitive once a query, in however many cells it stands"};
    static const OptionInfo insert = {"insert", "exact|box", "exact",
                                      "where a primitive is entered: cells that it meets, or its box"};
    static const OptionInfo budget = {"budget", "BYTES", "8e9",
                                      "a build that would take more memory is refused"};
    static const OptionInfo empty_bonus = {"empty_bonus", "0..0.99", "0.2",
                                           "how much less a plane costs that cuts off empty space"};
    static const std::vector<OptionInfo> of_orthtrees = {
        {"leaf_size", "COUNT", "8", "cells of no more primitives are leaves"},
        {"max_depth", "0..32", "20", "how often the first cell may be halved"},
        mailbox};
    static const std::vector<StructureInfo> list = {
        {"brute-force",
         "no structure: every primitive is tested",
         {{"box", "on|off", "off", "ask one box around everything first"}}},
        {"grid",
         "uniform grid",
         {{"density", "NUMBER", "4", "cells a primitive"},
          {"heuristic", "density|roots", "density", "roots: 3 cube roots of n along each axis"},
          {"resolution", "0..1024 (2D: 32768)", "0", "cells on the longest axis; 0: by the heuristic"},
          insert,
          budget,
          mailbox,
          {"skip_empty", "on|off", "on", "rays pass over a block of empty cells in one step"}}},
        {"two-level-grid",
         "a coarse grid, of which each crowded cell is a grid of its own",
         {{"density", "NUMBER", "0.12", "cells a primitive, of the first level"},
          {"inner_density", "NUMBER", "2.4", "cells a primitive, of the second"},
          {"heuristic", "density|roots", "density",
           "of the first level; roots: 3 cube roots of n along each axis"},
          {"resolution", "0..1024 (2D: 32768)", "0",
           "of the first level, on the longest axis; 0: by the heuristic"},
          insert,
          budget,
          mailbox}},
        {"kdtree",
         "kd-tree: space cut by axis-aligned planes",
         {{"builder", "sah|binned|median|midpoint", "sah", "how planes are chosen"},
          {"leaf_size", "COUNT", "0",
           "cells of no more primitives are leaves; 0: 1 where costs decide, else 4"},
          {"max_depth", "0..64", "0", "0: 8 + 1.3 log2(n)"},
          {"bins", "2..256", "32", "of the binned builder"},
          {"traversal_cost", "NUMBER", "4", "of an inner node, for the SAH"},
          {"intersection_cost", "NUMBER", "1", "of a primitive, for the SAH"},
          empty_bonus,
          mailbox}},
        {"point-kdtree",
         "kd-tree over points, which are themselves the inner nodes; axes in turn",
         {},
         0,
         true},
        {"octree", "cells cut into eight equal ones, in space", of_orthtrees, 3},
        {"quadtree", "cells cut into four equal ones, in the plane", of_orthtrees, 2},
        {"bsp",
         "BSP tree: space cut by planes across the axes and along the geometry",
         {{"leaf_size", "COUNT", "1", "cells of no more primitives are leaves"},
          {"max_depth", "0..64", "0", "0: 8 + 1.3 log2(n)"},
          {"samples", "COUNT", "32", "in larger cells, so many primitives suggest planes"},
          {"traversal_cost", "NUMBER", "4", "of an inner node across an axis, for the SAH"},
          {"plane_cost", "NUMBER", "6", "of one with any other plane"},
          {"intersection_cost", "NUMBER", "1", "of a primitive"},
          empty_bonus,
          mailbox}},
        {"bvh",
         "binary bounding volume hierarchy (the default)",
         {{"volume", "box|sphere|obb|kdop6|kdop14|kdop18|kdop26|cylinder|hull", "box",
           "what nodes are bounded by (in the plane: box, sphere, obb, kdop4, kdop8)"},
          {"builder", "binned|sweep|equal-counts|midpoint|lbvh|ploc|agglomerative|spatial-splits", "binned",
           "how nodes are found"},
          {"bins", "2..64", "32", "most bins of the binned builder"},
          {"search_radius", "1..128", "10", "neighbours that the ploc builder looks at, to either side"},
          {"reinsertion", "PASSES", "0", "most passes of improvement after the build"},
          {"duplicates", "0..10", "0.5", "spatial splits: what they may add, as a share of the primitives"},
          {"overlap", "0..1", "1e-5",
           "spatial splits: tried where sides overlap by so much of the root's area"},
          {"traversal_cost", "NUMBER", "2", "of an inner node, for the SAH"},
          {"intersection_cost", "NUMBER", "1", "of a primitive, for the SAH"},
          {"max_leaf_size", "COUNT", "8", "larger nodes are always split"},
          {"ordered", "on|off", "on", "visit the nearer child first"},
          {"culling", "on|off", "on", "pass over what a nearer hit has put out of reach"}}}};
    return list;
}

}  // namespace hedgerow
