#include "labels.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace hedgerow::cli {

bool Labels::free(const Box2d& box) const {
    for (int k = 0; k < 2; ++k)
        if (box.low[k] < area_.low[k] || box.high[k] > area_.high[k]) return false;
    return std::none_of(taken_.begin(), taken_.end(), [&](const Box2d& b) {
        return b.low[0] < box.high[0] && box.low[0] < b.high[0] && b.low[1] < box.high[1] &&
               box.low[1] < b.high[1];
    });
}

std::optional<Vec2d> Labels::place(const Vec2d& wanted, const Vec2d& size, double reach) {
    // Try places on circles around the wanted one, 4 pixels apart and in 24 directions.
    constexpr int directions = 24;
    constexpr double step = 4, turn = 2 * std::numbers::pi / directions;
    for (double away = 0; away <= reach; away += step)
        for (int d = 0; d < (away > 0 ? directions : 1); ++d) {
            const Vec2d middle = wanted + Vec2d(std::sin(turn * d), -std::cos(turn * d)) * away;
            const Box2d box{middle - size * 0.5, middle + size * 0.5};
            if (!free(box)) continue;
            taken_.push_back({box.low - Vec2d::all(1), box.high + Vec2d::all(1)});
            return middle;
        }
    return std::nullopt;
}

void Labels::draw(Svg& svg, const Vec2d& named, const Vec2d& wanted, std::string_view text,
                  std::string_view look) {
    const Vec2d size(5.8 * double(text.size()) + 8, 14);
    const auto middle = place(wanted, size);
    if (!middle) return;
    const Vec2d d = *middle - named;
    if (std::abs(d[0]) > size[0] / 2 || std::abs(d[1]) > size[1] / 2)
        svg.line(*middle, named, "class=\"leader\"");
    svg.rounded({*middle - size * 0.5, *middle + size * 0.5}, 7, look);
    svg.text(*middle + Vec2d(0, 3.4), text, "class=\"number\"");
}

}  // namespace hedgerow::cli
