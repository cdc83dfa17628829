/// Every structure by its own type, for what an AnyIndex does not answer.
#pragma once

#include <hedgerow/hedgerow.h>

namespace hedgerow {

/// Calls f(name, index) for every structure over a set, and for some builders and options of them.
template <class P, class F>
void for_each_index(const P& set, F f) {
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
