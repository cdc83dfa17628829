#include "field_picture.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include <hedgerow/geometry/elementary.h>
#include <hedgerow/render/film/colour.h>
#include <hedgerow/render/lettering.h>

#include "common.h"

namespace hedgerow::cli {

namespace {

constexpr Image::Pixel field_ground = {12, 12, 16}, field_letters = {235, 235, 240};

/// The least of 1, 2 and 5 times a power of ten that is not below `least`.
double round_step(double least) {
    const double ten = std::pow(10, std::floor(std::log10(least)));
    for (const double times : {1, 2, 5})
        if (times * ten >= least * (1 - 1e-9)) return times * ten;
    return 10 * ten;
}

Image::Pixel mixed(const Image::Pixel& a, const Image::Pixel& b, double share) {
    Image::Pixel p;
    for (std::size_t k = 0; k < 3; ++k)
        p[k] = static_cast<std::uint8_t>(std::lround(a[k] * (1 - share) + b[k] * share));
    return p;
}

/// From dark blue at −1 by white at 0 to dark brown at 1.
Image::Pixel two_sided(double x) {
    static constexpr Image::Pixel stops[5] = {
        {24, 58, 140}, {140, 180, 226}, {246, 246, 242}, {243, 188, 120}, {150, 62, 20}};
    const double at = (std::clamp(x, -1.0, 1.0) + 1) * 2;
    const auto i = std::min<std::size_t>(3, static_cast<std::size_t>(at));
    return mixed(stops[i], stops[i + 1], at - static_cast<double>(i));
}

bool is_two_sided(FieldKind kind) {
    return kind == FieldKind::signed_distance || kind == FieldKind::winding;
}

/// The inside of a solid is blue: where distances are negative and winding numbers positive.
Image::Pixel colour_of(FieldKind kind, const FieldScale& scale, double value) {
    if (!std::isfinite(value)) return field_ground;
    if (!is_two_sided(kind)) return heat(scale.high > 0 ? static_cast<float>(value / scale.high) : 0.f);
    const double side =
        value < 0 ? (scale.low < 0 ? -value / scale.low : 0) : (scale.high > 0 ? value / scale.high : 0);
    return two_sided(kind == FieldKind::winding ? -side : side);
}

/// A contour over a colour: lighter where that is dark, else darker.
Image::Pixel contoured(const Image::Pixel& p) {
    const bool dark = 3 * p[0] + 6 * p[1] + p[2] < 1100;
    return dark ? mixed(p, {255, 255, 255}, 0.45) : mixed(p, {0, 0, 0}, 0.4);
}

/// Draws on the part of an image that shows a field.
class Canvas {
public:
    Canvas(Image& image, const FieldValues& field, int top, int thick)
        : image_(image), field_(field), top_(top), thick_(thick) {}

    /// Calls f(pixel of the image) where `level` of the value differs from that of the neighbour to the right
    /// or below.
    template <class Level, class F>
    void for_each_step(Level level, F f) {
        for (int y = 0; y < field_.height; ++y)
            for (int x = 0; x < field_.width; ++x) {
                const double here = field_.at(x, y);
                const auto differs = [&](int px, int py) {
                    if (px >= field_.width || py >= field_.height) return false;
                    const double there = field_.at(px, py);
                    return std::isfinite(here) && std::isfinite(there) && level(here) != level(there);
                };
                if (differs(x + 1, y) || differs(x, y + 1)) f(x, y);
            }
    }
    Image::Pixel& at(int x, int y) { return image_.at(x, y + top_); }
    void dot(int x, int y, const Image::Pixel& colour) {
        for (int dy = 0; dy < thick_; ++dy)
            for (int dx = 0; dx < thick_; ++dx) {
                const int px = x + dx - thick_ / 2, py = y + dy - thick_ / 2;
                if (px >= 0 && py >= 0 && px < field_.width && py < field_.height) at(px, py) = colour;
            }
    }
    /// Points of the plane outside of the frame are not drawn.
    void dot(const Vec2d& p, const Image::Pixel& colour) {
        const Vec2d at = pixels(p);
        if (at[0] >= 0 && at[1] >= 0 && at[0] < field_.width && at[1] < field_.height)
            dot(static_cast<int>(at[0]), static_cast<int>(at[1]), colour);
    }
    void line(const Vec2d& p, const Vec2d& q, const Image::Pixel& colour) {
        const Vec2d d = pixels(q) - pixels(p);
        const double most = 2.0 * (field_.width + field_.height);
        const double steps = std::min(most, 1 + std::ceil(1.5 * std::max(std::abs(d[0]), std::abs(d[1]))));
        for (int i = 0; i <= static_cast<int>(steps); ++i) dot(p + (q - p) * (i / steps), colour);
    }
    void draw(const FlatPrimitive& p, const Image::Pixel& colour) {
        if (p.radius > 0) {
            const double turn = 2 * std::numbers::pi;
            const int sides = static_cast<int>(std::clamp(p.radius / field_.pixel() * turn / 2, 8.0, 4096.0));
            const auto on_circle = [&](int k) {
                return p.points[0] + Vec2d(cosine(turn * k / sides), sine(turn * k / sides)) * p.radius;
            };
            for (int k = 0; k < sides; ++k) line(on_circle(k), on_circle(k + 1), colour);
        } else if (p.points.size() == 1) {
            dot(p.points[0], colour);
        } else {
            const std::size_t n = p.points.size(), lines = n == 2 ? 1 : n;
            for (std::size_t k = 0; k < lines; ++k) line(p.points[k], p.points[(k + 1) % n], colour);
        }
    }

private:
    Vec2d pixels(const Vec2d& p) const {
        return {(p[0] - field_.frame.low[0]) / field_.pixel(),
                (field_.frame.high[1] - p[1]) / field_.pixel()};
    }

    Image& image_;
    const FieldValues& field_;
    int top_, thick_;
};

int unit_of(int width) {
    return std::max(1, width / 800);
}

/// A bar of the colours, the highest on top, with a number at each contour for which there is room.
void draw_legend(Image& image, const FieldValues& field, const FieldScale& scale, int left, int top,
                 int bottom) {
    const int unit = unit_of(image.width), first = top + 8 * unit, last = bottom - 8 * unit;
    const int bar = left + 6 * unit, wide = 14 * unit;
    if (last - first < 2 * letter_height * unit || !(scale.high > scale.low)) return;
    const auto value_at = [&](int y) {
        return scale.high + (scale.low - scale.high) * (y - first) / (last - first);
    };
    const auto row_of = [&](double value) {
        return first + static_cast<int>(
                           std::lround((scale.high - value) / (scale.high - scale.low) * (last - first)));
    };
    for (int y = first; y <= last; ++y)
        for (int x = bar; x < bar + wide; ++x) image.at(x, y) = colour_of(field.kind, scale, value_at(y));
    int free = last + letter_height * unit;  // the row above which a number may stand
    for (double k = std::ceil(scale.low / scale.step - 1e-9); k <= scale.high / scale.step + 1e-9; ++k) {
        const int y = std::clamp(row_of(k * scale.step), first, last);
        for (int x = bar; x < bar + wide; ++x) image.at(x, y) = contoured(image.at(x, y));
        if (y + letter_height * unit / 2 > free) continue;
        free = y - letter_height * unit / 2;
        draw_text(image, bar + wide + 4 * unit, y - letter_height * unit / 2,
                  fmt::format("{:.6g}", k == 0 ? 0.0 : k * scale.step), field_letters, unit);
    }
}

}  // namespace

FieldKind parse_field(const std::string& name) {
    return name == "distance"          ? FieldKind::distance
           : name == "signed-distance" ? FieldKind::signed_distance
           : name == "winding"         ? FieldKind::winding
                                       : FieldKind::count;
}

FieldScale::FieldScale(const FieldValues& field) {
    bool any = false;
    for (const double v : field.values) {
        if (!std::isfinite(v)) continue;
        found_low = any ? std::min(found_low, v) : v;
        found_high = any ? std::max(found_high, v) : v;
        any = true;
    }
    low = std::min(0.0, found_low), high = std::max(0.0, found_high);
    if (field.kind == FieldKind::winding) high = std::max(1.0, high);
    if (high > low) step = round_step((high - low) / 12);
    if (field.kind == FieldKind::count) step = std::max(1.0, step);
}

int width_of_legend(int picture_width) {
    return (6 + 14 + 4 + 10 * letter_width) * unit_of(picture_width);
}

Image field_picture(const FieldValues& field, const FieldScale& scale, const std::vector<std::string>& title,
                    const std::vector<FlatPrimitive>& cut) {
    // The title on top, the field below it, the legend beside.
    int width = field.width;
    while (width - width_of_legend(width) < field.width) ++width;
    const int unit = unit_of(width);
    std::vector<std::string> lines;
    for (const auto& text : title)
        for (auto& line : wrapped(text, static_cast<std::size_t>(width / (letter_width * unit) - 2)))
            lines.push_back(std::move(line));
    const int top = (static_cast<int>(lines.size()) * letter_height + 6) * unit;
    Image image(width, top + field.height, field_ground);
    draw_note(image, 0, 0, lines, unit);
    // Colours, and contours over them.
    Canvas canvas(image, field, top, unit + 1);
    for (int y = 0; y < field.height; ++y)
        for (int x = 0; x < field.width; ++x) canvas.at(x, y) = colour_of(field.kind, scale, field.at(x, y));
    canvas.for_each_step([&](double v) { return std::floor(v / scale.step); },
                         [&](int x, int y) { canvas.at(x, y) = contoured(canvas.at(x, y)); });
    // The surface, in a line that stands out from the colours of small values.
    const Image::Pixel line = is_two_sided(field.kind) ? Image::Pixel{0, 0, 0} : Image::Pixel{255, 255, 255};
    if (is_two_sided(field.kind)) {
        const double border = field.kind == FieldKind::winding ? 0.5 : 0;
        canvas.for_each_step([&](double v) { return v < border; },
                             [&](int x, int y) { canvas.dot(x, y, line); });
    }
    for (const FlatPrimitive& p : cut) canvas.draw(p, line);
    draw_legend(image, field, scale, field.width, top, image.height);
    return image;
}

}  // namespace hedgerow::cli
