/// Two-level scenes: any structure over instances of any structure gives the bits of brute force over brute
/// force.
#include <hedgerow/any_index.h>
#include <hedgerow/any_structure.h>
#include <hedgerow/hedgerow.h>
#include <hedgerow/scenes/meshes.h>
#include <hedgerow/scenes/sets.h>

#include "matrix.h"
#include "placements.h"

using namespace hedgerow;

namespace {

/// The answers of an index of instances.
template <class T, int D>
struct Answers {
    std::vector<Hit<T>> closest;
    std::vector<std::vector<Hit<T>>> all;
    std::vector<std::size_t> counts;
    std::vector<Near<T, D>> near;
    std::vector<std::vector<Near<T, D>>> nearest;
    std::vector<std::vector<PlacedId>> overlapping;
};
template <class T, int D>
struct Questions {
    std::vector<Ray<T, D>> rays;
    std::vector<Vec<T, D>> points;
    std::vector<Box<T, D>> boxes;

    Questions() = default;
    Questions(const Box<T, D>& world, const std::vector<Vec<T, D>>& targets, std::size_t count) {
        for (std::size_t i = 0; i < count; ++i) {
            rays.push_back(matrix::ray_of(world, targets, i));
            Random random(9, i);
            if (i % 4 != 0) continue;
            points.push_back(matrix::point_in(world, i % 8 == 0 ? 0.0 : 3.0, random));
            boxes.push_back({});
            for (int c = 0; c < 2; ++c) boxes.back().expand(matrix::point_in(world, 0.1, random));
        }
    }
};

template <class I, class T = typename I::Scalar, int D = I::dimension>
Answers<T, D> ask(const I& index, const Questions<T, D>& questions, bool regions) {
    Answers<T, D> said;
    for (const auto& ray : questions.rays) {
        said.closest.push_back(closest_hit(index, ray));
        said.counts.push_back(hit_count(index, ray) * 2 + any_hit(index, ray));
        all_hits(index, ray, said.all.emplace_back());
    }
    if (!regions) return said;
    for (const auto& p : questions.points) {
        said.near.push_back(closest_point(index, p));
        nearest(index, p, 5, said.nearest.emplace_back());
    }
    for (const auto& box : questions.boxes) overlapping(index, box, said.overlapping.emplace_back());
    return said;
}
template <class T, int D>
void expect_same(const Answers<T, D>& want, const Answers<T, D>& got) {
    for (std::size_t i = 0; i < want.closest.size(); ++i) {
        ASSERT_EQ(want.closest[i], got.closest[i]) << "closest hit of ray " << i;
        ASSERT_EQ(want.counts[i], got.counts[i]) << "count of ray " << i;
        ASSERT_EQ(want.all[i], got.all[i]) << "all hits of ray " << i;
    }
    for (std::size_t i = 0; i < want.near.size(); ++i) {
        ASSERT_EQ(want.near[i], got.near[i]) << "closest point of " << i;
        ASSERT_EQ(want.nearest[i], got.nearest[i]) << "nearest of " << i;
        ASSERT_EQ(want.overlapping[i], got.overlapping[i]) << "overlap of " << i;
    }
}

/// A scene: some indexes of one structure, and the instances that place them again and again.
template <template <class, int> class Inner, class P>
struct Scene {
    using I = IndexOf<Inner, P>;
    std::vector<I> indexes;
    std::vector<Instance<I>> instances;

    Scene(const std::vector<P>& sets, const std::vector<Transform<P::dimension>>& transforms,
          const typename I::Structure::Options& options = {}) {
        for (const P& set : sets) indexes.push_back(build<Inner>(set, options));
        for (std::size_t i = 0; i < transforms.size(); ++i)
            instances.emplace_back(indexes[i % indexes.size()], transforms[i]);
    }
};

template <class P>
struct Case {
    static constexpr int D = P::dimension;
    using T = typename P::Scalar;
    std::vector<P> sets;
    std::vector<Transform<D>> transforms;
    bool regions = true;
    Questions<T, D> questions;
    Answers<T, D> want;

    Case(std::vector<P> s, std::vector<Transform<D>> t, bool r, std::size_t rays)
        : sets(std::move(s)), transforms(std::move(t)), regions(r) {
        const Scene<BruteForce, P> scene(sets, transforms);
        const auto oracle = build<BruteForce>(InnerSet<BruteForce>(scene.instances));
        std::vector<Vec<T, D>> targets;
        for (std::size_t i = 0; i < transforms.size(); ++i) {
            const auto set = view_of(sets[i % sets.size()]);
            for (std::size_t k = 0; k < std::min<std::size_t>(set.size(), 20); ++k)
                targets.push_back(transformed(transforms[i].there(), set.bounds(k).high));
        }
        questions = Questions<T, D>(oracle.bounds(), targets, rays);
        want = ask(oracle, questions, regions);
        const auto hits = std::count_if(want.closest.begin(), want.closest.end(),
                                        [](const auto& hit) { return bool(hit); });
        EXPECT_EQ(hits > 0, (!std::is_same_v<P, PointCloud<T, D>>));
    }

    template <template <class, int> class Inner>
    using InnerSet = InstanceSet<typename Scene<Inner, P>::I>;

    template <template <class, int> class S>
    using Options = typename S<T, D>::Options;

    template <template <class, int> class Outer, template <class, int> class Inner>
    void expect(const std::string& name, const Options<Outer>& outer = {},
                const Options<Inner>& inner = {}) const {
        SCOPED_TRACE(name);
        const Scene<Inner, P> scene(sets, transforms, inner);
        const auto index = build<Outer>(InnerSet<Inner>(scene.instances), outer);
        EXPECT_EQ(index.validate(), "");
        expect_same(want, ask(index, questions, regions));
    }
    /// Pairs of an outer and an inner structure: of each kind of walk in each, and the engine by its type.
    void expect_all() const {
        for (const auto& [outer, inner] : {std::pair{"bvh", "grid"},
                                           {"kdtree", "bvh"},
                                           {"brute-force", "bvh"},
                                           {"bvh", "brute-force"},
                                           {"kdtree", "kdtree"},
                                           {"grid", "bvh"},
                                           {"octree", "grid"},
                                           {"bsp", "kdtree"},
                                           {"wide", "two-level-grid"}})
            expect<AnyStructure, AnyStructure>(std::string(inner) + " in " + outer,
                                               {matrix::named_for<P>(outer)}, {matrix::named_for<P>(inner)});
        if constexpr (std::is_same_v<P, TriangleMesh<float>>)  // which has kernels
            expect<WideBvh, WideBvh>("wide in wide, by their types");
        expect_of_any();
    }
    /// Of indexes of different structures in one scene.
    void expect_of_any() const {
        SCOPED_TRACE("of any index");
        using Any = AnyIndex<T, D>;
        const char* const specs[] = {"wide", "grid", "kdtree:leaf_size=2", "bvh"};
        std::vector<std::unique_ptr<Any>> indexes;
        for (std::size_t i = 0; i < 4 * sets.size(); ++i)
            indexes.push_back(build_any(specs[i / sets.size()], sets[i % sets.size()]));
        std::vector<Instance<Any>> placed;
        for (std::size_t i = 0; i < transforms.size(); ++i)
            placed.emplace_back(*indexes[i % sets.size() + i % 4 * sets.size()], transforms[i]);
        const InstanceSet<Any> world(placed);
        expect_same(want, ask(build<Bvh>(world), questions, regions));
        expect_same(want, ask(build<AnyStructure>(world, {"kdtree"}), questions, regions));
    }
};

template <class T>
class Instances : public testing::Test {};
using Scalars = testing::Types<float, double>;
TYPED_TEST_SUITE(Instances, Scalars);

TYPED_TEST(Instances, OfMeshes) {
    using T = TypeParam;
    const std::vector<TriangleMesh<T>> sets = {teapot<T>(200), cube<T>(12), soup<T>(50)};
    const std::size_t rays = in_long_runs(20000, 400);
    for (const auto scales : {Scales::none, Scales::even, Scales::any})
        Case<TriangleMesh<T>>(sets, transforms<3>(20, scales, 20), true, rays).expect_all();
}

TYPED_TEST(Instances, FarAndFlat) {
    using T = TypeParam;
    TriangleMesh<T> floor = cube<T>(12);
    for (auto& v : floor.vertices) v[1] = T(0);  // flat, and each triangle twice
    auto far = teapot<T>(100);
    for (auto& v : far.vertices) v = v + Vec<T, 3>(T(3e4), T(-1e5), T(2e4));
    auto all = transforms<3>(20, Scales::any, 20);
    for (std::size_t i = 1; i < all.size(); i += 2)  // moves the far mesh back to the origin
        all[i] = all[i] * Transform<3>::translation({-3e4, 1e5, -2e4});
    all.push_back({});
    Case<TriangleMesh<T>>({floor, far}, all, true, 400).expect_all();
    Case<TriangleMesh<T>>({floor}, transforms<3>(20, Scales::none, 1e6), true, 300).expect_all();
}

TYPED_TEST(Instances, TinyAndHuge) {
    using T = TypeParam;
    const double size = std::is_same_v<T, float> ? 1e12 : 1e100;
    std::vector<Transform<3>> tiny, huge;
    for (const auto& t : transforms<3>(12, Scales::any, 20)) {
        tiny.push_back(Transform<3>::scaling(1 / size) * t);
        huge.push_back(Transform<3>::scaling(size) * t);
    }
    const std::vector<TriangleMesh<T>> sets = {teapot<T>(100), cube<T>(12)};
    Case<TriangleMesh<T>>(sets, tiny, true, 300).expect_all();
    Case<TriangleMesh<T>>(sets, huge, true, 300).expect_all();
}

TYPED_TEST(Instances, OfOtherPrimitives) {
    using T = TypeParam;
    Case<SphereSet<T, 3>>({spheres<T>(60)}, transforms<3>(20, Scales::even, 4), true, 500).expect_all();
    Case<SphereSet<T, 3>>({spheres<T>(60)}, transforms<3>(20, Scales::any, 4), false, 500).expect_all();
    Case<PointCloud<T, 3>>({points<T>(60)}, transforms<3>(20, Scales::any, 4), true, 100).expect_all();
    Case<SegmentSet<T>>({segments2d<T>(60)}, transforms<2>(20, Scales::any, 4), true, 500).expect_all();
}

/// A mesh that is translated by whole numbers is hit exactly as if its vertices were there.
TYPED_TEST(Instances, SayWhatIsHit) {
    using T = TypeParam;
    const auto mesh = cube<T>(12);
    const auto grid = build<Grid>(mesh);
    const auto index = build<Bvh>(
        InstanceSet{Instance(grid), Instance(grid, Transform<3>::translation({4, 0, 0})), Instance(grid)});
    const Ray<T, 3> right{{T(4.25), T(0.5), T(8)}, {T(0), T(0), T(-2)}};
    const auto hit = closest_hit(index, right);
    ASSERT_TRUE(bool(hit));
    EXPECT_EQ(hit.t, T(3.5));
    EXPECT_EQ(hit.instance, 1u);
    const auto alone = closest_hit(grid, Ray<T, 3>{{T(0.25), T(0.5), T(8)}, {T(0), T(0), T(-2)}});
    EXPECT_EQ(hit.element, alone.element);
    // Of two instances in one place the first is the closest hit. Both are counted.
    const Ray<T, 3> left{{T(0.25), T(0.5), T(8)}, {T(0), T(0), T(-1)}};
    EXPECT_EQ(closest_hit(index, left).instance, 0u);
    EXPECT_EQ(hit_count(index, left), 4u);
    EXPECT_EQ(closest_hit(index, left, Except{closest_hit(index, left).element}).instance, 2u);
    // Closest points and overlaps name the instance too.
    const auto near = closest_point(index, Vec<T, 3>(T(4), T(0), T(3)));
    EXPECT_EQ(near.instance, 1u);
    EXPECT_EQ(near.distance2, T(4));
    std::vector<PlacedId> found;
    overlapping(index, Box<T, 3>{{T(3), T(-2), T(-2)}, {T(3), T(2), T(2)}}, found);
    ASSERT_FALSE(found.empty());
    for (const auto& id : found) EXPECT_EQ(id.instance, 1u);
}

/// Triangles, spheres and points in one world: its answers are those of each instance alone, put together.
TYPED_TEST(Instances, OfManyKindsInOneWorld) {
    using T = TypeParam;
    using Any = AnyIndex<T, 3>;
    const auto mesh = teapot<T>(100);
    const auto balls = spheres<T>(60);
    const auto cloud = points<T>(60);
    const std::unique_ptr<Any> indexes[] = {build_any("wide", mesh), build_any("octree", balls),
                                            build_any("point-kdtree", cloud), build_any("bsp", mesh)};
    std::vector<Instance<Any>> placed;
    for (const auto& transform : transforms<3>(16, Scales::even, 6)) {
        const auto i = static_cast<std::uint32_t>(placed.size());
        placed.emplace_back(*indexes[i % 4], transform, 1u << i % 3, 5 * i);
    }
    const auto merged = [&](const auto& ask) {
        decltype(ask(build<BruteForce>(InstanceSet<Any>(std::span(placed).first(1))))) all;
        for (std::uint32_t i = 0; i < placed.size(); ++i)
            for (auto found : ask(build<BruteForce>(InstanceSet<Any>{placed[i]}))) {
                found.instance = i;
                all.push_back(found);
            }
        return all;
    };
    const auto world = build<Bvh>(InstanceSet<Any>(placed));
    std::size_t hits = 0;
    for (std::size_t k = 0; k < 100; ++k) {
        const auto ray = matrix::ray_of(world.bounds(), {world.bounds().center()}, k);
        auto all = merged([&](const auto& one) { return all_hits(one, ray); });
        std::sort(all.begin(), all.end(), [](const auto& a, const auto& b) { return hit_before(a, b); });
        ASSERT_EQ(all_hits(world, ray), all) << "ray " << k;
        ASSERT_EQ(closest_hit(world, ray), all.empty() ? Hit<T>() : all[0]) << "ray " << k;
        ASSERT_EQ(any_hit(world, ray), !all.empty()) << "ray " << k;
        hits += all.size();
        auto seen = all;
        std::erase_if(seen, [&](const Hit<T>& hit) { return (placed[hit.instance].mask & 5) == 0; });
        ASSERT_EQ(closest_hit(world, ray, {.mask = 5}), seen.empty() ? Hit<T>() : seen[0]) << "ray " << k;
        Random random(3, k);
        const auto p = matrix::point_in(world.bounds(), 0.5, random);
        auto near = merged([&](const auto& one) { return nearest(one, p, 100); });
        std::sort(near.begin(), near.end(), [](const auto& a, const auto& b) { return nearer(a, b); });
        near.resize(100);
        ASSERT_EQ(nearest(world, p, 100), near) << "point " << k;
        const Sphere<T, 3> ball{p, T(1)};
        ASSERT_EQ(overlapping(world, ball), merged([&](const auto& one) { return overlapping(one, ball); }))
            << "ball " << k;
    }
    EXPECT_GT(hits, 100u);
}

TEST(Transforms, GoThereAndBack) {
    for (std::uint64_t i = 0; i < 1000; ++i) {
        const auto t = transform_of<3>(i, Scales::any, 100);
        Random random(2, i);
        const Vec3d p = random.in_cube<3>() * 10.0, q = t.back().point(t.there().point(p));
        EXPECT_LT(length(p - q), 1e-10);
        EXPECT_LT(t.residual(), 1e-12);
        // The transformed box contains the transformed points of the box, with no tolerance.
        Box3d box;
        for (int c = 0; c < 2; ++c) box.expand(random.in_cube<3>() * 10.0);
        const auto world = t.there().box(box);
        for (int k = 0; k < 8; ++k)
            EXPECT_TRUE(world.contains(t.there().point(matrix::point_in(box, 0.0, random))));
        EXPECT_TRUE(world.contains(t.there().point(box.low)) && world.contains(t.there().point(box.high)));
        // No vector is stretched by more than the greatest stretch or by less than the least.
        const Vec3d s = t.there().stretches(), v = random.direction<3>();
        const double by = length(t.there().vector(v));
        EXPECT_LE(by, max_component(s) * (1 + 1e-12));
        EXPECT_GE(by, -max_component(-s) * (1 - 1e-12));
    }
}

TEST(Transforms, RefuseWhatCannotBeUndone) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    EXPECT_THROW(Transform<3>::scaling({1, 0, 1}), InputError);
    EXPECT_THROW(Transform<3>::scaling({1, nan, 1}), InputError);
    EXPECT_THROW(Transform<3>::translation({std::numeric_limits<double>::infinity(), 0, 0}), InputError);
    EXPECT_THROW(Transform<3>({Vec3d(1, 2, 3), Vec3d(4, 5, 6), Vec3d(7, 8, 9)}, {}), InputError);
    EXPECT_NO_THROW(Transform<3>::scaling({1e-200, 1, 1e200}));
    EXPECT_NO_THROW(Transform<2>::scaling({-1, 1}));
}

TEST(InstanceSets, RefuseWhatHasNoAnswer) {
    const TriangleMesh<float> none;
    const auto nothing = build<Bvh>(none);
    EXPECT_THROW((InstanceSet{Instance(nothing)}), InputError);
    const auto balls = spheres<float>(10);
    const auto inner = build<Bvh>(balls);
    const auto index = build<Bvh>(InstanceSet{Instance(inner, Transform<3>::scaling({1, 2, 1}))});
    EXPECT_THROW(closest_point(index, Vec3f(3, 3, 3)), InputError);
}

}  // namespace
