/// The planes of --slice: perpendicular to an axis.
#pragma once

#include <string>

#include "flat.h"
#include "upright.h"

namespace hedgerow::cli {

/// The value of --slice: an axis, and where the plane crosses it.
struct Slice {
    int axis = 0;
    bool is_position = false;  ///< whether `value` is a position; else it is a fraction of the scene's extent
    double value = 0.5;

    double position(const Box3d& bounds) const {
        return is_position ? value : bounds.low[axis] + value * bounds.extent()[axis];
    }
};

/// Parses --slice: "z=0.5" is a fraction, "z=@12.5" a position. Throws UsageError for any other text.
Slice slice_of(const std::string& text);

/// The plane at a position on an axis. The scene's up axis points up in the picture, unless the plane is
/// perpendicular to it.
Section<3> section_across(int axis, double position, const Upright& upright);

}  // namespace hedgerow::cli
