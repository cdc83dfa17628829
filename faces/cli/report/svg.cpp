#include "svg.h"

#include <algorithm>
#include <cmath>

#include "xml.h"

namespace hedgerow::cli {

namespace {

/// A length in half pixels, rounded; `half` writes it in pixels.
long halves(double x) {
    return std::lround(2 * x);
}
std::string half(long x) {
    return fmt::format("{}", static_cast<double>(x) / 2);
}

}  // namespace

void Path::polygon(const std::vector<Vec2d>& points) {
    std::string shape;
    long x = 0, y = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
        const long px = halves(points[i][0]), py = halves(points[i][1]);
        const bool first = i == 0;
        if (!first && py == y)
            shape += "h" + half(px - x);
        else if (!first && px == x)
            shape += "v" + half(py - y);
        else
            shape += fmt::format("{}{},{}", first ? "M" : "l", half(px - x), half(py - y));
        x = px, y = py;
    }
    add(points.size() > 2 ? shape + "z" : shape);
}
void Path::circle(const Vec2d& center, double radius) {
    const auto r = half(std::max(1L, halves(radius))), across = half(2 * std::max(1L, halves(radius)));
    add(fmt::format("M{},{}a{r},{r} 0 1,0 {w},0a{r},{r} 0 1,0 -{w},0", half(halves(center[0] - radius)),
                    half(halves(center[1])), fmt::arg("r", r), fmt::arg("w", across)));
}

Svg::Svg(int width, int height, std::string_view style) {
    put("<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0}\" height=\"{1}\" viewBox=\"0 0 {0} {1}\">\n",
        width, height);
    put("<style>\n{}</style>\n", style);
    put("<rect width=\"{}\" height=\"{}\" fill=\"#ffffff\"/>\n", width, height);
}
void Svg::polygon(const Points& points, std::string_view attributes, std::string_view hint) {
    put("<polygon points=\"");
    for (const auto& p : points) put("{:.2f},{:.2f} ", p[0], p[1]);
    if (hint.empty())
        put("\" {}/>\n", attributes);
    else
        put("\" {}><title>{}</title></polygon>\n", attributes, escaped(hint));
}
void Svg::line(const Vec2d& a, const Vec2d& b, std::string_view attributes) {
    put("<line x1=\"{:.2f}\" y1=\"{:.2f}\" x2=\"{:.2f}\" y2=\"{:.2f}\" {}/>\n", a[0], a[1], b[0], b[1],
        attributes);
}
void Svg::circle(const Vec2d& center, double radius, std::string_view attributes) {
    put("<circle cx=\"{:.2f}\" cy=\"{:.2f}\" r=\"{:.2f}\" {}/>\n", center[0], center[1], radius, attributes);
}
void Svg::rect(const Box2d& box, std::string_view attributes) {
    const Vec2d e = box.extent();
    put("<rect x=\"{:.2f}\" y=\"{:.2f}\" width=\"{:.2f}\" height=\"{:.2f}\" {}/>\n", box.low[0], box.low[1],
        e[0], e[1], attributes);
}
void Svg::rounded(const Box2d& box, double radius, std::string_view attributes) {
    rect(box, fmt::format("rx=\"{:.1f}\" {}", radius, attributes));
}
void Svg::path(const Path& path, std::string_view attributes) {
    if (!path.data().empty()) put("<path d=\"{}\" {}/>\n", path.data(), attributes);
}
void Svg::text(const Vec2d& at, std::string_view text, std::string_view attributes) {
    put("<text x=\"{:.2f}\" y=\"{:.2f}\" {}>{}</text>\n", at[0], at[1], attributes, escaped(text));
}

Panel::Panel(const Box2d& shown, const Box2d& area) : shown_(shown), middle_(area.center()) {
    const double wide = shown.extent()[0], high = shown.extent()[1];
    // Give some room to a scene of one point, or one that is flat along an axis.
    const double room = std::max({wide, high, std::abs(shown.center()[0]) * 1e-9, 1e-300});
    for (int k = 0; k < 2; ++k)
        if (shown_.extent()[k] < 1e-3 * room) {
            shown_.low[k] = shown.center()[k] - room * 0.05;
            shown_.high[k] = shown.center()[k] + room * 0.05;
        }
    scale_ = std::min(area.extent()[0] / shown_.extent()[0], area.extent()[1] / shown_.extent()[1]);
}
Vec2d Panel::operator()(const Vec2d& p) const {
    const Vec2d d = (p - shown_.center()) * scale_;
    return {middle_[0] + d[0], middle_[1] - d[1]};
}
std::vector<Vec2d> Panel::operator()(const std::vector<Vec2d>& points) const {
    std::vector<Vec2d> all(points.size());
    std::ranges::transform(points, all.begin(), [&](const Vec2d& p) { return (*this)(p); });
    return all;
}
Box2d Panel::frame() const {
    return Box2d().expand((*this)(shown_.low)).expand((*this)(shown_.high));
}

std::string level_colour(int k, int n) {
    static constexpr int stops[][3] = {{36, 46, 104},  {38, 98, 168}, {26, 150, 150}, {88, 168, 70},
                                       {214, 160, 30}, {222, 98, 28}, {184, 30, 44}};
    constexpr int last = 6;
    const double at = n <= 1 ? 1.0 : std::clamp(double(k) / double(n - 1), 0.0, 1.0) * last;
    const int i = std::min(last - 1, static_cast<int>(at));
    int c[3];
    for (int j = 0; j < 3; ++j)
        c[j] = static_cast<int>(std::lround(stops[i][j] + (stops[i + 1][j] - stops[i][j]) * (at - i)));
    return fmt::format("#{:02x}{:02x}{:02x}", c[0], c[1], c[2]);
}

}  // namespace hedgerow::cli
