/// Rays of pictures, which a batch answers in blocks of 8 by 8. Rows of any length, whole or cut short, give
/// the bits of single rays, and each ray keeps its number.
#include "engine.h"

#include <hedgerow/scenes/meshes.h>

using namespace hedgerow;

namespace {

enum class Kind { pinhole, parallel, to_a_light, jittered };

/// The rays of a picture, row by row, from beyond a corner of the box.
std::vector<Ray3f> picture(const Box3f& box, Kind kind, int columns, int rows) {
    const Vec3f size = box.extent(), center = box.center(), eye = center + size * 0.9f;
    const Vec3f forward = normalized(center - eye), right = normalized(cross(forward, Vec3f(0, 1, 0)));
    const Vec3f up = cross(right, forward);
    std::vector<Ray3f> rays;
    for (int y = 0; y < rows; ++y)
        for (int x = 0; x < columns; ++x) {
            Random random(5, rays.size());
            const float dx = kind == Kind::jittered ? float(random.uniform()) : 0.5f;
            const float dy = kind == Kind::jittered ? float(random.uniform()) : 0.5f;
            const Vec3f beside = right * ((float(x) + dx) / float(columns) - 0.5f) +
                                 up * (0.5f - (float(y) + dy) / float(columns));
            const Vec3f spread = beside * length(size);
            if (kind == Kind::parallel)
                rays.push_back({eye + spread, forward});
            else if (kind == Kind::to_a_light)
                rays.push_back({center + spread, eye - center - spread, 0, 1});
            else
                rays.push_back({eye, forward + beside});
        }
    return rays;
}

struct Shape {
    int columns, rows;
};
// Columns are multiples of 8 and others; long rows of the others are answered in blocks too. Rows are bands
// of 8, some with a rest.
constexpr Shape shapes[] = {{16, 40}, {24, 33}, {100, 20}, {130, 17}, {132, 24}, {200, 16}, {521, 17}};

/// Calls f(rays) for each instruction set and shape.
template <class F>
void for_each_picture(const Box3f& box, Kind kind, F f) {
    for (const auto set : instruction_sets())
        for (const auto& [columns, rows] : shapes) {
            SCOPED_TRACE(std::string(set) + ", rows of " + std::to_string(columns));
            const Using use(set);
            f(picture(box, kind, columns, rows));
            if (testing::Test::HasFatalFailure()) return;
        }
}

template <class Index>
void expect_the_same(const Index& index, std::span<const Ray3f> rays) {
    std::vector<Hit<float>> hits(rays.size());
    const std::unique_ptr<bool[]> any(new bool[rays.size()]);
    const KernelUse use = closest_hits(index, rays, std::span(hits));
    EXPECT_EQ(use.single + use.phased + use.packets, rays.size());
    any_hits(index, rays, {any.get(), rays.size()});
    for (std::size_t i = 0; i < rays.size(); ++i) {
        const auto want = closest_hit(index, rays[i]);
        ASSERT_EQ(want, hits[i]) << "ray " << i;
        ASSERT_EQ(bool(want), any[i]) << "any, ray " << i;
    }
}

TEST(Pictures, OfAnyRowsGiveTheBitsOfSingleRays) {
    const auto mesh = teapot_in_stadium<float>(2000);
    for (const int width : wide_widths) {
        WideOptions options;
        options.width = width;
        const auto index = build<WideBvh>(mesh, options);
        for (const auto kind : {Kind::pinhole, Kind::parallel, Kind::to_a_light, Kind::jittered}) {
            SCOPED_TRACE("width " + std::to_string(width));
            for_each_picture(index.bounds(), kind,
                             [&](const std::vector<Ray3f>& rays) { expect_the_same(index, rays); });
        }
    }
}

/// Batches that begin in the middle of a row, contain rays that hit nothing, and join two pictures.
TEST(Pictures, CutAndJoined) {
    const auto mesh = teapot_in_stadium<float>(2000);
    const auto index = build<WideBvh>(mesh);
    auto rays = picture(index.bounds(), Kind::pinhole, 96, 64);
    for (std::size_t i = 0; i < rays.size(); i += 97) rays[i].t_max = -1;
    const auto more = picture(index.bounds(), Kind::to_a_light, 40, 64);
    rays.insert(rays.end(), more.begin(), more.end());
    for (const auto set : instruction_sets()) {
        SCOPED_TRACE(set);
        const Using use(set);
        for (const std::size_t from : {0u, 1u, 50u, 96u, 6000u})
            expect_the_same(index, std::span<const Ray3f>(rays).subspan(from));
    }
}

/// Packets pause where they do not pay, and resume after that.
TEST(Pictures, BetweenRaysThatGoTheirOwnWays) {
    const auto mesh = soup<float>(20000);
    const auto index = build<WideBvh>(mesh);
    const auto targets = matrix::targets_of(mesh);
    auto rays = picture(index.bounds(), Kind::pinhole, 128, 64);
    const auto between = apart(index.bounds(), targets, 6000);
    const auto far = picture(index.bounds(), Kind::to_a_light, 16, 512);  // rays a triangle apart, or farther
    const auto last = rays;
    for (const auto* more : {&between, &far, &last}) rays.insert(rays.end(), more->begin(), more->end());
    for (const auto set : instruction_sets()) {
        SCOPED_TRACE(set);
        const Using use(set);
        expect_the_same(index, rays);
    }
}

TEST(Pictures, RaysKeepTheirNumbersForFilters) {
    const auto mesh = soup<float>(3000);
    const auto index = build<WideBvh>(mesh);
    const auto refuses = [](std::size_t i, const Hit<float>& hit) { return (hit.element + i) % 3 == 0; };
    for_each_picture(index.bounds(), Kind::pinhole, [&](const std::vector<Ray3f>& rays) {
        std::vector<Hit<float>> hits(rays.size());
        closest_hits(index, rays, std::span(hits), {.threads = serial_executor()},
                     [&](std::size_t i, const Hit<float>& hit) { return !refuses(i, hit); });
        for (std::size_t i = 0; i < rays.size(); ++i) {
            const auto want =
                closest_hit(index, rays[i], [&](const Hit<float>& hit) { return !refuses(i, hit); });
            ASSERT_EQ(want, hits[i]) << "ray " << i;
        }
    });
}

/// Where many rays of a picture hit each triangle, packets answer them, whatever the length of a row. Only
/// the last rays, fewer than 64, may be left over. (Every thread's piece of a batch would have such a rest.)
TEST(Pictures, GoInPackets) {
    const auto mesh = soup<float>(12);
    const auto index = build<WideBvh>(mesh);
    for_each_picture(index.bounds(), Kind::parallel, [&](const std::vector<Ray3f>& rays) {
        std::vector<Hit<float>> hits(rays.size());
        const std::size_t packets =
            closest_hits(index, rays, std::span(hits), {.threads = serial_executor()}).packets;
        if (in_use<AllRayKernels>() == nullptr)
            EXPECT_EQ(packets, 0u);
        else
            EXPECT_GT(packets + 64, rays.size());
    });
}

}  // namespace
