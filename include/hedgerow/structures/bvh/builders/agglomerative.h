/// Agglomerative clustering (Walter, Bala, Kulkarni, Pingali, RT 2008): starts from single primitives and
/// repeatedly joins the two clusters whose common box has the least area. This is the approximate form that
/// scales (AAC; Gu, He, Fatahalian, Blelloch, HPG 2013): a recursion along the bits of a Morton curve, in
/// which a part of n primitives hands only f(n) = δ^(½+ε)/2 · n^(½−ε) clusters up, so that only near clusters
/// are ever compared. δ = 20 and ε = 0.1 are the paper's high-quality setting. O(n) but for the sort. The top
/// joins run in one thread; they are a small part of the work.
///
/// Of equally near pairs the smaller one is joined first, so that clusters that are all alike form no chain.
/// Nested boxes do form chains; `Collapse` cuts a chain where it grows too deep.
#pragma once

#include <cmath>

#include <hedgerow/structures/bvh/builders/joined.h>
#include <hedgerow/structures/bvh/builders/lbvh.h>

namespace hedgerow {

/// A list of clusters and the nearest neighbour of each. O(count²) while few clusters share their nearest
/// neighbour, as in space.
template <std::floating_point T, int D>
class NearestPairs {
public:
    explicit NearestPairs(std::vector<Cluster<T>>& clusters) : clusters_(clusters) {}

    /// Joins the nearest two clusters until `target` are left.
    void reduce(std::size_t target, JoinedTree<T, D>& tree) {
        if (clusters_.size() <= target) return;
        find_all();
        while (clusters_.size() > target) {
            const std::size_t a = first_to_join(tree), b = nearest_[a].index;
            join(std::min(a, b), std::max(a, b), tree);
        }
    }

private:
    struct Nearest {
        T distance = std::numeric_limits<T>::infinity();
        std::size_t index = 0, differs = 0;

        /// Keeps the nearer neighbour. Of equally near ones it keeps the one whose index differs from `own`
        /// in the lowest bits, so that clusters that are all alike pair up.
        void consider(T d, std::size_t i, std::size_t own) {
            if (d < distance || (d == distance && (i ^ own) < differs)) *this = {d, i, i ^ own};
        }
    };
    std::size_t first_to_join(const JoinedTree<T, D>& tree) const {
        const auto size = [&](std::size_t i) {
            return tree.size(clusters_[i].node) + tree.size(clusters_[nearest_[i].index].node);
        };
        std::size_t least = 0;
        for (std::size_t i = 1; i < nearest_.size(); ++i) {
            const T d = nearest_[i].distance, best = nearest_[least].distance;
            if (d < best || (d == best && size(i) < size(least))) least = i;
        }
        return least;
    }
    T between(std::size_t i, std::size_t j) const { return distance<D>(clusters_[i].box, clusters_[j].box); }

    void find_all() {
        nearest_.assign(clusters_.size(), {});
        for (std::size_t i = 0; i < clusters_.size(); ++i)
            for (std::size_t j = i + 1; j < clusters_.size(); ++j) {
                const T d = between(i, j);
                nearest_[i].consider(d, j, i);
                nearest_[j].consider(d, i, j);
            }
    }
    void find(std::size_t i) {
        nearest_[i] = {};
        for (std::size_t j = 0; j < clusters_.size(); ++j)
            if (j != i) nearest_[i].consider(between(i, j), j, i);
    }

    /// Joins clusters a and b, a < b. The new cluster takes a's place in the list, and the last cluster takes
    /// b's. Boxes only grow, so the new cluster is as near to another one as a or b was, or farther. If it is
    /// farther, that other cluster searches for its nearest neighbour again.
    void join(std::size_t a, std::size_t b, JoinedTree<T, D>& tree) {
        // Put the new cluster in a's place and the last one in b's.
        clusters_[a] = tree.join(clusters_[a], clusters_[b]);
        const std::size_t last = clusters_.size() - 1;
        clusters_[b] = clusters_[last];
        nearest_[b] = nearest_[last];
        clusters_.pop_back();
        nearest_.pop_back();
        // Compare each other cluster with the new one, and correct the indices of clusters that moved.
        nearest_[a] = {};
        lost_.clear();
        for (std::size_t i = 0; i < last; ++i) {
            if (i == a) continue;
            const T d = between(i, a);
            nearest_[a].consider(d, i, a);
            auto& near = nearest_[i];
            if (near.index == a || near.index == b) {
                near.index = a;
                if (d > near.distance) lost_.push_back(i);
            } else if (near.index == last) {
                near.index = b;
            }
        }
        // Search again for each cluster whose nearest neighbour is farther now.
        for (const std::size_t i : lost_) find(i);
    }

    std::vector<Cluster<T>>& clusters_;
    std::vector<Nearest> nearest_;
    std::vector<std::size_t> lost_;
};

template <std::floating_point T, int D>
class Agglomerative {
public:
    Agglomerative(std::span<const Reference<T, D>> references, Executor& executor)
        : tree_(references, executor), curve_(tree_.order()), executor_(executor) {}

    /// The tree over all primitives, of which there must be at least one.
    const JoinedTree<T, D>& build() {
        auto clusters = gather(curve_.root());
        NearestPairs<T, D>(clusters).reduce(1, tree_);
        tree_.set_root(clusters[0]);
        return tree_;
    }

private:
    using Part = typename MortonTree<T, D>::Node;
    static constexpr double few = 20, epsilon = 0.1;

    /// f(n) clusters: how many a part of n primitives hands up.
    static std::size_t handed_up(std::uint32_t n) {
        return static_cast<std::size_t>(
            std::max(1.0, std::pow(few, 0.5 + epsilon) / 2 * std::pow(n, 0.5 - epsilon)));
    }
    /// The clusters that a part of the curve hands up.
    std::vector<Cluster<T>> gather(Part part) {
        const std::uint32_t size = curve_.size(part);
        std::vector<Cluster<T>> clusters;
        // Gather single primitives from a small part, and clusters from the halves of a large one.
        if (size <= few) {
            for (std::uint32_t i = part.first; i < part.last; ++i) clusters.push_back(tree_.cluster(i));
        } else {
            const auto [left, right] = curve_.children(part);
            std::vector<Cluster<T>> second;
            if (size > worth_a_task) {
                executor_.both([&, l = left] { clusters = gather_task(l); },
                               [&, r = right] { second = gather_task(r); });
            } else {
                clusters = gather(left);
                second = gather(right);
            }
            clusters.insert(clusters.end(), second.begin(), second.end());
        }
        // Join the nearest of them.
        NearestPairs<T, D>(clusters).reduce(handed_up(size), tree_);
        return clusters;
    }

    std::vector<Cluster<T>> gather_task(Part part) {
        auto clusters = gather(part);
        if (curve_.size(part) <= worth_a_task) executor_.advance(curve_.size(part));
        return clusters;
    }

    JoinedTree<T, D> tree_;
    MortonTree<T, D> curve_;
    Executor& executor_;
};

template <std::floating_point T, int D>
BuildTree<T, D> build_agglomerative(std::span<const Reference<T, D>> references, const SahOptions& options,
                                    Executor& executor) {
    if (references.empty()) return {};
    Agglomerative<T, D> clustering(references, executor);
    return Collapse<T, D>(options, executor)
        .build(clustering.build(), static_cast<std::uint32_t>(references.size()));
}

}  // namespace hedgerow
