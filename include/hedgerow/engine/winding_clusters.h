/// The clusters of a wide BVH: their centers, extents and moments, in the rows that expansions read.
#pragma once

#include <unordered_map>
#include <vector>

#include <hedgerow/engine/wide_tree.h>
#include <hedgerow/engine/winding_parts.h>
#include <hedgerow/parallel/executor.h>
#include <hedgerow/queries/winding_terms.h>

namespace hedgerow {

namespace detail {

struct alignas(64) WindingLine {
    double numbers[8];
};

/// Computes the rows of all nodes of a tree (see WindingRow). `Parts` tells of each primitive its `mass`,
/// its `reach` and `eighth` about a center, and adds its moments (see WindingTriangles).
template <std::floating_point T, class Parts>
class WindingClusters {
public:
    WindingClusters(const WideTree<T, 3>& tree, const Parts& parts, Executor& executor)
        : tree_(&tree),
          parts_(&parts),
          width_(static_cast<std::size_t>(tree.nodes.width())),
          clusters_(tree.nodes.size() * width_),
          rows_((clusters_.size() * WindingRow::count + 7) / 8) {
        if (tree.empty()) return;
        std::fill_n(rows_.data(), rows_.size(), WindingLine{});
        find_centers(executor);
        executor.for_each_piece(clusters_.size(), 64, [&](std::size_t begin, std::size_t end) {
            for (std::size_t slot = begin; slot < end; ++slot) find_extent(slot);
        });
        compute_moments(executor);
    }
    Stored<WindingLine> take_rows() { return std::move(rows_); }

private:
    struct Sums {
        double area = 0, count = 0;
        Vec3d by_area, by_count;

        Sums& operator+=(const Sums& s) {
            area += s.area, count += s.count, by_area += s.by_area, by_count += s.by_count;
            return *this;
        }
    };
    struct Cluster {
        Sums sums;
        Vec3d center;
        double reach = 0, eighth = 0;
    };
    /// Clusters are at least so large, in units of the greatest coordinate: a single dipole has no extent.
    static constexpr double least_reach = 0x1p-120;

    WideChild child(std::size_t slot) const {
        return tree_->nodes.child(slot / width_, static_cast<int>(slot % width_));
    }
    template <class F>
    void for_each_of_leaf(std::size_t slot, WideChild leaf, F f) const {
        const std::uint32_t count = tree_->nodes.count(slot / width_, static_cast<int>(slot % width_));
        for (std::uint32_t i = 0; i < count; ++i) f(tree_->items[wide_leaf_size * leaf.block() + i]);
    }
    template <class F>
    void for_each_below(std::size_t slot, F f) const {
        const WideChild c = child(slot);
        if (c.empty()) return;
        if (c.leaf()) return for_each_of_leaf(slot, c, f);
        for (std::size_t i = 0; i < width_; ++i) for_each_below(c.word * width_ + i, f);
    }

    /// The centers are the centroids by area, or by number where there is no area.
    void find_centers(Executor& executor) {
        executor.for_each_piece(clusters_.size(), 512, [&](std::size_t begin, std::size_t end) {
            for (std::size_t slot = begin; slot < end; ++slot)
                if (const WideChild c = child(slot); !c.empty() && c.leaf())
                    for_each_of_leaf(slot, c, [&](PrimitiveId id) {
                        const WindingMass m = parts_->mass(id);
                        clusters_[slot].sums += Sums{m.area, 1, m.middle * m.area, m.middle};
                    });
        });
        for (std::size_t slot = clusters_.size(); slot-- > 0;) {  // parents come before their children
            const WideChild c = child(slot);
            if (c.empty()) continue;
            Sums& sums = clusters_[slot].sums;
            if (!c.leaf())
                for (std::size_t i = 0; i < width_; ++i) sums += clusters_[c.word * width_ + i].sums;
            clusters_[slot].center = sums.area > 0 ? sums.by_area / sums.area : sums.by_count / sums.count;
        }
    }
    void find_extent(std::size_t slot) {
        Cluster& c = clusters_[slot];
        double reach = least_reach;
        for_each_below(slot, [&](PrimitiveId id) { reach = std::max(reach, parts_->reach(id, c.center)); });
        c.reach = reach * (1 + 0x1p-50);
        for_each_below(slot, [&](PrimitiveId id) { c.eighth += parts_->eighth(id, c.center, c.reach); });
    }

    /// The moments of leaves are those of their primitives; others are summed from their children's. Each
    /// subtree below some level is a task.
    void compute_moments(Executor& executor) {
        std::vector<std::size_t> level{0};  // nodes
        std::vector<std::size_t> tasks;     // slots of their children
        for (constexpr std::size_t enough = 128; level.size() < enough;) {
            std::vector<std::size_t> below;
            for (const std::size_t node : level)
                for (std::size_t i = 0; i < width_; ++i)
                    if (const WideChild c = child(node * width_ + i); !c.empty() && !c.leaf())
                        below.push_back(c.word);
            if (below.empty()) break;
            level = std::move(below);
        }
        for (const std::size_t node : level)
            for (std::size_t i = 0; i < width_; ++i) tasks.push_back(node * width_ + i);
        std::vector<WindingMoments> moments(tasks.size());
        executor.for_each_piece(tasks.size(), 1, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) moments[i] = moments_of(tasks[i]);
        });
        for (std::size_t i = 0; i < tasks.size(); ++i) done_.emplace(tasks[i], &moments[i]);
        for (std::size_t i = 0; i < width_; ++i) moments_of(i);
    }
    WindingMoments moments_of(std::size_t slot) {
        if (const auto found = done_.find(slot); found != done_.end()) return *found->second;
        WindingMoments moments;
        const WideChild c = child(slot);
        if (c.empty()) return moments;
        const Cluster& cluster = clusters_[slot];
        if (c.leaf())
            for_each_of_leaf(slot, c, [&](PrimitiveId id) {
                parts_->add_moments(id, cluster.center, cluster.reach, moments);
            });
        else
            for (std::size_t i = c.word * width_; i < (c.word + 1) * width_; ++i) {
                if (child(i).empty()) continue;
                const WindingMoments part = moments_of(i);
                moments.add_part(part, (clusters_[i].center - cluster.center) / cluster.reach,
                                 clusters_[i].reach / cluster.reach);
            }
        double* const row =
            rows_.data()->numbers + (slot - slot % width_) * WindingRow::count + slot % width_;
        WindingRow::write(row, static_cast<int>(width_), cluster.center, cluster.reach, cluster.sums.area,
                          cluster.eighth, moments);
        return moments;
    }

    const WideTree<T, 3>* tree_;
    const Parts* parts_;
    std::size_t width_;
    std::vector<Cluster> clusters_;
    Stored<WindingLine> rows_;
    std::unordered_map<std::size_t, const WindingMoments*> done_;  // by slot
};

template <std::floating_point T, class Parts>
Stored<WindingLine> winding_rows(const WideTree<T, 3>& tree, const Parts& parts, Executor& executor) {
    return WindingClusters<T, Parts>(tree, parts, executor).take_rows();
}

}  // namespace detail
}  // namespace hedgerow
