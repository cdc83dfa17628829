/// Textures averaged over areas. The levels of a texture are its image at half the size, a quarter, and so on
/// (Williams, Pyramidal parametrics, SIGGRAPH 1983). A long area is looked up at several places along it
/// (McCormack et al., Feline, SIGGRAPH 1999), so that it is not averaged across as well.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <hedgerow/looks/texture.h>

namespace hedgerow {

/// An area of a texture around a texture coordinate: the ellipse cos(s)·a + sin(s)·b, in texture coordinates.
/// An area without extent is the point.
struct TextureFootprint {
    Vec2f a, b;
};

/// An image at every power of two below its size. Values are linear. Wrapping and filter are those of the
/// texture that is looked up; textures with the same pixels and colour space may share levels.
class TextureLevels {
public:
    /// Averages a texture. O(texels); takes 16/3 bytes a texel.
    explicit TextureLevels(const Texture& texture) {
        if (!texture.pixels || texture.pixels->width <= 0 || texture.pixels->height <= 0) return;
        const int width = texture.pixels->width, height = texture.pixels->height;
        if (width == 1 && height == 1) return;
        levels_.push_back(halved(width, height, [&](int x, int y) { return texture.texel(x, y); }));
        while (levels_.back().width > 1 || levels_.back().height > 1) {
            const Level& last = levels_.back();
            levels_.push_back(halved(last.width, last.height, [&](int x, int y) { return last.at(x, y); }));
        }
    }

    /// The mean of a texture, which is that of the constructor, around a coordinate. Lookups lie side by side
    /// in the area, two across and up to 16 along, each between the two levels whose texels are about as wide
    /// as they are apart. Where a texel is wider than that, they take the texture itself; the filter
    /// `nearest` then averages over parts of texels. An area that is not finite is a point. O(1).
    Rgba at(const Texture& texture, const Vec2f& coordinate, const TextureFootprint& area) const {
        if (levels_.empty()) return texture.at(coordinate);
        const Vec2f size(static_cast<float>(texture.pixels->width),
                         static_cast<float>(texture.pixels->height));
        const Rectangle r(area, size);
        if (!std::isfinite(r.length)) return texture.at(coordinate);
        const float texel = std::max({1.0f, r.width / 2, r.length / most_lookups});
        const auto lookups = [&](float side) {
            return std::clamp(static_cast<int>(std::ceil(side / texel)), 1, most_lookups);
        };
        const int along = lookups(r.length), across = lookups(r.width);
        const Vec2f step_along = r.along * (r.length / static_cast<float>(along)),
                    step_across = r.across * (r.width / static_cast<float>(across));
        const Vec2f extent = abs(step_along) + abs(step_across);  // of a lookup, in texels
        Rgba sum{{}, 0};
        for (int j = 0; j < across; ++j)
            for (int i = 0; i < along; ++i) {
                const Vec2f from = step_along * (static_cast<float>(2 * i + 1 - along) / 2) +
                                   step_across * (static_cast<float>(2 * j + 1 - across) / 2);
                sum = sum + between_levels(texture, coordinate + Vec2f(from[0] / size[0], from[1] / size[1]),
                                           texel, extent);
            }
        return sum * (1 / static_cast<float>(along * across));
    }

    /// The mean of all texels of a texture, which is that of the constructor.
    Rgba mean(const Texture& texture) const {
        return levels_.empty() ? texture.at({0.5f, 0.5f}) : levels_.back().texels[0];
    }

private:
    static constexpr int most_lookups = 16;

    struct Level {
        int width, height;
        std::vector<Rgba> texels;
        const Rgba& at(int x, int y) const {
            return texels[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                          static_cast<std::size_t>(x)];
        }
    };
    /// An area as a rectangle of the same size, in texels: unit vectors along its sides, and their lengths.
    struct Rectangle {
        Vec2f along, across;
        float length, width;

        Rectangle(const TextureFootprint& area, const Vec2f& size) {
            const Vec2f a(area.a[0] * size[0], area.a[1] * size[1]),
                b(area.b[0] * size[0], area.b[1] * size[1]);
            // The squared axes are the eigenvalues of aaᵀ + bbᵀ.
            const float xx = product(a[0], a[0]) + product(b[0], b[0]),
                        yy = product(a[1], a[1]) + product(b[1], b[1]),
                        xy = product(a[0], a[1]) + product(b[0], b[1]);
            const float middle = (xx + yy) / 2, half = (xx - yy) / 2;
            const float spread = std::sqrt(product(half, half) + product(xy, xy));
            constexpr float side = 1.7724539f;  // √π: the square has the area of a disc of radius 1
            length = side * std::sqrt(middle + spread);
            width = side * std::sqrt(std::max(0.0f, middle - spread));
            along = half > 0 ? Vec2f(half + spread, xy) : Vec2f(xy, spread - half);
            const float norm = std::sqrt(length2(along));
            along = norm > 0 ? along / norm : Vec2f(1, 0);
            across = {-along[1], along[0]};
        }
    };

    /// The mean of the texels of an image that each texel of half its size covers. Where a side is odd, a
    /// texel covers parts of others.
    template <class Texel>
    static Level halved(int width, int height, const Texel& texel) {
        Level level{std::max(1, width / 2), std::max(1, height / 2), {}};
        level.texels.reserve(static_cast<std::size_t>(level.width) * static_cast<std::size_t>(level.height));
        for (int y = 0; y < level.height; ++y)
            for (int x = 0; x < level.width; ++x) {
                Rgba sum{{}, 0};
                for_each_covered(y, height, level.height, [&](int row, float down) {
                    for_each_covered(x, width, level.width, [&](int column, float across) {
                        sum = sum + texel(column, row) * (down * across);
                    });
                });
                level.texels.push_back(sum);
            }
        return level;
    }
    /// Calls `visit(j, share)` for each of `size` parts of a side that part i of `parts` overlaps, with its
    /// share of that part.
    template <class Visit>
    static void for_each_covered(int i, int size, int parts, const Visit& visit) {
        // In units of which a whole side has size · parts.
        const std::int64_t low = std::int64_t{i} * size, high = low + size;
        for (std::int64_t j = low / parts; j * parts < high; ++j) {
            const std::int64_t overlap = std::min(high, (j + 1) * parts) - std::max(low, j * parts);
            visit(static_cast<int>(j), static_cast<float>(overlap) / static_cast<float>(size));
        }
    }
    /// A lookup where texels have this width, in texels of the texture, at least 1.
    Rgba between_levels(const Texture& texture, const Vec2f& coordinate, float width,
                        const Vec2f& extent) const {
        // The width is 2^k · (1 + share).
        int k;
        const float share = 2 * std::frexp(width, &k) - 1;
        --k;
        const auto last = static_cast<int>(levels_.size());
        if (k >= last) return at_level(texture, coordinate, last, extent);
        const Rgba fine = at_level(texture, coordinate, k, extent);
        return share == 0 ? fine : fine * (1 - share) + at_level(texture, coordinate, k + 1, extent) * share;
    }
    Rgba at_level(const Texture& texture, const Vec2f& coordinate, int k, const Vec2f& extent) const {
        if (k == 0) return texture.at(coordinate, extent);
        const Level& level = levels_[static_cast<std::size_t>(k - 1)];
        return detail::bilinear(
            detail::in_texels(coordinate[0], level.width), detail::in_texels(coordinate[1], level.height),
            {1, 1}, [&](std::int64_t i) { return detail::wrapped(i, level.width, texture.wrap_s); },
            [&](std::int64_t i) { return detail::wrapped(i, level.height, texture.wrap_t); },
            [&](int column, int row) { return level.at(column, row); });
    }

    std::vector<Level> levels_;  // from half the size down to one texel
};

}  // namespace hedgerow
