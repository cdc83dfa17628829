/// The triangles that may cover samples of each tile of a picture, front to back.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

#include <hedgerow/base/bare_vector.h>
#include <hedgerow/parallel/blocks.h>
#include <hedgerow/parallel/executor.h>
#include <hedgerow/primitives/triangle_mesh.h>
#include <hedgerow/render/visibility/pixel_bounds.h>
#include <hedgerow/render/visibility/raster_kernels.h>

namespace hedgerow {

/// Triangles of a view, how a picture sees them, and the kernels for them, or null for the plain loops.
template <class Triangles>
struct TrianglesSeen {
    const Triangles& triangles;
    const PixelBounds& bounds;
    const RasterKernels* kernels;

    static constexpr bool in_lanes = std::is_same_v<Triangles, TriangleMeshView<float>>;

    /// Finds where the triangles from `first` on are seen.
    void find_sights(std::size_t first, std::span<Sight> sights) const {
        std::fill(sights.begin(), sights.end(), Sight{uncut, 0});
        if constexpr (in_lanes)
            if (kernels != nullptr) kernels->bounds(bounds, triangles, first, sights);
        for (std::size_t i = 0; i < sights.size(); ++i)
            if (sights[i].box == uncut) sights[i] = bounds.of(triangles.triangle(first + i));
    }
};

/// Lists up to a million triangles by tile, in one go or, where that would take more than about 60 MiB, in
/// several. Threads list blocks of triangles at the same time; a sort by counting joins what they listed.
class TileLists {
public:
    TileLists(int width, int height)
        : columns_((width + tile_side - 1) / tile_side),
          size_(columns_ * ((height + tile_side - 1) / tile_side)),
          picture_{0, 0, width - 1, height - 1} {}

    /// The number of tiles.
    int size() const { return size_; }
    PixelBox pixels(int tile) const { return pixels_at(tile % columns_, tile / columns_); }
    /// The list of a tile. Front to back only if it is long.
    std::span<const TileTriangle> front_to_back(int tile) {
        const auto t = static_cast<std::size_t>(tile);
        const std::span<TileTriangle> list(listed_.data() + begins_[t], begins_[t + 1] - begins_[t]);
        order_front_to_back(list);
        return list;
    }
    /// Starts with `count` triangles from `first` on, of which none is listed yet.
    void start(std::size_t first, std::size_t count) {
        first_ = first, blocks_ = {count, std::size_t(1) << 17};
        if (parts_.size() < blocks_.number()) parts_.resize(blocks_.number());
        for (std::size_t b = 0; b < blocks_.number(); ++b)
            parts_[b].next = b * blocks_.size, parts_[b].outside = 0;
    }
    /// Lists triangles that have not been listed. False if some are left.
    template <class Triangles>
    bool fill(const TrianglesSeen<Triangles>& seen, Executor& threads) {
        const auto tiles = static_cast<std::size_t>(size_);
        const std::size_t most = entries_at_once / std::max<std::size_t>(blocks_.number(), 1);
        places_.resize(blocks_.number() * tiles);
        blocks_.each(threads, [&](std::size_t block, std::size_t, std::size_t end) {
            Part& part = parts_[block];
            part.clear(std::span(places_).subspan(block * tiles, tiles), most);
            std::array<Sight, pieces> sights;
            while (part.next < end && part.size < part.most) {
                const std::size_t count = std::min(pieces, end - part.next);
                const std::span<Sight> some(sights.data(), count);
                seen.find_sights(first_ + part.next, some);
                list(seen, some, part);
                part.next += count;
            }
        });
        join(threads);
        for (std::size_t b = 0; b < blocks_.number(); ++b)
            if (parts_[b].next < std::min(blocks_.count, (b + 1) * blocks_.size)) return false;
        return true;
    }
    /// Of the triangles that were listed since the start, how many have a box without samples.
    std::uint64_t outside() const {
        std::uint64_t sum = 0;
        for (std::size_t b = 0; b < blocks_.number(); ++b) sum += parts_[b].outside;
        return sum;
    }
    std::size_t bytes() const {
        const auto of = [](const auto& list) { return list.capacity() * sizeof(list[0]); };
        std::size_t parts = of(parts_);
        for (const Part& part : parts_) parts += of(part.entries);
        return parts + of(places_) + of(begins_) + of(listed_);
    }

private:
    // Entries of triangles in tiles that are sorted together, and triangles whose sights are found together.
    static constexpr std::size_t entries_at_once = std::size_t(5) << 19, pieces = 256;

    struct InTile {
        std::uint32_t tile;
        TileTriangle triangle;
    };
    /// What a block lists: entries, whose places after the last are free, and the number of them by tile.
    struct Part {
        BareVector<InTile> entries;
        std::size_t size = 0, most = 0;  ///< most: with as many the list is full
        std::span<std::uint32_t> counts;
        std::size_t next = 0;  ///< the next triangle that is not listed
        std::uint64_t outside = 0;

        void clear(std::span<std::uint32_t> by_tile, std::size_t when_full) {
            size = 0, most = when_full, counts = by_tile;
            std::ranges::fill(counts, 0u);
        }
        void make_room(std::size_t more) {
            if (entries.size() >= size + more) return;
            const std::size_t room = std::max(size + more, std::min(2 * entries.size(), most));
            entries.reserve(room);  // no more, which resize alone would take
            entries.resize(room);
        }
        /// Adds an entry, if it counts, without a branch: whether it does cannot be predicted.
        void add(std::uint32_t tile, const TileTriangle& triangle, bool counts_too = true) {
            entries[size] = {tile, triangle};
            size += counts_too, counts[tile] += counts_too;
        }
        std::span<const InTile> listed() const { return std::span(entries).first(size); }
    };

    std::uint32_t number(int column, int row) const {
        return static_cast<std::uint32_t>(row * columns_ + column);
    }
    PixelBox pixels_at(int column, int row) const {
        const int left = column * tile_side, top = row * tile_side;
        return {left, top, std::min(left + tile_side - 1, picture_.right),
                std::min(top + tile_side - 1, picture_.bottom)};
    }
    /// Sorts what blocks listed by tile, and within a tile by block.
    void join(Executor& threads) {
        const auto tiles = static_cast<std::size_t>(size_);
        begins_.resize(tiles + 1);
        std::uint32_t before = 0;
        for (std::size_t tile = 0; tile < tiles; ++tile) {
            begins_[tile] = before;
            for (std::size_t b = 0; b < blocks_.number(); ++b)
                before += std::exchange(places_[b * tiles + tile], before);
        }
        begins_[tiles] = before;
        listed_.resize(before);
        blocks_.each(threads, [&](std::size_t block, std::size_t, std::size_t) {
            std::uint32_t* const places = places_.data() + block * tiles;
            for (const InTile& entry : parts_[block].listed()) listed_[places[entry.tile]++] = entry.triangle;
        });
    }

    /// The tiles that a box of pixels meets, which is in the picture.
    static PixelBox tiles_that_meet(const PixelBox& box) {
        const auto tile = [](int pixel) {
            return static_cast<int>(static_cast<unsigned>(pixel) / tile_side);
        };
        return {tile(box.left), tile(box.top), tile(box.right), tile(box.bottom)};
    }
    /// Lists the next triangles of a part, of which these are the sights.
    template <class Triangles>
    void list(const TrianglesSeen<Triangles>& seen, std::span<const Sight> sights, Part& part) const {
        constexpr int few = 4;  // tiles: to look at them in vain takes less than to find the edges
        std::array<std::uint32_t, pieces> inside, large;
        std::size_t insides = 0, larges = 0;
        for (std::size_t i = 0; i < sights.size(); ++i) {  // without a branch, as above
            const PixelBox& box = sights[i].box;
            inside[insides] = static_cast<std::uint32_t>(i);
            insides += static_cast<std::size_t>((box.left <= box.right) & (box.top <= box.bottom));
        }
        part.outside += sights.size() - insides;
        part.make_room(few * insides);
        for (std::size_t k = 0; k < insides; ++k) {
            const Sight& sight = sights[inside[k]];
            const PixelBox tiles = tiles_that_meet(sight.box);
            if (tiles.width() * tiles.height() > few)
                large[larges++] = inside[k];
            else
                for (int y = tiles.top; y <= tiles.bottom; ++y)
                    for (int x = tiles.left; x <= tiles.right; ++x)
                        part.add(number(x, y), {part.next + inside[k], sight.box, x, y, sight.nearest});
        }
        list_large(seen, sights, std::span(large.data(), larges), part);
    }
    /// The same for large ones, by their edges.
    template <class Triangles>
    void list_large(const TrianglesSeen<Triangles>& seen, std::span<const Sight> sights,
                    std::span<const std::uint32_t> large, Part& part) const {
        const std::size_t first = first_ + part.next;
        if constexpr (TrianglesSeen<Triangles>::in_lanes)
            if (seen.kernels != nullptr) {
                std::array<PixelBox, pieces> boxes;
                std::array<TriangleFunctions, pieces> functions;
                for (std::size_t k = 0; k < large.size(); ++k) {
                    const PixelBox tiles = tiles_that_meet(sights[large[k]].box);
                    boxes[k] = {tiles.left * tile_side, tiles.top * tile_side,
                                (tiles.right + 1) * tile_side - 1, (tiles.bottom + 1) * tile_side - 1};
                }
                seen.kernels->functions(seen.bounds, seen.triangles, first, large, boxes.data(),
                                        functions.data());
                for (std::size_t k = 0; k < large.size(); ++k) {
                    const Sight& sight = sights[large[k]];
                    const std::size_t n = part.next + large[k];
                    if (tiles_that_meet(sight.box).size() > 16)
                        list_by_functions<true>(seen.bounds.frame(), functions[k], n, sight, part);
                    else
                        list_by_functions<false>(seen.bounds.frame(), functions[k], n, sight, part);
                }
                return;
            }
        for (const std::uint32_t i : large) {
            const PixelEdges edges(seen.bounds, seen.triangles.triangle(first + i));
            const Sight& sight = sights[i];
            const PixelBox tiles = tiles_that_meet(sight.box);
            part.make_room(tiles.size());
            for (int y = tiles.top; y <= tiles.bottom; ++y)
                for (int x = tiles.left; x <= tiles.right; ++x)
                    part.add(number(x, y), {part.next + i, sight.box, x, y, sight.nearest},
                             !edges.exclude(pixels_at(x, y)));
        }
    }
    /// The most that a function is in the tile with its middle at (x, y).
    struct Most {
        float right, down, constant;

        Most(const float (&of)[3], float reach)
            : right(of[0]), down(of[1]), constant(of[2] + reach * (std::abs(of[0]) + std::abs(of[1]))) {}
        float operator()(float x, float y) const { return right * x + (down * y + constant); }
    };

    // Of many tiles, most are out.
    template <bool many>
    void list_by_functions(const PixelBounds::Frame& frame, const TriangleFunctions& triangle,
                           std::size_t triangle_number, const Sight& sight, Part& part) const {
        constexpr float infinity = std::numeric_limits<float>::infinity();
        const float reach = (tile_side - 1 + static_cast<float>(frame.most - frame.least)) / 2;
        const Most edges[3] = {{triangle.edge[0], reach},
                               {triangle.edge[1], reach},
                               {triangle.edge[2], reach}},
                   nearness(triangle.nearness, reach);
        const PixelBox tiles = tiles_that_meet(sight.box);
        part.make_room(tiles.size());
        constexpr int half = tile_side / 2;
        const auto from_middle = [](int tile, int first, int last) {
            return static_cast<float>((2 * tile - first - last) * half);
        };
        for (int row = tiles.top; row <= tiles.bottom; ++row) {
            const float y = from_middle(row, tiles.top, tiles.bottom);
            for (int column = tiles.left; column <= tiles.right; ++column) {
                const float x = from_middle(column, tiles.left, tiles.right);
                const float least = std::min(edges[0](x, y), std::min(edges[1](x, y), edges[2](x, y)));
                const bool out = least < -1;
                if constexpr (many)
                    if (out) continue;
                const float near = nearness(x, y) + triangle.slack;
                const float before = near > 0 ? (1 - 0x1p-20f) / near : infinity;
                const float forward = frame.parallel ? -near : before;
                part.add(number(column, row),
                         {triangle_number, sight.box, column, row, std::max(sight.nearest, forward)}, !out);
            }
        }
    }
    /// Orders triangles by their nearest points in steps: a sort by counting. A few are left as they are.
    static void order_front_to_back(std::span<TileTriangle> list) {
        constexpr std::size_t few = 8, steps = 32;
        if (list.size() <= few) return;
        static thread_local std::vector<TileTriangle> given;
        static thread_local std::vector<std::uint8_t> step;
        given.assign(list.begin(), list.end());
        step.resize(given.size());
        constexpr float largest = std::numeric_limits<float>::max();
        float least = largest, most = 0;
        for (const TileTriangle& t : given) {
            const float nearest = std::min(t.nearest, largest);
            least = std::min(least, nearest), most = std::max(most, nearest);
        }
        const float scale = most > least ? (steps - 1) / (most - least) : 0;
        std::array<std::uint32_t, steps + 1> places{};
        for (std::size_t i = 0; i < given.size(); ++i) {
            step[i] = static_cast<std::uint8_t>((std::min(given[i].nearest, most) - least) * scale);
            ++places[step[i] + 1u];
        }
        for (std::size_t k = 0; k < steps; ++k) places[k + 1] += places[k];
        for (std::size_t i = 0; i < given.size(); ++i) list[places[step[i]]++] = given[i];
    }

    int columns_, size_;
    PixelBox picture_;
    std::size_t first_ = 0;  // of the triangles
    Blocks blocks_{0, 1};
    std::vector<Part> parts_;  // by block
    BareVector<std::uint32_t> places_, begins_;
    BareVector<TileTriangle> listed_;
};

}  // namespace hedgerow
