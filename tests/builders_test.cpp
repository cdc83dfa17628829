/// The BVH's builders: valid trees whatever the scene, the same for any executor, none too deep, their costs
/// in proportion; improvement by reinsertion; refits.
#include <numeric>

#include <hedgerow/scenes/meshes.h>
#include <hedgerow/scenes/sets.h>
#include <hedgerow/structures/bvh/builders/collapse.h>
#include <hedgerow/structures/bvh/builders/morton.h>

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

template <class P>
void expect_right(const char* name, const P& set) {
    SCOPED_TRACE(name);
    const auto oracle = build<BruteForce>(set);
    with_each_builder([&](const BvhOptions& options) {
        const auto index = build<Bvh>(set, options);
        EXPECT_EQ(index.validate(), "");
        EXPECT_LE(index.structure().depth(), bvh_max_depth);
        EXPECT_EQ(index.structure().node_count(),
                  set.size() == 0 ? 0 : 2 * index.structure().leaf_count() - 1);
        if (set.size() == 0) return;
        const Questions questions(oracle, 40);
        EXPECT_EQ(answers(index, questions), answers(oracle, questions));
    });
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
    if (x.leaf()) return true;
    for (int i = 0; i < 2; ++i) {
        const auto of_a = a.volumes(x)[i], of_b = b.volumes(y)[i];
        if (of_a.low != of_b.low || of_a.high != of_b.high) return false;
        if (!same_below(a, b, a.child(x, i), b.child(y, i))) return false;
    }
    return true;
}
template <class I>
void expect_same_tree(const I& a, const I& b) {
    EXPECT_TRUE(std::ranges::equal(a.structure().items(), b.structure().items()));
    EXPECT_EQ(a.structure().depth(), b.structure().depth());
    EXPECT_TRUE(same_below(a.structure(), b.structure(), a.structure().root(), b.structure().root()));
}

TEST(Builders, GiveTheSameTreeForAnyNumberOfThreads) {
    const auto mesh = needles(20000);
    Backwards backwards;
    with_each_builder([&](const BvhOptions& options) {
        const auto serial = build<Bvh>(mesh, options);
        expect_same_tree(serial, build<Bvh>(mesh, options, backwards));
        for (const unsigned threads : {1u, 2u}) {
            const ThreadLimit limit(threads);
            expect_same_tree(serial, build<Bvh>(mesh, options, default_executor()));
        }
    });
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
    with_each_builder([&](const BvhOptions& options) {
        const auto index = build<Bvh>(balls, options);
        EXPECT_EQ(index.validate(), "");
        EXPECT_LE(index.structure().depth(), bvh_max_depth);
    });
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

// ---- Refits

TriangleMesh<float> swayed(TriangleMesh<float> mesh, float by) {
    for (auto& v : mesh.vertices)
        v = v + Vec3f(std::sin(9 * v[1]), std::sin(7 * v[2]), std::sin(8 * v[0])) * by;
    return mesh;
}

TEST(Refit, AnswersAsBruteForceDoes) {
    const auto still = teapot<float>(2000);
    for (const auto builder : bvh_builders) {
        auto mesh = still;
        auto index = build<Bvh>(mesh, options_of(builder));
        for (const float by : {0.f, 0.1f, 0.5f, 0.f}) {
            std::ranges::copy(swayed(still, by).vertices, mesh.vertices.begin());
            const double drift = index.refit(default_executor());
            EXPECT_EQ(index.validate(), "");
            EXPECT_EQ(drift, index.structure().drift());
            // What was cut is fitted whole again.
            if (by == 0 && builder != BvhBuilder::spatial_splits) {
                EXPECT_EQ(drift, 1);
            }
            const auto oracle = build<BruteForce>(mesh);
            const Questions questions(oracle, 300);
            EXPECT_EQ(answers(index, questions), answers(oracle, questions));
        }
    }
}

TEST(Refit, IsTheSameForAnyExecutor) {
    const auto still = soup<float>(30000), moved = swayed(still, 0.2f);
    auto serial = build<Bvh>(still), other = build<Bvh>(still);
    Backwards backwards;
    EXPECT_EQ(serial.refit(moved.view()), other.refit(moved.view(), backwards));
    expect_same_tree(serial, other);
    EXPECT_EQ(serial.refit(still.view()), 1);
}

TEST(Refit, TellsHowFarTheQualityDrifts) {
    const auto still = soup<float>(5000);
    auto index = build<Bvh>(still);
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

TEST(Refit, ThatIsRefusedLeavesTheIndexAsItWas) {
    const auto still = teapot<float>(2000);
    auto mesh = still;
    auto index = build<Bvh>(still);
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

TEST(Refit, HoldsForNoneOneAndOtherPrimitives) {
    PointCloud<double, 2> cloud;
    auto none = build<Bvh>(cloud);
    EXPECT_EQ(none.refit(), 1);
    cloud.points.emplace_back(1.0, 2.0);
    auto one = build<Bvh>(cloud);
    cloud.points[0] = {5, 6};
    EXPECT_EQ(one.refit(), 1);
    EXPECT_EQ(one.bounds().low, cloud.points[0]);
    cloud = points2d<double>(1000);
    auto many = build<Bvh>(cloud);
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
