/// The choice of one of many lights by a tree over them (Conty Estevez & Kulla, HPG 2018): at each node the
/// child is chosen by what may arrive from it (light_bounds.h).
#pragma once

#include <algorithm>
#include <array>
#include <vector>

#include <hedgerow/parallel/ieee_executor.h>
#include <hedgerow/render/lighting/power_lights.h>
#include <hedgerow/structures/bvh/bvh.h>
#include <hedgerow/walks/fold.h>

namespace hedgerow {

/// Chooses among a list of emitters. Its answers depend on the list, the scene's bounds, the point, the
/// normal and the number, and on nothing else. Const use is thread-safe. Memory: about 200 bytes an emitter.
///
/// The sun and the environment are not in the tree: a fixed share of choices, by power, is theirs.
class LightTree {
public:
    /// `scene` bounds the surfaces, and says how much power the sun and the environment have. O(n log n).
    explicit LightTree(const Emitters& emitters, const Box3f& scene = {},
                       Executor& executor = serial_executor()) {
        double near_power = 0, far_power = 0;
        std::vector<double> far_powers;
        place_.resize(emitters.size());
        for (std::uint32_t i = 0; i < emitters.size(); ++i) {
            const double power = emitters.power(i, detail::radius_around(scene));
            const bool near = emitters.has_position(i);
            (near ? near_power : far_power) += power;
            auto& list = near ? near_ : far_;
            place_[i] = {near, static_cast<std::uint32_t>(list.size())};
            list.push_back(i);
            if (!near) far_powers.push_back(power);
        }
        far_table_ = CumulativeTable(far_powers);
        far_share_ = far_.empty()    ? 0
                     : near_.empty() ? 1
                                     : std::clamp(far_power / (far_power + near_power), 0.25, 0.75);
        if (!near_.empty()) build(emitters, executor);
    }

    /// Chooses an emitter by a number in [0, 1), which should have at least 32 random bits: emitters that are
    /// less probable than its last bit may be missed. The normal is the receiver's, of length 1: emitters
    /// that lie wholly below its horizon are not chosen. A normal of 0 is for receivers that light may reach
    /// from all sides. Returns nothing where no light can arrive. O(depth).
    LightChoice choose(const Vec3f& point, const Vec3f& normal, double u) const {
        double left = in_unit_interval(u);
        if (left < far_share_) {
            const TableChoice c = far_table_.choose(left / far_share_);
            return {far_[c.entry], detail::probability_in_float(product(far_share_, c.probability))};
        }
        if (near_.empty() || !(importance(bounds_[0], point, normal) > 0)) return {};
        left = in_unit_interval((left - far_share_) / (1 - far_share_));
        double probability = 1 - far_share_;
        NodeRef node = tree_.root();
        while (!node.leaf()) {
            const double first = share_of_first(node, point, normal);
            if (first < 0) return {};
            const int i = left < first ? 0 : 1;
            const double share = i == 0 ? first : 1 - first;
            left = in_unit_interval((i == 0 ? left : left - first) / share);
            probability = product(probability, share);
            node = tree_.child(node, i);
        }
        const auto at = static_cast<std::uint32_t>(left * node.count);
        return {near_[tree_.items()[node.first + at]], leaf_probability(probability, node.count)};
    }
    /// The probability with which `choose` chooses this emitter, in the same bits. O(depth).
    float probability(const Vec3f& point, const Vec3f& normal, std::uint32_t emitter) const {
        const auto [is_near, place] = place_[emitter];
        if (!is_near) return detail::probability_in_float(product(far_share_, far_table_.probability(place)));
        if (!(importance(bounds_[0], point, normal) > 0)) return 0;
        // Collect the way up, then multiply the shares on the way down, in the order of `choose`.
        std::array<NodeId, static_cast<std::size_t>(bvh_max_depth) + 1> way;
        std::size_t count = 0;
        for (NodeId id = leaves_[place]; id != 0; id = ids_[(id - 1) / 2]) way[count++] = id;
        double probability = 1 - far_share_;
        NodeRef node = tree_.root();
        while (count-- > 0) {
            const double first = share_of_first(node, point, normal);
            const int i = static_cast<int>((way[count] - 1) % 2);
            const double share = i == 0 ? first : 1 - first;
            if (first < 0 || !(share > 0)) return 0;
            probability = product(probability, share);
            node = tree_.child(node, i);
        }
        return leaf_probability(probability, node.count);
    }

private:
    struct Place {
        bool near;
        std::uint32_t at;  // in near_ or far_
    };
    /// The boxes of emitters, to build a tree over.
    struct Boxes {
        using Scalar = float;
        static constexpr int dimension = 3;
        const std::vector<LightBounds>& all;

        std::size_t size() const { return all.size(); }
        Box3f bounds(std::size_t i) const { return all[i].box; }
    };

    void build(const Emitters& emitters, Executor& executor) {
        std::vector<LightBounds> of_emitters;
        of_emitters.reserve(near_.size());
        for (const std::uint32_t i : near_) of_emitters.push_back(emitters.bounds(i));
        BvhOptions options;
        options.max_leaf_size = 1;
        in_ieee_mode([&] {
            IeeeExecutor threads(executor);
            tree_ = Bvh<float, 3>::build(Boxes{of_emitters}, options, threads);
        });
        bounds_ = fold(
            tree_,
            [&](const Leaf& leaf) {
                LightBounds all;
                for (std::uint32_t i = leaf.first; i < leaf.first + leaf.count; ++i)
                    all = merged(all, of_emitters[leaf.ids[i]]);
                return all;
            },
            [](const LightBounds& a, const LightBounds& b) { return merged(a, b); });
        leaves_.resize(near_.size());
        ids_.resize(tree_.leaf_count());
        note_places(tree_.root(), 0);
    }
    /// Notes the leaf of each emitter below a node, and the ids of inner nodes. The depth of the recursion is
    /// that of the tree.
    void note_places(NodeRef node, NodeId id) {
        if (node.leaf()) {
            for (std::uint32_t i = node.first; i < node.first + node.count; ++i)
                leaves_[tree_.items()[i]] = id;
            return;
        }
        ids_[node.first] = id;
        for (int i = 0; i < 2; ++i) note_places(tree_.child(node, i), Bvh<float, 3>::child_id(node, i));
    }

    /// The share of choices at an inner node that its first child has; less than 0 if no light can arrive
    /// from either child. A child from which light can arrive has at least 2^-20.
    double share_of_first(NodeRef node, const Vec3f& point, const Vec3f& normal) const {
        const double first = importance(bounds_[Bvh<float, 3>::child_id(node, 0)], point, normal);
        const double second = importance(bounds_[Bvh<float, 3>::child_id(node, 1)], point, normal);
        if (!(first > 0) && !(second > 0)) return -1;
        if (!(first > 0) || !(second > 0)) return first > 0 ? 1 : 0;
        return std::clamp(first / (first + second), 0x1p-20, 1 - 0x1p-20);
    }
    /// Emitters of one leaf are equally probable. A leaf has several only where the tree cannot part them.
    static float leaf_probability(double probability, std::uint32_t count) {
        return detail::probability_in_float(probability / count);
    }

    std::vector<std::uint32_t> near_, far_;  // emitters with a position, and others
    std::vector<Place> place_;               // of each emitter
    Bvh<float, 3> tree_;                     // over near_
    std::vector<LightBounds> bounds_;        // by node
    std::vector<NodeId> ids_;                // of inner nodes, by number
    std::vector<NodeId> leaves_;             // of near_
    CumulativeTable far_table_;
    double far_share_ = 0;
};

}  // namespace hedgerow
