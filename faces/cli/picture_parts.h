/// Code that the flat pictures share: style, layout of panels and captions, and drawing of primitives and
/// cells.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "pictures.h"
#include "report/svg.h"

namespace hedgerow::cli {

/// The most shapes that are drawn one by one, with hints. More are drawn as a few paths, rounded to half a
/// pixel.
inline constexpr std::size_t most_with_hints = 2'000;

/// The style sheet of texts, cells and primitives.
std::string_view plain_style();
/// Adds the definitions that styles refer to: hatchings and the arrow of a ray.
void add_definitions(Svg& svg);
/// A style sheet with a class `lK` for each level K from 1: its colour, and thinner lines for deeper levels.
/// All widths are multiplied by `thin`.
std::string level_style(int levels, double thin);

/// A structure's name and facts, broken into lines that are as wide as its panel.
struct Caption {
    std::vector<std::string> name, facts;

    Caption(std::string_view name_text, const std::vector<std::string>& facts_text, double width);
    /// The height in pixels that the caption takes below the panel.
    double height() const { return 26 + 16 * double(name.size() + facts.size()); }
    void draw(Svg& svg, Vec2d at) const;
};

/// The places of panels, captions and the legend. Panels are in rows, each above its caption, with the legend
/// at the right.
class Layout {
public:
    /// `columns`: panels a row; 0: two, or one for a single panel. Width and height are in pixels.
    Layout(int width, int height, const std::vector<NamedStructure>& structures, std::size_t columns = 0);

    /// The area of the panel of structure i.
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

/// The left part of an area, for cells, and the right part, for their tree.
Box2d cells_part(const Box2d& area);
Box2d tree_part(const Box2d& area);

/// The box around all cells of the structures and all primitives; from -1 to 1 if there are none.
Box2d frame_of(const FlatScene& scene, const std::vector<const FlatStructure*>& structures);
/// A factor for widths of lines and sizes of dots, from 0.3 to 1: smaller where many shapes share a panel.
double crowding(std::size_t count, const Panel& panel);

/// Draw primitives in one style. `more` is a list of further classes that begins with a blank.
void draw_primitive(Svg& svg, const Panel& panel, const FlatPrimitive& p, double size, std::string_view more);
void draw_primitives(Svg& svg, const Panel& panel, const std::vector<FlatPrimitive>& all, double size,
                     std::string_view more);

/// The text about a cell that a browser shows under the pointer.
std::string hint_of(const FlatCell& cell);

/// A legend, drawn line by line from `at` downwards. A line is a text beside a swatch, which `draw` draws in
/// a box of 22 × 12 pixels.
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
