/// Kernels over instances: every instruction set and width, on both levels or below any structure, against
/// brute force over brute force, with filters and masks.
#include <hedgerow/hedgerow.h>
#include <hedgerow/scenes/meshes.h>

#include "engine.h"
#include "filtered.h"
#include "placements.h"

using namespace hedgerow;
using namespace hedgerow::matrix;

namespace {

using Mesh = TriangleMesh<float>;
using Wide = IndexOf<WideBvh, Mesh>;
using Brute = IndexOf<BruteForce, Mesh>;

/// Meshes and the transforms of their instances. Instance i has mesh i modulo the number of meshes.
struct Scene {
    std::vector<Mesh> meshes;
    std::vector<Transform<3>> transforms;

    static std::uint32_t mask(std::size_t i) { return 1u << i % 3; }
    static std::uint32_t geometry(std::size_t i) { return static_cast<std::uint32_t>(7 * i + 1); }

    template <class I>
    InstanceSet<I> over(const std::vector<I>& indexes) const {
        std::vector<Instance<I>> all;
        for (std::size_t i = 0; i < transforms.size(); ++i)
            all.emplace_back(indexes[i % indexes.size()], transforms[i], mask(i), geometry(i));
        return InstanceSet<I>(all);
    }
    /// Indexes of widths 4, 8 and 16 in turn, so that one scene has several widths.
    std::vector<Wide> wide() const {
        std::vector<Wide> all;
        for (std::size_t i = 0; i < meshes.size(); ++i) {
            WideOptions options;
            options.width = 4 << i % 3;
            all.push_back(build<WideBvh>(meshes[i], options));
        }
        return all;
    }
    Points<float, 3> targets() const {
        Points<float, 3> all;
        for (std::size_t i = 0; i < transforms.size(); ++i)
            for (std::size_t k = 0; k < 10; ++k)
                all.push_back(
                    transformed(transforms[i].there(), meshes[i % meshes.size()].view().triangle(k).b));
        return all;
    }
};

/// Enters only instances whose mask has a wanted bit.
struct InMasks {
    std::uint32_t wanted;
    bool enters(std::uint32_t mask) const { return (mask & wanted) != 0; }
    bool operator()(const Hit<float>&) const { return true; }
};
/// The filter of hits that keeps what InMasks keeps.
struct OfMask {
    std::uint32_t wanted;
    bool operator()(const Hit<float>& hit) const { return (Scene::mask(hit.instance) & wanted) != 0; }
};
/// A filter of masks and of hits.
struct OddInMasks : InMasks {
    bool operator()(const Hit<float>& hit) const { return hit.element % 2 != 0; }
};

template <class Index>
void expect_answers(const Index& index, const Expected<float>& expected, bool filtered) {
    using H = Hit<float>;
    expect_filtered("all", index, expected, KeepAll());
    for (std::size_t i = 0; i < expected.rays.size(); ++i) {
        const auto& all = expected.all[i];
        const H want = all.empty() ? H() : all[0];
        ASSERT_EQ(want, closest_hit(index, expected.rays[i])) << "ray " << i;
        ASSERT_EQ(bool(want), any_hit(index, expected.rays[i])) << "any, ray " << i;
    }
    if (!filtered) return;
    expect_filtered("none", index, expected, [](const H&) { return false; });
    expect_filtered("masks", index, expected, InMasks{5}, OfMask{5});
    expect_filtered("no mask", index, expected, InMasks{8}, OfMask{8});
    expect_filtered("masks and elements", index, expected, OddInMasks{{3}},
                    [](const H& h) { return OfMask{3}(h) && h.element % 2 != 0; });
    expect_filtered("by instance", index, expected, [](const H& h) { return h.instance % 2 != 0; });
    expect_filtered("by geometry", index, expected, [](const H& h) { return h.geometry > 40; });
    expect_filtered("by t", index, expected, [](const H& h) { return h.t > 0.7f; });
    expect_filtered("by ray", index, expected, [](std::size_t i, const H&) { return i % 3 != 0; });
    expect_filtered("but the first", index, expected, [&](std::size_t i, const H& h) {
        return h.element != expected.all[i][0].element || h.instance != expected.all[i][0].instance;
    });
}

void expect_brute_force(const char* name, const Scene& scene, std::size_t count, bool filtered = true) {
    SCOPED_TRACE(name);
    // Query brute force over brute force.
    std::vector<Brute> brutes;
    for (const auto& mesh : scene.meshes) brutes.push_back(build<BruteForce>(mesh));
    const auto oracle_set = scene.over(brutes);
    const auto oracle = build<BruteForce>(oracle_set);
    const Expected<float> expected(oracle, apart(oracle.bounds(), scene.targets(), count));
    EXPECT_TRUE(
        std::any_of(expected.all.begin(), expected.all.end(), [](const auto& h) { return h.size() > 1; }));

    // Put wide BVHs below each outer structure.
    const auto wide = scene.wide();
    const auto set = scene.over(wide);
    const auto in_bvh = build<Bvh>(set);
    const auto in_grid = build<Grid>(set);
    const auto in_kdtree = build<KdTree>(set);
    const auto in_brute_force = build<BruteForce>(set);
    // Compare with each instruction set, in wide BVHs of each width and in the others.
    for (const auto instructions : instruction_sets()) {
        const Using use(instructions);
        SCOPED_TRACE(instructions);
        for (const int width : wide_widths) {
            SCOPED_TRACE(width);
            WideOptions options;
            options.width = width;
            if (width == 8) options.intersection_cost = 0;  // so leaves hold several instances
            const auto index = build<WideBvh>(set, options);
            ASSERT_EQ(index.validate(), "");
            expect_answers(index, expected, filtered);
        }
        expect_answers(in_bvh, expected, filtered);
        expect_answers(in_grid, expected, filtered);
        expect_answers(in_kdtree, expected, filtered);
        expect_answers(in_brute_force, expected, filtered);
        if (testing::Test::HasFatalFailure()) return;
    }
}

const std::vector<Mesh>& meshes() {
    static const std::vector<Mesh> all = {teapot<float>(200), cube<float>(12), soup<float>(50),
                                          teapot<float>(60)};
    return all;
}

TEST(WideInstances, PlacedInEveryWay) {
    for (const auto scales : {Scales::none, Scales::even, Scales::any})
        expect_brute_force("placed", {meshes(), transforms<3>(20, scales, 20)}, in_long_runs(3000, 300));
}

TEST(WideInstances, Sheared) {
    auto all = transforms<3>(20, Scales::any, 20);
    for (auto& placed : all)
        placed =
            placed * Transform<3>({Vec3d(1, 0.5, -2), Vec3d(0, 1, 3), Vec3d(0.25, 0, -1)}, Vec3d(1, 2, 3));
    expect_brute_force("sheared", {meshes(), all}, 300);
}

/// Of instances in one place the hit has the lowest number, in whatever order they are tested. If a filter
/// refuses it, the hit has the next number.
TEST(WideInstances, CoincidentCopies) {
    std::vector<Transform<3>> all;
    for (const auto& t : transforms<3>(5, Scales::any, 6)) all.insert(all.begin(), 8, t);
    expect_brute_force("coincident", {{teapot<float>(100)}, all}, 300);
    expect_brute_force("identical", {{teapot<float>(100)}, {20, Transform<3>()}}, 300);
}

TEST(WideInstances, FarFlatTinyAndHuge) {
    Mesh floor = cube<float>(12);
    for (auto& v : floor.vertices) v[1] = 0;
    Mesh far = teapot<float>(100);
    for (auto& v : far.vertices) v = v + Vec3f(3e4f, -1e5f, 2e4f);
    auto back = transforms<3>(20, Scales::any, 20);
    for (std::size_t i = 1; i < back.size(); i += 2)
        back[i] = back[i] * Transform<3>::translation({-3e4, 1e5, -2e4});
    expect_brute_force("flat and far", {{floor, far}, back}, 300, false);
    expect_brute_force("far off", {{floor, meshes()[0]}, transforms<3>(20, Scales::none, 1e6)}, 300, false);
    for (const double size : {1e-12, 1e12}) {
        auto scaled = transforms<3>(12, Scales::any, 20);
        for (auto& t : scaled) t = Transform<3>::scaling(size) * t;
        expect_brute_force("scaled", {meshes(), scaled}, 300, false);
    }
}

/// Masks apply to every query that takes a filter, over indexes of any kind.
TEST(WideInstances, MasksAreAskedByEveryQuery) {
    const auto grid = build<Grid>(meshes()[0]);
    const auto set = InstanceSet{Instance(grid, {}, 1), Instance(grid, Transform<3>::scaling(2), 2, 9)};
    const auto index = build<KdTree>(set);
    const Ray3f ray{{0.1f, 0.2f, 20}, {0, 0, -1}};
    std::vector<Hit<float>> both, first, second;
    ASSERT_GT(all_hits(index, ray, both), 2u);
    const std::size_t one = all_hits(index, ray, first, InMasks{1});
    const std::size_t two = all_hits(index, ray, second, InMasks{6});
    EXPECT_EQ(one + two, both.size());
    EXPECT_EQ(hit_count(index, ray, InMasks{1}), one);
    EXPECT_EQ(closest_hit(index, ray, InMasks{1}).instance, 0u);
    EXPECT_EQ(closest_hit(index, ray, InMasks{2}).geometry, 9u);
    EXPECT_FALSE(any_hit(index, ray, InMasks{4}));
    EXPECT_EQ(hit_count(index, ray, InMasks{4}), 0u);
}

TEST(WideInstances, GoRayByRay) {
    const auto index = build<WideBvh>(meshes()[0]);
    const InstanceSet set{Instance(index), Instance(index, Transform<3>::translation({9, 0, 0}))};
    const auto world = build<WideBvh>(set);
    const auto rays = together(world.bounds(), 200);
    std::vector<Hit<float>> hits(200);
    EXPECT_EQ(closest_hits(world, rays, hits).single, 200u);
    EXPECT_TRUE(std::any_of(hits.begin(), hits.end(), [](const auto& hit) { return bool(hit); }));
}

TEST(WideInstances, AnUnusableRayHitsNothing) {
    const auto index = build<WideBvh>(meshes()[0]);
    const InstanceSet set{Instance(index)};
    const auto wide = build<WideBvh>(set);
    const auto binary = build<Bvh>(set);
    constexpr float nan = std::numeric_limits<float>::quiet_NaN();
    const Vec3f o(0.1f, 0.2f, 20), d(0, 0, -1);
    EXPECT_TRUE(any_hit(wide, Ray3f{o, d}));
    for (const auto& ray : {Ray3f{o, {0, 0, 0}},
                            {o, {nan, 0, -1}},
                            {{nan, 0, 9}, d},
                            {o, d, nan, 99},
                            {o, d, 0, nan},
                            {o, d, 99, 1},
                            {o, Vec3f::all(1e-40f)}}) {
        EXPECT_FALSE(closest_hit(wide, ray) || any_hit(wide, ray));
        EXPECT_FALSE(closest_hit(binary, ray) || any_hit(binary, ray));
    }
    const std::vector<Instance<Wide>> none;
    const auto empty = build<WideBvh>(InstanceSet<Wide>(none));
    EXPECT_FALSE(closest_hit(empty, Ray3f{o, d}) || any_hit(empty, Ray3f{o, d}));
}

}  // namespace
