/// Rays that are recorded while a picture is made: they are all of the picture's, and have its hits.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <atomic>

#include <hedgerow/render/camera/presets.h>
#include <hedgerow/render/integrators/bounce_rays.h>
#include <hedgerow/scenes/looks.h>

using namespace hedgerow;

namespace {

template <class T>
class RecordedRays : public testing::Test {
protected:
    RecordedRays() {
        options.camera = *camera_for("cornell-box");
        options.width = 24, options.height = 17, options.samples = 6;
    }
    PathScene<T> parts(const Tracer<T>& tracer) const { return {scene, lights, tracer}; }
    std::size_t paths() const {
        return std::size_t(options.width) * std::size_t(options.height) * options.samples;
    }

    const Model<T> model = generate_model<T>(parse_scene_spec("gen:cornell-box"));
    const ModelScene<T> scene{model, serial_executor()};
    const SceneLights<T> lights{scene};
    PathPictureOptions options;
};
using Scalars = testing::Types<float, double>;
TYPED_TEST_SUITE(RecordedRays, Scalars);

/// All numbers of the rays, ray by ray, in an order of their own.
template <class T>
std::vector<std::array<T, 8>> sorted(const std::vector<Ray<T, 3>>& rays) {
    std::vector<std::array<T, 8>> all;
    all.reserve(rays.size());
    for (const auto& [o, d, t_min, t_max] : rays)
        all.push_back({o[0], o[1], o[2], d[0], d[1], d[2], t_min, t_max});
    std::ranges::sort(all);
    return all;
}

TYPED_TEST(RecordedRays, ChangeNothingAndHaveTheirHitsWhenTheyAreTracedAgain) {
    using T = TypeParam;
    RecordingTracer<T> recorded(this->scene.tracer());
    const PathPicture plain =
        trace_paths(this->parts(this->scene.tracer()), by(serial_executor(), this->options));
    const PathPicture watched = trace_paths(this->parts(recorded), by(serial_executor(), this->options));
    for (std::size_t i = 0; i < plain.light.size(); ++i)
        ASSERT_EQ(plain.light.mean(i), watched.light.mean(i)) << i;
    std::size_t closest = 0, any = 0, blocked = 0;
    for (const auto& call : recorded.calls()) {
        ASSERT_EQ(call.first, call.any ? any : closest) << "calls follow each other";
        (call.any ? any : closest) += call.size;
        for (std::size_t i = call.first; i < call.first + call.size; ++i) {
            Hit<T> hit;
            bool is = false;
            if (call.any)
                this->scene.tracer().any_hits(RayArray<T, 3>(&recorded.any().rays[i], 1), {&is, 1});
            else
                this->scene.tracer().closest_hits(RayArray<T, 3>(&recorded.closest().rays[i], 1), {&hit, 1});
            if (call.any)
                ASSERT_EQ(is, recorded.any().answers[i]);
            else
                ASSERT_EQ(hit, recorded.closest().answers[i]);
            blocked += is;
        }
    }
    EXPECT_EQ(closest, recorded.closest().rays.size());
    EXPECT_EQ(closest, recorded.closest().answers.size());
    EXPECT_EQ(any, recorded.any().rays.size());
    EXPECT_EQ(any, recorded.any().answers.size());
    EXPECT_GT(closest, 2 * this->paths()) << "paths are scattered";
    EXPECT_GT(blocked, 0u);
    recorded.clear();
    EXPECT_TRUE(recorded.calls().empty() && recorded.closest().rays.empty() && recorded.any().rays.empty());
}

TYPED_TEST(RecordedRays, OfAllBouncesAreThoseOfThePicture) {
    using T = TypeParam;
    const RecordingTracer<T> recorded(this->scene.tracer());
    trace_paths(this->parts(recorded), by(default_executor(), this->options));
    const auto bounces = rays_by_bounce(this->parts(this->scene.tracer()), this->options, 1'000'000);
    std::vector<Ray<T, 3>> rays, shadow_rays;
    for (std::size_t k = 0; k < bounces.size(); ++k) {
        EXPECT_LE(bounces[k].rays.size(), k > 0 ? bounces[k - 1].rays.size() : this->paths()) << "paths end";
        EXPECT_LE(bounces[k].shadow_rays.size(), bounces[k].rays.size());
        rays.insert(rays.end(), bounces[k].rays.begin(), bounces[k].rays.end());
        shadow_rays.insert(shadow_rays.end(), bounces[k].shadow_rays.begin(), bounces[k].shadow_rays.end());
    }
    EXPECT_EQ(bounces[0].rays.size(), this->paths());
    for (const auto& ray : bounces[0].rays) ASSERT_EQ(ray.origin, (Vec<T, 3>(this->options.camera.eye)));
    EXPECT_EQ(sorted(rays), sorted(recorded.closest().rays));
    EXPECT_EQ(sorted(shadow_rays), sorted(recorded.any().rays));
}

/// Light that is scattered k times at most has rays of k bounces and no more.
TYPED_TEST(RecordedRays, HaveNoMoreBouncesThanPaths) {
    for (const std::uint32_t bounces : {0u, 1u, 2u}) {
        this->options.paths.bounces = bounces, this->options.paths.compensation = false;
        const auto rays = rays_by_bounce(this->parts(this->scene.tracer()), this->options, 1'000'000);
        ASSERT_EQ(rays.size(), bounces + 1);
        EXPECT_TRUE(rays.back().shadow_rays.empty()) << "no light is looked for where paths end";
        EXPECT_EQ(rays.front().shadow_rays.empty(), bounces == 0);
    }
}

TYPED_TEST(RecordedRays, AreSpreadEvenlyIfThereAreMorePathsThanAskedFor) {
    const auto parts = this->parts(this->scene.tracer());
    this->options.paths.compensation = false;
    const auto all = rays_by_bounce(parts, this->options, this->paths());
    for (const std::size_t most : {std::size_t(1), std::size_t(7), std::size_t(1000)}) {
        const auto some = rays_by_bounce(parts, this->options, most);
        ASSERT_EQ(some[0].rays.size(), most);
        for (std::size_t i = 0; i < most; ++i)
            ASSERT_EQ(some[0].rays[i].direction, all[0].rays[i * this->paths() / most].direction) << i;
    }
    EXPECT_TRUE(rays_by_bounce(parts, this->options, 0).empty());
}

TYPED_TEST(RecordedRays, RefuseOptionsWithoutAMeaningAndStop) {
    const auto parts = this->parts(this->scene.tracer());
    PathPictureOptions bad = this->options;
    bad.width = 0;
    EXPECT_THROW(rays_by_bounce(parts, bad, 10), InputError);
    bad = this->options, bad.camera.field_of_view = 0;
    EXPECT_THROW(rays_by_bounce(parts, bad, 10), InputError);
    bad = this->options, bad.paths.least_throughput = 1;
    EXPECT_THROW(rays_by_bounce(parts, bad, 10), InputError);
    const std::atomic<bool> stop{true};
    EXPECT_THROW(rays_by_bounce(parts, this->options, 10, {{}, &stop}), Cancelled);
}

}  // namespace
