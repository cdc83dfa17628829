/// What the flat pictures share: their style, where panels and captions lie, and how primitives and cells are
/// drawn.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "pictures.h"
#include "svg.h"

namespace hedgerow::cli {

/// More shapes than these are drawn as a few paths, at half a pixel, without hints.
inline constexpr std::size_t most_with_hints = 2'000;

/// Style sheet of texts, cells and primitives, and the definitions that it names: hatchings, a ray's arrow.
std::string_view plain_style();
void add_definitions(Svg& svg);
/// A class `lK` a level K: its colour, and lines that are thinner the deeper.
std::string level_style(int levels, double thin);

/// A structure's name and what is said of it, in lines as wide as its panel.
struct Caption {
    std::vector<std::string> name, facts;

    Caption(std::string_view name_text, const std::vector<std::string>& facts_text, double width);
    /// Of the part of the picture below the panel.
    double height() const { return 26 + 16 * double(name.size() + facts.size()); }
    void draw(Svg& svg, Vec2d at) const;
};

/// Panels in rows, each over its caption, with the legend at their right: two in a row from two panels on.
class Layout {
public:
    /// `columns`: 0 for as many as serve.
    Layout(int width, int height, const std::vector<NamedStructure>& structures, std::size_t columns = 0);

    /// Where the panel of structure i lies.
    const Box2d& area(std::size_t i) const { return areas_[i]; }
    void draw_caption(Svg& svg, std::size_t i) const;
    /// The upper left corner of the legend, and the height that is left for it.
    Vec2d legend() const { return legend_; }
    double legend_height() const { return legend_height_; }

private:
    std::vector<Caption> captions_;
    std::vector<Box2d> areas_;
    Vec2d legend_;
    double legend_height_;
};

inline constexpr double picture_margin = 24, picture_head = 64, legend_width = 150;

/// The left part of an area, for cells, and the rest of it, for their tree.
Box2d cells_part(const Box2d& area);
Box2d tree_part(const Box2d& area);

/// What is to be seen of some structures and of the primitives.
Box2d frame_of(const FlatScene& scene, const std::vector<const FlatStructure*>& structures);
/// A factor for lines: smaller where there are many.
double crowding(std::size_t count, const Panel& panel);

/// Primitives of one look. `more`: further classes, behind a blank.
void draw_primitive(Svg& svg, const Panel& panel, const FlatPrimitive& p, double size, std::string_view more);
void draw_primitives(Svg& svg, const Panel& panel, const std::vector<FlatPrimitive>& all, double size,
                     std::string_view more);

/// What the pointer shows of a cell.
std::string hint_of(const FlatCell& cell);

/// A line of a legend: a swatch of 22 × 12 pixels, which `draw` draws in its box, and a text.
class Legend {
public:
    Legend(Svg& svg, const Vec2d& at) : svg_(svg), at_(at) {}
    template <class F>
    void line(std::string_view text, F draw) {
        draw(Box2d{at_, at_ + Vec2d(22, 12)});
        svg_.text(at_ + Vec2d(30, 10), text, "class=\"legend\"");
        at_[1] += 19;
    }
    void heading(std::string_view text) {
        svg_.text(at_ + Vec2d(0, 8), text, "class=\"quiet\"");
        at_[1] += 15;
    }
    const Vec2d& at() const { return at_; }

private:
    Svg& svg_;
    Vec2d at_;
};

}  // namespace hedgerow::cli
