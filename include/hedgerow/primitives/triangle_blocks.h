/// Triangles copied in blocks of eight, as rows: what a leaf of a wide BVH is tested in at once.
#pragma once

#include <limits>

#include <hedgerow/primitives/concepts.h>
#include <hedgerow/stored.h>

namespace hedgerow {

/// Row (axis, corner) has that coordinate of eight triangles. What is not filled is NaN, which no test
/// accepts (zeros would be hit by every ray through the origin). 320 bytes (float), of which 288 are read.
template <std::floating_point T>
struct alignas(64) TriangleBlock {
    static constexpr int size = 8;
    /// Bytes, of sizeof: to the next line of the cache nothing is set.
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
    /// Blocks that were filled before.
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

    /// One by one, for any query and scalar. What is fast is the kernels (structures/bvh/wide/kernels.h).
    template <class Query>
    Flow test_leaf(const RayProbe<T, 3>& probe, const Leaf& leaf, Query& query) const {
        const Block& b = blocks_[leaf.first / Block::size];
        for (std::uint32_t i = 0; i < leaf.count; ++i) {
            const auto corner = [&](int c) {
                return Vec<T, 3>(b.corner[0][c][i], b.corner[1][c][i], b.corner[2][c][i]);
            };
            const auto m = meet(probe.watertight(), Triangle<T, 3>{corner(0), corner(1), corner(2)});
            if (m && query.offer({m->t, m->u, m->v, b.id[i]}) == Flow::stop) return Flow::stop;
        }
        return Flow::go_on;
    }

private:
    Stored<Block> blocks_;
};

}  // namespace hedgerow
