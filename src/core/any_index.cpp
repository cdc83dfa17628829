/// The structures' names and options, for people.
#include <hedgerow/any_index.h>

namespace hedgerow {

const std::vector<StructureInfo>& structure_list() {
    static const std::vector<StructureInfo> list = {
        {"brute-force",
         "no structure: every primitive is tested",
         {{"box", "on|off", "off", "ask one box around everything first"}}},
        {"grid",
         "uniform grid",
         {{"density", "NUMBER", "4", "cells a primitive"},
          {"resolution", "0..1024", "0", "cells on the longest axis; 0: by density"}}},
        {"kdtree",
         "kd-tree, cells halved in the middle of their widest axis",
         {{"leaf_size", "COUNT", "4", "cells of no more primitives are leaves"},
          {"max_depth", "0..64", "0", "0: 8 + 1.3 log2(n)"}}},
        {"bvh",
         "binary bounding volume hierarchy (the default)",
         {{"builder", "binned|sweep|equal-counts|midpoint|lbvh|ploc|agglomerative", "binned",
           "how nodes are found"},
          {"bins", "2..64", "32", "most bins of the binned builder"},
          {"search_radius", "1..128", "10", "neighbours that the ploc builder looks at, to either side"},
          {"reinsertion", "PASSES", "0", "most passes of improvement after the build"},
          {"traversal_cost", "NUMBER", "2", "of an inner node, for the SAH"},
          {"intersection_cost", "NUMBER", "1", "of a primitive, for the SAH"},
          {"max_leaf_size", "COUNT", "8", "larger nodes are always split"},
          {"ordered", "on|off", "on", "visit the nearer child first"},
          {"culling", "on|off", "on", "pass over what a nearer hit has put out of reach"}}}};
    return list;
}

}  // namespace hedgerow
