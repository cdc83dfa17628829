/// Points copied into blocks of eight, as rows of coordinates: a leaf of a wide BVH is one block, tested at
/// once.
#pragma once

#include <limits>
#include <tuple>
#include <utility>

#include <hedgerow/base/stored.h>
#include <hedgerow/geometry/box_rows.h>
#include <hedgerow/parallel/executor.h>
#include <hedgerow/primitives/point_cloud.h>

namespace hedgerow {

/// A row has a coordinate of eight points. Unused places are NaN, which is at no distance. 128 bytes (float,
/// in space): 16 a place.
template <std::floating_point T, int D>
struct alignas(64) PointBlock {
    static constexpr int size = 8;
    /// Bytes that hold data; padding follows.
    static constexpr std::size_t used = size * (D * sizeof(T) + sizeof(PrimitiveId));

    T at[D][size];
    PrimitiveId id[size];
};
static_assert(sizeof(PointBlock<float, 3>) == 128);

/// The blocks of a structure's items: eight places each, some of them empty.
template <std::floating_point T, int D>
class PointBlocks {
public:
    using Scalar = T;
    using Block = PointBlock<T, D>;
    static constexpr int dimension = D;

    PointBlocks() = default;
    explicit PointBlocks(Stored<Block> blocks) : blocks_(std::move(blocks)) {}
    explicit PointBlocks(std::size_t places) : blocks_((places + Block::size - 1) / Block::size) {}

    std::size_t size() const { return blocks_.size(); }
    std::size_t bytes() const { return blocks_.bytes(); }
    const Block* data() const { return blocks_.data(); }

    void set(std::size_t i, const Vec<T, D>& p, PrimitiveId id) {
        Block& b = blocks_[i / Block::size];
        for (int k = 0; k < D; ++k) b.at[k][i % Block::size] = p[k];
        b.id[i % Block::size] = id;
    }
    /// Leaves a place empty.
    void clear(std::size_t i) { set(i, Vec<T, D>::all(std::numeric_limits<T>::quiet_NaN()), no_primitive); }

    /// The box around the points of a block.
    Box<T, D> bounds(std::size_t block) const {
        Box<T, D> box;
        for (int k = 0; k < D; ++k)
            std::tie(box.low[k], box.high[k]) = extremes<T>({&blocks_[block].at[k], 1});
        return box;
    }

    /// Tests the points of a leaf one by one. It works for any query and scalar. The kernels
    /// (engine/kernels.h) are faster.
    template <class Query>
    Flow test_leaf(const PointProbe<T, D>& probe, const Leaf& leaf, Query& query) const {
        const Block& b = blocks_[leaf.first / Block::size];
        for (std::uint32_t i = 0; i < leaf.count; ++i) {
            Vec<T, D> p;
            for (int k = 0; k < D; ++k) p[k] = b.at[k][i];
            const auto foot = closest_point(probe.point(), p);
            if (query.offer({foot.distance2, b.id[i], foot.point}) == Flow::stop) return Flow::stop;
        }
        return Flow::go_on;
    }

private:
    Stored<Block> blocks_;
};

/// Copies the points of `items`, eight places a block, in their order. A place of `no_primitive` stays empty.
/// O(items).
template <std::floating_point T, int D>
PointBlocks<T, D> pack_blocks(const PointCloudView<T, D>& cloud, std::span<const PrimitiveId> items,
                              Executor& executor) {
    PointBlocks<T, D> blocks(items.size());
    executor.for_each_piece(items.size(), 4096, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            if (items[i] == no_primitive)
                blocks.clear(i);
            else
                blocks.set(i, cloud.point(items[i]), items[i]);
        }
    });
    return blocks;
}

}  // namespace hedgerow
