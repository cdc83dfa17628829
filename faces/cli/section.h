/// Code that the flat pictures of cells and of a ray share: bounds, and the primitives in a section.
#pragma once

#include <filesystem>
#include <tuple>

#include <fmt/format.h>

#include <hedgerow/any_index.h>
#include <hedgerow/base/error.h>

#include "draw.h"

namespace hedgerow::cli {

/// The bounds of an index in double; the origin if the index is empty.
template <class T, int D>
Box<double, D> bounds_of(const AnyIndex<T, D>& index) {
    if (index.bounds().empty()) return {Vec<double, D>(), Vec<double, D>()};
    return {Vec<double, D>(index.bounds().low), Vec<double, D>(index.bounds().high)};
}
/// The primitives that a section intersects, with the picture's title and size. Points of space count up to
/// 1% of the diagonal of `bounds` from the plane. Throws InputError if there are more than `most_shapes`.
template <class P, int D>
FlatScene flat_scene(const DrawArguments& a, const P& set, const Section<D>& section,
                     const Box<double, D>& bounds) {
    FlatScene scene;
    scene.primitives = flat_primitives(set, section, 0.01 * length(bounds.extent()));
    std::tie(scene.width, scene.height) = parse_size(a.view.size);
    scene.title = std::filesystem::path(a.scene).filename().string();
    if (scene.primitives.size() > most_shapes)
        throw InputError(fmt::format("{} primitives are too many to be seen: draw fewer, at most {}",
                                     scene.primitives.size(), most_shapes));
    return scene;
}

}  // namespace hedgerow::cli
