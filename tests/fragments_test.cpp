/// Lists of fragments: those of the rasteriser are the lists of all hits of rays, bit for bit, in bands of
/// any size; and transparent pictures by either are the same.
#include <gtest/gtest.h>

#include <hedgerow/hedgerow.h>
#include <hedgerow/render/shading/transparency.h>
#include <hedgerow/render/visibility/fragments.h>
#include <hedgerow/scenes/meshes.h>
#include <hedgerow/scenes/random.h>

#include "backwards.h"
#include "crowded.h"
#include "using.h"
#include "views.h"

using namespace hedgerow;

namespace {

/// The lists of all samples, joined.
template <class T>
using Lists = std::vector<std::vector<Hit<T>>>;
template <class T>
Lists<T> of_rays(const TriangleMesh<T>& mesh, const PictureSamples<T>& samples) {
    const auto index = build<WideBvh>(mesh);
    Lists<T> all;
    for (const auto& ray : samples.rays()) all_hits(index, ray, all.emplace_back());
    return all;
}
template <class T>
Lists<T> of_triangles(const TriangleMesh<T>& mesh, const PictureSamples<T>& samples,
                      const FragmentOptions& options = {}, Executor& executor = default_executor(),
                      FragmentCounts* counts = nullptr) {
    Lists<T> all;
    int next = 0;
    const auto take = [&](const FragmentBand<T>& band) {
        EXPECT_EQ(band.top(), next);
        next = band.bottom() + 1;
        std::size_t bytes = 0;
        for (int y = band.top(); y <= band.bottom(); ++y)
            for (int x = 0; x < samples.width(); ++x) {
                const auto list = band.at(x, y);
                all.emplace_back(list.begin(), list.end());
                bytes += list.size_bytes();
            }
        EXPECT_LE(bytes, options.budget);
    };
    const auto drawn =
        FragmentLists<T>(samples).list(mesh.view(), take, {.budget = options.budget, .threads = executor});
    EXPECT_EQ(next, samples.height());
    std::uint64_t fragments = 0, longest = 0;
    for (const auto& list : all)
        fragments += list.size(), longest = std::max<std::uint64_t>(longest, list.size());
    EXPECT_EQ(drawn.fragments, fragments);
    EXPECT_EQ(drawn.longest, longest);
    EXPECT_EQ(drawn.raster.triangles, mesh.size() * (1 + drawn.bands));
    if (counts != nullptr) *counts = drawn;
    return all;
}

template <class T>
class FragmentsOf : public testing::Test {};
using Scalars = testing::Types<float, double>;
TYPED_TEST_SUITE(FragmentsOf, Scalars);

TYPED_TEST(FragmentsOf, GeneratedMeshesAreTheListsOfRays) {
    using T = TypeParam;
    for (const auto& mesh :
         {soup<T>(600), hairball<T>(1500), teapot_in_stadium<T>(1500), terrain<T>(1200), cornell_box<T>(0)})
        for (std::uint64_t view = 0; view < 6; ++view) {
            SCOPED_TRACE(std::to_string(mesh.size()) + " triangles, view " + std::to_string(view));
            const Camera camera = seen_from(mesh, view, view % 2 == 0);
            for (const PictureSamples<T>& samples :
                 {PictureSamples<T>(camera, 61, 43), PictureSamples<T>(camera, 40, 50, 5, 1, 4)}) {
                const auto want = of_rays(mesh, samples);
                for (const auto name : instruction_sets()) {
                    const Using use(name);
                    ASSERT_EQ(of_triangles(mesh, samples), want) << name;
                }
            }
        }
}

/// Triangles with corners on the rays of samples, before and behind the eye; in one place, and in one plane
/// with a shared vertex on a ray.
TYPED_TEST(FragmentsOf, TiesAndCornersOnRays) {
    using T = TypeParam;
    std::size_t ties = 0;
    for (std::uint64_t scene = 0; scene < 60; ++scene) {
        SCOPED_TRACE(scene);
        Random random(80, scene);
        Camera camera;
        camera.eye = Vec3f(random.in_cube<3>());
        camera.target = camera.eye + Vec3f(random.in_cube<3>() - Vec3d::all(0.5));
        camera.field_of_view = static_cast<float>(random.uniform(20, 140));
        const PictureSamples<T> samples(camera, 24, 17);
        const auto on_a_ray = [&](bool behind) {
            const auto ray =
                samples.ray(static_cast<int>(random.bits() % 24), static_cast<int>(random.bits() % 17));
            const auto t = static_cast<T>(std::exp2(random.uniform(-6, 6)));
            return ray.at(behind ? -t : t);
        };
        TriangleMesh<T> mesh;
        for (std::uint32_t i = 0; i < 40; ++i) {
            for (int c = 0; c < 3; ++c) mesh.vertices.push_back(on_a_ray(i % 5 == 0 && c == 0));
            mesh.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
            // The same triangle again, turned.
            if (i % 3 == 0) mesh.triangles.push_back({3 * i + 2, 3 * i + 1, 3 * i});
        }
        const auto want = of_rays(mesh, samples);
        ASSERT_EQ(of_triangles(mesh, samples), want);
        for (const auto& list : want)
            for (std::size_t i = 1; i < list.size(); ++i) ties += list[i].t == list[i - 1].t;
    }
    EXPECT_GT(ties, 1000u);
}

/// Whatever the budget and the executor, the lists are the same; smaller budgets take more bands.
TYPED_TEST(FragmentsOf, BandsOfEveryBudget) {
    using T = TypeParam;
    const auto mesh = hairball<T>(3000);
    const PictureSamples<T> samples(seen_from(mesh, 2, false), 70, 60);
    FragmentCounts whole;
    const auto want = of_triangles(mesh, samples, {}, serial_executor(), &whole);
    EXPECT_EQ(whole.bands, 1u);
    EXPECT_EQ(want, of_rays(mesh, samples));
    // The budget that the fullest row needs.
    std::size_t row = 0;
    for (std::size_t y = 0; y < 60; ++y) {
        std::size_t bytes = 0;
        for (std::size_t x = 0; x < 70; ++x) bytes += want[70 * y + x].size() * sizeof(Hit<T>);
        row = std::max(row, bytes);
    }
    Backwards backwards;
    std::uint64_t bands = 1;
    for (const std::size_t budget : {whole.fragments * sizeof(Hit<T>), 8 * row, 2 * row, row})
        for (Executor* const executor :
             std::initializer_list<Executor*>{&serial_executor(), &default_executor(), &backwards}) {
            FragmentCounts counts;
            ASSERT_EQ(of_triangles(mesh, samples, {.budget = budget}, *executor, &counts), want);
            EXPECT_GE(counts.bands, bands);
            bands = counts.bands;
        }
    EXPECT_GT(bands, 8u);
    // A row that does not fit is named, before anything is taken.
    try {
        FragmentLists<T>(samples).list(mesh.view(), [](const FragmentBand<T>&) { FAIL(); },
                                       {.budget = row - 1});
        FAIL();
    } catch (const InputError& e) {
        EXPECT_NE(std::string(e.what()).find("budget of " + std::to_string(row - 1)), std::string::npos)
            << e.what();
        EXPECT_NE(std::string(e.what()).find("row "), std::string::npos);
    }
}

TEST(Fragments, OfNothing) {
    const TriangleMesh<float> none;
    const PictureSamples<float> samples(Camera(), 5, 4);
    const auto lists = of_triangles(none, samples);
    EXPECT_EQ(lists, Lists<float>(20));
    const PictureSamples<float> no_samples(Camera(), 0, 0);
    const auto counts =
        FragmentLists<float>(no_samples).list(soup<float>(9).view(), [](const auto&) { FAIL(); });
    EXPECT_EQ(counts.bands, 0u);
}

/// A transparent picture by the rasteriser has the bits of that by rays.
TEST(Fragments, MakeTheTransparentPicturesOfRays) {
    const auto mesh = soup<float>(4000);
    const auto index = build(mesh);
    const PictureSamples<float> samples(seen_from(mesh, 1, false), 64, 48);
    const auto rays = samples.rays();
    const auto layer = [](const Ray3f&, const Hit<float>& hit) {
        return Layer{{float(hit.element % 5) / 5, hit.u, hit.v}, 0.2f + float(hit.element % 7) / 10};
    };
    std::vector<Composite> back(rays.size()), front(rays.size()), drawn(rays.size());
    const auto layers = composite_back_to_front(index, rays, layer, back);
    composite_front_to_back(index, rays, layer, front);
    const auto counts = FragmentLists<float>(samples).list(
        mesh.view(),
        [&](const FragmentBand<float>& band) {
            for (int y = band.top(); y <= band.bottom(); ++y)
                for (int x = 0; x < samples.width(); ++x) {
                    const std::size_t i = samples.number(x, y);
                    drawn[i] = composite_list(rays[i], band.at(x, y), layer);
                }
        },
        {.budget = 30000});
    EXPECT_EQ(counts.fragments, layers);
    EXPECT_GT(counts.bands, 3u);
    for (std::size_t i = 0; i < rays.size(); ++i) {
        ASSERT_EQ(drawn[i].colour, back[i].colour);
        ASSERT_EQ(drawn[i].through, back[i].through);
        ASSERT_LE(max_component(abs(drawn[i].colour - front[i].colour)), 1.0f / 255);
    }
}

}  // namespace
