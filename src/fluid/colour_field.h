/// The colour field of points, sampled on blocks of a lattice that exist only near points.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <string>
#include <tuple>
#include <vector>

#include <hedgerow/base/error.h>
#include <hedgerow/base/strided.h>
#include <hedgerow/geometry/lanes.h>
#include <hedgerow/geometry/vec.h>
#include <hedgerow/parallel/blocks.h>
#include <hedgerow/parallel/sort.h>
#include <hedgerow/primitives/concepts.h>

namespace hedgerow::detail {

/// The cells and vertices along each side of a block. With 8 × 8 vertices a layer's signs fit 64 bits. A
/// block owns its cells and the lower corner of each cell. Vertices that blocks share are sampled by each of
/// them, with the same bits.
inline constexpr int block_cells = 7, block_vertices = 8;

/// The number of a block along each axis, ordered by rows along x.
struct BlockPlace {
    std::int64_t z, y, x;

    friend bool operator==(const BlockPlace&, const BlockPlace&) = default;
    friend bool operator<(const BlockPlace& a, const BlockPlace& b) {
        return std::tie(a.z, a.y, a.x) < std::tie(b.z, b.y, b.x);
    }
    /// The number of a block's first vertex along an axis.
    std::int64_t first(int axis) const { return block_cells * (axis == 0 ? x : axis == 1 ? y : z); }
    /// The number of the block that owns a vertex or a cell, along one axis.
    static std::int64_t of(std::int64_t vertex) {
        return vertex >= 0 ? vertex / block_cells : -((block_cells - 1 - vertex) / block_cells);
    }
};

/// The field at the vertices of a block, x first.
using BlockValues = std::array<float, block_vertices * block_vertices * block_vertices>;

/// The sum over points of weight · spacing³ · W(distance), where W(d) = 315 / (64π radius³) · (1 −
/// d²/radius²)³ within the radius. W needs no root. Lengths are in cells, so vertices lie at whole
/// numbers.
class ColourField {
public:
    /// Throws InputError for the first bad point.
    template <std::floating_point T>
    ColourField(const Strided<Vec<T, 3>>& points, double cell, double radius, double spacing,
                Executor& executor)
        : radius_(radius / cell),
          per_radius_(1 / radius_),
          norm_(static_cast<float>(315 / (64 * std::numbers::pi * std::pow(radius / spacing, 3)))) {
        const std::size_t n = points.size();
        std::vector<InBlock> in_blocks(n);
        for (std::size_t i = 0; i < n; ++i) {
            const Vec3d p = in_cells(points[i], i, cell);
            in_blocks[i] = {{home(p[2]), home(p[1]), home(p[0])}, static_cast<PrimitiveId>(i)};
        }
        sort_watched(in_blocks.begin(), in_blocks.end(), executor);
        places_.resize(n), weights_.assign(n, 1);
        for (std::size_t i = 0; i < n; ++i) {
            places_[i] = in_cells(points[in_blocks[i].id], in_blocks[i].id, cell);
            if (i == 0 || in_blocks[i].block != homes_.back().block)
                homes_.push_back({in_blocks[i].block, i});
        }
        homes_.push_back({{}, n});
    }

    /// Raises the weights of points where the field is less than `least`, by as much as it is less. The field
    /// at a point is interpolated between vertices.
    void raise_drops(double least, Executor& executor) {
        std::vector<float> raised(weights_.size());
        executor.for_each_piece(home_count(), 16, [&](std::size_t begin, std::size_t end) {
            BlockValues values;
            for (std::size_t h = begin; h < end; ++h) {
                sample(homes_[h].block, values);
                for (std::size_t i = homes_[h].first; i < homes_[h + 1].first; ++i) {
                    const double value = interpolated(values, homes_[h].block, places_[i]);
                    raised[i] = value > 0 && value < least ? static_cast<float>(least / value) : 1.0f;
                }
                executor.advance(homes_[h + 1].first - homes_[h].first);
            }
        });
        weights_.swap(raised);
    }

    /// The blocks, ascending, that own all vertices where the field may be more than 0, and all cells and
    /// edges at these.
    std::vector<BlockPlace> blocks() const {
        std::vector<BlockPlace> near;
        for (std::size_t h = 0; h < home_count(); ++h) {
            Vec3d low = places_[homes_[h].first], high = low;
            for (std::size_t i = homes_[h].first; i < homes_[h + 1].first; ++i)
                low = min(low, places_[i]), high = max(high, places_[i]);
            const auto first = [&](int k) { return BlockPlace::of(whole(std::ceil(low[k] - radius_)) - 1); };
            const auto last = [&](int k) { return BlockPlace::of(whole(std::floor(high[k] + radius_))); };
            for (std::int64_t z = first(2); z <= last(2); ++z)
                for (std::int64_t y = first(1); y <= last(1); ++y)
                    for (std::int64_t x = first(0); x <= last(0); ++x) near.push_back({z, y, x});
        }
        std::sort(near.begin(), near.end());
        near.erase(std::unique(near.begin(), near.end()), near.end());
        return near;
    }

    /// Samples the field at a block's vertices. Each vertex adds points in the order of their blocks, and
    /// within a block in the order of the caller's array. Distances are rounded the same way in all blocks.
    void sample(const BlockPlace& block, BlockValues& values) const {
        values.fill(0);
        const auto below = whole(std::ceil(radius_ / block_cells)),
                   above = whole(std::floor(radius_ / block_cells)) + 1;
        for (std::int64_t z = block.z - below; z <= block.z + above; ++z)
            for (std::int64_t y = block.y - below; y <= block.y + above; ++y) {
                const BlockPlace first{z, y, block.x - below}, last{z, y, block.x + above};
                for (std::size_t h = home_from(first); h < home_count() && !(last < homes_[h].block); ++h)
                    for (std::size_t i = homes_[h].first; i < homes_[h + 1].first; ++i) add(i, block, values);
            }
    }

    /// How many points lie in the cells of a block.
    std::size_t points_in(const BlockPlace& block) const {
        const std::size_t h = home_from(block);
        return h < home_count() && homes_[h].block == block ? homes_[h + 1].first - homes_[h].first : 0;
    }

private:
    struct InBlock {
        BlockPlace block;
        PrimitiveId id;
        friend bool operator<(const InBlock& a, const InBlock& b) {
            return std::tie(a.block, a.id) < std::tie(b.block, b.id);
        }
    };
    /// A block with points, and the first of these in the sorted arrays.
    struct Home {
        BlockPlace block;
        std::size_t first;
    };

    static std::int64_t whole(double x) { return static_cast<std::int64_t>(x); }
    static std::int64_t home(double x) { return BlockPlace::of(whole(std::floor(x))); }

    template <std::floating_point T>
    static Vec3d in_cells(const Vec<T, 3>& point, std::size_t i, double cell) {
        constexpr double most_cells = 0x1p40;
        bool good = true, near = true;
        for (int k = 0; k < 3; ++k) good &= std::abs(point[k]) <= largest_coordinate<T>;
        const Vec3d p = Vec3d(point) / cell;
        for (int k = 0; k < 3; ++k) near &= std::abs(p[k]) <= most_cells;
        if (good && near) return p;
        throw InputError("point " + std::to_string(i) +
                         (good ? " lies more than 2^40 cells from the origin. Leave it out, move all points "
                                 "to the origin, or give a greater spacing"
                               : std::string(" has a coordinate that is NaN, infinite or beyond ") +
                                     (sizeof(T) == 4 ? "±2^60" : "±2^480") + ". Leave it out"));
    }

    std::size_t home_count() const { return homes_.size() - 1; }
    /// The number of the first block with points that is not before `block`.
    std::size_t home_from(const BlockPlace& block) const {
        const auto at = std::lower_bound(homes_.begin(), homes_.end() - 1, block,
                                         [](const Home& h, const BlockPlace& b) { return h.block < b; });
        return static_cast<std::size_t>(at - homes_.begin());
    }

    /// Adds the share of point i to the values of a block.
    void add(std::size_t i, const BlockPlace& block, BlockValues& values) const {
        const Vec3d p = places_[i];
        // The vertices along each axis that the point may be near to. Skip the point if there are none.
        int first[3], last[3];
        for (int k = 0; k < 3; ++k) {
            const double local = p[k] - static_cast<double>(block.first(k));
            if (local <= -radius_ || local >= block_vertices - 1 + radius_) return;
            first[k] = static_cast<int>(std::max(local - radius_, 0.0));
            last[k] = static_cast<int>(std::min(local + radius_, block_vertices - 1.0));
        }
        // The squares of the distances along each axis, in radii.
        float squares[3][block_vertices];
        for (int k = 0; k < 3; ++k)
            for (int v = 0; v < block_vertices; ++v) {
                const auto away =
                    static_cast<float>((p[k] - static_cast<double>(block.first(k) + v)) * per_radius_);
                squares[k][v] = away * away;
            }
        using L = Lanes<float>;
        const L low = L::load(squares[0]), high = L::load(squares[0] + 4), none = L::all(0);
        const L weight = L::all(norm_ * weights_[i]);
        for (int z = first[2]; z <= last[2]; ++z)
            for (int y = first[1]; y <= last[1]; ++y) {
                const L rest = L::all(1 - (squares[1][y] + squares[2][z]));
                float* const row = values.data() + block_vertices * (block_vertices * z + y);
                const L a = max(none, rest - low), b = max(none, rest - high);
                (L::load(row) + weight * a * a * a).store(row);
                (L::load(row + 4) + weight * b * b * b).store(row + 4);
            }
    }

    /// The field at a place in the cells of a block, linear along each axis between vertices.
    static double interpolated(const BlockValues& values, const BlockPlace& block, const Vec3d& p) {
        int lower[3];
        double share[3];
        for (int k = 0; k < 3; ++k) {
            const double local = p[k] - static_cast<double>(block.first(k));
            lower[k] = std::clamp(static_cast<int>(local), 0, block_cells - 1);
            share[k] = local - lower[k];
        }
        double sum = 0;
        for (int corner = 0; corner < 8; ++corner) {
            double weight = 1;
            int at = 0;
            for (int k = 2; k >= 0; --k) {
                const int upper = corner >> k & 1;
                weight *= upper != 0 ? share[k] : 1 - share[k];
                at = block_vertices * at + lower[k] + upper;
            }
            sum += product(weight, static_cast<double>(values[static_cast<std::size_t>(at)]));
        }
        return sum;
    }

    double radius_, per_radius_;  // in cells
    float norm_;                  // spacing³ · W(0)
    std::vector<Vec3d> places_;   // in cells, sorted by blocks
    std::vector<float> weights_;  // of the sorted points
    std::vector<Home> homes_;     // blocks with points, and an end
};

}  // namespace hedgerow::detail
