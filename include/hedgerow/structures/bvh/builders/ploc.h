/// Parallel locally-ordered clustering (Meister and Bittner, TVCG 2018): clusters lie along a Morton curve.
/// Each cluster chooses, of `radius` neighbours to either side, the one with which its common box is least,
/// and two clusters that choose each other are joined. Rounds repeat until one cluster is left. Within a
/// block the distance of each pair is computed once, as in PLOC++ (Benthin, Drabinski, Tessari, Dittebrandt,
/// 2022).
///
/// O(n · radius) in all where each round joins a share of the clusters, as in any usual scene. Where nearly
/// all clusters would choose one that chose another (nested boxes), neighbours on the curve are joined two by
/// two instead, so that there are O(log n) rounds. A larger radius costs time and
/// brings nothing beyond 10 (docs/design/003-builders.md).
#pragma once

#include <hedgerow/structures/bvh/builders/build.h>
#include <hedgerow/structures/bvh/builders/joined.h>

namespace hedgerow {

template <std::floating_point T, int D>
class Ploc {
public:
    Ploc(std::span<const Reference<T, D>> references, int radius, Executor& executor)
        : executor_(executor),
          radius_(static_cast<std::size_t>(std::clamp(radius, 1, BvhOptions::most_search_radius))),
          tree_(references, executor),
          count_(references.size()),
          clusters_(count_),
          next_(count_),
          choice_(count_) {}

    /// The tree over all primitives, of which there must be at least one.
    const JoinedTree<T, D>& build() {
        executor_.for_each_piece(count_, 4096, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) clusters_[i] = tree_.cluster(i);
        });
        while (count_ > 1) round();
        tree_.set_root(clusters_[0]);
        return tree_;
    }

private:
    static constexpr std::size_t block = 1024;
    static constexpr std::size_t few = 256;

    void round() {
        const Blocks blocks{count_, block};
        // Let each cluster choose its nearest neighbour.
        blocks.each(executor_, [&](std::size_t, std::size_t begin, std::size_t end) { choose(begin, end); });
        std::vector<std::uint32_t> before(blocks.number());
        std::uint32_t joins = count_joins(blocks, before);
        // Pair neighbours on the curve if the choices join too few clusters.
        if (joins < count_ / 16 && count_ > few) {
            for (std::uint32_t i = 0; i < count_; ++i) choice_[i] = (i ^ 1u) < count_ ? i ^ 1u : i;
            joins = count_joins(blocks, before);
        }
        blocks.each(executor_,
                    [&](std::size_t b, std::size_t begin, std::size_t end) { join(begin, end, before[b]); });
        count_ -= joins;
        executor_.advance(joins);
        clusters_.swap(next_);
    }

    /// Sets the choice of each cluster i in [begin, end) to its nearest neighbour. Of equally near ones it is
    /// the one whose index differs from i in the lowest bits. So clusters that are all alike pair up, and
    /// some two clusters always choose each other.
    void choose(std::size_t begin, std::size_t end) {
        T best[block];
        std::size_t differs[block];
        std::fill_n(best, end - begin, std::numeric_limits<T>::infinity());
        std::fill_n(differs, end - begin, std::numeric_limits<std::size_t>::max());
        // Keep the nearer neighbour, without branches, which could not be predicted.
        const auto consider = [&](std::size_t i, std::size_t bits, T d) {
            T& least = best[i - begin];
            std::size_t& with = differs[i - begin];
            const bool nearer = (d < least) | ((d == least) & (bits < with));
            least = nearer ? d : least;
            with = nearer ? bits : with;
        };
        // Compute the distance of each pair once, for whichever of the two are in the block.
        for (std::size_t i = begin - std::min(begin, radius_); i < end; ++i) {
            const LaneBox<T> box = clusters_[i].box;
            const std::size_t last = std::min(count_, i + radius_ + 1);
            for (std::size_t j = std::max(i + 1, begin); j < last; ++j) {
                const T d = distance<D>(box, clusters_[j].box);
                if (i >= begin) consider(i, i ^ j, d);
                if (j < end) consider(j, i ^ j, d);
            }
        }
        // Turn the bits in which indices differ back into indices.
        for (std::size_t i = begin; i < end; ++i)
            choice_[i] = static_cast<std::uint32_t>(i ^ differs[i - begin]);
    }

    bool mutual(std::size_t i) const { return choice_[i] != i && choice_[choice_[i]] == i; }

    bool joins_into_earlier(std::size_t i) const { return choice_[i] < i && mutual(i); }

    /// Sets before[b] to the number of clusters before block b that are joined into an earlier one, and
    /// returns the number in all blocks.
    std::uint32_t count_joins(const Blocks& blocks, std::vector<std::uint32_t>& before) {
        blocks.each(executor_, [&](std::size_t b, std::size_t begin, std::size_t end) {
            before[b] = 0;
            for (std::size_t i = begin; i < end; ++i) before[b] += joins_into_earlier(i);
        });
        std::uint32_t all = 0;
        for (auto& b : before) b = std::exchange(all, all + b);
        return all;
    }

    void join(std::size_t begin, std::size_t end, std::uint32_t joined_before) {
        std::size_t to = begin - joined_before;
        for (std::size_t i = begin; i < end; ++i) {
            if (joins_into_earlier(i)) continue;
            next_[to++] = mutual(i) ? tree_.join(clusters_[i], clusters_[choice_[i]]) : clusters_[i];
        }
    }

    Executor& executor_;
    std::size_t radius_;
    JoinedTree<T, D> tree_;
    std::size_t count_;
    BareVector<Cluster<T>> clusters_, next_;
    BareVector<std::uint32_t> choice_;
};

template <std::floating_point T, int D>
BuildTree<T, D> build_ploc(std::span<const Reference<T, D>> references, const SahOptions& options, int radius,
                           Executor& executor) {
    if (references.empty()) return {};
    Ploc<T, D> ploc(references, radius, executor);
    return Collapse<T, D>(options, executor)
        .build(ploc.build(), static_cast<std::uint32_t>(references.size()));
}

}  // namespace hedgerow
