/// The fault of a mesh without triangles.
#pragma once

#include <hedgerow/base/error.h>

namespace hedgerow::detail {

/// Nothing in a file has three corners. It may hold points.
class NoFaces : public InputError {
public:
    using InputError::InputError;
};

}  // namespace hedgerow::detail
