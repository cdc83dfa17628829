/// Another ray tracer in the place of an index: what it finds, and the pictures that it makes, but for the
/// last bits and for rays through edges.
#include <gtest/gtest.h>

#include <hedgerow/hedgerow.h>
#include <hedgerow/render/camera/presets.h>
#include <hedgerow/render/render.h>
#include <hedgerow/render/shading/surfaces.h>
#include <hedgerow/render/visibility/cast.h>
#include <hedgerow/scenes/meshes.h>

#include "peers/tracers.h"

using namespace hedgerow;

namespace {

/// A scene with many layers, its index as a Tracer, and Embree, if it was found.
class PeerTracer : public testing::Test {
protected:
    void SetUp() override {
        if (!peer) GTEST_SKIP() << "this build has no Embree";
        EXPECT_EQ(peer->bounds(), own.bounds());
    }
    /// Of so many answers at least 998 in a thousand are the same.
    static void expect_mostly(std::size_t same, std::size_t all) {
        EXPECT_GE(same, all - all / 500) << "of " << all;
    }
    static bool alike(const Hit<float>& a, const Hit<float>& b) {
        return bool(a) == bool(b) && (!a || (a.element == b.element && a.primitive == b.primitive &&
                                             std::abs(a.t - b.t) <= 1e-4f * a.t &&
                                             std::abs(a.u - b.u) <= 1e-2f && std::abs(a.v - b.v) <= 1e-2f));
    }

    const TriangleMesh<float> mesh = soup<float>(2000);
    using OwnIndex = decltype(build<WideBvh>(std::declval<const TriangleMesh<float>&>()));
    const OwnIndex index = build<WideBvh>(mesh);
    const IndexTracer<OwnIndex> own{index};
    const std::unique_ptr<Tracer<float>> peer = measure::embree_tracer(mesh);
    const std::vector<Ray3f> rays = PictureSamples<float>(automatic_camera(index.bounds()), 80, 60).rays();
};

TEST_F(PeerTracer, FindsClosestAndAnyHits) {
    using measure::EmbreeCalls;
    const Tracer<float>::Filter filters[] = {
        {}, [](std::size_t ray, const Hit<float>& hit) { return (hit.element + ray) % 3 != 0; }};
    for (const auto& filter : filters)
        for (const EmbreeCalls calls :
             {EmbreeCalls::single, EmbreeCalls::stream, EmbreeCalls::coherent_stream}) {
            const auto theirs = measure::embree_tracer(mesh, calls);
            std::vector<Hit<float>> want(rays.size()), hits(rays.size());
            own.closest_hits(rays, want, {}, filter), theirs->closest_hits(rays, hits, {}, filter);
            const auto want_any = std::make_unique<bool[]>(rays.size()),
                       any = std::make_unique<bool[]>(rays.size());
            own.any_hits(rays, std::span(want_any.get(), rays.size()), {}, filter);
            theirs->any_hits(rays, std::span(any.get(), rays.size()), {}, filter);
            std::size_t same = 0, same_any = 0, hit = 0;
            for (std::size_t i = 0; i < rays.size(); ++i) {
                same += alike(want[i], hits[i]), same_any += want_any[i] == any[i], hit += bool(want[i]);
            }
            EXPECT_GT(hit, 500u);
            expect_mostly(same, rays.size());
            expect_mostly(same_any, rays.size());
        }
}

TEST_F(PeerTracer, FindsTheFirstHitsAfterAPlace) {
    constexpr std::size_t k = 3;
    HitLists<float> want, hits;
    std::vector<AfterHit> after(rays.size());
    std::size_t some = 0;
    for (int round = 0; round < 3; ++round) {
        own.first_hits(rays, k, want, after, {});
        peer->first_hits(rays, k, hits, after, {});
        std::size_t same = 0;
        for (std::size_t i = 0; i < rays.size(); ++i)
            same += std::equal(want[i].begin(), want[i].end(), hits[i].begin(), hits[i].end(), alike);
        some += want.count();
        expect_mostly(same, rays.size());
        // Both go on after our hits, halfway to the next, so that the last bits do not matter.
        after.clear();
        for (std::size_t i = 0; i < rays.size(); ++i) {
            const Hit<float> last = want[i].size() == k ? want[i].back() : Hit<float>();
            after.emplace_back(last ? last.t * 1.0001f : last.t, 0u, last ? 0u : Hit<float>::none);
        }
    }
    EXPECT_GT(some, 1000u);
}

TEST_F(PeerTracer, MakesTheSamePicture) {
    const SurfacesOf surfaces(mesh);
    RenderOptions options;
    options.camera = automatic_camera(index.bounds());
    options.width = 80, options.height = 60;
    const auto picture = [&](const Tracer<float>& tracer) {
        RayCasting<float> cast(tracer);
        return render(PictureParts<float>{cast, surfaces, &tracer}, by(serial_executor(), options));
    };
    const Picture a = picture(own), b = picture(*peer);
    ASSERT_TRUE(b.whole);
    std::size_t same = 0;
    for (std::size_t i = 0; i < a.image.pixels.size(); ++i) {
        int most = 0;
        for (std::size_t c = 0; c < 3; ++c)
            most = std::max(most, std::abs(int(a.image.pixels[i][c]) - int(b.image.pixels[i][c])));
        same += most <= 1;
    }
    EXPECT_GE(same, a.image.pixels.size() * 99 / 100);
    std::vector<Hit<float>> hits(rays.size());
    std::vector<Visits> visits(rays.size());
    EXPECT_THROW(peer->closest_hits(rays, hits, visits), std::invalid_argument);
}

}  // namespace
