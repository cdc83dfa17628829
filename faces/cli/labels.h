/// Labels that do not overlap.
#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "report/svg.h"

namespace hedgerow::cli {

/// Places each label at the free place nearest to where it is wanted. O(places tried × labels) a label.
class Labels {
public:
    explicit Labels(const Box2d& area) : area_(area) {}

    /// Keeps labels out of a box.
    void block(const Box2d& box) { taken_.push_back(box); }
    /// Reserves a free box of that size, with its middle at most `reach` pixels from `wanted`. Returns the
    /// middle, or nothing if no box is free.
    std::optional<Vec2d> place(const Vec2d& wanted, const Vec2d& size, double reach = 90);
    /// Draws a text in a box with round corners, and a line to `named` if that point is outside of the box.
    /// Draws nothing if no place is free.
    void draw(Svg& svg, const Vec2d& named, const Vec2d& wanted, std::string_view text,
              std::string_view look);

private:
    bool free(const Box2d& box) const;

    Box2d area_;
    std::vector<Box2d> taken_;
};

}  // namespace hedgerow::cli
