/// How an octree of points grows: points are sorted along a Morton curve, then cells are divided a level at a
/// time.
#pragma once

#include <array>
#include <bit>
#include <vector>

#include <hedgerow/parallel/radix_sort.h>
#include <hedgerow/structures/orthtree/cell_codes.h>
#include <hedgerow/structures/references.h>
#include <hedgerow/walks/orthants.h>

namespace hedgerow {

/// The nodes of an octree of points, and the points by leaf. Each inner node has a group of 2^D children, and
/// a range of the items: all points below it. Groups are in the order of levels, and in a level along the
/// curve.
template <int D>
struct PointCells {
    static constexpr unsigned width = 1u << D;
    struct alignas(8 * width) Group {  // octree: a cache line
        std::array<OrthantNode, width> child;
    };
    struct Range {
        std::uint32_t first, count;
    };

    OrthantNode root;
    std::vector<Group> groups;
    std::vector<Range> ranges;  ///< of each group's parent
    std::vector<PrimitiveId> items;
    int depth = 0;  ///< levels
};

/// Which cells of points are leaves: those of at most `leaf_size` points, and those `max_depth` levels below
/// the root. So are cells whose points are all in one place, and cells that T cannot divide.
struct PointCellLimits {
    std::uint32_t leaf_size;
    int max_depth;
};

/// Each point has a key: the code of its cell, as far as a key has room for it, and its id in the low bits.
/// Keys are sorted, so the points of a cell are a range, and its orthants are found in the keys (Warren and
/// Salmon, A parallel hashed oct-tree N-body algorithm, 1993). Where the bits of the codes end in a cell that
/// is to be divided, its points get new keys by the cells inside of it. O(n log n), mostly O(n); 16 bytes a
/// point while it runs. The result is the same for every executor.
template <class P>
class PointGrowth {
public:
    using T = typename P::Scalar;
    static constexpr int D = P::dimension;
    using Cells = PointCells<D>;

    /// `root` must contain all points (root.h). There are fewer than 2^31 of them, and at least one.
    PointGrowth(const P& set, const PointCellLimits& limits, Executor& executor)
        : set_(set),
          limits_(limits),
          executor_(executor),
          keys_(set.size()),
          id_bits_(static_cast<int>(std::bit_width(set.size() - 1))) {}

    Cells grow(const Cube<T, D>& root) {
        const CellCodes<T, D> codes(root, 64 - id_bits_);
        executor_.expect(set_.size());
        executor_.for_each_piece(set_.size(), worth_a_task, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) keys_[i] = key(codes, static_cast<PrimitiveId>(i));
            executor_.advance(end - begin);
        });
        sort_by_first_bits(keys_, executor_, [&](std::size_t begin, std::size_t end) { sort(begin, end); });
        divide_all({root, 0, static_cast<std::uint32_t>(set_.size()), 0, 0, codes.levels()});
        cells_.items.resize(keys_.size());
        executor_.for_each_piece(keys_.size(), worth_a_task, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) cells_.items[i] = id(keys_[i]);
        });
        return std::move(cells_);
    }

private:
    /// A cell that is to be divided: its points, where its node is (as NodeIds count), and how many levels of
    /// its points' codes lead to it and into it.
    struct Open {
        Cube<T, D> cell;
        std::uint32_t first, count;
        NodeId node;
        int levels_above, levels_below;
    };

    std::uint64_t key(const CellCodes<T, D>& codes, PrimitiveId i) const {
        if (codes.levels() == 0) return i;
        return codes.code(set_.bounds(i).low) << (64 - D * codes.levels()) | i;
    }
    PrimitiveId id(std::uint64_t key) const {
        return static_cast<PrimitiveId>(key & ((std::uint64_t(1) << id_bits_) - 1));
    }
    void sort(std::size_t begin, std::size_t end) { std::sort(keys_.data() + begin, keys_.data() + end); }

    /// Divides cells from the root down. All cells of a level are divided at once, in blocks, whose results
    /// are joined in order.
    void divide_all(const Open& root) {
        cells_.root = {0, root.count};
        std::vector<Open> level;
        if (is_divided(root, 0)) level.push_back(root);
        for (cells_.depth = 1; !level.empty(); ++cells_.depth) {
            const std::size_t before = cells_.groups.size();
            if (before + level.size() > most_groups)
                throw InputError("an octree or quadtree has at most 2^32 nodes: give it larger leaves");
            cells_.groups.resize(before + level.size());
            cells_.ranges.resize(before + level.size());
            const Blocks blocks{level.size(), 64};
            std::vector<std::vector<Open>> below(blocks.number());
            blocks.each(executor_, [&](std::size_t b, std::size_t begin, std::size_t end) {
                executor_.look();
                for (std::size_t i = begin; i < end; ++i)
                    divide(level[i], static_cast<std::uint32_t>(before + i), below[b]);
            });
            level.clear();
            for (const auto& some : below) level.insert(level.end(), some.begin(), some.end());
        }
    }
    bool is_divided(const Open& e, int depth) const {
        return e.count > limits_.leaf_size && depth < limits_.max_depth && e.cell.divisible() &&
               !are_in_one_place(e.first, e.count);
    }
    /// Whether some points, whose keys are sorted, all coincide.
    bool are_in_one_place(std::uint32_t first, std::uint32_t count) const {
        if ((keys_[first] ^ keys_[first + count - 1]) >> id_bits_ != 0) return false;
        const auto place = set_.bounds(id(keys_[first])).low;
        for (std::uint32_t i = first + 1; i < first + count; ++i)
            if (set_.bounds(id(keys_[i])).low != place) return false;
        return true;
    }

    /// Makes the group of a cell's children. Appends those that are to be divided too.
    void divide(Open e, std::uint32_t group, std::vector<Open>& below) {
        if (e.levels_below == 0) key_anew(e);
        cells_.ranges[group] = {e.first, e.count};
        auto& children = cells_.groups[group].child;
        const int shift = 64 - D * (e.levels_above + 1);
        unsigned occupied = 0;
        for (std::uint32_t first = e.first, end = e.first + e.count, last; first < end; first = last) {
            const auto i = static_cast<unsigned>(keys_[first] >> shift) & (Cells::width - 1);
            last = end_of_orthant(first, end, shift);
            occupied |= 1u << i;
            children[i] = {first, last - first};
            const Open child{e.cell.orthant(i),  first,
                             last - first,       1 + Cells::width * group + i,
                             e.levels_above + 1, e.levels_below - 1};
            if (is_divided(child, cells_.depth)) below.push_back(child);
        }
        node(e.node) = OrthantNode::inner_over(group, occupied);
    }
    /// Gives the points of a cell keys by the cells inside of it.
    void key_anew(Open& e) {
        const CellCodes<T, D> codes(e.cell, 64 - id_bits_);
        for (std::uint32_t i = e.first; i < e.first + e.count; ++i) keys_[i] = key(codes, id(keys_[i]));
        sort(e.first, e.first + e.count);
        e.levels_above = 0, e.levels_below = codes.levels();
    }
    /// The end of the keys from `first` on that are in its orthant: few are looked at one by one, many by
    /// bisection.
    std::uint32_t end_of_orthant(std::uint32_t first, std::uint32_t end, int shift) const {
        const std::uint64_t* keys = keys_.data();
        if (end - first <= 64) return static_cast<std::uint32_t>(end_of_alike(keys, first, end, shift));
        const std::uint64_t orthant = keys[first] >> shift;
        return static_cast<std::uint32_t>(
            std::partition_point(keys + first, keys + end,
                                 [&](std::uint64_t key) { return key >> shift == orthant; }) -
            keys);
    }
    OrthantNode& node(NodeId n) {
        return n == 0 ? cells_.root : cells_.groups[(n - 1) / Cells::width].child[(n - 1) % Cells::width];
    }

    static constexpr std::size_t most_groups = 0xFFFFFFFFu / Cells::width;

    const P& set_;
    PointCellLimits limits_;
    Executor& executor_;
    BareVector<std::uint64_t> keys_;
    int id_bits_;
    Cells cells_;
};

}  // namespace hedgerow
