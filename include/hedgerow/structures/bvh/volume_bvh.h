/// A BVH whose bounding volume is a parameter: a study structure beside the default of boxes (bvh.h).
#pragma once

#include <hedgerow/structures/bvh/bvh.h>
#include <hedgerow/structures/bvh/volumes/region.h>
#include <hedgerow/structures/bvh/volumes/volume.h>
#include <hedgerow/structures/cells.h>

namespace hedgerow {

struct VolumeBvhOptions : BvhOptions {
    Volume volume = Volume::obb;

    /// Lists the options (option.h). Walks are always ordered and culled.
    template <class Option>
    void list(Option& option) {
        list_volume(option, volume);
        list_of_build(option);
    }
    template <class Option>
    static void list_volume(Option& option, Volume& volume) {
        option("volume", volume, volume_names, "what nodes are bounded by; each dimension has some of these");
    }
};

/// The tree is built with boxes, by any builder of the Bvh. Around each child another volume is then fitted
/// (Weghorst, Hooper and Greenberg 1984 weigh how tight a volume is against what its test costs). A volume
/// contains the corners of primitives whose answers lie on them (triangles, segments, points), the corners of
/// the boxes of other primitives, and around these the margin that answers may err by (cells.h).
///
/// Walks are always ordered and culled; the Bvh shows what these bring. The kind of volume is chosen at run
/// time, and every test branches on it: that costs some nanoseconds, and saves compiling every query for
/// every volume. Tests are in double. Memory: a node is 16 bytes for its two child references, and two
/// volumes (bytes in space, float): sphere 16, cylinder 36, obb 60, kdop 4k, hull 16 a face and 8. Build:
/// that of the tree, then serially O(n · depth), times some 50 µs a node for hulls.
template <std::floating_point T, int D>
class VolumeBvh {
public:
    using Options = VolumeBvhOptions;
    static constexpr auto packed_order = PackedOrder::of_leaves;
    static constexpr int width = 2;
    static constexpr int max_depth = bvh_max_depth;

    /// A tree without primitives.
    VolumeBvh() = default;
    /// Builds the tree over all primitives of a set. Throws InputError as `references_of` does, and
    /// UsageError if volumes of that kind do not exist in this dimension (`list_of`).
    template <PrimitiveSet P>
    static VolumeBvh build(const P& set, const Options& options, Executor& executor) {
        VolumeBvh tree(options, Bvh<T, D>::build(set, options, executor));
        const double margin = static_cast<double>(cell_margin(tree.bounds_));
        std::vector<Vec<double, D>> points;
        executor.expect(tree.items_.size());
        if (!tree.root_.empty()) tree.fit(set, tree.root_, margin, points, executor);
        return tree;
    }

    /// Whether each primitive is in one leaf only: always, except after spatial splits.
    bool exclusive() const { return exclusive_; }
    const Box<T, D>& bounds() const { return bounds_; }
    std::span<const PrimitiveId> items() const { return items_; }
    std::size_t bytes() const {
        return children_.capacity() * sizeof(Children) + items_.capacity() * sizeof(PrimitiveId) +
               std::visit([](const auto& list) { return list.bytes(); }, volumes_);
    }
    std::size_t node_count() const { return 2 * children_.size() + (root_.empty() ? 0 : 1); }
    std::size_t leaf_count() const { return root_.empty() ? 0 : children_.size() + 1; }
    int depth() const { return depth_; }
    const Options& options() const { return options_; }

    /// The volumes of a node's two children.
    struct Pair {
        static constexpr int width = 2;
        const AnyVolumeList<T, D>& list;
        std::size_t node;

        AnyVolume<T, D> operator[](int i) const { return {list, 2 * node + static_cast<std::size_t>(i)}; }
    };

    // The functions that the walk and `fold` need.
    NodeRef root() const { return root_; }
    Pair volumes(NodeRef r) const { return {volumes_, r.first}; }
    NodeRef child(NodeRef r, int i) const { return children_[r.first].child[i]; }
    Leaf leaf(NodeRef r) const { return {items_.data(), r.first, r.count}; }
    void prefetch(NodeRef r) const {
        if (!r.leaf()) __builtin_prefetch(children_.data() + r.first);
    }
    static NodeId child_id(NodeRef parent, int i) { return Bvh<T, D>::child_id(parent, i); }

    template <class Primitives, Query Q, class Count>
    void walk(const Primitives& primitives, Q& query, Count& count) const {
        walk_volumes(*this, primitives, query, count);
    }

    /// Describes a fault of the structure; empty if there is none. O(n · depth).
    template <PrimitiveSet P>
    std::string validate(const P& set) const {
        std::vector<std::uint8_t> seen(set.size());
        std::string fault;
        // Check the subtree of r and append its corners to `below`: each volume must contain the corners
        // below it.
        const auto visit = [&](auto& self, NodeRef r, int depth, std::vector<Vec<double, D>>& below) -> void {
            if (!fault.empty()) return;
            if (depth > max_depth) return void(fault = "deeper than its bound");
            if (r.leaf()) {
                for (std::uint32_t i = r.first; i < r.first + r.count; ++i) {
                    if (i >= items_.size() || items_[i] >= seen.size() ||
                        (seen[items_[i]]++ != 0 && exclusive_))
                        return void(fault = "an item is missing or held twice");
                    add_corners(set, items_[i], below);
                }
                return;
            }
            if (r.first >= children_.size()) return void(fault = "a child that is not there");
            for (int i = 0; i < 2; ++i) {
                const std::size_t first = below.size();
                self(self, child(r, i), depth + 1, below);
                for (std::size_t p = first; p < below.size(); ++p)
                    if (least_distance2(below[p], volumes(r)[i]) > 0)
                        fault = "a primitive reaches out of a volume above it";
            }
        };
        std::vector<Vec<double, D>> points;
        if (!root_.empty()) visit(visit, root_, 1, points);
        // Check that every primitive is in a leaf.
        for (const auto s : seen)
            if (s == 0 && fault.empty()) fault = "a primitive is in no leaf";
        return fault;
    }

private:
    struct Children {
        NodeRef child[2];
    };

    VolumeBvh(const Options& options, const Bvh<T, D>& boxes)
        : options_(options),
          bounds_(boxes.bounds()),
          root_(boxes.root()),
          items_(boxes.items().begin(), boxes.items().end()),
          depth_(boxes.depth()),
          exclusive_(boxes.exclusive()),
          volumes_(list_of<T, D>(options.volume)) {
        const std::size_t inner = boxes.leaf_count() > 0 ? boxes.leaf_count() - 1 : 0;
        for (std::uint32_t n = 0; n < inner; ++n)
            children_.push_back({{boxes.child({n, 0}, 0), boxes.child({n, 0}, 1)}});
        std::visit([&](auto& list) { list.resize(2 * inner); }, volumes_);
    }

    /// Fits the volumes below a node, and appends the points below it to `points`.
    template <class P>
    void fit(const P& set, NodeRef r, double margin, std::vector<Vec<double, D>>& points,
             Executor& executor) {
        executor.advance(r.count);
        if (r.leaf()) {
            for (std::uint32_t i = r.first; i < r.first + r.count; ++i) add_corners(set, items_[i], points);
            return;
        }
        for (int i = 0; i < 2; ++i) {
            const std::size_t first = points.size();
            fit(set, child(r, i), margin, points, executor);
            const auto below = PointSpan<D>(points).subspan(first);
            const std::size_t at = 2 * std::size_t{r.first} + static_cast<std::size_t>(i);
            std::visit([&](auto& list) { list.fit(at, below, margin); }, volumes_);
        }
    }

    /// Appends the points of a primitive that its volumes must contain.
    template <class P>
    static void add_corners(const P& set, PrimitiveId id, std::vector<Vec<double, D>>& points) {
        if (const auto corners = corners_in(set, id)) {
            for (const auto& corner : *corners) points.push_back(Vec<double, D>(corner));
        } else {
            const Box<double, D> box{Vec<double, D>(set.bounds(id).low), Vec<double, D>(set.bounds(id).high)};
            for (int i = 0; i < (box.low == box.high ? 1 : 1 << D); ++i) {
                Vec<double, D> corner = box.low;
                for (int k = 0; k < D; ++k)
                    if (i >> k & 1) corner[k] = box.high[k];
                points.push_back(corner);
            }
        }
    }

    Options options_;
    Box<T, D> bounds_;
    NodeRef root_;
    std::vector<Children> children_;
    std::vector<PrimitiveId> items_;
    int depth_ = 0;
    bool exclusive_ = true;
    AnyVolumeList<T, D> volumes_;
};

}  // namespace hedgerow
