/// A Caster answers as closest_hit and any_hit do, for every index and instruction set, and leaves the
/// thread's floating-point mode as it was.
#include <concepts>

#include <hedgerow/caster.h>
#include <hedgerow/engine/kernels.h>
#include <hedgerow/hedgerow.h>
#include <hedgerow/measure/ray_sets.h>
#include <hedgerow/scenes/meshes.h>
#include <hedgerow/scenes/random.h>
#include <hedgerow/scenes/sets.h>

#include <gtest/gtest.h>

#if defined(__SSE2__)
#include <immintrin.h>
#endif

using namespace hedgerow;

namespace {

template <class I>
void expect_same_answers(const I& index) {
    using T = typename I::Scalar;
    constexpr int D = I::dimension;
    std::vector<RayOf<I>> rays;
    rays.reserve(501);
    Random random(3, 0);
    const auto box = index.bounds();
    for (int i = 0; i < 500; ++i) {
        rays.push_back(measure::random_ray(box, random));
    }
    rays.push_back({box.center(), Vec<T, D>()});  // not usable
    const Caster cast(index);
    std::size_t hits = 0;
    for (const auto& ray : rays) {
        const auto hit = closest_hit(index, ray);
        EXPECT_EQ(cast.closest_hit(ray), hit);
        EXPECT_EQ(cast.any_hit(ray), any_hit(index, ray));
        EXPECT_EQ(cast.any_hit(ray), bool(hit));
        hits += bool(hit);
    }
    EXPECT_GT(hits, 20u);
    EXPECT_LT(hits, rays.size());
}

TEST(Caster, AnswersAsTheFunctionsDo) {
    const auto mesh = teapot_in_stadium<float>(3000);
    for (const auto set : instruction_sets()) {
        use_instruction_set(set);
        SCOPED_TRACE(set);
        const auto index = build(mesh);
        expect_same_answers(index);
        std::vector<Instance<MeshIndex<float>>> all;
        all.reserve(5);
        for (int i = 0; i < 5; ++i)
            all.emplace_back(index, Transform<3>::translation({double(i) * 300, 0, 0}));
        const InstanceSet<MeshIndex<float>> placed(all);
        expect_same_answers(build(placed));
        expect_same_answers(build<KdTree>(placed));
    }
    use_instruction_set(instruction_sets().front());
    expect_same_answers(build<Bvh>(mesh));
    expect_same_answers(build(soup<double>(2000)));
    expect_same_answers(build<KdTree>(segments2d<double>(500)));
    const MeshIndex<float> empty;
    EXPECT_FALSE(Caster(empty).closest_hit({{0, 0, 0}, {0, 0, 1}}));
    static_assert(!std::constructible_from<Caster<MeshIndex<float>>, MeshIndex<float>>, "it would be gone");
}

#if defined(__SSE2__)
TEST(Caster, KeepsTheThreadInIeeeModeWhileItExists) {
    // Coordinates are subnormal, which other modes take as zero.
    auto mesh = teapot<float>(500);
    for (auto& v : mesh.vertices) v *= 0x1p-130f;
    const auto index = build(mesh);
    const auto bvh = build<Bvh>(mesh);
    const Ray3f ray{index.bounds().center() + Vec3f(0, 0x1p-126f, 0), {0, -1, 0}};
    const auto expected = closest_hit(index, ray);
    ASSERT_TRUE(expected);
    const unsigned before = _mm_getcsr(), flushing = before | 0xC040;  // flush and round up
    _mm_setcsr(flushing);
    unsigned inside = 0;
    Hit<float> hit, plain;
    {
        const Caster cast(index);
        const Caster other(bvh);
        inside = _mm_getcsr();
        hit = cast.closest_hit(ray);
        plain = other.closest_hit(ray);
    }
    const unsigned after = _mm_getcsr();
    _mm_setcsr(before);
    EXPECT_EQ(inside & 0xE040, 0u);
    EXPECT_EQ(after & 0xE040, flushing & 0xE040);
    EXPECT_EQ(hit, expected);
    EXPECT_EQ(plain, expected);
}
#endif

}  // namespace
