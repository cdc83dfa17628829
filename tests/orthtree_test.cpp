/// Octrees and quadtrees that change: what is inserted, erased and moved one by one is answered as by brute
/// force; bad changes change nothing; depth, memory and the cost of a change are bounded.
#include <array>
#include <limits>

#include <hedgerow/scenes/meshes.h>
#include <hedgerow/scenes/sets.h>

#include "contract.h"
#include "generated.h"

using namespace hedgerow;
using namespace hedgerow::contract;
using namespace hedgerow::generated;
namespace gen = rc::gen;

namespace {

template <class P>
using TreeOf = Orthtree<typename P::Scalar, P::dimension>;
template <class P>
using OptionsOf = typename TreeOf<P>::Options;

/// A set that changes, and two indexes that are told.
template <class P>
struct Both {
    using Item = std::remove_cvref_t<decltype(items(std::declval<P&>())[0])>;
    P set;
    Index<TreeOf<P>, ViewOf<P>> tree;
    Index<BruteForce<typename P::Scalar, P::dimension>, ViewOf<P>> oracle;

    explicit Both(P start, const OptionsOf<P>& options = {})
        : set(std::move(start)),
          tree(build<Orthtree>(set, options, default_executor())),
          oracle(build<BruteForce>(set)) {}

    /// Each returns whether both indexes said the same.
    bool insert(PrimitiveId id) { return tree.insert(set, id) == oracle.insert(set, id); }
    bool erase(PrimitiveId id) { return tree.erase(set, id) == oracle.erase(set, id); }
    bool append(const Item& item) {
        items(set).push_back(item);
        return insert(static_cast<PrimitiveId>(set.size() - 1)) && tree.structure().holds(last());
    }
    bool move(PrimitiveId id, const Item& to) {
        if (!erase(id)) return false;
        items(set)[id] = to;
        return insert(id);
    }
    bool same(const Questions<typename P::Scalar, P::dimension>& questions) const {
        return answers(tree, questions) == answers(oracle, questions);
    }
    PrimitiveId last() const { return static_cast<PrimitiveId>(set.size() - 1); }
};

/// Change `kind` (of four), and whether both indexes agree on it.
template <class P>
bool change(Both<P>& both, int kind, std::uint64_t which, const typename Both<P>::Item& item) {
    if (kind == 0 || both.set.size() == 0) return both.append(item);
    const auto id = static_cast<PrimitiveId>(which % both.set.size());
    switch (kind) {
        case 1:
            return both.move(id, item);
        case 2:
            return both.insert(id);  // often held
        default:
            return both.erase(id);  // often not held
    }
}

template <class P>
class OfEverySet : public testing::Test {};
using Sets = testing::Types<TriangleMesh<float>, TriangleMesh<double>, SphereSet<float, 3>,
                            SphereSet<double, 3>, SegmentSet<float>, SegmentSet<double>, PointCloud<float, 3>,
                            PointCloud<double, 3>, PointCloud<float, 2>, PointCloud<double, 2>>;
TYPED_TEST_SUITE(OfEverySet, Sets);

template <class P>
OptionsOf<P> any_options() {
    OptionsOf<P> options;
    options.leaf_size = *gen::inRange(1u, 9u).as("leaf_size");
    options.max_depth = *gen::element(20, 20, 32, 3, 0).as("max_depth");
    options.mailbox = *gen::arbitrary<bool>().as("mailbox");
    return options;
}

TYPED_TEST(OfEverySet, AnyChangesAreAnsweredAsByBruteForce) {
    using T = typename TypeParam::Scalar;
    constexpr int D = TypeParam::dimension;
    expect_always([] {
        AnyCase<TypeParam> one;
        Both<TypeParam> both(one.set, any_options<TypeParam>());
        const int steps = *gen::inRange(0, 30).as("steps");
        for (int i = 0; i < steps; ++i) {
            const int kind = *gen::inRange(0, 4).as("kind of change");
            const auto which = *gen::inRange<std::uint64_t>(0, 1000).as("which");
            RC_ASSERT(change(both, kind, which, *any_item<TypeParam>(one.wild).as("primitive")));
        }
        RC_ASSERT(both.tree.validate() == "");
        one.set = both.set;
        Questions<T, D> questions({}, {}, 0);
        for (int i = 0; i < 4; ++i) questions.rays.push_back(one.ray());
        questions.points = {one.point(), one.point()};
        questions.boxes = {one.box(), one.box()};
        RC_ASSERT(both.same(questions));
    });
}

/// Ten thousand steps on one tree, in the long run: first it mostly grows, then it mostly shrinks, and again.
TYPED_TEST(OfEverySet, ALongLifeIsAnsweredAsByBruteForce) {
    using P = TypeParam;
    rc::Random draw(5);
    P start;
    if constexpr (requires { start.vertices; })
        start.vertices = gen::container<decltype(start.vertices)>(10, vectors<typename P::Scalar, 3>(true))(
                             draw.split(), rc::kNominalSize)
                             .value();
    Both<P> both(start);
    const auto tame = any_item<P>(false), wild = any_item<P>(true);
    const std::size_t steps = matrix::in_long_runs(10000, 1000);
    for (std::size_t i = 0; i < steps; ++i) {
        Random random(17, i);
        const bool grows = i / 250 % 2 == 0;
        const int kind =
            (grows ? std::array{0, 0, 0, 1, 2, 3} : std::array{0, 1, 2, 3, 3, 3})[random.bits() % 6];
        const auto& item = random.bits() % 16 == 0 ? wild : tame;
        const auto which = random.bits();
        ASSERT_TRUE(change(both, kind, which, item(draw.split(), rc::kNominalSize).value())) << i;
        if (i % 5 == 0) {
            ASSERT_TRUE(both.same(Questions(both.oracle, 6))) << i;
        }
        if (i % 50 == 0) {
            ASSERT_EQ(both.tree.validate(), "") << i;
        }
    }
}

template <class T>
class OfEveryScalar : public testing::Test {};
using Scalars = testing::Types<float, double>;
TYPED_TEST_SUITE(OfEveryScalar, Scalars);

/// Calls f with a name and a set of each kind, of about `size` primitives.
template <class T, class F>
void with_scenes(std::size_t size, F f) {
    f("teapot", teapot<T>(size));
    f("soup", soup<T>(size));
    f("terrain", terrain<T>(size));
    f("spheres", spheres<T>(size));
    f("points", points<T>(size));
    f("points in the plane", points2d<T>(size));
    f("clusters in the plane", clusters2d<T>(size));
    f("segments", segments2d<T>(size));
}

/// Nothing is left to its first place: a third is erased, a third inserted anew, all in a scattered order.
TYPED_TEST(OfEveryScalar, ScenesMayBeTakenApartAndPutTogether) {
    with_scenes<TypeParam>(3000, [](const char* name, auto set) {
        SCOPED_TRACE(name);
        using P = decltype(set);
        Both<P> both(std::move(set));
        const Questions questions(both.oracle, 300);
        const auto n = static_cast<PrimitiveId>(both.set.size());
        for (PrimitiveId i = 0; i < n; ++i) {
            const PrimitiveId id = i * 7919 % n;
            if (id % 3 != 0) both.tree.erase(both.set, id);
        }
        EXPECT_EQ(both.tree.validate(), "");
        for (PrimitiveId id = n; id-- > 0;)
            if (id % 3 == 1) both.tree.insert(both.set, id);
        EXPECT_EQ(both.tree.validate(), "");
        for (PrimitiveId id = 2; id < n; id += 3) both.oracle.erase(both.set, id);
        EXPECT_EQ(both.tree.structure().size(), both.oracle.structure().items().size());
        EXPECT_TRUE(both.same(questions));
        for (PrimitiveId id = 0; id < n; ++id) both.tree.erase(both.set, id);
        EXPECT_EQ(both.tree.validate(), "");
        EXPECT_EQ(both.tree.structure().size(), 0u);
        EXPECT_EQ(both.tree.structure().node_count(),
                  1 + TreeOf<P>::width * both.tree.structure().store().group_count());
        EXPECT_EQ(both.tree.structure().store().groups_in_use(), 0u);
        EXPECT_FALSE(closest_point(both.tree, questions.points[0]));
    });
}

// ---- Changes that cannot be

TYPED_TEST(OfEveryScalar, WhatIsHeldIsNotInsertedAndWhatIsNotHeldIsNotErased) {
    using T = TypeParam;
    Both<PointCloud<T, 2>> both(points2d<T>(100));
    const std::vector<PrimitiveId> before(both.tree.structure().items().begin(),
                                          both.tree.structure().items().end());
    EXPECT_FALSE(both.tree.insert(both.set, 7));
    EXPECT_FALSE(both.tree.erase(both.set, 100));
    EXPECT_FALSE(both.tree.erase(both.set, 0xFFFFFFFFu));
    EXPECT_TRUE(std::ranges::equal(both.tree.structure().items(), before));
    EXPECT_TRUE(both.tree.erase(both.set, 7));
    EXPECT_FALSE(both.tree.erase(both.set, 7));
    EXPECT_FALSE(both.tree.structure().holds(7));
    EXPECT_EQ(both.tree.structure().size(), 99u);
    EXPECT_TRUE(both.tree.insert(both.set, 7));
    EXPECT_FALSE(both.tree.insert(both.set, 7));
    EXPECT_EQ(both.tree.structure().size(), 100u);
    EXPECT_EQ(both.tree.validate(), "");
}

template <class P>
void expect_refused(Both<P>& both, PrimitiveId id, const char* word) {
    const std::vector<PrimitiveId> before(both.tree.structure().items().begin(),
                                          both.tree.structure().items().end());
    const auto bounds = both.tree.bounds();
    try {
        both.tree.insert(both.set, id);
        ADD_FAILURE() << "primitive " << id << " was let in";
    } catch (const InputError& e) {
        EXPECT_NE(std::string(e.what()).find(word), std::string::npos) << e.what();
    }
    EXPECT_THROW(both.oracle.insert(both.set, id), InputError);
    EXPECT_FALSE(both.tree.structure().holds(id));
    EXPECT_TRUE(std::ranges::equal(both.tree.structure().items(), before));
    EXPECT_EQ(both.tree.bounds(), bounds);
    EXPECT_EQ(both.tree.validate(), "");
    EXPECT_TRUE(both.same(Questions(both.oracle, 50)));
}

TYPED_TEST(OfEveryScalar, BadPrimitivesAreRefusedAndChangeNothing) {
    using T = TypeParam;
    constexpr T nan = std::numeric_limits<T>::quiet_NaN(), infinity = std::numeric_limits<T>::infinity();
    Both<PointCloud<T, 3>> cloud(points<T>(200));
    expect_refused(cloud, 200, "no primitive 200");
    for (const T bad : {nan, infinity, -infinity, 2 * largest_coordinate<T>}) {
        ASSERT_TRUE(cloud.erase(9));
        const auto good = cloud.set.points[9];
        cloud.set.points[9][2] = bad;
        expect_refused(cloud, 9, "primitive 9 ");
        cloud.set.points[9] = good;
        ASSERT_TRUE(cloud.insert(9));
    }
    Both<TriangleMesh<T>> mesh(teapot<T>(200));
    mesh.set.triangles.push_back({0, 1, static_cast<std::uint32_t>(mesh.set.vertices.size())});
    expect_refused(mesh, mesh.last(), "names vertex");
    mesh.set.triangles.back() = {0, 1, 2};
    EXPECT_TRUE(mesh.insert(mesh.last()));
    EXPECT_TRUE(mesh.same(Questions(mesh.oracle, 50)));
}

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

/// Many that no division parts: a build ends, in a sensible tree; more of them can be inserted, and erased.
template <class P>
void expect_bounded(const char* name, P set) {
    SCOPED_TRACE(name);
    Both<P> both(std::move(set), {.leaf_size = 2, .max_depth = 32});
    const TreeOf<P>& tree = both.tree.structure();
    EXPECT_LE(tree.depth(), 33);
    expect_within_memory(both.set, tree);
    const Questions questions(both.oracle, 100);
    EXPECT_TRUE(both.same(questions));
    for (int i = 0; i < 300; ++i) {
        const auto again = items(both.set)[both.set.size() - 7];
        ASSERT_TRUE(both.append(again));
    }
    for (PrimitiveId id = 0; id < both.set.size(); id += 3) ASSERT_TRUE(both.erase(id));
    EXPECT_EQ(both.tree.validate(), "");
    EXPECT_LE(tree.depth(), 33);
    EXPECT_TRUE(both.same(questions));
}

TYPED_TEST(OfEveryScalar, WhatCannotBePartedMakesNoDepthBomb) {
    using T = TypeParam;
    TriangleMesh<T> alike;
    alike.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 1}};
    alike.triangles.assign(2000, {0, 1, 2});
    EXPECT_EQ(build<Orthtree>(alike).structure().leaf_count(), 1u);
    expect_bounded("equal triangles", alike);

    TriangleMesh<T> fan = cube<T>(12);
    for (std::uint64_t i = 0; i < 500; ++i) {
        Random random(1, i);
        for (int k = 0; k < 2; ++k) fan.vertices.emplace_back(random.direction<3>());
        const auto n = static_cast<std::uint32_t>(fan.vertices.size());
        fan.triangles.push_back({0, n - 2, n - 1});
    }
    expect_bounded("triangles around one vertex", fan);

    PointCloud<T, 2> near_twins = points2d<T>(20);
    for (int i = 0; i < 1000; ++i)
        near_twins.points.emplace_back(T(0.3), i % 2 == 0 ? T(0.3) : std::nextafter(T(0.3), T(1)));
    expect_bounded("two places side by side", near_twins);

    PointCloud<T, 3> geometric;
    for (int i = 0; i < 300; ++i)
        geometric.points.emplace_back(std::ldexp(T(1), i % 100 - 50), std::ldexp(T(1), i % 59 - 40), T(0));
    expect_bounded("a geometric progression", geometric);

    SphereSet<T, 3> onion;
    for (int i = 0; i < 500; ++i) onion.spheres.push_back({Vec<T, 3>::all(T(i) / 500), T(1) + T(i) / 100});
    expect_bounded("spheres around each other", onion);

    SegmentSet<T> star;
    for (std::uint64_t i = 0; i < 1000; ++i)
        star.segments.push_back({{T(0.1), T(0.2)}, Vec<T, 2>(Random(2, i).direction<2>())});
    expect_bounded("segments through one point", star);
}

TYPED_TEST(OfEveryScalar, GrowsUpwardOverWhatLiesBeyondItsRoot) {
    using T = TypeParam;
    Both<PointCloud<T, 3>> both(points<T>(500));
    for (int i = 0; i < 60; ++i) {
        const T away = std::ldexp(T(1), i);
        ASSERT_TRUE(both.append({i % 2 == 0 ? away : -away, T(i), i % 3 == 0 ? -away : away}));
        ASSERT_EQ(both.tree.validate(), "") << i;
        ASSERT_LE(both.tree.structure().depth(), (Orthtree<T, 3>::max_depth + 1));
        ASSERT_TRUE(both.same(Questions(both.oracle, 20))) << i;
    }
    while (both.set.size() > 500) {
        ASSERT_TRUE(both.erase(both.last()));
        both.set.points.pop_back();
    }
    EXPECT_TRUE(both.same(Questions(build<Bvh>(both.set), 100)));
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

// ---- What a change costs

/// Nodes opened and items looked at, a change, over inserting and then erasing points in a tree of n.
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

/// One by one, a tree becomes as good as one that is built at once.
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
