/// Labels that do not lie on each other.
#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "svg.h"

namespace hedgerow::cli {

/// Finds each label the nearest free place to what it names. O(places tried × labels) a label.
class Labels {
public:
    explicit Labels(const Box2d& area) : area_(area) {}

    /// Keeps labels away.
    void block(const Box2d& box) { taken_.push_back(box); }
    /// The middle of a free place of that size, at most `reach` away; nothing if there is none.
    std::optional<Vec2d> place(const Vec2d& wanted, const Vec2d& size, double reach = 90);
    /// A text in a box with round corners, with a line to what it names if that is not beside it. Draws
    /// nothing where no place is free.
    void draw(Svg& svg, const Vec2d& named, const Vec2d& wanted, std::string_view text,
              std::string_view look);

private:
    bool free(const Box2d& box) const;

    Box2d area_;
    std::vector<Box2d> taken_;
};

}  // namespace hedgerow::cli
