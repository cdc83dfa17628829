/// The hits of beams against those of rays, bit for bit.
#include <gtest/gtest.h>

#include <filesystem>
#include <numeric>

#include <hedgerow/hedgerow.h>
#include <hedgerow/io/mesh_file.h>
#include <hedgerow/render/camera/presets.h>
#include <hedgerow/render/visibility/beams.h>
#include <hedgerow/scenes/meshes.h>
#include <hedgerow/scenes/random.h>

#include "matrix.h"
#include "using.h"
#include "views.h"

using namespace hedgerow;

namespace {

using Mesh = TriangleMesh<float>;

/// Compares what beams of every width and instruction set find with the hits of rays, in trees of every
/// width. Returns the counts of the widest beams, summed up.
BeamCounts expect_hits_of_rays(const Mesh& mesh, const PictureSamples<float>& samples) {
    std::vector<Hit<float>> want(samples.size());
    closest_hits(build<BruteForce>(mesh), samples.rays(), std::span(want));
    BeamCounts sum;
    for (const int width : wide_widths) {
        const auto index = build<WideBvh>(mesh, {.width = width});
        for (const auto name : instruction_sets())
            for (const int widest : {64, 16, 8, 0}) {
                SCOPED_TRACE(std::string(name) + ", tree of " + std::to_string(width) + ", beams of " +
                             std::to_string(widest));
                const Using use(name);
                // What the buffer held does not matter.
                std::vector<Hit<float>> hits(samples.size(), Hit<float>{1e-30f, 2, 3, 4, 5, 6, 7});
                const auto counts =
                    beam_hits(index, samples, hits, {.widest = widest, .threads = default_executor()});
                expect_same(want, hits);
                if (widest == 64) sum += counts;
            }
    }
    return sum;
}

TEST(Beams, OfGeneratedMeshesFromAllSides) {
    const std::size_t views = in_long_runs(700, 4);
    for (std::uint64_t i = 0; i < views; ++i)
        for (const bool inside : {false, true}) {
            SCOPED_TRACE(std::to_string(i) + (inside ? " inside" : " outside"));
            const auto expect = [&](const char* name, const Mesh& mesh) {
                SCOPED_TRACE(name);
                expect_hits_of_rays(mesh, PictureSamples<float>(seen_from(mesh, i, inside), 141, 83));
                expect_hits_of_rays(mesh, PictureSamples<float>(seen_from(mesh, i, inside), 50, 70, 5, 1, 4));
            };
            expect("soup", soup<float>(200));
            expect("terrain", terrain<float>(1500));
            expect("stadium", teapot_in_stadium<float>(1500));
            expect("hairball", hairball<float>(800));
            expect("cornell box", cornell_box<float>(0));
        }
}

/// Triangles with corners on the rays of samples, before and behind the eye, near and far: whether a ray hits
/// them depends on the last bits.
TEST(Beams, OfTrianglesWithCornersOnRays) {
    const std::size_t scenes = in_long_runs(3000, 40);
    BeamCounts counts;
    std::vector<std::uint64_t> numbers(scenes);
    std::iota(numbers.begin(), numbers.end(), 0u);
    numbers.insert(numbers.end(), {99, 441});  // boxes that begin at −0
    for (const std::uint64_t scene : numbers) {
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
        const PictureSamples<float> samples(camera, 70, 37, scene, 0, scene % 2 == 0 ? 1 : 4);
        const auto on_a_ray = [&](bool behind) {
            // Often at the border of a tile.
            const auto pixel = [&](int count) {
                const auto any = static_cast<int>(random.bits() % static_cast<unsigned>(count));
                return scene % 5 < 2 ? std::min(any / 8 * 8 + (any % 2 == 0 ? 0 : 7), count - 1) : any;
            };
            const auto ray = samples.ray(pixel(70), pixel(37));
            const auto t = static_cast<float>(std::exp2(number(-6, 6)));
            return ray.at(behind ? -t : t);
        };
        Mesh mesh;
        for (std::uint32_t i = 0; i < 40; ++i) {
            const bool crosses = i % 5 == 0;
            for (int c = 0; c < 3; ++c) mesh.vertices.push_back(on_a_ray(crosses && c == 0));
            if (i % 7 == 0) mesh.vertices.back() = mesh.vertices[3 * i] + mesh.vertices[3 * i + 1] * 1e-6f;
            mesh.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
        }
        counts += expect_hits_of_rays(mesh, samples);
    }
    if (in_use<BeamKernels>() != nullptr) {
        EXPECT_GT(counts.packets, 0u);
    }
}

/// Walls of large triangles, some of them twice, some in one plane with others, some passing the eye closely:
/// tiles lie within one triangle, or within several at one depth.
TEST(Beams, OfWallsAndCoplanarFaces) {
    const std::size_t scenes = in_long_runs(2000, 24);
    BeamCounts counts;
    for (std::uint64_t scene = 0; scene < scenes; ++scene) {
        SCOPED_TRACE(scene);
        Random random(79, scene);
        const auto number = [&](double from, double to) { return from + (to - from) * random.uniform(); };
        Mesh mesh;
        const auto add = [&](const Vec3f& a, const Vec3f& b, const Vec3f& c) {
            const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
            for (const auto& v : {a, b, c}) mesh.vertices.push_back(v);
            mesh.triangles.push_back({first, first + 1, first + 2});
        };
        const int walls = 1 + static_cast<int>(random.bits() % 4);
        for (int wall = 0; wall < walls; ++wall) {
            // Two triangles, and parts of the same plane.
            const auto at = static_cast<float>(number(1, 4)), tilt = static_cast<float>(number(-1, 1));
            const auto corner = [&](float x, float y) { return Vec3f(x, y, at + tilt * x); };
            const float w = static_cast<float>(number(0.5, 6));
            add(corner(-w, -w), corner(w, -w), corner(w, w));
            add(corner(-w, -w), corner(w, w), corner(-w, w));
            for (int i = 0; i < 3; ++i) {
                const auto x = static_cast<float>(number(-1, 1)), y = static_cast<float>(number(-1, 1));
                add(corner(x, y), corner(x + 1, y), corner(x, y + 1));
                if (scene % 2 == 0) add(corner(x, y), corner(x + 1, y), corner(x, y + 1));
            }
        }
        // A sliver, and a floor just below the eye.
        add({-3, 0.1f, 0.9f}, {3, 0.1f, 0.9f}, {3, std::nextafter(0.1f, 1.f), 0.9f});
        add({-9, scene % 3 == 0 ? 0 : -1e-4f, -9}, {9, -1e-4f, -9}, {0, -1e-3f, 50});
        Camera camera{{0, 0, 0}, {static_cast<float>(number(-0.3, 0.3)), 0, 1}, {0, 1, 0}};
        camera.field_of_view = static_cast<float>(number(5, 90));
        counts +=
            expect_hits_of_rays(mesh, PictureSamples<float>(camera, 150, 130, 3, 1, scene % 4 == 0 ? 4 : 1));
    }
    if (in_use<BeamKernels>() == nullptr) return;
    EXPECT_GT(counts.filled, counts.packets);
    EXPECT_GT(counts.beams, 0u);
}

/// A triangle of a mesh that has area, by number.
FlatMirror mirror_in(const Mesh& mesh, std::uint64_t number) {
    for (std::uint64_t i = number;; ++i) {
        const auto triangle = mesh.view().triangle(i % mesh.size());
        if (length2(triangle.normal()) > 0) return FlatMirror::through(triangle);
    }
}

/// In mirrors that lie anywhere in a mesh, behind which there is as much as before them.
TEST(Beams, GoOnFromFlatMirrors) {
    const std::size_t views = in_long_runs(300, 3);
    BeamCounts counts;
    for (std::uint64_t i = 0; i < views; ++i) {
        SCOPED_TRACE(i);
        const auto expect = [&](const char* name, const Mesh& mesh) {
            SCOPED_TRACE(name);
            const FlatMirror mirror = mirror_in(mesh, 7919 * i);
            for (const bool inside : {false, true}) {
                const Camera camera = seen_from(mesh, i, inside);
                if (std::abs(mirror.above(Vec3d(camera.eye))) < 1e-3) continue;
                counts += expect_hits_of_rays(mesh, PictureSamples<float>(camera, 141, 83).in_mirror(mirror));
                expect_hits_of_rays(mesh, PictureSamples<float>(camera, 50, 70, 5, 1, 4).in_mirror(mirror));
            }
        };
        expect("soup", soup<float>(200));
        expect("terrain", terrain<float>(1500));
        expect("stadium", teapot_in_stadium<float>(1500));
        expect("hairball", hairball<float>(800));
        expect("cornell box", cornell_box<float>(0));
    }
    EXPECT_GT(counts.filled, 0u);
    EXPECT_GT(counts.beams, 0u);
}

/// What an eye sees in a mirror is what rays see that are reflected where it is hit, and never the mirror.
TEST(Beams, SeeInAMirrorWhatReflectedRaysSee) {
    const auto mesh = cornell_box<float>(0);
    const auto index = build<WideBvh>(mesh);
    const Camera camera = *camera_for("cornell-box");
    const PictureSamples<float> samples(camera, 200, 150);
    std::vector<Hit<float>> first(samples.size()), seen(samples.size());
    beam_hits(index, samples, first, {.threads = default_executor()});
    // The mirror is what lies in the plane of the triangle in the middle: the back wall or a side of a block.
    const auto middle = mesh.view().triangle(first[samples.number(100, 75)].element);
    const FlatMirror mirror = FlatMirror::through(middle);
    const auto is_mirror = [&](std::uint32_t element) {
        const auto t = mesh.view().triangle(element);
        return std::max({std::abs(mirror.above(Vec3d(t.a))), std::abs(mirror.above(Vec3d(t.b))),
                         std::abs(mirror.above(Vec3d(t.c)))}) < 1e-3 * mirror.reach;
    };
    const auto wanted = std::make_unique<bool[]>(samples.size());
    std::size_t on_mirror = 0, alike = 0;
    for (std::size_t i = 0; i < samples.size(); ++i)
        on_mirror += wanted[i] = first[i] && is_mirror(first[i].element);
    ASSERT_GT(on_mirror, 1000u);
    const auto reflected = samples.in_mirror(mirror);
    beam_hits(index, reflected, seen,
              {.wanted = std::span<const bool>(wanted.get(), samples.size()), .threads = default_executor()});
    std::vector<Hit<float>> all(samples.size());
    beam_hits(index, reflected, all, {.threads = default_executor()});
    const auto rays = samples.rays();
    for (std::size_t i = 0; i < samples.size(); ++i) {
        if (!wanted[i]) continue;
        EXPECT_EQ(seen[i], all[i]) << i;
        EXPECT_FALSE(seen[i] && is_mirror(seen[i].element)) << i;
        Ray<float, 3> ray;
        ray.origin = rays[i].origin + rays[i].direction * first[i].t;
        ray.direction = Vec3f(mirror.image_of_direction(Vec3d(rays[i].direction)));
        ray.t_min = 1e-3f * static_cast<float>(mirror.reach);
        const auto hit = closest_hit(index, ray);
        alike += hit ? seen[i] && hit.element == seen[i].element &&
                           std::abs(hit.t + first[i].t - seen[i].t) < 1e-4f * seen[i].t
                     : !seen[i];
    }
    EXPECT_GT(alike, on_mirror - on_mirror / 100) << "but for edges";
}

TEST(Beams, RefuseMirrorsThatCannotBeSeen) {
    const PictureSamples<float> samples(*camera_for("cornell-box"), 20, 20);
    const Vec3d eye(camera_for("cornell-box")->eye);
    EXPECT_THROW(samples.in_mirror({{0, 0, 1}, eye[2], 1}), InputError);
    EXPECT_THROW(FlatMirror::through(Triangle<float, 3>{{0, 0, 0}, {1, 1, 1}, {2, 2, 2}}), InputError);
    Camera parallel = *camera_for("cornell-box"), lens = parallel;
    parallel.projection = Projection::orthographic, lens.lens_radius = 1;
    for (const Camera& camera : {parallel, lens})
        EXPECT_THROW(PictureSamples<float>(camera, 20, 20).in_mirror({{0, 0, 1}, -1e4, 1}), InputError);
    EXPECT_FALSE(samples.in_mirror({{0, 0, 1}, -1e4, 1}).has_plane()) << "no rasteriser begins at a mirror";
    std::vector<Hit<float>> hits(samples.size());
    const auto index = build<WideBvh>(cornell_box<float>(0));
    const bool few[3] = {};
    EXPECT_THROW(beam_hits(index, samples, hits, {.wanted = few, .threads = serial_executor()}), InputError);
}

TEST(Beams, OfCamerasThatSeeNothing) {
    const auto mesh = cornell_box<float>(0);
    const float nan = std::numeric_limits<float>::quiet_NaN();
    for (const Camera& camera :
         {Camera{{278, 273, -800}, {278, 273, -800}}, Camera{{278, 273, -800}, {278, 273, 0}, {0, 0, 1}},
          Camera{{1e30f, 0, 0}, {0, 0, 0}, {0, 1, 0}}, Camera{{nan, 0, 0}, {0, 0, 0}, {0, 1, 0}},
          Camera{{278, 273, -800}, {278, 273, 0}, {0, 1, 0}, 0}})
        expect_hits_of_rays(mesh, PictureSamples<float>(camera, 70, 66));
    // An empty mesh, an empty picture, a picture of one sample.
    expect_hits_of_rays({}, PictureSamples<float>(Camera{{1, 1, 1}, {0, 0, 0}, {0, 1, 0}}, 9, 65));
    const Camera box = *camera_for("cornell-box");
    for (const auto& [width, height] : {std::pair{0, 0}, {1, 1}, {1, 200}, {200, 7}})
        expect_hits_of_rays(mesh, PictureSamples<float>(box, width, height));
    // Wrong widths, and too little room.
    std::vector<Hit<float>> hits(99);
    const auto index = build<WideBvh>(mesh);
    EXPECT_THROW(beam_hits(index, PictureSamples<float>(box, 10, 10), hits, {.threads = serial_executor()}),
                 InputError);
    EXPECT_THROW(beam_hits(index, PictureSamples<float>(box, 9, 9), hits,
                           {.widest = 24, .threads = serial_executor()}),
                 UsageError);
}

TEST(Beams, OfAnyIndexAndByAnyExecutor) {
    const auto mesh = teapot_in_stadium<float>(1500);
    const PictureSamples<float> samples(*camera_for("teapot-in-stadium"), 200, 150);
    std::vector<Hit<float>> want(samples.size()), hits(samples.size());
    closest_hits(build<BruteForce>(mesh), samples.rays(), std::span(want));
    const auto expect = [&](const auto& index, Executor& executor) {
        std::fill(hits.begin(), hits.end(), Hit<float>{1, 2, 3, 4, 5, 6, 7});
        beam_hits(index, samples, hits, {.threads = executor});
        expect_same(want, hits);
    };
    expect(build<KdTree>(mesh), default_executor());
    expect(build<Bvh>(mesh), serial_executor());
    expect(build<WideBvh>(mesh), serial_executor());
    expect(build<WideBvh>(mesh), default_executor());
    // Ids that are not the positions.
    auto named = mesh;
    for (std::uint32_t i = 0; i < named.triangles.size(); ++i) named.faces.push_back(i / 2 + 7);
    for (auto& hit : want)
        if (hit) hit.primitive = hit.element / 2 + 7;
    expect(build<WideBvh>(named), serial_executor());
}

TEST(Beams, OfScans) {
    const std::string name = HEDGEROW_DATA "/bunny.ply";
    if (!std::filesystem::exists(name)) GTEST_SKIP() << name << " is missing";
    const auto scan = load_mesh(name);
    const auto index = build<WideBvh>(scan);
    for (std::uint64_t i = 0; i < in_long_runs(100, 4); ++i) {
        SCOPED_TRACE(i);
        const PictureSamples<float> samples(seen_from(scan, i, i % 2 == 1), 300, 200);
        std::vector<Hit<float>> want(samples.size()), hits(samples.size());
        closest_hits(index, samples.rays(), std::span(want));
        beam_hits(index, samples, hits, {.threads = default_executor()});
        expect_same(want, hits);
    }
}

}  // namespace
