/// Every structure over a set.
#pragma once

#include <hedgerow/any_structure.h>
#include <hedgerow/hedgerow.h>

namespace hedgerow {

/// Calls f(name, index) for every structure over a set, and for some builders and options of them: for the
/// engine and a BVH by their own types, for the others behind one type.
template <class P, class F>
void for_each_index(const P& set, F f) {
    f("wide by its type", build<WideBvh>(set));
    f("bvh by its type", build<Bvh>(set));
    std::vector<const char*> specs = {"brute-force",
                                      "wide:builder=fast,width=4",
                                      "bvh:builder=spatial-splits",
                                      "bvh:builder=lbvh,max_leaf_size=1",
                                      "bvh:volume=sphere",
                                      "kdtree",
                                      "bsp",
                                      P::dimension == 3 ? "octree" : "quadtree",
                                      "grid",
                                      "two-level-grid"};
    if (PointSet<ViewOf<P>>)
        for (const char* spec :
             {"point-kdtree", P::dimension == 3 ? "point-octree" : "point-quadtree", "hash-grid"})
            specs.push_back(spec);
    for (const char* spec : specs) f(spec, build<AnyStructure>(set, {spec}));
}

/// The same for every structure by its own type, for beams, cones and folds, which an AnyStructure does not
/// walk. Takes the compiler ten times as long.
template <class P, class F>
void for_each_type(const P& set, F f) {
    f("brute force", build<BruteForce>(set));
    f("wide", build<WideBvh>(set));
    f("wide fast", build<WideBvh>(set, {.builder = WideBuilder::fast, .width = 4}));
    f("bvh", build<Bvh>(set));
    BvhOptions options;
    options.builder = BvhBuilder::spatial_splits;
    f("spatial splits", build<Bvh>(set, options));
    options.builder = BvhBuilder::lbvh;
    options.max_leaf_size = 1;
    f("bvh of single primitives", build<Bvh>(set, options));
    VolumeBvhOptions spheres;
    spheres.volume = Volume::sphere;
    f("spheres", build<VolumeBvh>(set, spheres));
    f("kd-tree", build<KdTree>(set));
    f("bsp", build<BspTree>(set));
    f("octree", build<Orthtree>(set));
    f("grid", build<Grid>(set));
    f("two-level grid", build<TwoLevelGrid>(set));
    if constexpr (PointSet<ViewOf<P>>) {
        f("point kd-tree", build<PointKdTree>(set));
        f("point octree", build<PointOrthtree>(set));
        f("hash grid", build<HashGrid>(set));
    }
}

}  // namespace hedgerow
