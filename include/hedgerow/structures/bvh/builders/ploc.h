/// Parallel locally-ordered clustering (Meister and Bittner, TVCG 2018): clusters lie along a Morton curve,
/// each looks at `radius` neighbours to either side for the one with which its box would be least, and those
/// that choose each other are joined; again, until one is left. Each pair is looked at once, as in PLOC++
/// (Benthin, Drabinski, Tessari, Dittebrandt, 2022).
///
/// O(n · radius) in all where rounds join a part of the clusters, as they do of any usual scene. Where nearly
/// all would choose one that chose another (boxes that nest), neighbours on the curve are joined two by two
/// instead, so that rounds stay O(log n). A larger radius costs time and brings little beyond 10: on the
/// scenes of docs/design/003-builders.md 16 lowers the SAH cost by 1% more.
#pragma once

#include <hedgerow/structures/bvh/builders/joined.h>

namespace hedgerow {

template <std::floating_point T, int D>
class Ploc {
public:
    static constexpr int max_radius = 128;

    Ploc(std::span<const Reference<T, D>> references, int radius, Executor& executor)
        : executor_(executor),
          radius_(static_cast<std::size_t>(std::clamp(radius, 1, max_radius))),
          tree_(references, executor),
          count_(references.size()),
          clusters_(count_),
          next_(count_),
          choice_(count_) {}

    /// Of at least one primitive.
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
        blocks.each(executor_, [&](std::size_t, std::size_t begin, std::size_t end) { choose(begin, end); });
        std::vector<std::uint32_t> before(blocks.number());
        std::uint32_t joins = count_joins(blocks, before);
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

    /// Of equally near neighbours i prefers the one whose number differs from its own in the lowest bits. So
    /// clusters that are all alike pair up, and some two always choose each other.
    void choose(std::size_t begin, std::size_t end) {
        T best[block];
        std::size_t differs[block];
        std::fill_n(best, end - begin, std::numeric_limits<T>::infinity());
        std::fill_n(differs, end - begin, std::numeric_limits<std::size_t>::max());
        const auto consider = [&](std::size_t i, std::size_t bits,
                                  T d) {  // without branches: none is guessed
            T& least = best[i - begin];
            std::size_t& with = differs[i - begin];
            const bool nearer = (d < least) | ((d == least) & (bits < with));
            least = nearer ? d : least;
            with = nearer ? bits : with;
        };
        for (std::size_t i = begin - std::min(begin, radius_); i < end; ++i) {
            const LaneBox<T> box = clusters_[i].box;
            const std::size_t last = std::min(count_, i + radius_ + 1);
            for (std::size_t j = std::max(i + 1, begin); j < last; ++j) {
                const T d = distance<D>(box, clusters_[j].box);
                if (i >= begin) consider(i, i ^ j, d);
                if (j < end) consider(j, i ^ j, d);
            }
        }
        for (std::size_t i = begin; i < end; ++i)
            choice_[i] = static_cast<std::uint32_t>(i ^ differs[i - begin]);
    }

    bool mutual(std::size_t i) const { return choice_[i] != i && choice_[choice_[i]] == i; }

    bool joins_into_earlier(std::size_t i) const { return choice_[i] < i && mutual(i); }

    /// Fills in how many clusters before each block are joined into an earlier one, and returns how many are.
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
