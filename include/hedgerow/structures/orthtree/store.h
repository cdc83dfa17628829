/// The memory of an orthtree's nodes and items: groups of children, and blocks of ids that grow and shrink.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <span>
#include <vector>

#include <hedgerow/base/error.h>
#include <hedgerow/walks/orthants.h>

namespace hedgerow {

/// All groups have one size, and a freed group is used again. A leaf's items are a block of one list. The
/// length of a block follows from its number of items (`capacity_for`), so it is not stored: up to 16 it is
/// the number itself, beyond that at most a fourth more. Freed blocks are used again for items of the same
/// length. When freed blocks make up half of the list, or freed groups half of all groups, everything in use
/// is copied to arrays of its size. So all of this costs O(1) an item, amortized.
template <int D>
class OrthantStore {
public:
    static constexpr unsigned width = 1u << D;
    struct alignas(8 * width) Group {  // octree: a cache line
        std::array<OrthantNode, width> child;
    };

    OrthantStore() { free_blocks_.fill(none); }

    static constexpr std::uint32_t capacity_for(std::uint32_t count) {
        if (count <= exact) return count;
        const std::uint32_t step = 1u << (std::bit_width(count - 1) - 3);
        return (count + step - 1) / step * step;
    }

    const Group& group(std::uint32_t g) const { return groups_[g]; }
    Group& group(std::uint32_t g) { return groups_[g]; }
    /// The number of groups, freed ones included. The children of a freed group are empty leaves.
    std::size_t group_count() const { return groups_.size(); }
    std::size_t groups_in_use() const { return groups_.size() - free_group_count_; }
    /// The list of all blocks. Unused words are `none`, but the first word of a free block is the next free
    /// block of its length.
    const std::vector<PrimitiveId>& list() const { return list_; }
    std::span<const PrimitiveId> items(OrthantNode leaf) const {
        return std::span(list_).subspan(leaf.first, leaf.count);
    }
    /// Words of four bytes in the groups and blocks that are in use.
    std::uint64_t words_in_use() const {
        return groups_in_use() * std::uint64_t(sizeof(Group) / 4) + list_.size() - free_words_;
    }
    std::size_t bytes() const {
        return groups_.capacity() * sizeof(Group) + list_.capacity() * sizeof(PrimitiveId);
    }

    std::uint32_t allocate_group() {
        if (free_group_ == none) {
            if (groups_.size() >= most_groups)
                throw InputError("an octree or quadtree has at most 2^32 nodes: give it larger leaves");
            make_room(groups_, 1);
            groups_.emplace_back();
            return static_cast<std::uint32_t>(groups_.size() - 1);
        }
        const std::uint32_t g = free_group_;
        free_group_ = groups_[g].child[0].first;
        --free_group_count_;
        groups_[g] = {};
        return g;
    }
    void free_group(std::uint32_t g) {
        groups_[g] = {};
        groups_[g].child[0].first = free_group_;
        free_group_ = g;
        ++free_group_count_;
    }

    OrthantNode make_leaf(std::span<const PrimitiveId> ids) {
        const auto count = static_cast<std::uint32_t>(ids.size());
        const OrthantNode leaf{allocate_block(capacity_for(count)), count};
        std::copy(ids.begin(), ids.end(), list_.begin() + leaf.first);
        return leaf;
    }
    void free_leaf(OrthantNode leaf) { free_block(leaf.first, capacity_for(leaf.count)); }
    /// The leaf with one item more. `capacity_for` tells whether its block grew.
    OrthantNode added(OrthantNode leaf, PrimitiveId id) {
        leaf = resized(leaf, leaf.count + 1);
        list_[leaf.first + leaf.count - 1] = id;
        return leaf;
    }
    /// The leaf without the item, or unchanged if it does not have the item. O(items).
    OrthantNode removed(OrthantNode leaf, PrimitiveId id) {
        const auto begin = list_.begin() + leaf.first, end = begin + leaf.count;
        const auto found = std::find(begin, end, id);
        if (found == end) return leaf;
        *found = *(end - 1);
        return resized(leaf, leaf.count - 1);
    }

    /// Copies a subtree from another store, depth first. Returns its root.
    OrthantNode graft(const OrthantStore& from, OrthantNode node) {
        if (!node.inner()) return make_leaf(from.items(node));
        const std::uint32_t g = allocate_group();
        for (unsigned i = 0; i < width; ++i) {
            const OrthantNode child = graft(from, from.group(node.first).child[i]);
            groups_[g].child[i] = child;
        }
        return OrthantNode::inner_over(g, node.occupied());
    }
    void reserve(std::size_t groups, std::size_t words) {
        groups_.reserve(groups_.size() + groups);
        list_.reserve(list_.size() + words);
    }
    void shrink_to_fit() {
        groups_.shrink_to_fit();
        list_.shrink_to_fit();
    }

    /// Copies everything in use to new arrays if at least half of the list (and 1024 words), or of the groups
    /// (and 64), is free.
    void tidy(OrthantNode& root) {
        const bool words_wait = free_words_ >= 1024 && free_words_ >= list_.size() / 2;
        const bool groups_wait = free_group_count_ >= 64 && free_group_count_ >= groups_.size() / 2;
        if (!words_wait && !groups_wait) return;
        OrthantStore tidied;
        tidied.reserve(groups_in_use(), list_.size() - free_words_);
        root = tidied.graft(*this, root);
        *this = std::move(tidied);
    }

private:
    static constexpr std::uint32_t none = 0xFFFFFFFFu;
    static constexpr std::uint32_t exact = 16;
    /// The most groups for which every child has a NodeId.
    static constexpr std::size_t most_groups = none / width;

    /// Numbers the lengths that a block may have: each up to 16, then four between powers of two.
    static constexpr std::size_t length_class(std::uint32_t capacity) {
        if (capacity <= exact) return capacity;
        const auto bits = static_cast<std::uint32_t>(std::bit_width(capacity - 1));
        return exact + 4 * (bits - 5) + (capacity >> (bits - 3)) - 4;
    }
    /// Reserves memory for `more` elements. A full array grows by an eighth: O(1) an element, amortized.
    template <class Array>
    static void make_room(Array& array, std::size_t more) {
        const std::size_t wanted = array.size() + more;
        if (wanted > array.capacity()) array.reserve(wanted + wanted / 8);
    }
    std::uint32_t allocate_block(std::uint32_t capacity) {
        if (capacity == 0) return 0;
        std::uint32_t& first_free = free_blocks_[length_class(capacity)];
        if (first_free == none) {
            if (list_.size() + capacity > none)
                throw InputError("an octree or quadtree holds at most 2^32 items: give it larger leaves");
            make_room(list_, capacity);
            list_.resize(list_.size() + capacity, none);
            return static_cast<std::uint32_t>(list_.size() - capacity);
        }
        const std::uint32_t block = first_free;
        first_free = list_[block];
        list_[block] = none;
        free_words_ -= capacity;
        return block;
    }
    void free_block(std::uint32_t block, std::uint32_t capacity) {
        if (capacity == 0) return;
        const auto begin = list_.begin() + block;
        std::fill(begin, begin + capacity, none);
        std::uint32_t& first_free = free_blocks_[length_class(capacity)];
        *begin = first_free;
        first_free = block;
        free_words_ += capacity;
    }
    OrthantNode resized(OrthantNode leaf, std::uint32_t count) {
        const std::uint32_t before = capacity_for(leaf.count), after = capacity_for(count);
        if (after == before) return {leaf.first, count};
        const OrthantNode moved{allocate_block(after), count};
        std::copy_n(list_.begin() + leaf.first, std::min(leaf.count, count), list_.begin() + moved.first);
        free_block(leaf.first, before);
        return moved;
    }

    std::vector<Group> groups_;
    std::vector<PrimitiveId> list_;
    std::uint32_t free_group_ = none;
    std::size_t free_group_count_ = 0;
    /// The first free block of each length. The first word of a free block is the next one.
    std::array<std::uint32_t, 128> free_blocks_;
    std::size_t free_words_ = 0;
};

}  // namespace hedgerow
