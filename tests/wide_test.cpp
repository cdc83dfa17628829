/// The engine: every instruction set of this machine gives the bits of brute force, one ray at a time and in
/// batches of any size, on trees of any width.
#include "engine.h"

#include <hedgerow/engine/wide_bvh.h>
#include <hedgerow/mesh_index.h>
#include <hedgerow/scenes/meshes.h>
#include <hedgerow/structures/brute_force.h>
#include <hedgerow/structures/bvh/bvh.h>
#include <hedgerow/structures/grid/grid.h>

using namespace hedgerow;
using namespace hedgerow::matrix;

namespace {

using Mesh = TriangleMesh<float>;

/// Compares all instruction sets × widths × builders with brute force, on `count` rays of every kind.
void expect_brute_force(const char* name, const Mesh& mesh, std::size_t count) {
    SCOPED_TRACE(name);
    // Query brute force.
    const auto brute = build<BruteForce>(mesh);
    const auto targets = targets_of(mesh);
    std::vector<Ray3f> rays;
    for (std::size_t i = 0; i < count && !targets.empty(); ++i)
        rays.push_back(ray_of(brute.bounds(), targets, i));
    if (targets.empty()) rays.push_back({Vec3f(0, 0, 0), Vec3f(1, 2, 3)});
    std::vector<Hit<float>> want(rays.size());
    closest_hits(brute, std::span<const Ray3f>(rays), std::span(want), {.threads = default_executor()});
    // Compare each tree, with each instruction set.
    for (const int width : wide_widths)
        for (const auto builder : wide_builders) {
            WideOptions options;
            options.width = width;
            options.builder = builder;
            options.max_leaf_size = builder == WideBuilder::fast ? 3 : 8;
            const auto index = build<WideBvh>(mesh, options);
            ASSERT_EQ(index.validate(), "");
            for (const auto set : instruction_sets()) {
                SCOPED_TRACE(std::string(set) + ", width " + std::to_string(width));
                const Using use(set);
                expect_hits(want, Answers(index, rays));
                if (testing::Test::HasFatalFailure()) return;
            }
        }
}

/// Compares all instruction sets with the plain walk.
void expect_hits_of_the_walk(const MeshIndex<float>& index, const std::vector<Ray3f>& rays) {
    const auto want = hits_of_the_walk(index, rays);
    for (const auto set : instruction_sets()) {
        SCOPED_TRACE(set);
        const Using use(set);
        expect_hits(want, Answers(index, rays));
    }
}

/// Triangles each so much larger than the last that no box is shared: the deepest tree there is.
Mesh chain(int count) {
    Mesh mesh;
    for (int i = 0; i < count; ++i) {
        const float at = std::ldexp(1.0f, i - count / 2);
        const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
        mesh.vertices.insert(mesh.vertices.end(), {{at, 0, 0}, {at, at * 0.5f, 0}, {at, 0, at * 0.5f}});
        mesh.triangles.push_back({first, first + 1, first + 2});
    }
    return mesh;
}

TEST(Wide, GeneratedMeshesAsBruteForce) {
    expect_brute_force("soup", soup<float>(500), 1500);
    expect_brute_force("stadium", teapot_in_stadium<float>(2000), 1000);
    expect_brute_force("hairball", hairball<float>(1500), 1000);
    expect_brute_force("terrain", terrain<float>(2000), 1000);
}

TEST(Wide, TinyHugeAndFarMeshesAsBruteForce) {
    for (const float scale : {1e-30f, 1e-12f, 1e12f, 1e17f}) {
        Mesh mesh = soup<float>(200);
        for (auto& v : mesh.vertices) v = v * scale;
        expect_brute_force("scaled", mesh, 1000);
    }
    Mesh far = soup<float>(200);
    for (auto& v : far.vertices) v = v + Vec3f(1e4f, -3e3f, 1e5f);
    expect_brute_force("far", far, 1000);
}

TEST(Wide, DegenerateMeshesAsBruteForce) {
    expect_brute_force("empty", {}, 0);
    Mesh mesh;
    // The vertices are in one plane that is not across an axis, so no box is flat.
    mesh.vertices = {{0, 0, 0}, {1, 0, 0.5f}, {0, 1, 0.75f}, {1, 1, 1.25f}};
    mesh.triangles = {{0, 1, 2}};
    expect_brute_force("one", mesh, 500);
    mesh.triangles.assign(100, {0, 1, 2});
    expect_brute_force("coincident", mesh, 500);
    mesh.triangles.assign(30, {0, 0, 0});
    mesh.triangles.resize(60, {0, 1, 1});
    mesh.triangles.resize(70, {0, 1, 2});
    expect_brute_force("of no area", mesh, 500);
    mesh.triangles = {{0, 1, 2}, {1, 3, 2}};
    expect_brute_force("coplanar", mesh, 500);
    expect_brute_force("chain", chain(90), 500);
}

TEST(Wide, BatchesOfAnySize) {
    const auto mesh = teapot_in_stadium<float>(1000);
    const auto targets = targets_of(mesh);
    for_each_kernel(mesh, [&](const auto& index, std::string_view) {
        for (const std::size_t count : {0u, 1u, 2u, 15u, 16u, 17u, 31u, 33u, 64u, 65u, 257u, 5000u}) {
            std::vector<Ray3f> rays(count);
            for (std::size_t i = 0; i < count; ++i) rays[i] = ray_of(index.bounds(), targets, 7 * i);
            expect_hits(hits_of_the_walk(index, rays), Answers(index, rays));
            if (testing::Test::HasFatalFailure()) return;
        }
    });
}

TEST(Wide, IntervalsThatEndAtAHit) {
    // Steps of a staircase, which lie across the rays' longest axis: a hit has the s of all three corners.
    Mesh mesh;
    for (std::uint32_t i = 0; i < 64; ++i) {
        Random random(3, i);
        const std::uint32_t column = i % 8, row = i / 8;
        const float x = static_cast<float>(column), y = static_cast<float>(row),
                    z = static_cast<float>(random.uniform());
        mesh.vertices.insert(mesh.vertices.end(),
                             {{x, y, z}, {x + 1, y, z}, {x, y + 1, z}, {x + 1, y + 1, z}});
        mesh.triangles.push_back({4 * i, 4 * i + 1, 4 * i + 2});
        mesh.triangles.push_back({4 * i + 1, 4 * i + 3, 4 * i + 2});
    }
    const auto brute = build<BruteForce>(mesh);
    std::vector<Ray3f> rays;
    for (std::uint64_t i = 0; rays.size() < 20'000; ++i) {
        Random random(5, i);
        const Vec3d from(random.uniform(0, 8), random.uniform(0, 8), random.uniform(1, 9));
        const Vec3d along(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-3, -1));
        Ray3f ray{Vec3f(from), Vec3f(along)};
        const float t = closest_hit(brute, ray).t;
        if (std::isinf(t)) continue;
        // The interval ends at the hit or begins there, or it is too short for it by the least step.
        const float end = i % 2 == 0 ? t : std::nextafter(t, i % 4 == 1 ? 0.0f : 100.0f);
        (i / 4 % 2 == 0 ? ray.t_max : ray.t_min) = end;
        rays.push_back(ray);
    }
    const auto want = std::make_unique<bool[]>(rays.size()), found = std::make_unique<bool[]>(rays.size());
    for (std::size_t i = 0; i < rays.size(); ++i) want[i] = any_hit(brute, rays[i]);
    EXPECT_GT(std::count(want.get(), want.get() + rays.size(), true), 5000);
    EXPECT_GT(std::count(want.get(), want.get() + rays.size(), false), 2000);
    for_each_kernel(mesh, [&](const auto& index, std::string_view) {
        any_hits(index, rays, {found.get(), rays.size()});
        for (std::size_t i = 0; i < rays.size(); ++i) {
            ASSERT_EQ(any_hit(index, rays[i]), want[i]) << i;
            ASSERT_EQ(found[i], want[i]) << i;
        }
    });
}

TEST(Wide, CoherentRays) {
    const auto mesh = teapot_in_stadium<float>(3000);
    const auto index = build<WideBvh>(mesh);
    // Take pictures of 48 × 48 from eight corners; one is parallel. Cut short some rays.
    const Vec3f center = index.bounds().center(), size = index.bounds().extent();
    std::vector<Ray3f> rays;
    for (int view = 0; view < 8; ++view)
        for (int y = 0; y < 48; ++y)
            for (int x = 0; x < 48; ++x) {
                const Vec3f eye =
                    center + Vec3f(view & 1 ? 1 : -1, view & 2 ? 1 : -1, view & 4 ? 1 : -1) * length(size);
                const Vec3f beside(float(x) / 48 - 0.5f, float(y) / 48 - 0.5f, 0.1f * float(view - 4));
                Ray3f ray{eye, center - eye + beside * length(size)};
                if (view == 3) ray.origin = ray.origin + beside, ray.direction = center - eye;
                if (x % 16 == 5) ray.t_max = 0.9f;
                rays.push_back(ray);
            }
    expect_hits_of_the_walk(index, rays);
}

/// Rays of a picture whose components change sign, or whose longest axis changes. A packet has up to four
/// such ways, in any order, with one ray of a way or many, and some components are 0 or -0.
TEST(Wide, RaysThatGoSeveralWaysTogether) {
    const auto mesh = teapot_in_stadium<float>(3000);
    const auto index = build<WideBvh>(mesh);
    const Vec3f center = index.bounds().center();
    std::vector<Ray3f> rays;
    for (int bunch = 0; bunch < 96; ++bunch)
        for (int i = 0; i < 64; ++i) {
            Random random(29, static_cast<std::uint64_t>(bunch));
            const int alone = bunch % 3 == 0 ? 16 : 4;  // how many go one way before the next
            const float x = (i / alone) % 2 == 0 ? -0.05f : 0.05f, y = (i / 8) % 2 == 0 ? 0.04f : -0.04f;
            Vec3f d(x, bunch % 2 == 0 ? y : 0.04f, 1 + 0.001f * float(i));
            if (bunch % 4 == 1) d[0] = i % 2 == 0 ? 0.0f : -0.0f;
            if (bunch % 5 == 2) d[1] = i % 7 == 0 ? 1.2f : 0.9f;  // z is the longest, or y
            const Vec3f turned(d[bunch % 3], d[(bunch + 1) % 3], d[(bunch + 2) % 3]);
            const Vec3f origin = bunch % 6 < 3 ? center : center + Vec3f(random.direction<3>()) * float(i);
            rays.push_back({origin, turned});
        }
    const auto want = hits_of_the_walk(index, rays);
    std::vector<Hit<float>> hits(rays.size());
    for (const auto set : instruction_sets()) {
        SCOPED_TRACE(set);
        const Using use(set);
        expect_hits(want, Answers(index, rays));
        EXPECT_EQ(closest_hits(index, rays, hits).packets, set == "plain" ? 0 : rays.size());
    }
}

/// 64 rays that go all ways from near one place. Some bunches are short, some have no end or no length, and
/// some components are 0 or -0.
std::vector<Ray3f> bunch_of_rays(std::uint64_t bunch, const Vec3f& near, float size) {
    constexpr float infinity = std::numeric_limits<float>::infinity();
    const float ends[] = {0.02f * size, 0.1f * size, 2 * size, infinity, 0, 1e-30f};
    const float end = ends[bunch % 6], spread = bunch % 4 == 0 ? 0 : 0.01f * size;
    const float far = bunch % 8 == 3 ? 1000 * size : 0;  // of the scene: few rays reach it
    Random random(31, bunch);
    std::vector<Ray3f> rays;
    for (int i = 0; i < 64; ++i) {
        Vec3f d(random.direction<3>());
        if (i % 9 == 4) d[static_cast<int>(bunch % 3)] = i % 2 == 0 ? 0.0f : -0.0f;
        const float longer = i % 5 == 2 ? 1e12f : 1;  // the same ray, told in other units
        const Vec3f origin = near + Vec3f(far, 0, -far) + Vec3f(random.direction<3>()) * spread;
        rays.push_back({origin, d * longer, 0, end / longer});
    }
    return rays;
}

/// Any hits of rays that go all ways are answered in bundles, as long as they share nodes.
TEST(Wide, ShortRaysThatGoAllWays) {
    const std::uint64_t count = in_long_runs(80000, 96), at_once = 96;
    for (const auto& mesh : {teapot_in_stadium<float>(3000), soup<float>(3000)}) {
        const auto index = build<WideBvh>(mesh);
        const auto targets = targets_of(mesh);
        const float size = length(index.bounds().extent());
        const auto found = std::make_unique<bool[]>(64 * at_once);
        for (std::uint64_t begin = 0; begin < count; begin += at_once) {
            std::vector<Ray3f> rays;
            for (std::uint64_t b = begin; b < begin + at_once; ++b)
                for (const auto& ray : bunch_of_rays(b, targets[b % targets.size()], size))
                    rays.push_back(ray);
            const auto want = hits_of_the_walk(index, rays);
            for (const auto set : instruction_sets()) {
                SCOPED_TRACE(set);
                const Using use(set);
                expect_hits(want, Answers(index, rays));
                const auto used =
                    any_hits(index, rays, {found.get(), rays.size()}, {.threads = serial_executor()});
                EXPECT_EQ(used.packets >= 64, set != "plain") << "from bunch " << begin;
                if (HasFatalFailure()) return;
            }
        }
    }
}

/// One ray of a bundle ends on a flat floor, where rounding decides on which side, and the others go up: the
/// box around them all must not miss the floor.
TEST(Wide, ShortRaysThatEndOnAFloor) {
    Mesh mesh = soup<float>(300);
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    constexpr float floor = -0.1f;
    mesh.vertices.insert(mesh.vertices.end(), {{-9, floor, -9}, {9, floor, -9}, {0, floor, 9}});
    mesh.triangles.push_back({first, first + 1, first + 2});
    const auto index = build<WideBvh>(mesh);
    std::vector<Ray3f> rays;
    for (std::uint64_t bunch = 0; bunch < 200; ++bunch) {
        Random random(37, bunch);
        const Vec3f place(Vec3d(random.uniform(-2, 2), random.uniform(-0.09, 0.05), random.uniform(-2, 2)));
        for (std::uint64_t i = 0; i < 64; ++i) {
            Vec3f d(random.direction<3>());
            d[1] = i == bunch % 64 ? -std::abs(d[1]) : std::abs(d[1]);
            rays.push_back({place, d, 0, 0.05f});
            if (d[1] > 0) continue;
            rays.back().t_max = 9;
            rays.back().t_max = closest_hit(index, rays.back()).t;
        }
    }
    expect_hits_of_the_walk(index, rays);
}

/// A batch returns the number of rays that each algorithm answered.
TEST(Wide, KernelsAreChosenByWhatRaysDo) {
    const auto mesh = teapot_in_stadium<float>(3000);
    const auto index = build<WideBvh>(mesh);
    const auto targets = targets_of(mesh);
    // Make rays of every kind, and rays of a picture of 32 columns.
    std::vector<Ray3f> apart(1000), together(1000);
    for (std::size_t i = 0; i < apart.size(); ++i) {
        apart[i] = ray_of(index.bounds(), targets, i);
        const std::size_t column = i % 32, row = i / 32;
        const float x = 0.001f * static_cast<float>(column), y = 0.001f * static_cast<float>(row);
        together[i] = {index.bounds().center(), Vec3f(0.2f + x, 0.9f, 0.3f + y)};
    }
    std::vector<Hit<float>> hits(1000);
    const auto use = [&](const auto& of, const std::vector<Ray3f>& rays) {
        return closest_hits(of, std::span<const Ray3f>(rays), std::span(hits));
    };
    for (const auto set : instruction_sets()) {
        SCOPED_TRACE(set);
        const Using instructions(set);
        const bool plain = set == "plain";
        EXPECT_EQ(use(index, apart).phased, plain ? 0u : 1000u);
        EXPECT_EQ(use(index, together).packets, plain ? 0u : 960u);
        EXPECT_EQ(use(index, together).single, plain ? 1000u : 0u);
        EXPECT_EQ(use(build<Bvh>(mesh), apart).single, 1000u);
    }
}

TEST(Wide, UnusableRaysHitNothing) {
    const auto mesh = soup<float>(300);
    const auto index = build<WideBvh>(mesh);
    constexpr float nan = std::numeric_limits<float>::quiet_NaN(),
                    infinity = std::numeric_limits<float>::infinity();
    const Vec3f o(0.5f, 0.5f, -1), d(0, 0, 1);
    std::vector<Ray3f> rays = {{o, {0, 0, 0}},   {o, {nan, 0, 1}},       {o, {0, infinity, 1}},
                               {{nan, 0, 0}, d}, {{0, 0, infinity}, d},  {{0, 1e20f, 0}, d},
                               {o, d, nan, 1},   {o, d, 0, nan},         {o, d, 2, 1},
                               {o, d, 0, -1},    {o, Vec3f::all(1e-40f)}};
    for (const auto set : instruction_sets()) {
        const Using use(set);
        expect_hits(std::vector<Hit<float>>(rays.size()), Answers(index, rays));
    }
}

TEST(Wide, ArraysOfDifferentLengthsAreRefused) {
    const auto mesh = soup<float>(100);
    const std::vector<Ray3f> rays(10, Ray3f{{0, 0, 0}, {1, 1, 1}});
    std::vector<Hit<float>> hits(9);
    bool any[9];
    const auto wide = build<WideBvh>(mesh);
    const auto binary = build<Bvh>(mesh);
    EXPECT_THROW(closest_hits(wide, std::span<const Ray3f>(rays), std::span(hits)), InputError);
    EXPECT_THROW(any_hits(wide, std::span<const Ray3f>(rays), std::span(any)), InputError);
    EXPECT_THROW(closest_hits(binary, std::span<const Ray3f>(rays), std::span(hits)), InputError);
}

/// So many primitives that the list of their boxes alone would take 64 GiB: 2^31 of 32 bytes each.
struct TooMany {
    using Scalar = float;
    static constexpr int dimension = 3;
    std::size_t size() const { return (std::size_t(1) << 31) + 1; }
    Box3f bounds(std::size_t) const { return {Vec3f::all(0), Vec3f::all(1)}; }
};
TEST(Wide, TooManyPrimitivesAreRefusedBeforeMemoryIsSpent) {
    EXPECT_THROW(build<WideBvh>(TooMany()), InputError);
    EXPECT_THROW(build<Bvh>(TooMany()), InputError);
    EXPECT_THROW(build<Grid>(TooMany()), InputError);
}

TEST(Wide, HitsReportFaces) {
    Mesh mesh = soup<float>(300);
    for (std::uint32_t i = 0; i < mesh.size(); ++i) mesh.faces.push_back(i / 2);
    const auto index = build<WideBvh>(mesh);
    const auto targets = targets_of(mesh);
    std::size_t found = 0;
    for (const auto set : instruction_sets()) {
        const Using use(set);
        std::vector<Ray3f> rays(500);
        for (std::size_t i = 0; i < rays.size(); ++i) rays[i] = ray_of(index.bounds(), targets, i);
        const Answers answers(index, rays);
        for (const auto& hits : {answers.batch, answers.one})
            for (const auto& h : hits)
                if (h) {
                    EXPECT_EQ(h.primitive, h.element / 2);
                    ++found;
                }
    }
    EXPECT_GT(found, 100u);
}

TEST(Wide, InstructionSetsAreListedAndChosen) {
    const auto sets = instruction_sets();
    ASSERT_FALSE(sets.empty());
    EXPECT_EQ(sets.back(), "plain");
    for (const auto set : sets) {
        const Using use(set);
        EXPECT_EQ(name_of(instruction_set()), set);
        EXPECT_EQ(build<WideBvh>(soup<float>(10)).structure().options().width, preferred_wide_width());
    }
    EXPECT_THROW(use_instruction_set("avx1024"), InputError);
}

/// Compares the instruction sets with a binary BVH on many rays.
TEST(Wide, InstructionSetsAgreeOnManyRays) {
    for (const auto& mesh : {teapot_in_stadium<float>(20000), hairball<float>(20000), soup<float>(20000)}) {
        const auto targets = targets_of(mesh);
        const auto plain = build<Bvh>(mesh);
        const std::size_t count = in_long_runs(10000000, 30000), at_once = 10000;
        std::vector<Hit<float>> want(at_once), got(at_once);
        std::vector<Ray3f> rays(at_once);
        for (const int width : {8, 16}) {
            WideOptions options;
            options.width = width;
            const auto index = build<WideBvh>(mesh, options);
            for (std::size_t begin = 0; begin < count; begin += at_once) {
                for (std::size_t i = 0; i < at_once; ++i)
                    rays[i] = ray_of(index.bounds(), targets, begin + i);
                closest_hits(plain, std::span<const Ray3f>(rays), std::span(want),
                             {.threads = default_executor()});
                for (const auto set : instruction_sets()) {
                    if (set == "plain") continue;
                    const Using use(set);
                    closest_hits(index, std::span<const Ray3f>(rays), std::span(got),
                                 {.threads = default_executor()});
                    for (std::size_t i = 0; i < at_once; ++i)
                        ASSERT_EQ(want[i], got[i]) << set << ", width " << width << ", ray " << begin + i;
                }
            }
        }
    }
}

}  // namespace
