/// Builds wide BVHs of points.
#include <algorithm>
#include <atomic>

#include <hedgerow/engine/build.h>

namespace hedgerow {
namespace {

/// The tree over some number of leaves. Where a node has more leaves than children, each child but the last
/// has a full subtree, whose leaves are a power of the width: so the places of all nodes and leaves follow
/// from the number of points alone.
struct Layout {
    std::size_t width;

    /// The leaves of a full child of a node with so many leaves.
    std::size_t leaves_of_child(std::size_t leaves) const {
        std::size_t full = 1;
        while (full * width < leaves) full *= width;
        return full;
    }
    /// The inner nodes above so many leaves; none above one.
    std::size_t nodes(std::size_t leaves) const {
        if (leaves <= 1) return 0;
        const std::size_t full = leaves_of_child(leaves), others = (leaves - 1) / full;
        return 1 + others * ((full - 1) / (width - 1)) + nodes(leaves - others * full);
    }
    int levels(std::size_t leaves) const { return leaves <= 1 ? 1 : 1 + levels(leaves_of_child(leaves)); }
};

template <std::floating_point T, int D>
class PointTree {
public:
    PointTree(PointItems<T, D> points, const WideOptions& options, Executor& executor)
        : points_(std::move(points)),
          leaf_size_(options.max_leaf_size),
          layout_{static_cast<std::size_t>(options.width)},
          executor_(executor) {}

    WideTree<T, D> build() {
        if (points_.empty()) return {};
        executor_.expect(points_.size());
        const std::size_t leaves = leaves_of(points_.size());
        tree_.nodes =
            WideNodes<T, D>(static_cast<int>(layout_.width), std::max<std::size_t>(layout_.nodes(leaves), 1));
        tree_.items = Stored<PrimitiveId>(leaves * wide_leaf_size);
        tree_.depth = std::max(layout_.levels(leaves), 2);
        const LaneBox<T> bounds = box_of(0, points_.size());
        tree_.bounds = bounds.template box<D>();
        grow(0, 0, points_.size(), bounds);
        tree_.crowded = crowded_;
        if (points_.size() <= worth_a_task) executor_.advance(points_.size());
        return std::move(tree_);
    }

private:
    /// Consecutive points that become a child.
    struct Part {
        std::size_t first, count;
        LaneBox<T> box;
    };
    /// Fewer points than these are not worth a task.
    static constexpr std::size_t worth_a_task = 8192;
    /// To look at more points than these takes longer than to notice that they are at one place.
    static constexpr std::size_t crowd = 1024;

    std::size_t leaves_of(std::size_t points) const { return (points + leaf_size_ - 1) / leaf_size_; }

    /// Fills a node, and all below it, with consecutive points.
    void grow(std::size_t node, std::size_t first, std::size_t count, const LaneBox<T>& box) {
        const std::size_t leaves = leaves_of(count), each = layout_.leaves_of_child(leaves) * leaf_size_;
        Part parts[most_wide];
        split({first, count, box}, each, parts);
        // Name the children: full ones have as many nodes each.
        const auto children = static_cast<int>((count + each - 1) / each);
        std::size_t next = node + 1;
        for (int i = 0; i < static_cast<int>(layout_.width); ++i) {
            if (i >= children) {
                tree_.nodes.set(node, i, {}, WideChild::none(), 0);
                continue;
            }
            const Part& part = parts[i];
            const bool leaf = part.count <= leaf_size_;
            const auto block = static_cast<std::uint32_t>(part.first / leaf_size_);
            tree_.nodes.set(node, i, part.box.template box<D>(),
                            leaf ? WideChild::of_leaf(block) : WideChild{static_cast<std::uint32_t>(next)},
                            static_cast<std::uint32_t>(part.count));
            next += layout_.nodes(leaves_of(part.count));
        }
        fill(node, count, parts, 0, children);
    }
    /// Fills the children from `begin` to `end`, in tasks if they are large.
    void fill(std::size_t node, std::size_t inside, const Part* parts, int begin, int end) {
        if (end - begin == 1) {
            const Part& part = parts[begin];
            const WideChild child = tree_.nodes.child(node, begin);
            // Report what is done by parts that are no tasks, and are in none that is not.
            if (part.count <= worth_a_task && inside > worth_a_task) executor_.advance(part.count);
            return child.leaf() ? fill_leaf(part) : grow(child.word, part.first, part.count, part.box);
        }
        const int middle = (begin + end) / 2;
        both(
            parts[begin].count, [&] { fill(node, inside, parts, begin, middle); },
            [&] { fill(node, inside, parts, middle, end); });
    }
    void fill_leaf(const Part& part) {
        PrimitiveId* const items = tree_.items.data() + part.first / leaf_size_ * wide_leaf_size;
        for (std::size_t i = 0; i < wide_leaf_size; ++i)
            items[i] = i < part.count ? points_[part.first + i].id() : no_primitive;
    }
    /// Halves a part until none has more than `each` points, and writes them in order. All but the last have
    /// `each`.
    void split(const Part& part, std::size_t each, Part* parts) {
        if (part.count <= each) {
            parts[0] = part;
            return;
        }
        const Box<T, D> box = part.box.template box<D>();
        if (box.low == box.high) return cut_in_order(part, each, parts);
        const std::size_t children = (part.count + each - 1) / each, low_children = children / 2;
        const std::size_t low_count = low_children * each;
        // Split at a rank along the longest side.
        alignas(32) T size[4];
        (part.box.high - part.box.low).store(size);
        const auto axis = std::max_element(size, size + D) - size;
        PointItem<T, D>* const points = points_.data() + part.first;
        std::nth_element(points, points + low_count, points + part.count,
                         [axis](const auto& a, const auto& b) { return a.lane[axis] < b.lane[axis]; });
        const auto half = [&](std::size_t from, std::size_t count, Part* to) {
            split({part.first + from, count, box_of(part.first + from, count)}, each, to);
        };
        both(
            part.count, [&] { half(0, low_count, parts); },
            [&] { half(low_count, part.count - low_count, parts + low_children); });
    }
    /// Cuts points that are all at one place, ascending by id: so the lowest ids below a node are the first.
    void cut_in_order(const Part& part, std::size_t each, Part* parts) {
        PointItem<T, D>* const points = points_.data() + part.first;
        const auto before = [](const auto& a, const auto& b) { return a.id() < b.id(); };
        if (!std::is_sorted(points, points + part.count, before))
            std::sort(points, points + part.count, before);
        for (std::size_t first = 0; first < part.count; first += each)
            *parts++ = {part.first + first, std::min(each, part.count - first), part.box};
        if (part.count > crowd) crowded_ = true;
    }
    LaneBox<T> box_of(std::size_t first, std::size_t count) const {
        auto box = LaneBox<T>::none();
        for (std::size_t i = first; i < first + count; ++i) box.expand(Lanes<T>::load(points_[i].lane));
        return box;
    }
    template <class F, class G>
    void both(std::size_t points, F f, G g) {
        if (points > worth_a_task)
            executor_.both(f, g);
        else
            f(), g();
    }

    PointItems<T, D> points_;
    std::size_t leaf_size_;
    Layout layout_;
    Executor& executor_;
    WideTree<T, D> tree_;
    std::atomic<bool> crowded_ = false;
};

}  // namespace

template <std::floating_point T, int D>
WideTree<T, D> build_wide_tree_of_points(PointItems<T, D> points, const WideOptions& options,
                                         Executor& executor) {
    return PointTree<T, D>(std::move(points), resolved(options), executor).build();
}

#define HEDGEROW_BUILD_POINTS(T, D) \
    template WideTree<T, D> build_wide_tree_of_points(PointItems<T, D>, const WideOptions&, Executor&);
HEDGEROW_BUILD_POINTS(float, 2)
HEDGEROW_BUILD_POINTS(float, 3)
HEDGEROW_BUILD_POINTS(double, 2)
HEDGEROW_BUILD_POINTS(double, 3)

}  // namespace hedgerow
