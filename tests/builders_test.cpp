/// The BVH's builders: they make valid trees of bounded depth for any scene, the same for any executor, at
/// costs in proportion to each other. Reinsertion never raises the cost.
#include <numeric>

#include <hedgerow/structures/bvh/builders/collapse.h>
#include <hedgerow/structures/bvh/builders/morton.h>
#include <hedgerow/structures/bvh/builders/reinsertion.h>

#include "trees.h"

using namespace hedgerow;
using namespace hedgerow::contract;
using namespace hedgerow::trees;

namespace {

/// Spheres around one center, each larger than the one before. Joining them by area makes a chain.
SphereSet<double, 3> nested_balls(std::size_t n) {
    SphereSet<double, 3> set;
    for (std::size_t i = 0; i < n; ++i) set.spheres.push_back({{1, 2, 3}, std::pow(1.001, double(i))});
    return set;
}

// ---- Sorting

/// By any number of bits: none, one digit, and several, the last of which has fewer.
TEST(RadixSort, IsStableAndSkipsDigitsThatAllShare) {
    struct Element {
        std::uint64_t key;
        std::size_t place;
        bool operator==(const Element&) const = default;
    };
    Backwards backwards;
    for (const std::size_t n : {0u, 1u, 2u, 1000u, 400000u})
        for (const std::uint64_t mask : {~std::uint64_t(0), std::uint64_t(0xF00000F), std::uint64_t(0)})
            for (Executor* executor : std::initializer_list<Executor*>{&serial_executor(), &backwards}) {
                BareVector<Element> sorted(n);
                for (std::size_t i = 0; i < n; ++i) sorted[i] = {Random(1, i).bits() & mask, i};
                for (const int bits : {22, 0, 5, 14, 17, 29, 55}) {
                    auto expected = sorted;
                    const auto digits = [&](const Element& e) {
                        return e.key >> 9 & ((std::uint64_t(1) << bits) - 1);
                    };
                    std::stable_sort(expected.begin(), expected.end(),
                                     [&](const auto& a, const auto& b) { return digits(a) < digits(b); });
                    radix_sort(
                        sorted, [](const Element& e) { return e.key; }, 9, bits, *executor);
                    EXPECT_EQ(sorted, expected) << n << " by " << bits;
                }
            }
}

/// Expects the order by whole codes, but by ids for two that alone share the bits of a key. Returns how many
/// such pairs stand against the order of their codes.
template <class T, int D>
std::size_t expect_order(const PointCloud<T, D>& cloud) {
    const auto references = references_of(cloud.view(), serial_executor());
    const MortonCells<T, D> cells(box_of_centers2<T, D>(references, serial_executor()));
    std::vector<std::pair<std::uint64_t, PrimitiveId>> expected;
    for (const auto& r : references) expected.emplace_back(cells.code(r.center2()), r.id());
    std::sort(expected.begin(), expected.end());
    const auto in_key = [&](std::size_t i) {
        return expected[i].first << (64 - cells.bits) >> std::bit_width(expected.size() - 1);
    };
    std::size_t against = 0;
    for (std::size_t first = 0, last; first < expected.size(); first = last) {
        for (last = first + 1; last < expected.size() && in_key(last) == in_key(first);) ++last;
        if (last - first != 2 || expected[first].second < expected[first + 1].second) continue;
        std::swap(expected[first], expected[first + 1]);
        ++against;
    }
    Backwards backwards;
    for (Executor* executor : std::initializer_list<Executor*>{&serial_executor(), &backwards}) {
        const MortonOrder<T, D> order(references, *executor);
        std::size_t misplaced = 0, misdivided = 0;
        for (std::size_t i = 0; i < expected.size(); ++i)
            misplaced += order.reference(i).id() != expected[i].second;
        for (std::size_t i = 1; i < expected.size(); ++i) misdivided += order.split(i - 1, i + 1) != i;
        EXPECT_EQ(misplaced, 0u);
        EXPECT_EQ(misdivided, 0u);
        if (expected.empty() || expected.front().first == expected.back().first) continue;
        const std::size_t split = order.split(0, expected.size());
        const auto differing = expected.front().first ^ expected.back().first;
        const auto bit = std::bit_floor(differing);
        EXPECT_EQ(expected[split - 1].first & bit, 0u);
        EXPECT_NE(expected[split].first & bit, 0u);
    }
    return against;
}

TEST(MortonOrder, IsByTheWholeCodeThenById) {
    for (const std::size_t n : {1u, 2u, 1000u, 60000u}) {
        auto cloud = points<float>(n);
        expect_order(cloud);
        expect_order(points2d<double>(n));
        for (auto& p : cloud.points) p = p * 1e-6f;  // all but the next point are in a few cells
        cloud.points.emplace_back(1.f, 1.f, 1.f);
        expect_order(cloud);
        for (auto& p : cloud.points) p = {1, 2, 3};
        expect_order(cloud);
    }
}

TEST(MortonOrder, LeavesPairsOfOneKeyAsTheyAre) {
    for (const std::size_t n : {1000u, 60000u}) {
        auto cloud = points<float>(n);
        for (std::size_t i = 0; i < n; i += 2) cloud.points[i + 1] = cloud.points[i] - Vec3f::all(1.5e-6f);
        EXPECT_GT(expect_order(cloud), n / 10);
    }
}

// ---- Trees

template <class I, class Oracle>
void expect_right(const I& index, const Oracle& oracle) {
    EXPECT_EQ(index.validate(), "");
    EXPECT_LE(index.structure().depth(), bvh_max_depth);
    if (oracle.size() == 0) return;
    const Questions questions(oracle, 40);
    EXPECT_EQ(answers(index, questions), answers(oracle, questions));
}
template <class P>
void expect_right(const char* name, const P& set) {
    SCOPED_TRACE(name);
    const auto oracle = build<BruteForce>(set);
    with_each_builder([&](const BvhOptions& options) {
        const auto index = build<Bvh>(set, options);
        expect_right(index, oracle);
        EXPECT_EQ(index.structure().node_count(),
                  set.size() == 0 ? 0 : 2 * index.structure().leaf_count() - 1);
    });
    with_each_wide_builder(
        [&](const WideOptions& options) { expect_right(build<WideBvh>(set, options), oracle); });
}

TEST(Builders, AnyNumberAndPlacementOfPrimitivesIsHeld) {
    PointCloud<float, 3> cloud;
    expect_right("none", cloud);
    for (int i = 0; i < 3; ++i) {
        cloud.points.emplace_back(float(i), 1.f, 2.f);
        expect_right("few", cloud);
    }
    for (int i = 0; i < 2000; ++i) cloud.points.emplace_back(float(i * i), 1.f, 2.f);
    expect_right("collinear", cloud);
    for (auto& p : cloud.points) p = {7, 8, 9};
    expect_right("all in one place", cloud);
    for (std::size_t i = 0; i < cloud.points.size(); ++i) {
        Random random(3, i);
        cloud.points[i] = Vec3f(random.direction<3>()) * 1e-9f;
        if (i % 3 != 0) cloud.points[i] = Vec3f::all(i % 3 == 1 ? 1.f : 1e9f);
    }
    expect_right("clusters within single cells of the curve", cloud);
    expect_right("in the plane", points2d<double>(3000));
    SphereSet<float, 3> balls;
    for (int i = 0; i < 1500; ++i) balls.spheres.push_back({{1, 1, 1}, float(i % 10)});
    expect_right("all around one center", balls);
    expect_right("needles", needles(1500));
}

template <template <class, int> class S>
void expect_same_tree_for_any_threads(const TriangleMesh<float>& mesh,
                                      const typename S<float, 3>::Options& options) {
    const auto serial = build<S>(mesh, options);
    Backwards backwards;
    expect_same_tree(serial, build<S>(mesh, options, backwards));
    for (const unsigned threads : {1u, 2u}) {
        const ThreadLimit limit(threads);
        expect_same_tree(serial, build<S>(mesh, options, default_executor()));
    }
}
TEST(Builders, GiveTheSameTreeForAnyNumberOfThreads) {
    const auto mesh = needles(20000);
    with_each_builder([&](const auto& options) { expect_same_tree_for_any_threads<Bvh>(mesh, options); });
    with_each_wide_builder(
        [&](const auto& options) { expect_same_tree_for_any_threads<WideBvh>(mesh, options); });
}

/// A tree that is a chain: each inner node has one leaf and one child with all remaining leaves.
struct Chain {
    struct Node {
        std::uint32_t first, last;
    };
    std::uint32_t count;

    Node root() const { return {0, count}; }
    std::uint32_t size(Node n) const { return n.last - n.first; }
    std::pair<Node, Node> children(Node n) const { return {{n.first, n.first + 1}, {n.first + 1, n.last}}; }
    PrimitiveId item(Node n) const { return n.first; }
    LaneBox<double> box(Node n) const {
        const auto at = static_cast<double>(n.first);
        return LaneBox<double>::of(Box3d{{at, 0, 0}, {at + 1, 1, 1}});
    }
};
template <class T>
int depth_of(const BuildTree<T, 3>& tree, std::uint32_t node) {
    const auto& n = tree.nodes[node];
    return n.count > 0 ? 1 : 1 + std::max(depth_of(tree, n.left), depth_of(tree, n.right));
}

TEST(Collapse, CutsChainsWhereTheyGrowTooDeep) {
    for (const std::uint32_t n : {1u, 60u, 70u, 1000u, 200000u}) {
        const auto tree =
            Collapse<double, 3>(SahOptions{.traversal_cost = 0, .max_leaf_size = 1}, serial_executor())
                .build(Chain{n}, n);
        EXPECT_LE(depth_of(tree, 0), bvh_max_depth);
        EXPECT_EQ(tree.leaves, n);
        std::vector<PrimitiveId> items(n);
        std::iota(items.begin(), items.end(), 0u);
        EXPECT_EQ(tree.items, items);
    }
}

TEST(Collapse, MakesLeavesWhereTheyAreCheaper) {
    SahOptions options;
    options.traversal_cost = 1e6;
    options.max_leaf_size = 16;
    const auto lumps = Collapse<double, 3>(options, serial_executor()).build(Chain{40}, 40);
    EXPECT_EQ(lumps.leaves, 25u);  // 24 leaves of one item, and one of the last 16
    options.traversal_cost = 1e-6;
    EXPECT_EQ((Collapse<double, 3>(options, serial_executor()).build(Chain{40}, 40).leaves), 40u);
}

TEST(Builders, DepthIsBoundedWhereBoxesNest) {
    const auto balls = nested_balls(20000);
    const auto expect_bounded = [](const auto& index) {
        EXPECT_EQ(index.validate(), "");
        EXPECT_LE(index.structure().depth(), bvh_max_depth);
    };
    with_each_builder([&](const auto& options) { expect_bounded(build<Bvh>(balls, options)); });
    with_each_wide_builder([&](const auto& options) { expect_bounded(build<WideBvh>(balls, options)); });
}

// ---- Costs

template <class P>
double cost(const P& set, const BvhOptions& options) {
    return build<Bvh>(set, options).structure().sah_cost();
}

TEST(Builders, CostsAreInProportion) {
    for (const auto& mesh : {teapot_in_stadium<float>(10000), terrain<float>(10000), soup<float>(10000)}) {
        const double sweep = cost(mesh, options_of(BvhBuilder::sweep));
        EXPECT_LT(cost(mesh, options_of(BvhBuilder::binned)), 1.05 * sweep);
        EXPECT_LT(cost(mesh, options_of(BvhBuilder::ploc)), 1.2 * sweep);
        EXPECT_LT(cost(mesh, options_of(BvhBuilder::agglomerative)), 1.3 * sweep);
        EXPECT_LT(cost(mesh, options_of(BvhBuilder::lbvh)), 1.3 * sweep);
    }
    const auto mesh = needles(10000);
    const double sweep = cost(mesh, options_of(BvhBuilder::sweep));
    EXPECT_LT(cost(mesh, options_of(BvhBuilder::ploc)), 1.05 * sweep);
    EXPECT_LT(cost(mesh, options_of(BvhBuilder::agglomerative)), 1.05 * sweep);
}

BuildTree<float, 3> binned_tree(const TriangleMesh<float>& mesh) {
    const auto view = mesh.view();
    return build_tree<float, 3>(
        references_of(view, serial_executor()), [](PrimitiveId) { return Corners<float, 3>(); },
        options_of(BvhBuilder::binned), serial_executor());
}
/// The sum of the areas of all inner nodes below `at`. Fails where a box is not the one around its children.
double inner_area(const BuildTree<float, 3>& tree, std::uint32_t at = 0) {
    const auto& n = tree.nodes[at];
    if (n.count > 0) return 0;
    Box3f around = tree.nodes[n.left].box();
    around.expand(tree.nodes[n.right].box());
    EXPECT_EQ(n.box(), around);
    EXPECT_EQ(n.leaves(), tree.nodes[n.left].leaves() + tree.nodes[n.right].leaves());
    return double(n.box().half_area()) + inner_area(tree, n.left) + inner_area(tree, n.right);
}

TEST(MovableTree, TellsWhatAMoveGainsAndMovesBack) {
    auto tree = binned_tree(needles(500));
    MovableTree<float, 3> movable(tree);
    Random random(5, 0);
    const double first = inner_area(tree);
    int moves = 0;
    for (int i = 0; i < 2000; ++i) {
        const auto any = [&] { return movable.all()[random.bits() % movable.all().size()]; };
        const auto n = any();
        const auto to = any();
        if (!movable.movable(n) || movable.below(n, to) || movable.below(to, n)) continue;
        const auto rest = movable.sibling(n);
        const double before = inner_area(tree), gain = movable.move(n, to), after = inner_area(tree);
        EXPECT_NEAR(before - after, gain, 1e-5 * before);
        EXPECT_EQ(movable.sibling(n), to);
        ++moves;
        if (i % 2 == 0) continue;  // stays there
        EXPECT_NEAR(movable.move(n, rest), -gain, 1e-5 * before);
        EXPECT_NEAR(inner_area(tree), before, 1e-5 * before);
    }
    EXPECT_GT(moves, 500);
    EXPECT_GT(inner_area(tree), first);  // random moves make a tree worse
}

TEST(MovableTree, HalvesWhatGrewTooDeep) {
    // A chain: inner node i has leaf i and the rest of the chain.
    BuildTree<float, 3> tree;
    constexpr std::uint32_t leaves = 300;
    tree.leaves = leaves;
    tree.nodes.resize(2 * leaves - 1);
    for (std::uint32_t i = leaves; i-- > 0;) {
        auto& leaf = tree.nodes[leaves - 1 + i];
        leaf.set(Box3f{{float(i), 0, 0}, {float(i) + 1, 1, 1}});
        leaf.first = i, leaf.count = 1;
        if (i + 1 == leaves) continue;
        auto& inner = tree.nodes[i];
        inner.set(Box3f{{float(i), 0, 0}, {float(leaves), 1, 1}});
        inner.first = leaves - i, inner.count = 0;
        inner.left = leaves - 1 + i, inner.right = i + 2 == leaves ? leaves - 1 + i + 1 : i + 1;
    }
    EXPECT_EQ(depth_of(tree, 0), 300);
    MovableTree<float, 3>(tree).limit_depth();
    EXPECT_LE(depth_of(tree, 0), bvh_max_depth);
    EXPECT_GT(depth_of(tree, 0), bvh_max_depth / 2);  // the upper part of the chain stays
    inner_area(tree);
    std::vector<std::uint32_t> found;
    const auto list = [&](auto& self, std::uint32_t at) -> void {
        if (tree.nodes[at].count > 0) return found.push_back(tree.nodes[at].first);
        self(self, tree.nodes[at].left);
        self(self, tree.nodes[at].right);
    };
    list(list, 0);
    std::vector<std::uint32_t> all(leaves);
    std::iota(all.begin(), all.end(), 0u);
    EXPECT_EQ(found, all);
}

TEST(Reinsertion, NeverRaisesTheCost) {
    for (const auto& mesh :
         {teapot_in_stadium<float>(5000), terrain<float>(5000), soup<float>(5000), needles(5000)})
        for (const auto builder : bvh_builders) {
            double last = cost(mesh, options_of(builder));
            for (const int passes : {1, 3, 9}) {
                const double now = cost(mesh, options_of(builder, passes));
                EXPECT_LE(now, last * (1 + 1e-6)) << int(builder) << ' ' << passes;
                last = now;
            }
        }
}

TEST(Reinsertion, GainsWhereTrianglesAreLong) {
    const auto mesh = needles(10000);
    EXPECT_LT(cost(mesh, options_of(BvhBuilder::binned, 5)),
              0.95 * cost(mesh, options_of(BvhBuilder::binned)));
    EXPECT_LT(cost(mesh, options_of(BvhBuilder::lbvh, 5)), 0.88 * cost(mesh, options_of(BvhBuilder::lbvh)));
}

}  // namespace
