/// The BVH's builders: valid trees whatever the scene, the same for any executor, none too deep, their costs
/// in proportion; improvement by reinsertion; wide trees; refits.
#include <numeric>

#include <hedgerow/scenes/meshes.h>
#include <hedgerow/scenes/sets.h>
#include <hedgerow/structures/bvh/builders/collapse.h>
#include <hedgerow/structures/bvh/builders/morton.h>
#include <hedgerow/structures/bvh/wide/collapse.h>
#include <hedgerow/structures/bvh/wide/kernels.h>

#include "contract.h"

using namespace hedgerow;
using namespace hedgerow::contract;

namespace {

BvhOptions options_of(BvhBuilder builder, int reinsertion = 0) {
    BvhOptions options;
    options.builder = builder;
    options.reinsertion = reinsertion;
    return options;
}
/// Every builder, bare and improved.
template <class F>
void with_each_builder(F f) {
    for (const auto builder : bvh_builders)
        for (const int reinsertion : {0, 2}) {
            SCOPED_TRACE(testing::Message() << "builder " << int(builder) << ", reinsertion " << reinsertion);
            f(options_of(builder, reinsertion));
        }
}

/// Of wide trees every builder and width.
template <class F>
void with_each_wide_builder(F f) {
    for (const auto builder : wide_builders)
        for (const int width : {4, 8, 16}) {
            SCOPED_TRACE(testing::Message() << "wide, builder " << int(builder) << ", width " << width);
            WideOptions options;
            options.builder = builder, options.width = width, options.reinsertion = 2;
            f(options);
        }
}

/// Long and thin, and of very different lengths.
TriangleMesh<float> needles(std::size_t n) {
    TriangleMesh<float> mesh;
    for (std::size_t i = 0; i < n; ++i) {
        Random random(31, i);
        const Vec3d from(random.uniform(), random.uniform(), random.uniform());
        const double longest = 0.3 * std::pow(random.uniform(), 3);
        const auto first = static_cast<std::uint32_t>(3 * i);
        for (const Vec3d& v :
             {from, from + random.direction<3>() * longest, from + random.direction<3>() * 0.003})
            mesh.vertices.emplace_back(v);
        mesh.triangles.push_back({first, first + 1, first + 2});
    }
    return mesh;
}

/// Balls around one center, each larger than the one before: to join them by area is to make a chain.
SphereSet<double, 3> nested_balls(std::size_t n) {
    SphereSet<double, 3> set;
    for (std::size_t i = 0; i < n; ++i) set.spheres.push_back({{1, 2, 3}, std::pow(1.001, double(i))});
    return set;
}

// ---- Sorting

/// Small pieces, from the last to the first.
class Backwards final : public Executor {
public:
    void for_each_piece(std::size_t count, std::size_t,
                        FunctionRef<void(std::size_t, std::size_t)> body) override {
        for (std::size_t end = count; end > 0; end -= std::min<std::size_t>(end, 7))
            body(end - std::min<std::size_t>(end, 7), end);
    }
    void both(FunctionRef<void()> first, FunctionRef<void()> second) override { second(), first(); }
};

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
                auto expected = sorted;
                const auto digits = [](const Element& e) { return e.key >> 9 & ((1u << 22) - 1); };
                std::stable_sort(expected.begin(), expected.end(),
                                 [&](const auto& a, const auto& b) { return digits(a) < digits(b); });
                radix_sort(
                    sorted, [](const Element& e) { return e.key; }, 9, 2, *executor);
                EXPECT_EQ(sorted, expected) << n;
            }
}

template <class T, int D>
void expect_order(const PointCloud<T, D>& cloud) {
    const auto references = references_of(cloud.view(), serial_executor());
    const MortonCells<T, D> cells(box_of_centers2<T, D>(references, serial_executor()));
    std::vector<std::pair<std::uint64_t, PrimitiveId>> expected;
    for (const auto& r : references) expected.emplace_back(cells.code(r.center2()), r.id());
    std::sort(expected.begin(), expected.end());
    Backwards backwards;
    for (Executor* executor : std::initializer_list<Executor*>{&serial_executor(), &backwards}) {
        const MortonOrder<T, D> order(references, *executor);
        for (std::size_t i = 0; i < expected.size(); ++i)
            ASSERT_EQ(order.reference(i).id(), expected[i].second) << i;
        if (expected.empty() || expected.front().first == expected.back().first) continue;
        const std::size_t split = order.split(0, expected.size());
        const auto differing = expected.front().first ^ expected.back().first;
        const auto bit = std::bit_floor(differing);
        EXPECT_EQ(expected[split - 1].first & bit, 0u);
        EXPECT_NE(expected[split].first & bit, 0u);
    }
}

TEST(MortonOrder, IsByTheWholeCodeThenById) {
    for (const std::size_t n : {1u, 2u, 1000u, 60000u}) {
        auto cloud = points<float>(n);
        expect_order(cloud);
        expect_order(points2d<double>(n));
        for (auto& p : cloud.points) p = p * 1e-6f;  // all in a few cells, but for one
        cloud.points.emplace_back(1.f, 1.f, 1.f);
        expect_order(cloud);
        for (auto& p : cloud.points) p = {1, 2, 3};
        expect_order(cloud);
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

template <class S>
bool same_below(const S& a, const S& b, NodeRef x, NodeRef y) {
    if (x.first != y.first || x.count != y.count) return false;
    if (x.leaf() || x.empty()) return true;
    for (int i = 0; i < S::width; ++i) {
        if (!same_below(a, b, a.child(x, i), b.child(y, i))) return false;
        if (!a.child(x, i).empty() && a.volumes(x)[i] != b.volumes(y)[i]) return false;
    }
    return true;
}
template <class I>
void expect_same_tree(const I& a, const I& b) {
    EXPECT_TRUE(std::ranges::equal(a.structure().items(), b.structure().items()));
    EXPECT_EQ(a.structure().depth(), b.structure().depth());
    EXPECT_TRUE(same_below(a.structure(), b.structure(), a.structure().root(), b.structure().root()));
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

/// A chain: one leaf, and all others below its sibling.
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
int depth_of(const BuildTree<double, 3>& tree, std::uint32_t node) {
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
    EXPECT_EQ(lumps.leaves, 25u);  // the last 16 are one
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

TEST(Reinsertion, NeverRaisesTheCost) {
    for (const auto& mesh :
         {teapot_in_stadium<float>(5000), terrain<float>(5000), soup<float>(5000), needles(5000)})
        for (const auto builder : bvh_builders) {
            // Spatial splits go on to single primitives where these are to be moved, and so spend what they
            // may duplicate in other places.
            const double rounding = builder == BvhBuilder::spatial_splits ? 1e-2 : 1e-6;
            double last = cost(mesh, options_of(builder));
            for (const int passes : {1, 3, 9}) {
                const double now = cost(mesh, options_of(builder, passes));
                EXPECT_LE(now, last * (1 + rounding)) << int(builder) << ' ' << passes;
                last = now;
            }
        }
}

TEST(Reinsertion, GainsWhereTrianglesAreLong) {
    const auto mesh = needles(10000);
    EXPECT_LT(cost(mesh, options_of(BvhBuilder::binned, 5)),
              0.93 * cost(mesh, options_of(BvhBuilder::binned)));
    EXPECT_LT(cost(mesh, options_of(BvhBuilder::lbvh, 5)), 0.88 * cost(mesh, options_of(BvhBuilder::lbvh)));
}

// ---- Wide trees

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
    // Where areas say nothing there are as few nodes as may be.
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
        EXPECT_EQ(nearest(index, {1, 2, 3}, 200, near, infinity), cloud.size());
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
/// The areas of the inner nodes, if in each the largest child is opened as long as there is a place.
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
            for (const int width : {4, 8, 16}) {
                const double least = cost(WideCollapse<float, 3>(tree, width, serial_executor()).build());
                const double greedy = greedy_cost(tree, 0, width);
                EXPECT_LT(least, greedy) << int(builder) << ' ' << width;
            }
        }
}

// ---- Refits

TriangleMesh<float> swayed(TriangleMesh<float> mesh, float by) {
    for (auto& v : mesh.vertices)
        v = v + Vec3f(std::sin(9 * v[1]), std::sin(7 * v[2]), std::sin(8 * v[0])) * by;
    return mesh;
}

/// Structures that can be refitted, and the options to try.
struct RefitsBinary {
    template <class P>
    static auto over(const P& set, const BvhOptions& options = {}) {
        return build<Bvh>(set, options);
    }
    static std::vector<BvhOptions> all() {
        std::vector<BvhOptions> list;
        for (const auto builder : bvh_builders) list.push_back(options_of(builder));
        return list;
    }
};
struct RefitsWide {
    template <class P>
    static auto over(const P& set, const WideOptions& options = {}) {
        return build<WideBvh>(set, options);
    }
    static std::vector<WideOptions> all() {
        return {{.builder = WideBuilder::fast, .width = 4},
                {.builder = WideBuilder::medium, .width = 8},
                {.builder = WideBuilder::high, .width = 16}};
    }
};

template <class S>
class Refit : public testing::Test {};
using Refitted = testing::Types<RefitsBinary, RefitsWide>;
TYPED_TEST_SUITE(Refit, Refitted);

TYPED_TEST(Refit, AnswersAsBruteForceDoes) {
    const auto still = teapot<float>(2000);
    for (const auto& options : TypeParam::all()) {
        auto mesh = still;
        auto index = TypeParam::over(mesh, options);
        for (const float by : {0.f, 0.1f, 0.5f, 0.f}) {
            std::ranges::copy(swayed(still, by).vertices, mesh.vertices.begin());
            const double drift = index.refit(default_executor());
            EXPECT_EQ(index.validate(), "");
            EXPECT_EQ(drift, index.structure().drift());
            // What was cut is fitted whole again.
            if (by == 0 && index.structure().exclusive()) {
                EXPECT_EQ(drift, 1);
            }
            const auto oracle = build<BruteForce>(mesh);
            const Questions questions(oracle, 300);
            EXPECT_EQ(answers(index, questions), answers(oracle, questions));
        }
    }
}

TYPED_TEST(Refit, IsTheSameForAnyExecutor) {
    const auto still = soup<float>(30000), moved = swayed(still, 0.2f);
    auto serial = TypeParam::over(still), other = TypeParam::over(still);
    Backwards backwards;
    EXPECT_EQ(serial.refit(moved.view()), other.refit(moved.view(), backwards));
    expect_same_tree(serial, other);
    EXPECT_EQ(serial.refit(still.view()), 1);
}

TYPED_TEST(Refit, TellsHowFarTheQualityDrifts) {
    const auto still = soup<float>(5000);
    auto index = TypeParam::over(still);
    EXPECT_EQ(index.structure().drift(), 1);
    EXPECT_EQ(index.refit(), 1);
    double last = 1;
    for (const std::size_t exchanged : {50u, 500u, 5000u}) {  // triangles that change places
        auto mesh = still;
        for (std::size_t i = 0; i < exchanged; ++i)
            std::swap(mesh.triangles[i], mesh.triangles[Random(1, i).bits() % mesh.size()]);
        const double drift = index.refit(mesh.view());
        EXPECT_GT(drift, 1.1 * last);
        last = drift;
    }
    EXPECT_GT(last, 5);
    EXPECT_EQ(index.refit(still.view()), 1);
}

TYPED_TEST(Refit, ThatIsRefusedLeavesTheIndexAsItWas) {
    const auto still = teapot<float>(2000);
    auto mesh = still;
    auto index = TypeParam::over(still);
    const Questions questions(index, 200);
    const auto before = answers(index, questions);
    mesh = swayed(still, 0.3f);
    mesh.vertices[mesh.triangles[900][1]][2] = std::numeric_limits<float>::quiet_NaN();
    EXPECT_THROW(index.refit(mesh.view()), InputError);
    mesh.vertices[mesh.triangles[900][1]][2] = 1e30f;
    EXPECT_THROW(index.refit(mesh.view()), InputError);
    mesh = still;
    mesh.triangles.pop_back();
    EXPECT_THROW(index.refit(mesh.view()), InputError);
    EXPECT_EQ(answers(index, questions), before);
    EXPECT_EQ(index.structure().drift(), 1);
}

TYPED_TEST(Refit, HoldsForNoneOneAndOtherPrimitives) {
    PointCloud<double, 2> cloud;
    auto none = TypeParam::over(cloud);
    EXPECT_EQ(none.refit(), 1);
    cloud.points.emplace_back(1.0, 2.0);
    auto one = TypeParam::over(cloud);
    cloud.points[0] = {5, 6};
    EXPECT_EQ(one.refit(), 1);
    EXPECT_EQ(one.bounds().low, cloud.points[0]);
    cloud = points2d<double>(1000);
    auto many = TypeParam::over(cloud);
    for (auto& p : cloud.points) p = {p[1] * p[1], p[0]};
    many.refit();
    EXPECT_EQ(many.validate(), "");
    const auto oracle = build<BruteForce>(cloud);
    const Questions questions(oracle, 100);
    EXPECT_EQ(answers(many, questions), answers(oracle, questions));
    for (auto& p : cloud.points) p = {3, 3};  // no area: no line meets it
    EXPECT_GT(many.refit(), 0);
}

}  // namespace
