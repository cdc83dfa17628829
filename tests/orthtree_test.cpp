/// Octrees and quadtrees: their options, shape and memory, and the cost of a change.
#include "changes.h"

using namespace hedgerow;
using namespace hedgerow::changes;

namespace {

template <class P>
using TreeOf = Orthtree<typename P::Scalar, P::dimension>;
template <class T>
class OfEveryScalar : public testing::Test {};
using Scalars = testing::Types<float, double>;
TYPED_TEST_SUITE(OfEveryScalar, Scalars);

TEST(Orthtree, OptionsOutOfRangeAreRefused) {
    const auto cloud = points<float>(10);
    EXPECT_THROW(build<Orthtree>(cloud, {.leaf_size = 0}), InputError);
    EXPECT_THROW(build<Orthtree>(cloud, {.max_depth = -1}), InputError);
    EXPECT_THROW(build<Orthtree>(cloud, {.max_depth = 33}), InputError);
    EXPECT_EQ(build<Orthtree>(cloud, {.leaf_size = 1u << 30, .max_depth = 32}).structure().depth(), 1);
    EXPECT_EQ(build<Orthtree>(cloud, {.leaf_size = 1, .max_depth = 0}).structure().depth(), 1);
}

TEST(Orthtree, SaysWhenItIsNotThatOfItsPrimitives) {
    auto cloud = points<double>(500);
    const auto index = build<Orthtree>(cloud);
    EXPECT_EQ(index.validate(), "");
    const auto fault = [&] { return index.structure().validate(cloud.view()); };
    const Vec3d before = cloud.points[77];
    cloud.points[77] = Vec3d::all(1) - before;
    EXPECT_NE(fault().find("primitive 77 "), std::string::npos) << fault();
    cloud.points[77] = before * 100.;
    EXPECT_NE(fault(), "");
    cloud.points[77] = before;
    EXPECT_EQ(fault(), "");
    cloud.points.pop_back();
    EXPECT_NE(fault(), "");
}

// ---- Shape

template <class P>
void expect_within_memory(const P& set, const TreeOf<P>& tree) {
    EXPECT_LE(tree.bytes(), 128 * set.size() + set.size() / 8 + 64);
}

TYPED_TEST(OfEveryScalar, MemoryStaysWithinTheBound) {
    with_scenes<TypeParam>(20000, [](const char* name, const auto& set) {
        SCOPED_TRACE(name);
        for (const std::uint32_t leaf_size : {1u, 8u})
            expect_within_memory(set, build<Orthtree>(set, {leaf_size}).structure());
        using P = std::remove_cvref_t<decltype(set)>;
        auto tree = TreeOf<P>::build(P().view(), {.leaf_size = 2}, serial_executor());
        for (PrimitiveId id = 0; id < set.size(); ++id) {
            tree.insert(set.view(), id);
            ASSERT_LE(tree.bytes(), 4 * (128 * (id + 1u) + 1024)) << id;
        }
    });
}

TEST(Orthtree, OfWhatCannotBePartedIsOneLeaf) {
    TriangleMesh<float> alike;
    alike.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 1}};
    alike.triangles.assign(2000, {0, 1, 2});
    EXPECT_EQ(build<Orthtree>(alike).structure().leaf_count(), 1u);
}

TEST(Orthtree, IsTheSameForAnyNumberOfThreads) {
    const auto expect_same = [](const auto& set) {
        const auto serial = build<Orthtree>(set);
        const ThreadLimit limit(2);
        for (int run = 0; run < 3; ++run) {
            const auto parallel = build<Orthtree>(set, {}, default_executor());
            const auto &a = serial.structure(), &b = parallel.structure();
            ASSERT_TRUE(std::ranges::equal(a.items(), b.items()));
            ASSERT_EQ(a.root(), b.root());
            ASSERT_EQ(a.store().group_count(), b.store().group_count());
            for (std::uint32_t g = 0; g < a.store().group_count(); ++g)
                ASSERT_EQ(a.store().group(g).child, b.store().group(g).child) << g;
        }
    };
    expect_same(soup<float>(50000));
    expect_same(points2d<double>(50000));
}

/// Arrays that doubled when they were full, and groups that were never given back, made it half more and all.
TYPED_TEST(OfEveryScalar, MemoryFollowsWhatIsHeld) {
    const auto mesh = soup<TypeParam>(20000);
    auto tree = Orthtree<TypeParam, 3>::build(mesh.view(), {}, serial_executor());
    const std::size_t bytes = tree.bytes(), items = tree.item_count();
    for (PrimitiveId round = 0; round < 3; ++round) {
        for (PrimitiveId i = 0; i < 2000; ++i) ASSERT_TRUE(tree.erase(mesh.view(), 10 * i + round));
        for (PrimitiveId i = 0; i < 2000; ++i) ASSERT_TRUE(tree.insert(mesh.view(), 10 * i + round));
        EXPECT_LT(double(tree.bytes()), 1.3 * double(bytes)) << round;
        EXPECT_LT(double(tree.item_count()), 1.1 * double(items)) << round;
    }
    for (PrimitiveId id = 10; id < mesh.size(); ++id) ASSERT_TRUE(tree.erase(mesh.view(), id));
    EXPECT_EQ(tree.validate(mesh.view()), "");
    EXPECT_LT(tree.bytes(), 32768u);
    for (PrimitiveId id = 10; id < mesh.size(); ++id) ASSERT_TRUE(tree.insert(mesh.view(), id));
    EXPECT_EQ(tree.validate(mesh.view()), "");
    EXPECT_LT(double(tree.bytes()), 1.3 * double(bytes));
}

// ---- The cost of a change

/// Nodes opened and items tested per change. 500 points of a tree of n + 500 are erased, inserted and erased
/// again.
double cost_of_a_change(std::size_t n) {
    constexpr std::size_t more = 500;
    const auto cloud = points<float>(n + more);
    auto tree = Orthtree<float, 3>::build(cloud.view(), {}, serial_executor());
    Visits visits;
    for (const bool in : {false, true, false})
        for (std::size_t i = 0; i < more; ++i) {
            const auto id = static_cast<PrimitiveId>(i * (n / more));
            EXPECT_TRUE(in ? tree.insert(cloud.view(), id, visits) : tree.erase(cloud.view(), id, visits));
        }
    return double(visits.nodes + visits.primitives) / (3 * more);
}

TEST(Orthtree, AChangeCostsItsPathWhateverTheNumberOfPrimitives) {
    const double small = cost_of_a_change(1000);
    EXPECT_LT(small, 64);
    for (const std::size_t n : {8000u, 64000u, 512000u}) EXPECT_LT(cost_of_a_change(n), 1.5 * small) << n;
}

/// A tree that grows by insertions is about as good as one that is built at once: rays open at most a quarter
/// more nodes and test at most a quarter more primitives.
TEST(Orthtree, InsertionsMakeAsGoodATree) {
    const auto mesh = soup<float>(5000);
    const auto at_once = build<Orthtree>(mesh);
    auto grown = build<Orthtree>(TriangleMesh<float>());
    for (PrimitiveId id = 0; id < mesh.size(); ++id) grown.insert(mesh, id);
    Visits built, inserted;
    for (const auto& ray : Questions(at_once, 1000).rays) {
        ASSERT_EQ(closest_hit(at_once, ray, KeepAll{}, built), closest_hit(grown, ray, KeepAll{}, inserted));
    }
    EXPECT_LT(double(inserted.nodes), 1.25 * double(built.nodes));
    EXPECT_LT(double(inserted.primitives), 1.25 * double(built.primitives));
}

}  // namespace
