/// The choice of one of many lights by a tree over them (Conty Estevez & Kulla, HPG 2018): at each node one
/// of four children is chosen by what may arrive from it (light_groups.h).
#pragma once

#include <algorithm>
#include <array>
#include <vector>

#include <hedgerow/parallel/ieee_executor.h>
#include <hedgerow/render/lighting/light_groups.h>
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
        lists_.resize(emitters.size());
        for (std::uint32_t i = 0; i < emitters.size(); ++i) {
            const double power = emitters.power(i, detail::radius_around(scene));
            const bool near = emitters.has_position(i);
            (near ? near_power : far_power) += power;
            auto& list = near ? near_ : far_;
            lists_[i] = {near, static_cast<std::uint32_t>(list.size())};
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
        if (near_.empty()) return {};
        left = in_unit_interval((left - far_share_) / (1 - far_share_));
        double probability = 1 - far_share_;
        Child child;  // the root first
        while (child.leaf_size == 0) {
            const Node& node = nodes_[child.first];
            const Weights weights = weights_at(node, point, normal);
            if (!(weights.sum > 0)) return {};
            const std::size_t i = weights.choose(left);
            probability = product(probability, weights.of[i] / weights.sum);
            child = node.children[i];
        }
        const auto at = static_cast<std::uint32_t>(left * child.leaf_size);
        return {near_[tree_.items()[child.first + at]], leaf_probability(probability, child.leaf_size)};
    }
    /// The probability with which `choose` chooses this emitter, in the same bits. O(depth).
    float probability(const Vec3f& point, const Vec3f& normal, std::uint32_t emitter) const {
        const auto [is_near, at] = lists_[emitter];
        if (!is_near) return detail::probability_in_float(product(far_share_, far_table_.probability(at)));
        // Collect the way up, then multiply the shares on the way down, in the order of `choose`.
        std::array<Place, static_cast<std::size_t>(bvh_max_depth) + 1> way;
        std::size_t count = 0;
        way[count++] = places_[at];
        while (way[count - 1] >= width) way[count] = nodes_[way[count - 1] / width].place, ++count;
        double probability = 1 - far_share_;
        while (true) {
            const Place place = way[--count];
            const Node& node = nodes_[place / width];
            const Weights weights = weights_at(node, point, normal);
            if (!(weights.of[place % width] > 0)) return 0;
            probability = product(probability, weights.of[place % width] / weights.sum);
            if (count == 0) return leaf_probability(probability, node.children[place % width].leaf_size);
        }
    }

private:
    static constexpr std::size_t width = LightGroups::width;

    /// A child of a node: its number times the width, plus the child's own.
    using Place = std::size_t;
    /// Node `first`; or a leaf: so many items of the binary tree from `first` on.
    struct Child {
        std::uint32_t first = 0, leaf_size = 0;
    };
    struct Node {
        LightGroups groups;
        std::array<Child, width> children;
        Place place = 0;  // in its parent
    };
    /// An emitter is in near_ or in far_.
    struct InList {
        bool near;
        std::uint32_t at;
    };
    /// What the children of a node are chosen by.
    struct Weights {
        LightGroups::Lanes of;
        double sum = 0;

        /// The child that a number in [0, 1) chooses. What it leaves of the number is in [0, 1), too.
        std::size_t choose(double& number) const {
            std::size_t i = 0, last = width - 1;
            while (!(of[last] > 0)) --last;
            double left = number * sum;
            while (i < last && left >= of[i]) left -= of[i++];
            number = in_unit_interval(left / of[i]);
            return i;
        }
    };
    /// A node of the binary tree, and its number.
    struct Binary {
        NodeRef node;
        NodeId id;
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
        const std::vector<LightBounds> bounds = fold(
            tree_,
            [&](const Leaf& leaf) {
                LightBounds all;
                for (std::uint32_t i = leaf.first; i < leaf.first + leaf.count; ++i)
                    all = merged(all, of_emitters[leaf.ids[i]]);
                return all;
            },
            [](const LightBounds& a, const LightBounds& b) { return merged(a, b); });
        places_.resize(near_.size());
        add_node(children_of({tree_.root(), 0}, bounds), 0, bounds);
    }
    using Children = std::vector<Binary>;
    /// Up to four nodes of the binary tree that part what is below one: of those there are, the one with the
    /// most light is opened.
    Children children_of(const Binary& parent, const std::vector<LightBounds>& bounds) const {
        Children parts{parent};
        while (parts.size() < width) {
            const auto light = [&](const Binary& b) { return b.node.leaf() ? -1 : bounds[b.id].intensity; };
            const auto most =
                std::max_element(parts.begin(), parts.end(),
                                 [&](const Binary& a, const Binary& b) { return light(a) < light(b); });
            if (most->node.leaf()) break;
            const Binary opened = *most;
            *most = child_of(opened, 0);
            parts.push_back(child_of(opened, 1));
        }
        return parts;
    }
    Binary child_of(const Binary& b, int i) const {
        return {tree_.child(b.node, i), Bvh<float, 3>::child_id(b.node, i)};
    }
    /// Adds a node with these children, and all below it. The depth of the recursion is that of the tree.
    void add_node(const Children& children, Place place, const std::vector<LightBounds>& bounds) {
        const std::size_t number = nodes_.size();
        nodes_.push_back({});
        nodes_[number].place = place;
        for (std::size_t i = 0; i < children.size(); ++i) {
            const auto& [node, id] = children[i];
            nodes_[number].groups.set(i, bounds[id]);
            const Place own = number * width + i;
            if (node.leaf()) {
                nodes_[number].children[i] = {node.first, node.count};
                for (std::uint32_t k = node.first; k < node.first + node.count; ++k)
                    places_[tree_.items()[k]] = own;
            } else {
                nodes_[number].children[i] = {static_cast<std::uint32_t>(nodes_.size()), 0};
                add_node(children_of(children[i], bounds), own, bounds);
            }
        }
    }

    /// What the children of a node are chosen by: their importance. A child from which light can arrive has
    /// at least 2^-20 of all.
    static Weights weights_at(const Node& node, const Vec3f& point, const Vec3f& normal) {
        Weights weights{node.groups.importances(point, normal)};
        double all = 0;
        for (const double w : weights.of) all += w;
        for (double& w : weights.of) {
            w = w > 0 ? std::max(w, all * 0x1p-20) : 0;
            weights.sum += w;
        }
        return weights;
    }
    /// Emitters of one leaf are equally probable. A leaf has several only where the tree cannot part them.
    static float leaf_probability(double probability, std::uint32_t count) {
        return detail::probability_in_float(probability / count);
    }

    std::vector<std::uint32_t> near_, far_;  // emitters with a position, and others
    std::vector<InList> lists_;              // of each emitter
    Bvh<float, 3> tree_;                     // over near_
    std::vector<Node> nodes_;                // of four children; the root is first
    std::vector<Place> places_;              // of near_
    CumulativeTable far_table_;
    double far_share_ = 0;
};

}  // namespace hedgerow
