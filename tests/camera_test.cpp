/// Cameras: which rays they make, and what their views show.
#include <gtest/gtest.h>

#include <hedgerow/base/error.h>
#include <hedgerow/render/camera/presets.h>
#include <hedgerow/render/camera/ray_maker.h>
#include <hedgerow/render/visibility/samples.h>

#include "matrix.h"

using namespace hedgerow;

namespace {

void expect_near(const Vec3f& want, const Vec3f& is, float error = 1e-5f) {
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(want[k], is[k], error);
}
Camera looking_north(Projection projection) {
    Camera camera;
    camera.eye = {1, 2, 3}, camera.target = {1, 12, 3};
    camera.projection = projection;
    return camera;
}

TEST(Cameras, ParallelRaysGoForwardFromThePlaneOfTheEye) {
    Camera camera = looking_north(Projection::orthographic);
    camera.height = 6;
    const RayMaker make(camera, 20, 10);
    ASSERT_TRUE(make.has_plane());
    const Ray3f middle = make.ray<float>(10, 5), corner = make.ray<float>(0, 0);
    expect_near({1, 2, 3}, middle.origin);
    expect_near({0, 1, 0}, middle.direction);
    expect_near({1 - 6, 2, 3 + 3}, corner.origin);
    EXPECT_EQ(corner.direction, middle.direction);
    expect_near({0, 0, 4}, make.seen({-5, 6, 6}));
}

TEST(Cameras, ParallelRaysShowByDefaultWhatAPerspectiveShowsAtTheTarget) {
    const RayMaker perspective(looking_north(Projection::perspective), 30, 20),
        parallel(looking_north(Projection::orthographic), 30, 20);
    const Vec3f at_target = parallel.ray<float>(3, 4).at(10);
    expect_near({3, 4, 10}, perspective.seen(at_target), 1e-4f);
}

TEST(Cameras, APanoramaLooksAround) {
    const RayMaker make(looking_north(Projection::panorama), 40, 20);
    EXPECT_FALSE(make.has_plane());
    expect_near({0, 1, 0}, make.ray<float>(20, 10).direction);
    expect_near({1, 0, 0}, make.ray<float>(30, 10).direction);
    expect_near({0, -1, 0}, make.ray<float>(0, 10).direction);
    expect_near({0, 0, 1}, make.ray<float>(7, 0).direction);
    expect_near({0, 0, -1}, make.ray<float>(31, 20).direction);
    expect_near({0, std::sqrt(0.5f), std::sqrt(0.5f)}, make.ray<float>(20, 5).direction);
}

TEST(Cameras, RaysOfALensMeetWhereItIsInFocus) {
    Camera camera = looking_north(Projection::perspective);
    camera.lens_radius = 0.5f, camera.focus = 4;
    const RayMaker lens(camera, 20, 10);
    camera.lens_radius = 0;
    const RayMaker pinhole(camera, 20, 10);
    ASSERT_TRUE(lens.has_lens());
    EXPECT_FALSE(lens.has_plane());
    const Ray3f through_middle = pinhole.ray<float>(3, 7);
    const Vec3f in_focus = through_middle.at(4 / pinhole.forward_of(through_middle.direction));
    for (const LensPoint& point : {LensPoint{0, 0}, LensPoint{1, 0}, LensPoint{-0.3f, 0.7f}}) {
        const Ray3f ray = lens.ray<float>(3, 7, point);
        EXPECT_NEAR(length(ray.origin - camera.eye), 0.5f * std::hypot(point.right, point.up), 1e-6f);
        EXPECT_NEAR(length(ray.direction), 1, 1e-6f);
        const float t = 4 / lens.forward_of(ray.direction);
        expect_near(in_focus, ray.at(t), 1e-5f);
    }
    // Samples go through different points of the lens.
    camera.lens_radius = 0.5f;
    const PictureSamples<float> samples(camera, 20, 10, 3, 0, 1);
    EXPECT_NE(samples.ray(0, 0).origin, samples.ray(1, 0).origin);
    EXPECT_EQ(samples.ray(0, 0).origin, samples.ray(0, 0).origin);
}

TEST(Cameras, PointsOfALensFillItEvenly) {
    // The share of points within half of the radius is a quarter; so is that of each quadrant.
    constexpr int side = 200;
    int within = 0, first_quadrant = 0;
    for (int i = 0; i < side; ++i)
        for (int j = 0; j < side; ++j) {
            const LensPoint p =
                lens_point((static_cast<float>(i) + 0.5f) / side, (static_cast<float>(j) + 0.5f) / side);
            const float r = std::hypot(p.right, p.up);
            ASSERT_LE(r, 1);
            within += r < 0.5f;
            first_quadrant += p.right > 0 && p.up > 0;
        }
    EXPECT_NEAR(within, 0.25 * side * side, side);
    EXPECT_NEAR(first_quadrant, 0.25 * side * side, side);
}

TEST(Cameras, ViewsShowTheWholeBoxUpright) {
    const Box3f boxes[] = {{{-1, -2, -3}, {4, 2, 9}},
                           {{5, 5, 5}, {6, 25, 5.5f}},
                           {{0, 0, 0}, {1, 1, 0}},
                           {{2, 2, 2}, {2, 2, 2}}};
    for (const Box3f& box : boxes)
        for (int up = 0; up < 3; ++up)
            for (const auto name : view_names)
                for (const auto projection : {Projection::perspective, Projection::orthographic})
                    for (const int width : {300, 100}) {
                        SCOPED_TRACE(std::string(name) + ", up " + std::to_string(up));
                        if (name == "corner" && length2(box.extent()) == 0) continue;  // no size to go by
                        auto camera = named_view(name, box, up, static_cast<float>(width) / 200);
                        ASSERT_TRUE(camera);
                        camera->projection = projection;
                        ASSERT_NO_THROW(check_camera(*camera));
                        const RayMaker make(*camera, width, 200);
                        for (int corner = 0; corner < 8 && name != "corner"; ++corner) {
                            Vec3f p;
                            for (int k = 0; k < 3; ++k) p[k] = corner >> k & 1 ? box.high[k] : box.low[k];
                            const Vec3f seen = make.seen(p);
                            EXPECT_GT(seen[2], 0);
                            EXPECT_GE(seen[0], 0);
                            EXPECT_GE(seen[1], 0);
                            EXPECT_LE(seen[0], static_cast<float>(width));
                            EXPECT_LE(seen[1], 200);
                        }
                        // What is higher is drawn higher.
                        if (name == "top" || name == "bottom") continue;
                        Vec3f above = box.center();
                        above[up] += 1e-2f;
                        EXPECT_LT(make.seen(above)[1], make.seen(box.center())[1]);
                    }
    EXPECT_FALSE(named_view("behind", boxes[0], 2, 1));
    EXPECT_TRUE(named_view("front", Box3f(), 2, 1));
}

TEST(Cameras, ThatSeeNothingAreRefused) {
    const Camera sound = looking_north(Projection::perspective);
    EXPECT_NO_THROW(check_camera(sound));
    const auto refused = [&](auto change) {
        Camera camera = sound;
        change(camera);
        EXPECT_THROW(check_camera(camera), InputError);
    };
    const float nan = std::numeric_limits<float>::quiet_NaN();
    refused([&](Camera& c) { c.field_of_view = 0; });
    refused([&](Camera& c) { c.field_of_view = 180; });
    refused([&](Camera& c) { c.field_of_view = nan; });
    refused([&](Camera& c) { c.height = -1; });
    refused([&](Camera& c) { c.lens_radius = nan; });
    refused([&](Camera& c) { c.focus = -2; });
    refused([&](Camera& c) { c.eye = c.target; });
    refused([&](Camera& c) { c.eye[1] = nan; });
}

}  // namespace
