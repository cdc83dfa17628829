/// Structures that change: after single inserts, erases and moves they answer like brute force. Bad changes
/// change nothing. The depth of a tree and the visits of its queries stay bounded.
#include <array>
#include <limits>

#include <hedgerow/any_pairs.h>

#include "changes.h"

using namespace hedgerow;
using namespace hedgerow::changes;
namespace gen = rc::gen;

namespace {

template <template <class, int> class S, class P>
struct Kind {
    template <class T, int D>
    using Structure = S<T, D>;
    using Set = P;
};
template <class K>
using BothOf = Both<K::template Structure, typename K::Set>;
template <class K>
using OptionsOf = typename BothOf<K>::Tree::Options;

template <class K>
class OfEveryKind : public testing::Test {};
using Kinds = testing::Types<Kind<Orthtree, TriangleMesh<float>>, Kind<Orthtree, TriangleMesh<double>>,
                             Kind<Orthtree, SphereSet<double, 3>>, Kind<Orthtree, SegmentSet<float>>,
                             Kind<Orthtree, PointCloud<double, 2>>, Kind<Bvh, TriangleMesh<float>>,
                             Kind<Bvh, TriangleMesh<double>>, Kind<Bvh, SegmentSet<double>>,
                             Kind<Bvh, PointCloud<float, 2>>>;
TYPED_TEST_SUITE(OfEveryKind, Kinds);

template <class O>
O any_options(O options) {
    if constexpr (requires { options.mailbox; }) {
        options.leaf_size = *gen::inRange(1u, 9u).as("leaf_size");
        options.max_depth = *gen::element(20, 20, 32, 3, 0).as("max_depth");
        options.mailbox = *gen::arbitrary<bool>().as("mailbox");
    } else {
        options.builder = *gen::elementOf(std::vector(std::begin(bvh_builders), std::end(bvh_builders)));
        options.max_leaf_size = *gen::inRange(1u, 9u).as("max_leaf_size");
        options.overlap = 0;
        options.duplicates = 3;
    }
    return options;
}
/// Sets options that make trees as deep as possible.
template <class O>
void make_deep(O& options) {
    if constexpr (requires { options.mailbox; })
        options.leaf_size = 2, options.max_depth = 32;
    else
        options.max_leaf_size = 1;
}

TYPED_TEST(OfEveryKind, AnyChangesAreAnsweredAsByBruteForce) {
    using P = typename TypeParam::Set;
    using T = typename P::Scalar;
    constexpr int D = P::dimension;
    expect_always([] {
        AnyCase<P> one;
        BothOf<TypeParam> both(one.set, any_options(OptionsOf<TypeParam>()));
        const int steps = *gen::inRange(0, 30).as("steps");
        for (int i = 0; i < steps; ++i) {
            const int kind = *gen::inRange(0, 4).as("kind of change");
            const auto which = *gen::inRange<std::uint64_t>(0, 1000).as("which");
            RC_ASSERT(change(both, kind, which, *any_item<P>(one.wild).as("primitive")));
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

/// Makes 1,000 changes to one tree, or 10,000 in long runs. Every 250 changes it alternates between mostly
/// growing and mostly shrinking.
TYPED_TEST(OfEveryKind, ALongLifeIsAnsweredAsByBruteForce) {
    using P = typename TypeParam::Set;
    rc::Random draw(5);
    P start;
    if constexpr (requires { start.vertices; })
        start.vertices = gen::container<decltype(start.vertices)>(10, vectors<typename P::Scalar, 3>(true))(
                             draw.split(), rc::kNominalSize)
                             .value();
    BothOf<TypeParam> both(start);
    const auto tame = any_item<P>(false), wild = any_item<P>(true);
    const std::size_t steps = in_long_runs(10000, 1000);
    for (std::size_t i = 0; i < steps; ++i) {
        Random random(17, i);
        const bool grows = i / 250 % 2 == 0;
        const int kind =
            (grows ? std::array{0, 0, 0, 1, 2, 3} : std::array{0, 1, 2, 3, 3, 3})[random.bits() % 6];
        // Draw a change and compare what both indexes return.
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

template <template <class, int> class S, class T>
struct Scaled {
    template <class U, int D>
    using Structure = S<U, D>;
    using Scalar = T;
};
template <class K>
class OfEveryStructure : public testing::Test {};
using Structures = testing::Types<Scaled<Orthtree, float>, Scaled<Orthtree, double>, Scaled<Bvh, float>,
                                  Scaled<Bvh, double>>;
TYPED_TEST_SUITE(OfEveryStructure, Structures);

/// Erases two thirds of each scene in a scattered order, inserts half of these again, and at last erases all.
TYPED_TEST(OfEveryStructure, ScenesMayBeTakenApartAndPutTogether) {
    with_scenes<typename TypeParam::Scalar>(3000, [](const char* name, auto set) {
        SCOPED_TRACE(name);
        using P = decltype(set);
        Both<TypeParam::template Structure, P> both(std::move(set));
        const Questions questions(both.oracle, 300);
        const auto n = static_cast<PrimitiveId>(both.set.size());
        // Erase two thirds.
        for (PrimitiveId i = 0; i < n; ++i) {
            const PrimitiveId id = i * 7919 % n;
            if (id % 3 != 0) both.tree.erase(both.set, id);
        }
        EXPECT_EQ(both.tree.validate(), "");
        // Insert half of these again, the last first.
        for (PrimitiveId id = n; id-- > 0;)
            if (id % 3 == 1) both.tree.insert(both.set, id);
        EXPECT_EQ(both.tree.validate(), "");
        // Compare with brute force, from which the other half is erased too.
        for (PrimitiveId id = 2; id < n; id += 3) both.oracle.erase(both.set, id);
        EXPECT_EQ(both.tree.structure().size(), both.oracle.structure().items().size());
        EXPECT_TRUE(both.same(questions));
        // Erase all.
        for (PrimitiveId id = 0; id < n; ++id) both.tree.erase(both.set, id);
        EXPECT_EQ(both.tree.validate(), "");
        EXPECT_EQ(both.tree.structure().size(), 0u);
        EXPECT_EQ(both.tree.structure().leaf_count(), 0u);
        EXPECT_EQ(both.tree.structure().item_count(), 0u);
        EXPECT_FALSE(closest_point(both.tree, questions.points[0]));
    });
}

// ---- Changes that are refused

TYPED_TEST(OfEveryStructure, WhatIsHeldIsNotInsertedAndWhatIsNotHeldIsNotErased) {
    using T = typename TypeParam::Scalar;
    Both<TypeParam::template Structure, PointCloud<T, 2>> both(points2d<T>(100));
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

template <template <class, int> class S, class P>
void expect_refused(Both<S, P>& both, PrimitiveId id, const char* word) {
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

TYPED_TEST(OfEveryStructure, BadPrimitivesAreRefusedAndChangeNothing) {
    using T = typename TypeParam::Scalar;
    constexpr T nan = std::numeric_limits<T>::quiet_NaN(), infinity = std::numeric_limits<T>::infinity();
    Both<TypeParam::template Structure, PointCloud<T, 3>> cloud(points<T>(200));
    expect_refused(cloud, 200, "no primitive 200");
    for (const T bad : {nan, infinity, -infinity, 2 * largest_coordinate<T>}) {
        ASSERT_TRUE(cloud.erase(9));
        const auto good = cloud.set.points[9];
        cloud.set.points[9][2] = bad;
        expect_refused(cloud, 9, "primitive 9 ");
        cloud.set.points[9] = good;
        ASSERT_TRUE(cloud.insert(9));
    }
    Both<TypeParam::template Structure, TriangleMesh<T>> mesh(teapot<T>(200));
    mesh.set.triangles.push_back({0, 1, static_cast<std::uint32_t>(mesh.set.vertices.size())});
    expect_refused(mesh, mesh.last(), "names vertex");
    mesh.set.triangles.back() = {0, 1, 2};
    EXPECT_TRUE(mesh.insert(mesh.last()));
    EXPECT_TRUE(mesh.same(Questions(mesh.oracle, 50)));
}

// ---- Shape

/// Primitives that no plane separates: a build ends with a tree of bounded depth, and more of them can be
/// inserted and erased.
template <template <class, int> class S, class P>
void expect_bounded(const char* name, P set) {
    SCOPED_TRACE(name);
    typename S<typename P::Scalar, P::dimension>::Options options;
    make_deep(options);
    Both<S, P> both(std::move(set), options);
    const auto& tree = both.tree.structure();
    EXPECT_LE(tree.depth(), tree.max_depth);
    const Questions questions(both.oracle, 100);
    EXPECT_TRUE(both.same(questions));
    // Insert more of them and erase a third of all.
    for (int i = 0; i < 300; ++i) {
        const auto again = items(both.set)[both.set.size() - 7];
        ASSERT_TRUE(both.append(again));
    }
    for (PrimitiveId id = 0; id < both.set.size(); id += 3) ASSERT_TRUE(both.erase(id));
    EXPECT_EQ(both.tree.validate(), "");
    EXPECT_LE(tree.depth(), tree.max_depth);
    EXPECT_TRUE(both.same(questions));
}

TYPED_TEST(OfEveryStructure, WhatCannotBePartedMakesNoDepthBomb) {
    using T = typename TypeParam::Scalar;
    TriangleMesh<T> alike;
    alike.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 1}};
    alike.triangles.assign(2000, {0, 1, 2});
    expect_bounded<TypeParam::template Structure>("equal triangles", alike);

    TriangleMesh<T> fan = cube<T>(12);
    for (std::uint64_t i = 0; i < 500; ++i) {
        Random random(1, i);
        for (int k = 0; k < 2; ++k) fan.vertices.emplace_back(random.direction<3>());
        const auto n = static_cast<std::uint32_t>(fan.vertices.size());
        fan.triangles.push_back({0, n - 2, n - 1});
    }
    expect_bounded<TypeParam::template Structure>("triangles around one vertex", fan);

    PointCloud<T, 2> near_twins = points2d<T>(20);
    for (int i = 0; i < 1000; ++i)
        near_twins.points.emplace_back(T(0.3), i % 2 == 0 ? T(0.3) : std::nextafter(T(0.3), T(1)));
    expect_bounded<TypeParam::template Structure>("two places side by side", near_twins);

    PointCloud<T, 3> geometric;
    for (int i = 0; i < 300; ++i)
        geometric.points.emplace_back(std::ldexp(T(1), i % 100 - 50), std::ldexp(T(1), i % 59 - 40), T(0));
    expect_bounded<TypeParam::template Structure>("a geometric progression", geometric);

    SphereSet<T, 3> onion;
    for (int i = 0; i < 500; ++i) onion.spheres.push_back({Vec<T, 3>::all(T(i) / 500), T(1) + T(i) / 100});
    expect_bounded<TypeParam::template Structure>("spheres around each other", onion);

    SegmentSet<T> star;
    for (std::uint64_t i = 0; i < 1000; ++i)
        star.segments.push_back({{T(0.1), T(0.2)}, Vec<T, 2>(Random(2, i).direction<2>())});
    expect_bounded<TypeParam::template Structure>("segments through one point", star);
}

/// Neighbours that are inserted in order make a chain if each is only placed beside the last.
/// Lists of many points, and pairs, which cells find, have what an index holds, and nothing else is read.
template <class Erase, class I>
void expect_lists_of_what_is_held(PointCloud<float, 3>& cloud, const I& index, Erase erase) {
    const auto asked = cloud.points;
    for (PrimitiveId id = 0; id < cloud.size(); id += 3) {
        ASSERT_TRUE(erase(id));
        cloud.points[id] = Vec3f::all(std::numeric_limits<float>::quiet_NaN());
    }
    const double radius = 0.1;
    const auto lists = within(index, asked, radius);
    std::vector<PairWithin<float>> pairs;
    for (PrimitiveId i = 0; i < asked.size(); ++i) {
        const auto alone = within(index, asked[i], radius);
        ASSERT_EQ(lists[i].size(), alone.size()) << i;
        for (std::size_t k = 0; k < alone.size(); ++k) {
            EXPECT_EQ(lists[i].ids[k], alone[k].element) << i;
            EXPECT_EQ(lists[i].distances2[k], alone[k].distance2) << i;
            if (i % 3 != 0 && alone[k].element > i)
                pairs.push_back({i, alone[k].element, alone[k].distance2});
        }
    }
    std::sort(pairs.begin(), pairs.end());
    EXPECT_GT(pairs.size(), 1000u);
    EXPECT_EQ(pairs_within(index, radius), pairs);
    EXPECT_EQ(pairs_within(index, index, radius).size(), 2 * pairs.size() + cloud.size() - cloud.size() / 3);
}
template <template <class, int> class S>
void expect_lists_of_what_is_held() {
    auto cloud = points<float>(1200);
    auto index = build<S>(cloud);
    expect_lists_of_what_is_held(cloud, index, [&](PrimitiveId id) { return index.erase(cloud, id); });
}
TEST(ChangedClouds, ListsOfManyPointsHaveWhatIsHeld) {
    expect_lists_of_what_is_held<Orthtree>();
    expect_lists_of_what_is_held<Bvh>();
    expect_lists_of_what_is_held<BruteForce>();
    for (const char* const structure : {"octree", "bvh", "brute-force"}) {
        auto cloud = points<float>(1200);
        const auto index = build_any(structure, cloud);
        expect_lists_of_what_is_held(cloud, *index, [&](PrimitiveId id) { return index->erase(id); });
    }
}

TEST(BvhChanges, InsertionsInTheOrderOfPlacesMakeNoChains) {
    const auto mesh = turned_stadium<float>(5000);
    auto index = build<Bvh>(mesh);
    const auto nodes = [&] {
        Visits visits;
        for (const auto& ray : Questions(index, 1000).rays) closest_hit(index, ray, KeepAll{}, visits);
        return double(visits.nodes);
    };
    const double before = nodes();
    const auto n = static_cast<PrimitiveId>(mesh.size());
    // Erase and insert again a twentieth of the mesh at a time.
    for (PrimitiveId first = 0; first < n; first += n / 20) {
        const PrimitiveId last = std::min(n, first + n / 20);
        for (PrimitiveId id = first; id < last; ++id) ASSERT_TRUE(index.erase(mesh, id));
        for (PrimitiveId id = first; id < last; ++id) ASSERT_TRUE(index.insert(mesh, id));
        if (first == 0) {
            EXPECT_LT(nodes(), 1.4 * before);
        }
    }
    EXPECT_EQ(index.validate(), "");
    EXPECT_LT(nodes(), 2 * before);
    EXPECT_LT(index.structure().depth(), 48);
}

TYPED_TEST(OfEveryStructure, GrowsOverWhatLiesBeyondItsBounds) {
    using T = typename TypeParam::Scalar;
    Both<TypeParam::template Structure, PointCloud<T, 3>> both(points<T>(500));
    for (int i = 0; i < 60; ++i) {
        const T away = std::ldexp(T(1), i);
        ASSERT_TRUE(both.append({i % 2 == 0 ? away : -away, T(i), i % 3 == 0 ? -away : away}));
        ASSERT_EQ(both.tree.validate(), "") << i;
        ASSERT_LE(both.tree.structure().depth(), (TypeParam::template Structure<T, 3>::max_depth + 1));
        ASSERT_TRUE(both.same(Questions(both.oracle, 20))) << i;
    }
    while (both.set.size() > 500) {
        ASSERT_TRUE(both.erase(both.last()));
        both.set.points.pop_back();
    }
    EXPECT_TRUE(both.same(Questions(build<Bvh>(both.set), 100)));
}

}  // namespace
