/// What all loaders share: their options.
#pragma once

namespace hedgerow {

struct LoadOptions {
    /// Leave out what has a coordinate that is NaN, infinite or beyond `largest_coordinate<T>`, instead of an
    /// error. Of a mesh the faces go, whole, and such vertices; the faces that stay keep their ids (the
    /// ordinals in the file), the vertices that stay are renumbered. Of a point cloud the points go; the rest
    /// move up.
    bool drop_bad = false;
};

}  // namespace hedgerow
