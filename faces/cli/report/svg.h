/// A writer of SVG that is well-formed by construction, and a panel that maps a scene to pixels.
#pragma once

#include <iterator>
#include <string>
#include <string_view>
#include <unordered_set>
#include <vector>

#include <fmt/format.h>

#include <hedgerow/geometry/box.h>

namespace hedgerow::cli {

/// The data of one path for many shapes, rounded to half a pixel. A shape equal to an earlier one is left
/// out, so that a path is no longer than its pixels. O(1) a shape.
class Path {
public:
    /// A closed polygon, or a line for two points.
    void polygon(const std::vector<Vec2d>& points);
    void circle(const Vec2d& center, double radius);
    /// A line of length 0, which round line ends turn into a dot.
    void dot(const Vec2d& at) { polygon({at, at}); }

    const std::string& data() const { return data_; }

private:
    void add(std::string shape) {
        if (const auto [at, is_new] = seen_.insert(std::move(shape)); is_new) data_ += *at;
    }
    std::unordered_set<std::string> seen_;
    std::string data_;
};

/// An SVG document in the making. Attributes are written as they are given; texts are escaped. Lengths are in
/// pixels.
class Svg {
public:
    using Points = std::vector<Vec2d>;

    Svg(int width, int height, std::string_view style);

    void open_group(std::string_view attributes) { put("<g {}>\n", attributes); }
    void close_group() { put("</g>\n"); }
    /// A browser shows `hint` under the pointer; it may be empty.
    void polygon(const Points& points, std::string_view attributes, std::string_view hint = {});
    void line(const Vec2d& a, const Vec2d& b, std::string_view attributes);
    void circle(const Vec2d& center, double radius, std::string_view attributes);
    void rect(const Box2d& box, std::string_view attributes);
    /// A rectangle with round corners.
    void rounded(const Box2d& box, double radius, std::string_view attributes);
    /// Writes nothing for a path without shapes.
    void path(const Path& path, std::string_view attributes);
    void text(const Vec2d& at, std::string_view text, std::string_view attributes = {});
    /// Writes XML as it is, such as definitions. It must be well-formed.
    void raw(std::string_view xml) { put("{}", xml); }

    /// The whole document.
    std::string finished() const { return text_ + "</svg>\n"; }

private:
    template <class... A>
    void put(fmt::format_string<A...> format, A&&... a) {
        fmt::format_to(std::back_inserter(text_), format, std::forward<A>(a)...);
    }
    std::string text_;
};

/// Maps the box `shown` of the plane into `area` of the picture: as large as fits, centred, y upwards.
class Panel {
public:
    Panel(const Box2d& shown, const Box2d& area);

    Vec2d operator()(const Vec2d& p) const;
    std::vector<Vec2d> operator()(const std::vector<Vec2d>& points) const;
    double pixels(double length) const { return length * scale_; }
    /// The shown box in the picture.
    Box2d frame() const;

private:
    Box2d shown_;
    Vec2d middle_;  // the middle of the area
    double scale_;
};

/// The colour of level k of n, with k from 0, as "#rrggbb": from dark blue through green to red, each clearly
/// visible on white.
std::string level_colour(int k, int n);

}  // namespace hedgerow::cli
