/// Samples of paths: nets, independence, and the same numbers for the same keys.
#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <vector>

#include <hedgerow/base/instruction_set.h>
#include <hedgerow/render/integrators/path_camera.h>
#include <hedgerow/render/sampling/sample_batch.h>

namespace hedgerow {
namespace {

/// Sobol's second dimension by its recurrence: direction number v is the one before, added to its half.
std::uint32_t second_dimension(std::uint32_t index) {
    std::uint32_t sum = 0;
    for (std::uint32_t v = 0x80000000u; index != 0; index >>= 1, v ^= v >> 1)
        if ((index & 1) != 0) sum ^= v;
    return sum;
}

TEST(Sobol, TheSecondDimensionIsThatOfTheRecurrence) {
    for (std::uint32_t i = 0; i < 5000; ++i) {
        EXPECT_EQ(bits_reversed(pascal_product(i)), second_dimension(i));
        const std::uint32_t any = scattered32(i);
        EXPECT_EQ(bits_reversed(pascal_product(any)), second_dimension(any));
    }
}

TEST(Sobol, ScramblesAreNestedBijections) {
    for (const std::uint32_t seed : {0u, 1u, 0x12345678u}) {
        std::set<std::uint32_t> seen;
        for (std::uint32_t i = 0; i < 4096; ++i) {
            const std::uint32_t x = scrambled_upward(i, seed);
            seen.insert(x & 4095);
            // Higher bits do not change the lower ones.
            EXPECT_EQ(x & 4095, scrambled_upward(i | 0xABCD0000u, seed) & 4095);
        }
        EXPECT_EQ(seen.size(), 4096u);
    }
}

TEST(Sobol, PrefixesAreNets) {
    for (const std::uint32_t seed : {0u, 7u, 0xDEADBEEFu})
        for (const std::uint32_t m : {1u, 4u, 8u, 10u})
            for (std::uint32_t a = 0; a <= m; ++a) {
                std::set<std::uint32_t> boxes;
                for (std::uint32_t i = 0; i < (1u << m); ++i) {
                    const FractionPair p = sobol_pair(i, seed);
                    const std::uint32_t column = a == 0 ? 0 : p.x >> (32 - a),
                                        row = a == m ? 0 : p.y >> (32 - (m - a));
                    boxes.insert((column << 16) | row);
                }
                EXPECT_EQ(boxes.size(), std::size_t(1) << m) << "seed " << seed << ", 2^" << m << ", " << a;
            }
}

/// The χ² statistic of counts that should be equal, as standard deviations from its mean.
double deviation(const std::vector<int>& counts) {
    double all = 0, sum = 0;
    for (const int c : counts) all += c;
    const double expected = all / double(counts.size());
    for (const int c : counts) sum += (c - expected) * (c - expected) / expected;
    const double freedom = double(counts.size()) - 1;
    return (sum - freedom) / std::sqrt(2 * freedom);
}

TEST(PathSamples, PairsOfDimensionsPixelsAndSamplesAreIndependent) {
    for (const Sampler sampler : {Sampler::sobol, Sampler::independent}) {
        // The first sample of many pixels, and of many dimensions of one pixel.
        std::vector<int> pixels(256), dimensions(256), across(256), streams(256);
        const auto cell = [](float x, float y) {
            return static_cast<std::size_t>(x * 16) * 16 + static_cast<std::size_t>(y * 16);
        };
        for (std::uint32_t i = 0; i < 25600; ++i) {
            const UnitPair p = PixelSequence(sampler, 1, i).pair(0, 0);
            ++pixels[cell(p.x, p.y)];
            const UnitPair d = PixelSequence(sampler, 2, 0).pair(3, i);
            ++dimensions[cell(d.x, d.y)];
            // Two dimensions of different pairs, over the samples of one pixel.
            const PixelSequence one(sampler, 3, 12345);
            ++across[cell(one.pair(i, 4).x, one.pair(i, 5).x)];
            ++streams[cell(PixelSequence(sampler, 4, i, 0).pair(0, 0).x,
                           PixelSequence(sampler, 4, i, 1).pair(0, 0).x)];
        }
        for (const auto* counts : {&pixels, &dimensions, &across, &streams})
            EXPECT_LT(std::abs(deviation(*counts)), 5);
    }
}

TEST(PathSamples, SobolIntegratesBetterThanIndependentNumbers) {
    double error[2];
    for (const Sampler sampler : {Sampler::sobol, Sampler::independent}) {
        double sum2 = 0;
        for (std::uint64_t pixel = 0; pixel < 200; ++pixel) {
            const PixelSequence sequence(sampler, 9, pixel);
            double inside = 0;
            for (std::uint32_t i = 0; i < 256; ++i) {
                const UnitPair p = sequence.pair(i, 6);
                inside += p.x * p.x + p.y * p.y < 1;
            }
            const double off = inside / 256 - 0.78539816339744831;
            sum2 += off * off;
        }
        error[sampler == Sampler::independent] = std::sqrt(sum2 / 200);
    }
    EXPECT_LT(error[0], 0.35 * error[1]);
    EXPECT_NEAR(error[1], std::sqrt(0.7854 * 0.2146 / 256), 0.005);
}

TEST(PathSamples, HaveTheseNumbersOnEveryProcessor) {
    const PixelSequence sobol(Sampler::sobol, 1, 2), independent(Sampler::independent, 1, 2);
    EXPECT_EQ(scattered32(1), 1753845952u);
    std::uint32_t sum = 0;
    for (std::uint32_t i = 0; i < 1000; ++i)
        for (std::uint32_t d = 0; d < 10; ++d) {
            const UnitPair a = sobol.pair(i, d), b = independent.pair(i, d);
            for (const float x : {a.x, a.y, b.x, b.y}) {
                ASSERT_TRUE(x >= 0 && x < 1);
                sum = scattered32(sum + static_cast<std::uint32_t>(x * 0x1p24f));
            }
        }
    EXPECT_EQ(sum, 2973681719u);
}

template <class Samples>
void expect_same(const Samples& a, const Samples& b) {
    for (std::size_t k = 0; k < Samples::count; ++k) {
        ASSERT_EQ(a.pairs[k].x, b.pairs[k].x) << "pair " << k;
        ASSERT_EQ(a.pairs[k].y, b.pairs[k].y) << "pair " << k;
    }
}
/// Numbers of a batch, with each instruction set and for sizes that fill no vector, are those of single
/// paths.
TEST(PathSamples, BatchesHaveTheNumbersOfSinglePaths) {
    for (const auto set : instruction_sets()) {
        use_instruction_set(set);
        SCOPED_TRACE(set);
        for (const Sampler sampler : {Sampler::sobol, Sampler::independent}) {
            SampleBatch vertices(100, VertexSamples::count), cameras(100, CameraSamples::count),
                pixels(100, 1);
            for (const std::uint32_t size : {100u, 0u, 1u, 37u}) {
                const auto path = [&](std::uint32_t i) {
                    return PathSamples(PixelSequence(sampler, 3, i / 4), i + size);
                };
                for (auto* batch : {&vertices, &cameras, &pixels}) batch->clear();
                for (std::uint32_t i = 0; i < size; ++i) {
                    vertices.add(path(i), PathSamples::dimension(7 * i % 5));
                    cameras.add(path(i), 0), pixels.add(path(i), 0);
                }
                for (auto* batch : {&vertices, &cameras, &pixels}) batch->compute();
                for (std::uint32_t i = 0; i < size; ++i) {
                    SCOPED_TRACE(i);
                    expect_same(vertices.at_vertex(i), path(i).at(7 * i % 5));
                    CameraSamples camera = path(i).at_camera();
                    expect_same(cameras.at_camera(i), camera);
                    camera.pairs[1] = {0, 0};
                    expect_same(pixels.at_camera(i), camera);
                }
            }
        }
    }
    use_instruction_set(instruction_sets().front());
}

TEST(PathSamples, StartsOfABatchAreThoseOfSinglePaths) {
    for (const float lens_radius : {0.0f, 0.3f})
        for (const PixelFilter filter : {PixelFilter::box, PixelFilter::gaussian}) {
            Camera from{{1, 2, 3}, {0, 0, 0}, {0, 0, 1}, 40};
            from.lens_radius = lens_radius;
            const PathCamera camera(from, 20, 10, filter, Sampler::sobol, 4);
            const auto sample = [](int i) {
                return PixelSample{i % 20, i / 20, static_cast<std::uint32_t>(i % 2), 7};
            };
            PathStartBatch<float> batch(camera, 200);
            for (const int size : {200, 1, 33}) {
                batch.clear();
                for (int i = 0; i < size; ++i) batch.add(sample(i));
                batch.compute();
                for (int i = 0; i < size; ++i) {
                    const auto one = camera.start<float>(sample(i)), of_batch = batch[std::size_t(i)];
                    ASSERT_EQ(of_batch.ray.origin, one.ray.origin) << i;
                    ASSERT_EQ(of_batch.ray.direction, one.ray.direction) << i;
                    ASSERT_EQ(of_batch.samples.pixel().seed(), one.samples.pixel().seed()) << i;
                    ASSERT_EQ(of_batch.samples.sample(), one.samples.sample()) << i;
                }
            }
        }
}

TEST(PathSamples, APathTakesEachPairOnce) {
    const PixelSequence pixel(Sampler::independent, 5, 6);
    const PathSamples path(pixel, 7);
    std::set<float> seen;
    std::size_t taken = 0;
    const auto take = [&](const UnitPair& p) { seen.insert(p.x), seen.insert(p.y), taken += 2; };
    take(path.at_camera().in_pixel()), take(path.at_camera().on_lens());
    for (std::uint32_t v = 0; v < 50; ++v) {
        const VertexSamples at = path.at(v);
        take(at.light_point()), take(at.direction());
        take({static_cast<float>(at.light_choice()), at.lobe_choice()});
        take({at.end(), -at.end()});
    }
    EXPECT_EQ(seen.size(), taken);
}

}  // namespace
}  // namespace hedgerow
