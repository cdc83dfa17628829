/// Triangles copied into blocks of eight, as rows of coordinates: a leaf of a wide BVH is one block, tested
/// at once.
#pragma once

#include <algorithm>
#include <bit>
#include <limits>
#include <tuple>

#include <hedgerow/base/stored.h>
#include <hedgerow/geometry/box_rows.h>
#include <hedgerow/geometry/lanes.h>
#include <hedgerow/primitives/triangle_mesh.h>

namespace hedgerow {

/// Row (axis, corner) stores that coordinate of eight triangles. Unused places are NaN, which no test
/// accepts (zeros would be hit by every ray through the origin). 320 bytes (float), of which a test reads
/// 288, and the ids only of triangles that it meets.
template <std::floating_point T>
struct alignas(64) TriangleBlock {
    static constexpr int size = 8;
    /// Bytes of a block that hold data. The padding after them, up to the next cache line, is not set.
    static constexpr std::size_t used = size * (9 * sizeof(T) + sizeof(PrimitiveId));

    T corner[3][3][size];  // by axis, then corner
    PrimitiveId id[size];
};
static_assert(sizeof(TriangleBlock<float>) == 320);

/// The blocks of a structure's items: eight places each, some of them empty.
template <std::floating_point T>
class TriangleBlocks {
public:
    using Scalar = T;
    using Block = TriangleBlock<T>;
    static constexpr int dimension = 3;

    TriangleBlocks() = default;
    explicit TriangleBlocks(std::size_t places) : blocks_((places + Block::size - 1) / Block::size) {}
    /// Takes blocks that are already filled.
    explicit TriangleBlocks(Stored<Block> blocks) : blocks_(std::move(blocks)) {}

    std::size_t size() const { return blocks_.size(); }
    std::size_t bytes() const { return blocks_.bytes(); }
    const Block* data() const { return blocks_.data(); }

    void set(std::size_t i, const Triangle<T, 3>& t, PrimitiveId id) {
        Block& b = blocks_[i / Block::size];
        const std::size_t lane = i % Block::size;
        for (int k = 0; k < 3; ++k)
            b.corner[k][0][lane] = t.a[k], b.corner[k][1][lane] = t.b[k], b.corner[k][2][lane] = t.c[k];
        b.id[lane] = id;
    }
    /// Leaves a place empty.
    void clear(std::size_t i) {
        const auto nothing = Vec<T, 3>::all(std::numeric_limits<T>::quiet_NaN());
        set(i, {nothing, nothing, nothing}, no_primitive);
    }

    /// The box around the triangles of a block.
    Box<T, 3> bounds(std::size_t block) const {
        Box<T, 3> box;
        for (int k = 0; k < 3; ++k) std::tie(box.low[k], box.high[k]) = extremes<T>(blocks_[block].corner[k]);
        return box;
    }

    /// Tests the triangles of a leaf: the filter of the watertight test on four at once, then `meet_exactly`
    /// on each that passes. It works for any query and scalar. The kernels (engine/kernels.h) are faster.
    template <class Query>
    Flow test_leaf(const RayProbe<T, 3>& probe, const Leaf& leaf, Query& query) const {
        const WatertightRay<T>& ray = probe.watertight();
        const Block& b = blocks_[leaf.first / Block::size];
        for (std::uint32_t k = 0; k < leaf.count; k += 4) {
            const unsigned places = (1u << std::min(4u, leaf.count - k)) - 1;
            for (unsigned left = may_meet(ray, b, k) & places; left != 0; left &= left - 1) {
                const std::uint32_t i = k + static_cast<std::uint32_t>(std::countr_zero(left));
                const auto corner = [&](int c) {
                    return shear(ray, Vec<T, 3>(b.corner[0][c][i], b.corner[1][c][i], b.corner[2][c][i]));
                };
                const auto m = meet_exactly(ray, corner(0), corner(1), corner(2));
                if (m && query.offer({m->t, m->u, m->v, b.id[i]}) == Flow::stop) return Flow::stop;
            }
        }
        return Flow::go_on;
    }

    /// Calls f(triangle, id) for the triangles of a leaf whose boxes overlap a region. Four are compared at
    /// once.
    template <class F>
    void for_each_overlapping(const Leaf& leaf, const Box<T, 3>& region, F f) const {
        using L = Lanes<T>;
        const Block& b = blocks_[leaf.first / Block::size];
        for (std::uint32_t k = 0; k < leaf.count; k += 4) {
            unsigned left = (1u << std::min(4u, leaf.count - k)) - 1;
            for (int axis = 0; axis < 3; ++axis) {
                const auto& rows = b.corner[axis];
                const L p = L::load(rows[0] + k), q = L::load(rows[1] + k), r = L::load(rows[2] + k);
                left &= less_equal(min(min(p, q), r), L::all(region.high[axis]));
                left &= less_equal(L::all(region.low[axis]), max(max(p, q), r));
            }
            for (; left != 0; left &= left - 1) {
                const std::uint32_t i = k + static_cast<std::uint32_t>(std::countr_zero(left));
                const auto corner = [&](int c) {
                    return Vec<T, 3>(b.corner[0][c][i], b.corner[1][c][i], b.corner[2][c][i]);
                };
                f(Triangle<T, 3>{corner(0), corner(1), corner(2)}, b.id[i]);
            }
        }
    }

private:
    /// Bit i is set if the ray's line may meet triangle k + i, for i < 4. Higher bits mean nothing.
    static unsigned may_meet(const WatertightRay<T>& ray, const Block& b, std::uint32_t k) {
        using L = Lanes<T>;
        L x[3], y[3];
        for (int c = 0; c < 3; ++c) {
            const auto from_origin = [&](int axis) {
                return L::load(b.corner[axis][c] + k) - L::all(ray.origin[axis]);
            };
            const L z = from_origin(ray.kz);
            x[c] = from_origin(ray.kx) - L::all(ray.shear_x) * z;
            y[c] = from_origin(ray.ky) - L::all(ray.shear_y) * z;
        }
        unsigned left_of = 0, right_of = 0;
        for (int c = 0; c < 3; ++c) {
            const int next = (c + 1) % 3, previous = (c + 2) % 3;
            const L edge = edge_filter(x[previous], y[previous], x[next], y[next]);
            left_of |= edge.negative(), right_of |= edge.positive();
        }
        return ~(left_of & right_of);
    }

    Stored<Block> blocks_;
};

/// Copies the triangles of `items`, eight places a block, in their order. A place of `no_primitive` stays
/// empty. O(items).
template <std::floating_point T>
TriangleBlocks<T> pack_blocks(const TriangleMeshView<T>& mesh, std::span<const PrimitiveId> items,
                              Executor& executor) {
    TriangleBlocks<T> blocks(items.size());
    executor.for_each_piece(items.size(), 4096, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            if (items[i] == no_primitive)
                blocks.clear(i);
            else
                blocks.set(i, mesh.triangle(items[i]), items[i]);
        }
    });
    return blocks;
}

}  // namespace hedgerow
