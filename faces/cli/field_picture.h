/// Pictures of fields over a plane: colours, contours at round values, the surface's cut, and a legend.
#pragma once

#include <string>
#include <vector>

#include <hedgerow/io/image.h>

#include "flat.h"

namespace hedgerow::cli {

enum class FieldKind { distance, signed_distance, winding, count };
/// Parses "distance", "signed-distance", "winding" or "count".
FieldKind parse_field(const std::string& name);

/// The values of a field at the middles of pixels, in rows from the top; NaN where none is known.
struct FieldValues {
    FieldKind kind = FieldKind::distance;
    int width = 0, height = 0;
    Box2d frame;  ///< what of the plane the pixels cover
    std::vector<double> values;

    double at(int x, int y) const {
        return values[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                      static_cast<std::size_t>(x)];
    }
    double pixel() const { return frame.extent()[0] / width; }
    /// The middle of a pixel.
    Vec2d place(int x, int y) const {
        return {frame.low[0] + (x + 0.5) * pixel(), frame.high[1] - (y + 0.5) * pixel()};
    }
};

/// The range of a field's colours. `low` and `high` are the extremes of what is found, and of what the field
/// always shows: 0, and for winding numbers 1. Contours lie at the multiples of `step`, which is 1, 2 or 5
/// times a power of ten; of counts a whole number.
struct FieldScale {
    double low = 0, high = 0, step = 1;
    double found_low = 0, found_high = 0;

    explicit FieldScale(const FieldValues& field);
};

/// The part of a picture's width that is beside the field, for the legend.
int width_of_legend(int picture_width);

/// Draws a field below its title, with the cut of the scene's primitives in the plane, and a legend beside.
Image field_picture(const FieldValues& field, const FieldScale& scale, const std::vector<std::string>& title,
                    const std::vector<FlatPrimitive>& cut);

}  // namespace hedgerow::cli
