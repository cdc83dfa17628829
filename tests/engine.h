/// Shared parts of the tests of the engine.
#pragma once

#include <hedgerow/ask.h>

#include "matrix.h"
#include "using.h"

namespace hedgerow {

/// Calls f(index, instruction set) for the index of each width, with each instruction set in use.
template <class Set, class F>
void for_each_kernel(const Set& set, F f) {
    for (const int width : wide_widths) {
        WideOptions options;
        options.width = width;
        const auto index = build<WideBvh>(set, options);
        for (const auto name : instruction_sets()) {
            SCOPED_TRACE(std::string(name) + ", width " + std::to_string(width));
            const Using use(name);
            f(index, name);
            if (testing::Test::HasFatalFailure()) return;
        }
    }
}

/// The engine's answers to rays: in a batch, and one at a time.
struct Answers {
    std::vector<Hit<float>> batch, one;
    std::vector<char> any_batch, any_one;

    template <class Index>
    Answers(const Index& index, std::span<const Ray3f> rays) : batch(rays.size()) {
        closest_hits(index, rays, std::span(batch));
        const std::unique_ptr<bool[]> any(new bool[rays.size() + 1]);
        any_hits(index, rays, {any.get(), rays.size()});
        for (std::size_t i = 0; i < rays.size(); ++i) {
            one.push_back(closest_hit(index, rays[i]));
            any_batch.push_back(any[i]);
            any_one.push_back(any_hit(index, rays[i]));
        }
    }
};

/// The answers of the plain walk, whatever kernels there are. Queries that count visits use it, because
/// kernels do not count.
template <class Index>
std::vector<Hit<float>> hits_of_the_walk(const Index& index, std::span<const Ray3f> rays) {
    std::vector<Hit<float>> hits;
    for (const auto& r : rays) {
        Visits visits;
        hits.push_back(closest_hit(index, r, KeepAll{}, visits));
    }
    return hits;
}

inline void expect_hits(std::span<const Hit<float>> want, const Answers& got) {
    for (std::size_t i = 0; i < want.size(); ++i) {
        ASSERT_EQ(want[i], got.batch[i])
            << "in a batch, ray " << i << ": t " << want[i].t << " and " << got.batch[i].t;
        ASSERT_EQ(want[i], got.one[i])
            << "alone, ray " << i << ": t " << want[i].t << " and " << got.one[i].t;
        ASSERT_EQ(bool(want[i]), bool(got.any_batch[i])) << "any, in a batch, ray " << i;
        ASSERT_EQ(bool(want[i]), bool(got.any_one[i])) << "any, alone, ray " << i;
    }
}

/// Incoherent rays of every kind.
inline std::vector<Ray3f> apart(const Box3f& box, const matrix::Points<float, 3>& targets,
                                std::size_t count) {
    std::vector<Ray3f> rays;
    for (std::size_t i = 0; i < count; ++i) rays.push_back(matrix::ray_of(box, targets, i));
    return rays;
}
/// Coherent rays from beyond a corner of a box through its middle.
inline std::vector<Ray3f> together(const Box3f& box, std::size_t count) {
    std::vector<Ray3f> rays;
    const Vec3f size = box.extent();
    const int longest = max_axis(size);
    for (std::size_t i = 0; i < count; ++i) {
        Vec3f d;
        for (int k = 0; k < 3; ++k) d[k] = size[k] * (k == longest ? 1 : 0.6f);
        d[(longest + 1) % 3] *= 0.8f + 0.01f * static_cast<float>(i % 32);
        d[(longest + 2) % 3] *= 0.8f + 0.01f * static_cast<float>(i / 32 % 32);
        rays.push_back({box.low - size * 0.2f, d});
        if (i % 16 == 5) rays.back().t_min = 0.4f, rays.back().t_max = 0.7f;
    }
    return rays;
}

}  // namespace hedgerow
