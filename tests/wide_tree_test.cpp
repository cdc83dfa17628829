/// Wide BVHs as trees: their primitives, memory, options and costs.
#include <hedgerow/engine/collapse.h>
#include <hedgerow/engine/kernels.h>

#include "trees.h"

using namespace hedgerow;
using namespace hedgerow::contract;
using namespace hedgerow::trees;

namespace {

template <class P>
void expect_held_once(const P& set, const WideOptions& options) {
    const auto index = build<WideBvh>(set, options);
    std::vector<int> held(set.size());
    const auto below = fold(
        index.structure(),
        [&](const Leaf& leaf) {
            EXPECT_EQ(leaf.first % wide_leaf_size, 0u);
            EXPECT_LE(leaf.count, options.max_leaf_size);
            for (std::uint32_t i = 0; i < leaf.count; ++i) ++held[leaf.ids[leaf.first + i]];
            return std::size_t{leaf.count};
        },
        std::plus<>());
    EXPECT_EQ(below.empty() ? 0 : below[0], set.size());
    EXPECT_TRUE(std::ranges::all_of(held, [](int times) { return times == 1; }));
    EXPECT_EQ(index.structure().item_count(), set.size());
    EXPECT_EQ(index.structure().items().size(), wide_leaf_size * index.structure().leaf_count());
    EXPECT_EQ(index.structure().options().width, options.width);
}

TEST(Wide, HoldsEachPrimitiveOnceInLeavesThatAreNotTooLarge) {
    auto cloud = points<float>(1000);
    for (std::size_t i = 0; i < 500; ++i) cloud.points[i] = cloud.points[0];
    for (const std::uint32_t size : {1u, 3u, 8u})
        with_each_wide_builder([&](WideOptions options) {
            options.max_leaf_size = size;
            options.traversal_cost = 10;  // so that leaves grow
            expect_held_once(cloud, options);
            expect_held_once(soup<double>(1000), options);
            expect_held_once(segments2d<float>(3), options);
            expect_held_once(PointCloud<double, 2>(), options);
        });
}

TEST(Wide, TakesTheMemoryThatItsHeaderSays) {
    for (const auto& mesh : {soup<float>(10000), terrain<float>(10000), teapot_in_stadium<float>(10000)})
        with_each_wide_builder([&](const WideOptions& options) {
            const auto index = build<WideBvh>(mesh, options);
            const auto& tree = index.structure();
            const std::size_t leaves = tree.leaf_count();
            EXPECT_GE(tree.bytes(), 66 * leaves);
            EXPECT_LE(tree.bytes(), 95 * leaves);
            EXPECT_EQ(tree.used_node_count(), tree.tree().nodes.size() + leaves);
        });
    // Over points in one place nodes have no area, and there are as few nodes as possible.
    PointCloud<float, 3> cloud;
    cloud.points.assign(4096, {1, 2, 3});
    cloud.points.emplace_back(9.f, 8.f, 7.f);
    with_each_wide_builder([&](const WideOptions& options) {
        const auto index = build<WideBvh>(cloud, options);
        EXPECT_LE(index.structure().bytes(), 80 * index.structure().leaf_count());
    });
}

TEST(Wide, NeverEntersAPlaceWithoutAChild) {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    const auto cloud = points<double>(100);
    with_each_wide_builder([&](WideOptions options) {
        options.max_leaf_size = 1;
        const auto index = build<WideBvh>(cloud, options);
        const Box3d everywhere{Vec3d::all(-infinity), Vec3d::all(infinity)};
        std::vector<PrimitiveId> found;
        EXPECT_EQ(overlapping(index, everywhere, found), cloud.size());
        std::vector<Near<double, 3>> near;
        EXPECT_EQ(nearest(index, {1, 2, 3}, 200, near, {.radius2 = infinity}), cloud.size());
    });
}

TEST(Wide, RefusesOptionsOutOfTheirRanges) {
    const auto cloud = points<float>(10);
    const auto said = [&](const WideOptions& options) -> std::string {
        try {
            build<WideBvh>(cloud, options);
        } catch (const InputError& error) {
            return error.what();
        }
        return "nothing";
    };
    EXPECT_EQ(said({.width = 5}), "width=5 is not 0, 4, 8 or 16");
    EXPECT_EQ(said({.max_leaf_size = 9}), "max_leaf_size=9 is not a number from 1 to 8");
    EXPECT_EQ(said({.max_leaf_size = 0}), "max_leaf_size=0 is not a number from 1 to 8");
    EXPECT_NE(said({.traversal_cost = -1}), "nothing");
    EXPECT_NE(said({.intersection_cost = std::numeric_limits<double>::quiet_NaN()}), "nothing");
    EXPECT_NE(said({.reinsertion = -1}), "nothing");
    EXPECT_EQ(build<WideBvh>(cloud).structure().options().width, preferred_wide_width());
}

double area_of(const BuildTree<float, 3>& tree, std::uint32_t node) {
    return static_cast<double>(tree.nodes[node].box().half_area());
}
/// The cost of a greedy collapse, which opens the largest child of a node as long as it has a free place. The
/// cost is the sum of the areas of the inner nodes.
double greedy_cost(const BuildTree<float, 3>& tree, std::uint32_t node, int width) {
    std::vector<std::uint32_t> children = {node};
    const auto inner = [&](std::uint32_t n) { return tree.nodes[n].count == 0; };
    while (static_cast<int>(children.size()) < width) {
        const auto largest = std::ranges::max_element(
            children, {}, [&](std::uint32_t n) { return inner(n) ? area_of(tree, n) : -1; });
        const std::uint32_t n = *largest;
        if (!inner(n)) break;
        *largest = tree.nodes[n].left;
        children.push_back(tree.nodes[n].right);
    }
    double cost = area_of(tree, node);
    for (const auto n : children)
        if (inner(n)) cost += greedy_cost(tree, n, width);
    return cost;
}
double cost(const WideTree<float, 3>& tree) {
    double sum = static_cast<double>(tree.bounds.half_area());
    for (std::size_t n = 0; n < tree.nodes.size(); ++n)
        for (int i = 0; i < tree.nodes.children(n); ++i)
            if (!tree.nodes.child(n, i).leaf())
                sum += static_cast<double>(tree.nodes.boxes(n)[i].half_area());
    return sum;
}

TEST(Wide, CostsLessThanTheGreedyCollapse) {
    for (const auto& mesh : {teapot_in_stadium<float>(10000), terrain<float>(10000), needles(10000)})
        for (const auto builder : {BvhBuilder::binned, BvhBuilder::ploc, BvhBuilder::lbvh}) {
            const auto whole = [](PrimitiveId) { return Corners<float, 3>(); };
            const auto tree = build_tree<float, 3>(references_of(mesh.view(), serial_executor()), whole,
                                                   options_of(builder), serial_executor());
            for (const int width : wide_widths) {
                const double least = cost(WideCollapse<float, 3>(tree, width, serial_executor()).build());
                const double greedy = greedy_cost(tree, 0, width);
                EXPECT_LT(least, greedy) << int(builder) << ' ' << width;
            }
        }
}

/// The number of leaves below a node.
std::uint32_t leaves_below(const WideNodes<float, 3>& nodes, std::size_t node) {
    std::uint32_t sum = 0;
    for (int i = 0; i < nodes.children(node); ++i) {
        const WideChild c = nodes.child(node, i);
        sum += c.leaf() ? 1 : leaves_below(nodes, c.word);
    }
    return sum;
}

TEST(Wide, TheLikeliestChildToStopARayIsTheLast) {
    for (const auto& mesh : {teapot_in_stadium<float>(5000), soup<float>(3000)})
        for (const auto builder : wide_builders) {
            WideOptions options;
            options.builder = builder;
            const auto index = build<WideBvh>(mesh, options);
            const auto& nodes = index.structure().tree().nodes;
            for (std::size_t n = 0; n < nodes.size(); ++n) {
                // A child is at most a step of eight behind those before it.
                double most = 0;
                for (int i = 0; i < nodes.children(n); ++i) {
                    const WideChild c = nodes.child(n, i);
                    const double stops = double(nodes.boxes(n)[i].half_area()) /
                                         std::sqrt(c.leaf() ? 1.0 : leaves_below(nodes, c.word));
                    EXPECT_GE(stops, most / 8 * (1 - 1e-5));
                    most = std::max(most, stops);
                }
            }
        }
}

}  // namespace
