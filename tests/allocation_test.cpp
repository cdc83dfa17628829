/// Queries allocate nothing. A program of its own, since it counts every allocation that it makes; where a
/// sanitizer does its own, nothing is counted and nothing tested.
#include <atomic>
#include <cstdlib>
#include <new>

#include <hedgerow/scenes/meshes.h>

#include "contract.h"

#if defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
#define HEDGEROW_SANITIZED 1
#endif
#endif
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define HEDGEROW_SANITIZED 1
#endif

#ifndef HEDGEROW_SANITIZED
static std::atomic<std::size_t> allocations{0};

// Not inlined: g++ would see malloc without its free, or the other way round, and warn.
[[gnu::noinline]] void* operator new(std::size_t size) {
    ++allocations;
    if (void* p = std::malloc(size > 0 ? size : 1)) return p;
    throw std::bad_alloc();
}
[[gnu::noinline]] void* operator new(std::size_t size, std::align_val_t alignment) {
    ++allocations;
    const auto a = static_cast<std::size_t>(alignment);
    if (void* p = std::aligned_alloc(a, (size / a + 1) * a)) return p;
    throw std::bad_alloc();
}
[[gnu::noinline]] void operator delete(void* p) noexcept {
    std::free(p);
}
[[gnu::noinline]] void operator delete(void* p, std::size_t) noexcept {
    std::free(p);
}
[[gnu::noinline]] void operator delete(void* p, std::align_val_t) noexcept {
    std::free(p);
}
[[gnu::noinline]] void operator delete(void* p, std::size_t, std::align_val_t) noexcept {
    std::free(p);
}

using namespace hedgerow;
using namespace hedgerow::contract;

namespace {

template <class T>
class Allocation : public testing::Test {};
using Scalars = testing::Types<float, double>;
TYPED_TEST_SUITE(Allocation, Scalars);

template <class F>
std::size_t allocated_by(F f) {
    const std::size_t before = allocations;
    f();
    return allocations - before;
}

TYPED_TEST(Allocation, IsCounted) {
    // Called by name: what an expression allocates, a compiler may leave out.
    EXPECT_EQ(allocated_by([] { operator delete(operator new(3)); }), 1u);
}

TYPED_TEST(Allocation, QueriesDoNone) {
    using T = TypeParam;
    const auto mesh = teapot<T>(2000);
    const Questions questions(build(mesh), 500);
    with_each_structure(mesh, [&](const auto& index) {
        std::vector<Hit<T>> hits, batch(questions.rays.size());
        std::vector<Near<T, 3>> near;
        std::vector<PrimitiveId> found;
        hits.reserve(50 * mesh.size());  // a structure may offer a primitive often
        near.reserve(20);
        found.reserve(50 * mesh.size());
        std::size_t sum = 0;
        Visits visits;
        EXPECT_EQ(allocated_by([&] {
                      for (const auto& ray : questions.rays) {
                          sum += closest_hit(index, ray).has_value();
                          sum += closest_hit(index, ray, Except{3}, visits).has_value();
                          sum += any_hit(index, ray, KeepAll{}, visits);
                      }
                      closest_hits(index, questions.rays, batch);
                  }),
                  0u);
        EXPECT_EQ(allocated_by([&] {
                      for (const auto& ray : questions.rays) sum += all_hits(index, ray, hits);
                      for (const auto& box : questions.boxes) sum += overlapping(index, box, found);
                  }),
                  0u);
        EXPECT_EQ(allocated_by([&] {
                      for (const auto& p : questions.points)
                          sum += closest_point(index, p).has_value() + nearest(index, p, 20, near);
                  }),
                  0u);
        // Counting may need memory, which the thread keeps: none the second time.
        const auto count_all = [&] {
            for (const auto& ray : questions.rays) sum += hit_count(index, ray);
        };
        count_all();
        EXPECT_EQ(allocated_by(count_all), 0u);
        EXPECT_GT(sum + visits.primitives, 0u);
    });
}

}  // namespace
#endif
