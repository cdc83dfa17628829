/// What people can know of all structures: names, options and short descriptions.
#include <hedgerow/any_index.h>

#include <algorithm>

#include "structures.h"

namespace hedgerow {
namespace {

/// The structures in D dimensions, that of other volumes than boxes left out.
template <int D>
std::vector<StructureInfo> structures_in() {
    using T = float;
    using Shapes = std::conditional_t<D == 3, TriangleMeshView<T>, SegmentSetView<T>>;
    std::vector<StructureInfo> list;
    detail::for_each_structure<D>(
        [&]<template <class, int> class S>(std::string_view name, std::string_view description) {
            if (name == detail::bvh_of_volumes) return;
            typename S<T, D>::Options defaults;
            OptionInfos options;
            detail::list_options<S<T, D>>(defaults, options);
            list.push_back({name, description, std::move(options.all), 0, !Structure<S<T, D>, Shapes>,
                            AnswersProbe<S<T, D>, RayProbe<T, D>>});
        });
    return list;
}

/// Joins the lists of both dimensions. A range that differs is told of both.
std::vector<StructureInfo> joined(std::vector<StructureInfo> in_space,
                                  const std::vector<StructureInfo>& in_plane) {
    std::vector<StructureInfo> all;
    for (std::size_t i = 0; i < in_space.size(); ++i) {
        StructureInfo& space = in_space[i];
        StructureInfo plane = in_plane[i];
        if (space.name != plane.name) {
            space.dimension = 3, plane.dimension = 2;
            all.push_back(std::move(space));
            all.push_back(std::move(plane));
            continue;
        }
        for (std::size_t k = 0; k < space.options.size(); ++k)
            if (std::string& values = space.options[k].values; values != plane.options[k].values)
                values += " (2D: " + plane.options[k].values + ")";
        all.push_back(std::move(space));
    }
    return all;
}

}  // namespace

const std::vector<StructureInfo>& structure_list() {
    static const std::vector<StructureInfo> list = joined(structures_in<3>(), structures_in<2>());
    return list;
}

}  // namespace hedgerow
