/// χ² of what turns numbers into places and directions: warps, the lens, pixel filters, lights of all kinds
/// together. Lobes are in scattering_test, single lights and skies in lighting_test and environment_map_test.
#include <gtest/gtest.h>

#include <functional>

#include <hedgerow/render/camera/ray_maker.h>
#include <hedgerow/render/sampling/path_samples.h>
#include <hedgerow/render/sampling/pixel_filter.h>
#include <hedgerow/render/sampling/warps.h>

#include "lights_of_tests.h"
#include "path_scenes.h"

using namespace hedgerow;
using namespace hedgerow::test;

namespace {

/// Counts of a square's cells of equal area, beside the integrals of a density over them.
class CellsOfSquare {
public:
    CellsOfSquare(double low, double high) : low_(low), high_(high), counts_(std::size_t(side) * side) {}

    void add(const Vec2f& p) {
        const auto place = [&](float x) {
            return std::clamp(static_cast<int>((double(x) - low_) / (high_ - low_) * side), 0, side - 1);
        };
        counts_[cell(place(p[0]), place(p[1]))] += 1, ++samples_;
    }
    /// How many standard deviations χ² lies above its mean, for a density that must integrate to 1.
    double score(const std::function<double(const Vec2d&)>& density) const {
        constexpr int fine = 24;
        const double step = (high_ - low_) / side / fine;
        std::vector<double> expected(counts_.size());
        double all = 0;
        for (int y = 0; y < side * fine; ++y)
            for (int x = 0; x < side * fine; ++x) {
                const double p = density({low_ + (x + 0.5) * step, low_ + (y + 0.5) * step}) * step * step;
                expected[cell(x / fine, y / fine)] += p, all += p;
            }
        EXPECT_NEAR(all, 1, 3e-3);
        return chi_square_score(counts_, expected, samples_);
    }

private:
    static std::size_t cell(int x, int y) {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(side) + static_cast<std::size_t>(x);
    }
    static constexpr int side = 16;
    double low_, high_, samples_ = 0;
    std::vector<double> counts_;
};

constexpr int samples = 50000;
/// Numbers as paths take them, each of a pixel of its own.
UnitPair numbers(std::uint64_t i) {
    return PixelSequence(Sampler::independent, 1, i).pair(0, 0);
}

TEST(Samplers, PointsHaveTheirDensity) {
    const auto expect = [](const char* name, double low, double high, auto warp, auto density) {
        CellsOfSquare cells(low, high);
        for (int i = 0; i < samples; ++i) {
            const UnitPair p = numbers(static_cast<std::uint64_t>(i));
            cells.add(warp(p.x, p.y));
        }
        EXPECT_LT(cells.score(density), 4) << name;
    };
    const auto disc = [](const Vec2d& p) { return length2(p) < 1 ? 1 / pi : 0; };
    expect("disc", -1, 1, disc_point<float>, disc);
    expect(
        "lens", -1, 1,
        [](float u, float v) {
            const LensPoint p = lens_point(u, v);
            return Vec2f(p.right, p.up);
        },
        disc);
    expect("triangle", 0, 1, triangle_point<float>,
           [](const Vec2d& p) { return p[0] + p[1] < 1 ? 2.0 : 0.0; });
    expect(
        "box filter", 0, 1, [](float u, float v) { return place_in_pixel(PixelFilter::box, u, v); },
        [](const Vec2d&) { return 1.0; });
    expect(
        "Gaussian filter", -1, 2,
        [](float u, float v) { return place_in_pixel(PixelFilter::gaussian, u, v); },
        [](const Vec2d& p) {
            // σ = ½, up to 3σ.
            const double r2 = length2(p - Vec2d(0.5, 0.5));
            return r2 < 2.25 ? 2 / pi * std::exp(-2 * r2) / (1 - std::exp(-4.5)) : 0;
        });
}

TEST(Samplers, DirectionsHaveTheirDensity) {
    const SphereGrid grid{20, 20};
    // Directions are around z; cells are around y.
    const auto turned = [](const Vec3f& d) { return Vec3f(d[1], d[2], d[0]); };
    const auto expect = [&](const char* name, auto warp, auto density) {
        const auto probabilities = grid.integrals(24, [&](const Vec3f& d) { return double(density(d[1])); });
        double all = 0;
        for (const double p : probabilities) all += p;
        EXPECT_NEAR(all, 1, 3e-3) << name;
        std::vector<double> counts(grid.size());
        for (int i = 0; i < samples; ++i) {
            const UnitPair p = numbers(static_cast<std::uint64_t>(i));
            counts[grid.cell(turned(warp(p.x, p.y)))] += 1;
        }
        EXPECT_LT(chi_square_score(counts, probabilities, samples), 4) << name;
    };
    expect("cosine", cosine_direction<float>, cosine_direction_density<float>);
    expect("sphere", sphere_direction, [](float) { return sphere_direction_density; });
    expect("hemisphere", hemisphere_direction<float>,
           [](float z) { return z > 0 ? hemisphere_direction_density : 0; });
    for (const float height : {0.3f, 1.0f, 1.9f})
        expect(
            "cone", [height](float u, float v) { return cone_direction(height, u, v); },
            [height](float z) { return z > 1 - height ? cone_direction_density(height) : 0; });
}

/// Lamps of different shapes and a sky: what `sample` finds in cells of directions, beside
/// the densities that hits have.
TEST(Samplers, LightsOfASceneHaveTheDensityOfTheirHits) {
    auto model = model_of<float>({{box<float>(0.4, 0.3, 0.2, {1, 0.5, 2}), matte({}, {1, 2, 3})},
                                  {box<float>(0.2, 0.2, 0.2, {-1, 1, 1}), matte({}, {3, 1, 1})},
                                  {square<float>(1.5, 4), matte({}, Vec3f::all(0.5f))},
                                  {box<float>(0.5, 0.5, 0.5, {0, -2, 1}), matte(Vec3f::all(0.5f))}});
    model.instances[1].to_world = {{Vec3d(-0.6, -0.8, 0), Vec3d(-0.8, 0.6, 0.2), Vec3d(0, 0.3, 1)},
                                   {-1.5, 0, 0.5}};
    model.environment = Environment();
    const ModelScene<float> scene(model, serial_executor());
    const SceneLights<float> lights(scene, {.compensates = false});
    const SphereGrid grid{24, 24};
    for (const Vec3f& normal : {Vec3f(), Vec3f(0, 0, 1), Vec3f(0.6f, 0, 0.8f)}) {
        // The density of a direction is a sum over all that lies in it, since nothing blocks a sample.
        const Vec3f point(0.1f, 0.2f, 0);
        const auto density = [&](const Vec3f& d) {
            double sum =
                double(lights.environment()->density(d)) * double(lights.probability_of_sky(point, normal));
            Ray<float, 3> ray{point, d};
            for (int k = 0; k < 20; ++k) {
                Hit<float> hit;
                scene.tracer().closest_hits(RayArray<float, 3>(&ray, 1), {&hit, 1});
                if (!hit) break;
                sum += double(lights.density_of_hit(point, normal, d, hit));
                ray.t_min = std::nextafter(hit.t * (1 + 1e-6f), 1e9f);
            }
            return sum;
        };
        const auto probabilities = grid.integrals(32, density);
        double all = 0;
        for (const double p : probabilities) all += p;
        std::vector<double> counts(grid.size());
        double none = 0;
        for (int i = 0; i < samples; ++i) {
            const PathSamples numbers(PixelSequence(Sampler::independent, 2, static_cast<std::uint64_t>(i)),
                                      0);
            const SampledLight s =
                lights.sample(point, normal, numbers.at(0).light_choice(), numbers.at(0).light_point());
            if (s)
                counts[grid.cell(s.light.direction)] += 1;
            else
                none += 1;
        }
        // Samples of the backs of lamps bring no light and have no density.
        EXPECT_NEAR(all, 1 - none / samples, 4e-3);
        EXPECT_LT(chi_square_score(counts, probabilities, samples), 4) << normal[0];
    }
}

}  // namespace
