/// Options that all loaders share.
#pragma once

namespace hedgerow {

struct LoadOptions {
    /// Leaves out elements with a coordinate that is NaN, infinite or beyond `largest_coordinate<T>`, instead
    /// of throwing. A mesh loses such vertices and, whole, the faces that use them. Faces that stay keep
    /// their ids (ordinals in the file); vertices that stay are renumbered. A point cloud loses such points,
    /// and the rest move up.
    bool drop_bad = false;
};

}  // namespace hedgerow
