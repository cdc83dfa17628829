/// The one list of structures: the tool, the tests and the bindings know its names.
#pragma once

#include <string_view>
#include <type_traits>
#include <vector>

#include <hedgerow/all.h>

namespace hedgerow::detail {

/// The name of an Orthtree, whose cells have 2^D children.
constexpr std::string_view orthtree_name(int dimension) {
    return dimension == 3 ? "octree" : "quadtree";
}

/// The name of a PointOrthtree.
constexpr std::string_view point_orthtree_name(int dimension) {
    return dimension == 3 ? "point-octree" : "point-quadtree";
}
/// Internal name of a BVH of other volumes than boxes. It is another type than Bvh, but users know both as
/// 'bvh'.
inline constexpr std::string_view bvh_of_volumes = "bvh:volume";

/// Calls f with each structure, its name and its description.
template <int D, class F>
void for_each_structure(F f) {
    f.template operator()<BruteForce>("brute-force", "no structure: every primitive is tested");
    f.template operator()<Grid>("grid", "uniform grid");
    f.template operator()<TwoLevelGrid>("two-level-grid",
                                        "a coarse grid, of which each crowded cell is a grid of its own");
    f.template operator()<HashGrid>("hash-grid",
                                    "cells of one size, found by hashing: the neighbours of points");
    f.template operator()<KdTree>("kdtree", "kd-tree: space cut by axis-aligned planes");
    f.template operator()<PointKdTree>(
        "point-kdtree", "kd-tree over points, which are themselves the inner nodes; axes in turn");
    f.template operator()<Orthtree>(orthtree_name(D), D == 3
                                                          ? "cells cut into eight equal ones, in space"
                                                          : "cells cut into four equal ones, in the plane");
    f.template operator()<PointOrthtree>(
        point_orthtree_name(D), D == 3
                                    ? "octree over points, each in one cell: sorted along a Morton curve"
                                    : "quadtree over points, each in one cell: sorted along a Morton curve");
    f.template operator()<BspTree>("bsp",
                                   "BSP tree: space cut by planes across the axes and along the geometry");
    f.template operator()<Bvh>("bvh", "binary bounding volume hierarchy");
    f.template operator()<VolumeBvh>(bvh_of_volumes, "");
    f.template operator()<WideBvh>(
        "wide",
        "wide bounding volume hierarchy: 4 to 16 children a node, tested at once (the engine; the default)");
}

/// The name in D dimensions of the structure that is called `name` there or in the other dimension; empty if
/// none is.
template <int D>
std::string_view name_in(std::string_view name) {
    std::vector<std::string_view> here, there;
    for_each_structure<D>(
        [&]<template <class, int> class>(std::string_view own, std::string_view) { here.push_back(own); });
    for_each_structure<5 - D>([&]<template <class, int> class>(std::string_view other, std::string_view) {
        there.push_back(other);
    });
    for (std::size_t i = 0; i < here.size(); ++i)
        if (name == here[i] || name == there[i]) return here[i];
    return {};
}

/// Lists the options of a structure (base/option.h) as users know them: a 'bvh' has a volume too, which is
/// the box.
template <class S, class Option>
void list_options(typename S::Options& options, Option& option) {
    if constexpr (std::same_as<typename S::Options, BvhOptions>) {
        Volume box = Volume::box;
        VolumeBvhOptions::list_volume(option, box);
    }
    options.list(option);
}

/// The nodes and the items that a structure uses, of those that it has room for.
template <class S>
std::size_t node_count_of(const S& structure) {
    if constexpr (requires { structure.used_node_count(); })
        return structure.used_node_count();
    else
        return structure.node_count();
}
template <class S>
std::size_t item_count_of(const S& structure) {
    if constexpr (requires { structure.item_count(); })
        return structure.item_count();
    else
        return structure.items().size();
}

}  // namespace hedgerow::detail
