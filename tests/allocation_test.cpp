/// Tests that queries allocate nothing, and that a build with a budget allocates no more than it says. This
/// is a program of its own because it counts all its allocations. A sanitizer has an allocator of its own, so
/// nothing is counted or tested there.
#include <hedgerow/scenes/meshes.h>

#include "contract.h"
#include "counted_memory.h"

#ifndef HEDGEROW_SANITIZED
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
    // Calls the operators by name, because a compiler may leave out the allocation of a new-expression.
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
        hits.reserve(50 * mesh.size());  // a structure may offer a primitive many times
        near.reserve(20);
        found.reserve(50 * mesh.size());
        std::size_t sum = 0;
        Visits visits;
        EXPECT_EQ(allocated_by([&] {
                      for (const auto& ray : questions.rays) {
                          sum += bool(closest_hit(index, ray));
                          sum += bool(closest_hit(index, ray, Except{3}, visits));
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
                          sum += bool(closest_point(index, p)) + nearest(index, p, 20, near);
                  }),
                  0u);
        // hit_count may allocate memory that the thread keeps, so only a second run must allocate nothing.
        const auto count_all = [&] {
            for (const auto& ray : questions.rays) sum += hit_count(index, ray);
        };
        count_all();
        EXPECT_EQ(allocated_by(count_all), 0u);
        EXPECT_GT(sum + visits.primitives, 0u);
    });
}

// Questions that give lists, alone and in batches of one thread, once their lists have the memory.
TYPED_TEST(Allocation, WarmListsDoNone) {
    using T = TypeParam;
    const auto mesh = teapot<T>(2000);
    const Questions questions(build(mesh), 800);
    with_each_structure(mesh, [&](const auto& index) {
        std::vector<Hit<T>> hits;
        std::vector<Near<T, 3>> near;
        std::vector<PrimitiveId> found;
        HitLists<T> all, first;
        NearLists<T> nearest_ones, close;
        IdLists<> over, in;
        std::size_t sum = 0;
        const PointOptions alone{.threads = serial_executor()};
        const auto ask = [&] {
            for (const auto& ray : questions.rays) sum += all_hits(index, ray, hits);
            for (const auto& p : questions.points)
                sum += nearest(index, p, 7, near) + within(index, p, 0.3, near);
            for (const auto& box : questions.boxes)
                sum += overlapping(index, box, found) + contained(index, box, found);
            all_hits(index, questions.rays, all, {.threads = serial_executor()});
            first_hits(index, questions.rays, 3, first, {.threads = serial_executor()});
            nearest(index, questions.points, 7, nearest_ones, alone);
            within(index, questions.points, 0.3, close, alone);
            overlapping(index, questions.boxes, over, {.threads = serial_executor()});
            contained(index, questions.boxes, in, {.threads = serial_executor()});
            sum += all.count() + first.count() + nearest_ones.count() + close.count() + over.count();
        };
        ask();
        EXPECT_EQ(allocated_by(ask), 0u);
        EXPECT_GT(sum, 0u);
    });
}

/// Builds with every builder and width over four kinds of meshes. Leaves of one triangle take the most
/// memory.
TYPED_TEST(Allocation, WideBuildsStayWithinTheirBound) {
    using T = TypeParam;
    TriangleMesh<T> equal = cube<T>(12);
    equal.triangles.assign(3000, equal.triangles[0]);
    for (const auto& mesh : {soup<T>(20000), teapot_in_stadium<T>(20000), cube<T>(12), equal})
        for (const int width : wide_widths)
            for (const auto builder : wide_builders)
                for (const std::uint32_t leaf : {1u, 8u}) {
                    WideOptions options;
                    options.width = width;
                    options.builder = builder;
                    options.max_leaf_size = leaf;
                    // Stay within the bound; for large meshes, use more than a tenth of it.
                    const auto view = mesh.view();
                    const double bound = most_bytes_to_build<T, 3>(mesh.size(), options);
                    const double taken = static_cast<double>(
                        most_bytes_of([&] { WideBvh<T, 3>::build(view, options, serial_executor()); }));
                    EXPECT_LE(taken, bound) << width << " " << int(builder) << " " << leaf;
                    if (mesh.size() > 10000) {
                        EXPECT_GT(taken, 0.1 * bound) << width << " " << int(builder) << " " << leaf;
                    }
                    // A budget below the bound is refused before the build allocates.
                    options.budget = bound - 1;
                    EXPECT_LT(most_bytes_of([&] { EXPECT_THROW(build<WideBvh>(view, options), InputError); }),
                              10000u);
                    options.budget = bound;
                    EXPECT_NO_THROW(build<WideBvh>(view, options));
                }
    WideOptions bad;
    bad.budget = -1;
    EXPECT_THROW(build<WideBvh>(equal, bad), InputError);
}

/// Scratch is what a build takes beyond the index that it leaves; RecordProperty keeps each ratio.
TYPED_TEST(Allocation, ScratchOfABuildIsAtMostOneAndAHalfIndexes) {
    using T = TypeParam;
    const std::pair<const char*, TriangleMesh<T>> scenes[] = {{"interior", interior<T>(100000)},
                                                              {"boulder", boulder<T>(100000)},
                                                              {"hairball", hairball<T>(100000)},
                                                              {"soup", soup<T>(100000)},
                                                              {"stadium", teapot_in_stadium<T>(50000)}};
    for (const auto& [name, mesh] : scenes)
        for (const auto builder : wide_builders) {
            WideOptions options;
            options.builder = builder;
            const auto view = mesh.view();
            double left = 0;
            const auto build_it = [&] {
                const auto index = build<WideBvh>(view, options, serial_executor());
                left = static_cast<double>(index.bytes());
            };
            const double ratio = static_cast<double>(most_bytes_of(build_it)) / left - 1;
            EXPECT_LE(ratio, 1.5) << name << " " << name_of(builder);
            EXPECT_GT(ratio, 0.1) << name << " " << name_of(builder);
            this->RecordProperty(std::string(name) + "-" + std::string(name_of(builder)),
                                 std::to_string(ratio));
        }
}

}  // namespace
#endif
