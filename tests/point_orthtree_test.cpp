/// Octrees and quadtrees of points: each point in one half-open leaf, cells that are keyed anew, points in
/// one place, and the same tree for any executor.
#include <gtest/gtest.h>

#include <hedgerow/hedgerow.h>
#include <hedgerow/scenes/random.h>
#include <hedgerow/scenes/sets.h>
#include <hedgerow/structures/orthtree/point_orthtree.h>

using namespace hedgerow;

namespace {

template <class T>
class PointOrthtrees : public testing::Test {};
using Scalars = testing::Types<float, double>;
TYPED_TEST_SUITE(PointOrthtrees, Scalars);

template <class P>
auto tree_of(const P& set, std::uint32_t leaf_size = 8, Executor& executor = serial_executor()) {
    using Tree = PointOrthtree<typename P::Scalar, P::dimension>;
    auto tree = Tree::build(set.view(), {.leaf_size = leaf_size}, executor);
    EXPECT_EQ(tree.validate(set.view()), "");
    EXPECT_EQ(tree.items().size(), set.size());
    return tree;
}
/// The most points of a leaf.
template <class Tree>
std::size_t longest_leaf(const Tree& tree) {
    const auto lengths = fold(
        tree, [](const Leaf& leaf) { return std::size_t(leaf.count); },
        [](std::size_t a, std::size_t b) { return std::max(a, b); });
    return lengths[0];
}

TEST(PointOrthtree, OptionsOutOfRangeAreRefused) {
    const auto cloud = points<float>(10);
    EXPECT_THROW(build<PointOrthtree>(cloud, {.leaf_size = 0}), UsageError);
    EXPECT_THROW(build<PointOrthtree>(cloud, {.max_depth = -1}), UsageError);
    EXPECT_THROW(build<PointOrthtree>(cloud, {.max_depth = 49}), UsageError);
    EXPECT_EQ(build<PointOrthtree>(cloud, {.leaf_size = 1u << 30}).structure().depth(), 1);
    EXPECT_EQ(build<PointOrthtree>(cloud, {.leaf_size = 1, .max_depth = 0}).structure().leaf_count(), 1u);
    EXPECT_EQ(build<PointOrthtree>(PointCloud<float, 3>()).structure().depth(), 0);
    EXPECT_EQ(build<PointOrthtree>(PointCloud<float, 3>()).structure().leaf_count(), 0u);
    EXPECT_EQ(build<PointOrthtree>(PointCloud<float, 3>{{{1, 2, 3}}}).structure().depth(), 1);
}

/// A lattice whose points lie on the corners of cells, where an octree of primitives has each point
/// eightfold.
TYPED_TEST(PointOrthtrees, HoldEachPointOfALatticeOnce) {
    using T = TypeParam;
    PointCloud<T, 3> lattice{{{T(0.5), T(0.5), T(0.5)}}};
    for (int i = 0; i < 16 * 16 * 16; ++i) {
        const int x = i % 16, y = i / 16 % 16, z = i / 256;
        lattice.points.emplace_back(T(x) * T(0x1p-12), T(y) * T(0x1p-12), T(z) * T(0x1p-12));
    }
    EXPECT_EQ(build<Orthtree>(lattice, {.leaf_size = 1}).structure().item_count(), 8 * 4096u + 1);
    EXPECT_LE(longest_leaf(tree_of(lattice)), 8u);
    EXPECT_EQ(longest_leaf(tree_of(lattice, 1)), 1u);
    EXPECT_EQ(tree_of(lattice, 1).leaf_count(), lattice.size());
}

TYPED_TEST(PointOrthtrees, SayWhenTheyAreNotThoseOfTheirPoints) {
    auto cloud = points<TypeParam>(500);
    const auto tree = tree_of(cloud);
    const auto before = cloud.points[77];
    cloud.points[77] = Vec<TypeParam, 3>::all(1) - before;
    EXPECT_NE(tree.validate(cloud.view()).find("outside"), std::string::npos);
    cloud.points[77] = before;
    EXPECT_EQ(tree.validate(cloud.view()), "");
    cloud.points.pop_back();
    EXPECT_NE(tree.validate(cloud.view()), "");
}

/// Clusters so small that the bits of the codes end in the root's cells of their size.
TYPED_TEST(PointOrthtrees, DivideSmallClusters) {
    using T = TypeParam;
    PointCloud<T, 3> cloud;
    const T far = std::is_same_v<T, float> ? T(0x1p-12) : T(0x1p-36);
    Random random(3, 0);
    for (int i = 0; i < 20000; ++i) {
        const Vec<T, 3> p(random.in_cube<3>());
        cloud.points.push_back(i % 2 == 0 ? p * far : p * far + Vec<T, 3>(1, T(0.5), 0));
    }
    const auto tree = tree_of(cloud);
    EXPECT_GT(tree.depth(), (std::is_same_v<T, float> ? 16 : 40));
    if (std::is_same_v<T, double>) {
        EXPECT_LE(longest_leaf(tree), 8u);
    }
}
/// Ever smaller coordinates near zero, where numbers of T are ever denser.
TYPED_TEST(PointOrthtrees, DivideAGeometricProgression) {
    using T = TypeParam;
    PointCloud<T, 2> cloud;
    for (int i = 0; i < 40; ++i)
        for (const T sign : {T(1), T(-1)})
            cloud.points.emplace_back(std::ldexp(sign, -i), std::ldexp(sign, -2 * i));
    const auto tree = tree_of(cloud, 1);
    EXPECT_LE(longest_leaf(tree), 32u);
    EXPECT_LE(tree.depth(), tree.max_depth + 1);
}
TYPED_TEST(PointOrthtrees, OfHugeAndTinyCoordinates) {
    using T = TypeParam;
    constexpr int most = std::is_same_v<T, float> ? 59 : 479;
    for (const int exponent : {most, -most, std::is_same_v<T, float> ? -140 : -1060}) {
        auto cloud = points<T>(300);
        for (auto& p : cloud.points)
            for (int k = 0; k < 3; ++k) p[k] = std::ldexp(p[k] - T(0.5), exponent);
        tree_of(cloud, 2);
    }
    auto far = points<T>(300);
    for (auto& p : far.points) p[1] += std::ldexp(T(1), std::is_same_v<T, float> ? 20 : 50);
    tree_of(far, 2);
}

/// Points in one place are one leaf, at once, wherever others are.
TYPED_TEST(PointOrthtrees, OfCoincidentPointsAreOneLeaf) {
    using T = TypeParam;
    PointCloud<T, 3> one;
    one.points.assign(1000000, {T(0.1), T(0.2), T(0.3)});
    EXPECT_EQ(tree_of(one).depth(), 1);
    auto cloud = points<T>(1000);
    cloud.points.insert(cloud.points.end(), 100000, {T(0.1), T(0.2), T(0.3)});
    const auto tree = tree_of(cloud);
    EXPECT_LE(tree.depth(), 12);
    EXPECT_EQ(longest_leaf(tree), 100000u);
}

/// Points of random bits, in any order of magnitude, in groups that differ by a few numbers of T.
TYPED_TEST(PointOrthtrees, OfNoiseInTheLastPlace) {
    using T = TypeParam;
    Random random(4, 0);
    PointCloud<T, 3> cloud;
    for (int i = 0; i < 3000; ++i) {
        Vec<T, 3> p;
        for (int k = 0; k < 3; ++k) {
            p[k] = std::ldexp(static_cast<T>(static_cast<int>(random.bits() % 5) - 2),
                              static_cast<int>(random.bits() % 4));
            for (auto steps = random.bits() % 4; steps > 0; --steps) p[k] = std::nextafter(p[k], T(100));
        }
        cloud.points.push_back(p);
    }
    tree_of(cloud, 1);
}

TYPED_TEST(PointOrthtrees, AreTheSameForAnyNumberOfThreads) {
    using T = TypeParam;
    auto cloud = points<T>(50000);
    for (std::size_t i = 0; i < cloud.size(); i += 3) cloud.points[i] = cloud.points[i] * T(1e-5);
    const auto serial = tree_of(cloud), parallel = tree_of(cloud, 8, default_executor());
    EXPECT_TRUE(std::ranges::equal(serial.items(), parallel.items()));
    EXPECT_EQ(serial.node_count(), parallel.node_count());
    EXPECT_EQ(serial.root(), parallel.root());
    const auto boxes = [&](const auto& tree) {
        return fold(
            tree, [](const Leaf& leaf) { return std::pair(leaf.first, leaf.count); },
            [](auto a, auto b) { return std::pair(a.second == 0 ? b.first : a.first, a.second + b.second); });
    };
    EXPECT_EQ(boxes(serial), boxes(parallel));
}

/// What a query accepts is one range of points.
TEST(PointOrthtree, GivesTheRangeBelowEachNode) {
    const auto cloud = points2d<double>(2000);
    const auto tree = tree_of(cloud);
    const auto check = [&](auto& self, OrthantNode n) -> std::uint32_t {
        if (!n.inner()) return n.count;
        std::uint32_t count = 0;
        for (unsigned i = 0; i < tree.width; ++i) count += self(self, tree.children(n)[i]);
        EXPECT_EQ(tree.below(n).count, count);
        return count;
    };
    EXPECT_EQ(check(check, tree.root()), 2000u);
}

}  // namespace
