/// The rasteriser's hits against those of rays, bit for bit.
#include <gtest/gtest.h>

#include <hedgerow/hedgerow.h>
#include <hedgerow/render/visibility/rasterise.h>
#include <hedgerow/scenes/meshes.h>
#include <hedgerow/scenes/random.h>

#include "matrix.h"
#include "placements.h"
#include "using.h"
#include "views.h"

using namespace hedgerow;

namespace {

template <class T>
class RasterisedHits : public testing::Test {};
using Scalars = testing::Types<float, double>;
TYPED_TEST_SUITE(RasterisedHits, Scalars);

template <class T>
std::vector<Hit<T>> hits_of_rays(const TriangleMesh<T>& mesh, const PictureSamples<T>& samples) {
    const auto rays = samples.rays();
    std::vector<Hit<T>> hits(rays.size());
    closest_hits(build<WideBvh>(mesh), rays, std::span(hits));
    return hits;
}
/// Compares a visibility buffer, and the hits that it resolves to, with the hits of rays.
template <class T>
void expect_visible(const TriangleMesh<T>& mesh, const PictureSamples<T>& samples,
                    const std::vector<Hit<T>>& want) {
    Rasteriser<T> rasteriser(samples);
    std::vector<Visible> visible(samples.size(), Visible{7, 1});
    EXPECT_EQ(rasteriser.draw_visible(mesh.view(), visible, {.threads = default_executor()}).triangles,
              mesh.size());
    const auto rays = samples.rays();
    const Vec<T, 3> forward(samples.plane().forward);
    for (std::size_t i = 0; i < want.size(); ++i) {
        SCOPED_TRACE(i);
        ASSERT_EQ(visible[i].element, want[i].element);
        if (!want[i]) {
            EXPECT_EQ(visible[i].depth, std::numeric_limits<float>::infinity());
        } else {
            const double depth = double(want[i].t) * double(dot(rays[i].direction, forward));
            EXPECT_NEAR(double(visible[i].depth), depth, depth / 4096);
        }
    }
    std::vector<Hit<T>> hits(samples.size(), Hit<T>{T(1e-30), T(2), T(3), 4, 5, 6, 7});
    rasteriser.resolve(mesh.view(), visible, hits, {.threads = default_executor()});
    expect_same(want, hits);
}
/// Compares the buffers that every coverage and instruction set fills with the hits of rays. Every sample of
/// every triangle is tested on demand alone.
template <class T>
void expect_hits_of_rays(const TriangleMesh<T>& mesh, const PictureSamples<T>& samples, bool all = false) {
    const auto want = hits_of_rays(mesh, samples);
    for (const auto name : instruction_sets()) {
        SCOPED_TRACE(name);
        const Using use(name);
        Rasteriser<T> rasteriser(samples);
        for (const Coverage coverage : {Coverage::all, Coverage::box, Coverage::tiles}) {
            if (coverage == Coverage::all && !all) continue;
            SCOPED_TRACE(static_cast<int>(coverage));
            // What the buffer held does not matter.
            std::vector<Hit<T>> hits(samples.size(), Hit<T>{T(1e-30), T(2), T(3), 4, 5, 6, 7});
            const RasterCounts counts =
                rasteriser.draw(mesh.view(), hits, by(default_executor(), RasterOptions{coverage}));
            expect_same(want, hits);
            EXPECT_EQ(counts.triangles, mesh.size());
            if (coverage == Coverage::all) {
                EXPECT_EQ(counts.tests, mesh.size() * samples.size());
            }
        }
        expect_visible(mesh, samples, want);
    }
}

TYPED_TEST(RasterisedHits, OfGeneratedMeshesFromAllSides) {
    using T = TypeParam;
    const std::size_t views = in_long_runs(450, 6);
    for (std::uint64_t i = 0; i < views; ++i)
        for (const int way : {0, 1, 2, 3}) {
            const bool inside = way % 2 == 1, parallel = way >= 2;
            SCOPED_TRACE(std::to_string(i) + (inside ? " inside" : " outside") +
                         (parallel ? ", parallel rays" : ""));
            const auto expect = [&](const char* name, const TriangleMesh<T>& mesh) {
                SCOPED_TRACE(name);
                const Camera camera = seen_from(mesh, i, inside, parallel);
                expect_hits_of_rays(mesh, PictureSamples<T>(camera, 61, 43), i == 0);
                expect_hits_of_rays(mesh, PictureSamples<T>(camera, 50, 70, 5, 1, 4));
            };
            expect("soup", soup<T>(400));
            expect("terrain", terrain<T>(1500));
            expect("stadium", teapot_in_stadium<T>(1500));
            expect("hairball", hairball<T>(800));
            expect("cornell box", cornell_box<T>(0));
        }
}

/// Triangles with corners on the rays of samples, before and behind the eye, near and far: whether a ray hits
/// them depends on the last bits.
TYPED_TEST(RasterisedHits, OfTrianglesWithCornersOnRays) {
    using T = TypeParam;
    const std::size_t scenes = in_long_runs(3000, 60);
    for (std::uint64_t scene = 0; scene < scenes; ++scene) {
        SCOPED_TRACE(scene);
        Random random(78, scene);
        const auto number = [&](double from, double to) { return from + (to - from) * random.uniform(); };
        Camera camera;
        const double far = scene % 3 == 0 ? 1e4 : 1;
        for (int k = 0; k < 3; ++k) {
            camera.eye[k] = static_cast<float>(number(-far, far));
            camera.target[k] = camera.eye[k] + static_cast<float>(number(-1, 1));
        }
        camera.field_of_view = static_cast<float>(scene % 4 == 0 ? 0.2 : number(20, 140));
        if (scene % 5 < 2) {
            camera.projection = Projection::orthographic;
            camera.height = static_cast<float>(std::exp2(number(-8, 8)));
        }
        const PictureSamples<T> samples(camera, 24, 17, scene, 0, scene % 2 == 0 ? 1 : 4);
        const auto on_a_ray = [&](bool behind) {
            const auto ray =
                samples.ray(static_cast<int>(random.bits() % 24), static_cast<int>(random.bits() % 17));
            const auto t = static_cast<T>(std::exp2(number(-6, 6)));
            return ray.at(behind ? -t : t);
        };
        TriangleMesh<T> mesh;
        for (std::uint32_t i = 0; i < 40; ++i) {
            const bool crosses = i % 5 == 0;
            for (int c = 0; c < 3; ++c) mesh.vertices.push_back(on_a_ray(crosses && c == 0));
            if (i % 7 == 0) mesh.vertices.back() = mesh.vertices[3 * i] + mesh.vertices[3 * i + 1] * T(1e-6);
            mesh.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
        }
        expect_hits_of_rays(mesh, samples, true);
    }
}

/// Compares the buffers of instances with the hits of rays on two levels.
template <class I>
void expect_hits_on_two_levels(const InstanceSet<I>& set, const PictureSamples<typename I::Scalar>& samples) {
    using T = typename I::Scalar;
    const auto rays = samples.rays();
    std::vector<Hit<T>> want(rays.size());
    closest_hits(build<Bvh>(set), rays, std::span(want));
    for (const auto name : instruction_sets()) {
        SCOPED_TRACE(name);
        const Using use(name);
        Rasteriser<T> rasteriser(samples);
        for (const Coverage coverage : {Coverage::box, Coverage::tiles})
            for (const bool onto : {false, true}) {
                std::vector<Hit<T>> hits(samples.size(),
                                         onto ? Hit<T>() : Hit<T>{T(1e-30), 2, 3, 4, 5, 6, 7});
                rasteriser.draw(set.view(), hits, by(default_executor(), RasterOptions{coverage, onto}));
                expect_same(want, hits);
            }
    }
}

TYPED_TEST(RasterisedHits, OfInstances) {
    using T = TypeParam;
    const auto mesh = teapot<T>(300);
    const auto index = build<WideBvh>(mesh);
    const std::size_t views = in_long_runs(100, 4);
    for (std::uint64_t view = 0; view < views; ++view)
        for (const auto scales : {Scales::none, Scales::even, Scales::any}) {
            SCOPED_TRACE(view);
            std::vector<Instance<std::remove_cvref_t<decltype(index)>>> instances;
            std::uint32_t number = 0;
            for (const auto& transform : transforms<3>(9, scales, view % 2 == 0 ? 12 : 1000))
                instances.push_back(Instance(index, transform, ~0u, 7 * number++));
            const InstanceSet set(instances);
            TriangleMesh<T> corners;  // of the world
            for (std::size_t i = 0; i < set.size(); ++i) {
                corners.vertices.push_back(set.view().bounds(i).low);
                corners.vertices.push_back(set.view().bounds(i).high);
            }
            const Camera camera = seen_from(corners, view, view % 3 == 1, view % 4 == 3);
            expect_hits_on_two_levels(set, PictureSamples<T>(camera, 61, 43, 5, 1, view % 2 == 0 ? 1 : 4));
        }
}

TYPED_TEST(RasterisedHits, OfInstancesWithCornersOnRays) {
    using T = TypeParam;
    const std::size_t scenes = in_long_runs(2000, 40);
    for (std::uint64_t scene = 0; scene < scenes; ++scene) {
        SCOPED_TRACE(scene);
        Random random(79, scene);
        Camera camera;
        for (int k = 0; k < 3; ++k) {
            camera.eye[k] = static_cast<float>(random.uniform(-3, 3));
            camera.target[k] = camera.eye[k] + static_cast<float>(random.uniform(-1, 1));
        }
        camera.field_of_view = static_cast<float>(random.uniform(20, 140));
        if (scene % 3 == 0) camera.projection = Projection::orthographic, camera.height = 2;
        const PictureSamples<T> samples(camera, 24, 17, scene, 0, scene % 2 == 0 ? 1 : 4);
        Transform<3> placed = transform_of<3>(scene, Scales::any, scene % 4 == 0 ? 1000 : 2);
        // Some are all but flat.
        if (scene % 5 == 0)
            placed = placed * Transform<3>::scaling({1, 1, std::exp2(random.uniform(-12, 12))});
        TriangleMesh<T> mesh;
        for (std::uint32_t i = 0; i < 40; ++i) {
            for (int c = 0; c < 3; ++c) {
                const auto ray =
                    samples.ray(static_cast<int>(random.bits() % 24), static_cast<int>(random.bits() % 17));
                const auto t = static_cast<T>(std::exp2(random.uniform(-6, 6)));
                const auto there = ray.at(i % 5 == 0 && c == 0 ? -t : t);
                mesh.vertices.push_back(Vec<T, 3>(placed.back().point(Vec3d(there))));
            }
            mesh.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
        }
        const auto index = build<WideBvh>(mesh);
        expect_hits_on_two_levels(InstanceSet{Instance(index, placed), Instance(index, placed)}, samples);
    }
}

/// A set in parts, in any order, has the hits of the whole.
TYPED_TEST(RasterisedHits, OfPartsOfASet) {
    using T = TypeParam;
    auto mesh = soup<T>(600);
    mesh.triangles[599] = mesh.triangles[2];  // equal t
    mesh.triangles[301] = mesh.triangles[300];
    const PictureSamples<T> samples(seen_from(mesh, 2, false), 90, 60);
    const auto want = hits_of_rays(mesh, samples);
    for (const auto name : instruction_sets())
        for (const Coverage coverage : {Coverage::box, Coverage::tiles})
            for (const bool backwards : {false, true}) {
                const Using use(name);
                std::vector<Hit<T>> hits(samples.size());
                Rasteriser<T> rasteriser(samples);
                for (int k = 0; k < 6; ++k) {
                    const auto first = static_cast<std::uint32_t>(100 * (backwards ? 5 - k : k));
                    TriangleMesh<T> part;
                    part.vertices = mesh.vertices;
                    part.triangles.assign(mesh.triangles.begin() + first,
                                          mesh.triangles.begin() + first + 100);
                    RasterOptions options{coverage, k > 0};
                    options.first_element = first;
                    rasteriser.draw(part.view(), hits, by(default_executor(), options));
                }
                expect_same(want, hits);
            }
}

TYPED_TEST(RasterisedHits, AreCountedOnRequest) {
    using T = TypeParam;
    const auto mesh = soup<T>(300);
    const PictureSamples<T> samples(seen_from(mesh, 2, false), 90, 60);
    const auto want = hits_of_rays(mesh, samples);
    std::vector<Hit<T>> hits(samples.size());
    Rasteriser<T> rasteriser(samples);
    EXPECT_EQ(rasteriser.bytes(), 0u);
    const auto counts = [&](Coverage coverage) {
        const auto c =
            rasteriser.draw(mesh.view(), hits, by(default_executor(), RasterOptions{coverage, false, true}));
        expect_same(want, hits);
        return c;
    };
    const auto all = counts(Coverage::all), box = counts(Coverage::box), tiles = counts(Coverage::tiles);
    EXPECT_EQ(all.tests, mesh.size() * samples.size());
    EXPECT_LT(box.tests, all.tests);
    EXPECT_LT(tiles.tests, box.tests);
    EXPECT_GT(tiles.tests, 0u);
    EXPECT_GT(rasteriser.bytes(), mesh.size() * sizeof(Sight));
}

/// Forward shading shades each fragment that is nearest so far, and the last is what is seen.
TYPED_TEST(RasterisedHits, AreShadedWhenTheyAreNearestSoFar) {
    using T = TypeParam;
    const auto mesh = soup<T>(600);
    const auto index = build<WideBvh>(mesh);
    const InstanceSet set{Instance(index), Instance(index, Transform<3>::translation({0, 0, 0.3}))};
    const PictureSamples<T> samples(seen_from(mesh, 2, false), 90, 60);
    const auto expect = [&](const auto& drawn, const std::vector<Hit<T>>& want) {
        std::vector<std::uint64_t> shaded;
        for (const Coverage coverage : {Coverage::all, Coverage::box, Coverage::tiles}) {
            std::vector<Hit<T>> hits(samples.size()), last(samples.size());
            std::vector<std::uint32_t> times(samples.size());
            Rasteriser<T> rasteriser(samples);
            const auto counts = rasteriser.draw(drawn, hits, by(default_executor(), RasterOptions{coverage}),
                                                [&](std::size_t i, const Hit<T>& hit) {
                                                    EXPECT_TRUE(hit.t <= last[i].t);
                                                    last[i] = hit;
                                                    ++times[i];
                                                });
            expect_same(want, hits);
            expect_same(want, last);
            shaded.push_back(0);
            for (std::size_t i = 0; i < times.size(); ++i) {
                EXPECT_EQ(times[i] > 0, bool(want[i]));
                shaded.back() += times[i];
            }
            EXPECT_EQ(counts.nearest, shaded.back());
        }
        EXPECT_EQ(shaded[0], shaded[1]) << "in the order of the triangles";
        EXPECT_LT(shaded[2], shaded[1]) << "front to back";
    };
    expect(mesh.view(), hits_of_rays(mesh, samples));
    std::vector<Hit<T>> want(samples.size());
    closest_hits(build<Bvh>(set), samples.rays(), std::span(want));
    expect(set.view(), want);
}

TYPED_TEST(RasterisedHits, OntoThoseOfOthersAndByAnyExecutor) {
    using T = TypeParam;
    const auto mesh = soup<T>(700);
    auto half = mesh;
    half.triangles.resize(300);
    const PictureSamples<T> samples(seen_from(mesh, 2, false), 130, 70);
    const auto want = hits_of_rays(mesh, samples), first = hits_of_rays(half, samples);
    for (const auto name : instruction_sets())
        for (const Coverage coverage : {Coverage::box, Coverage::tiles})
            for (Executor* const executor :
                 {static_cast<Executor*>(&serial_executor()), &default_executor()}) {
                SCOPED_TRACE(name);
                const Using use(name);
                Rasteriser<T> rasteriser(samples);
                std::vector<Hit<T>> hits(samples.size());
                rasteriser.draw(half.view(), hits, by(*executor, RasterOptions{coverage}));
                expect_same(first, hits);
                rasteriser.draw(mesh.view(), hits, by(*executor, RasterOptions{coverage, true}));
                expect_same(want, hits);
                rasteriser.draw(mesh.view(), hits, by(*executor, RasterOptions{coverage, true}));
                expect_same(want, hits);
                rasteriser.draw(TriangleMesh<T>().view(), hits, by(*executor, RasterOptions{coverage, true}));
                expect_same(want, hits);
                rasteriser.draw(TriangleMesh<T>().view(), hits, by(*executor, RasterOptions{coverage}));
                expect_same(std::vector<Hit<T>>(samples.size()), hits);
            }
}

/// More entries of triangles in tiles than are listed at once; coplanar ones, and equal ones.
TYPED_TEST(RasterisedHits, OfTrianglesThatFillThePicture) {
    using T = TypeParam;
    Camera camera;
    camera.eye = {0, 0, 0}, camera.target = {0, 1, 0.1f};
    TriangleMesh<T> mesh;
    for (std::uint32_t i = 0; i < 3500; ++i) {
        const auto distance = static_cast<T>(1 + (i * 7919) % 1000);
        mesh.vertices.insert(mesh.vertices.end(), {{-9 * distance, distance, -9 * distance},
                                                   {9 * distance, distance, -9 * distance},
                                                   {T(i % 5), distance, 9 * distance}});
        mesh.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
    }
    const PictureSamples<T> samples(camera, 250, 250);
    const auto want = hits_of_rays(mesh, samples);
    Rasteriser<T> rasteriser(samples);
    std::vector<Hit<T>> hits(samples.size());
    const auto counts = rasteriser.draw(mesh.view(), hits, {.threads = default_executor()});
    expect_same(want, hits);
    EXPECT_EQ(counts.outside, 0u);
    EXPECT_LT(rasteriser.bytes(), std::size_t(64) << 20);
    expect_visible(mesh, samples, want);
}

TYPED_TEST(RasterisedHits, OfNothingWhereNothingCanBeSeen) {
    using T = TypeParam;
    const auto mesh = soup<T>(50);
    Camera along_up, far;
    along_up.eye = {0, 0, 5}, along_up.target = {0, 0, 0};
    far.eye = {1e30f, 0, 0}, far.target = {0, 0, 0};
    for (const Camera& camera : {along_up, far}) expect_hits_of_rays(mesh, PictureSamples<T>(camera, 9, 17));
    expect_hits_of_rays(mesh, PictureSamples<T>(seen_from(mesh, 1, false), 1, 1), true);
    expect_hits_of_rays(TriangleMesh<T>(), PictureSamples<T>(Camera{{0, 0, 1}, {1, 0, 1}}, 8, 8), true);
}

TYPED_TEST(RasterisedHits, NeedAPlaceForEachSample) {
    using T = TypeParam;
    Rasteriser<T> rasteriser(PictureSamples<T>(Camera{{0, 0, 1}, {1, 0, 1}}, 5, 4));
    std::vector<Hit<T>> hits(19);
    const auto mesh = soup<T>(5);
    EXPECT_THROW(rasteriser.draw(mesh.view(), hits, {.threads = serial_executor()}), InputError);
    std::vector<Visible> visible(19);
    EXPECT_THROW(rasteriser.draw_visible(mesh.view(), visible, {.threads = serial_executor()}), InputError);
    visible.resize(20);
    EXPECT_THROW(rasteriser.resolve(mesh.view(), visible, hits, {.threads = serial_executor()}), InputError);
    hits.resize(20);
    rasteriser.resolve(mesh.view(), visible, hits, {.threads = serial_executor()});
    EXPECT_EQ(hits, std::vector<Hit<T>>(20));
    visible[7].element = 5;
    EXPECT_THROW(rasteriser.resolve(mesh.view(), visible, hits, {.threads = serial_executor()}), InputError);
}

/// An element that the ray of its sample does not hit is not seen.
TYPED_TEST(RasterisedHits, OfAVisibilityBufferThatIsWrong) {
    using T = TypeParam;
    const auto mesh = soup<T>(300);
    const PictureSamples<T> samples(seen_from(mesh, 1, false), 40, 30);
    auto want = hits_of_rays(mesh, samples);
    std::vector<Visible> visible(samples.size());
    for (std::size_t i = 0; i < visible.size(); ++i) visible[i].element = want[i].element;
    for (std::size_t i = 0; i < visible.size(); i += 3)
        visible[i].element = (static_cast<std::uint32_t>(i) * 7) % 300;
    std::vector<Hit<T>> hits(samples.size());
    Rasteriser<T>(samples).resolve(mesh.view(), visible, hits, {.threads = default_executor()});
    const auto index = build<BruteForce>(mesh);
    for (std::size_t i = 0; i < hits.size(); ++i) {
        const auto only = [&](const Hit<T>& hit) { return hit.element == visible[i].element; };
        const auto x = static_cast<int>(i % 40), y = static_cast<int>(i / 40);
        EXPECT_EQ(hits[i], closest_hit(index, samples.ray(x, y), only)) << i;
    }
}

}  // namespace
