/// Distances to a few elements at once: the same bits by every instruction set, never below the true distance
/// and hardly above it.
#include <gtest/gtest.h>

#include <bit>

#include <hedgerow/engine/kernels.h>
#include <hedgerow/geometry/distance.h>
#include <hedgerow/scenes/random.h>

#include "engine.h"

using namespace hedgerow;

namespace {

Vec3d some_point(Random& random) {
    return {random.uniform(), random.uniform(), random.uniform()};
}
/// Triangles in the unit cube, some of them slivers or without area.
Triangle<double, 3> some_triangle(Random& random, int kind) {
    Triangle<double, 3> t{some_point(random), some_point(random), some_point(random)};
    if (kind == 1) t.c = t.a + (t.b - t.a) * 0.3 + some_point(random) * 0x1p-30;
    if (kind == 2) t.c = t.b;
    if (kind == 3) t.b = t.c = t.a;
    return t;
}
NearElements some_elements(Random& random, int count, double scale, bool points) {
    NearElements near = {};
    near.points = points;
    for (near.count = 0; near.count < count; ++near.count) {
        const int kind = points ? 3 : static_cast<int>(random.bits() % 16);
        const auto t = some_triangle(random, kind);
        near.set(near.count, {t.a * scale, t.b * scale, t.c * scale});
    }
    return near;
}

TEST(NearElements, EveryInstructionSetMeasuresAlike) {
    Random random(1);
    for (int round = 0; round < 4000; ++round) {
        const double scale = round % 5 == 0 ? 0x1p-180 : round % 5 == 1 ? 0x1p180 : 1;
        const DistanceMargin margin{0x1p-48, 0x1p-45 * scale};
        const NearElements near =
            some_elements(random, 1 + round % NearElements::most, scale, round % 7 == 0);
        const Vec3d points[3] = {some_point(random) * (2 * scale), near.triangle(0).b,
                                 near.triangle(0).a * 0.25 + near.triangle(0).c * 0.75};
        ToElements want[3];
        for (const auto name : instruction_sets()) {
            SCOPED_TRACE(name);
            const Using use(name);
            const ElementKernels& kernels = element_kernels();
            NearElements prepared = near;
            ToElements found[3];
            kernels.prepare(prepared);
            kernels.measure(prepared, margin, points, 3, found);
            for (int n = 0; n < 3; ++n) {
                if (name == instruction_sets().front()) want[n] = found[n];
                ASSERT_EQ(found[n].nearest, want[n].nearest);
                for (int i = 0; i < NearElements::most; ++i)
                    ASSERT_EQ(std::bit_cast<std::uint64_t>(found[n].distance[i]),
                              std::bit_cast<std::uint64_t>(want[n].distance[i]));
            }
        }
        // Compare with the distance of one point and one triangle.
        for (int n = 0; n < 3; ++n) {
            double least = std::numeric_limits<double>::infinity();
            for (int i = 0; i < near.count; ++i) {
                const double distance = std::sqrt(closest_point(points[n], near.triangle(i)).distance2),
                             found = want[n].distance[i];
                ASSERT_GE(found, distance) << i;
                ASSERT_LE(found, distance + margin.absolute + scale * 0x1p-20) << i;
                least = std::min(least, found);
            }
            ASSERT_EQ(want[n].least(), least);
            for (int i = 0; i < want[n].nearest; ++i) ASSERT_GT(want[n].distance[i], least);
            for (int i = near.count; i < NearElements::most; ++i)
                ASSERT_EQ(want[n].distance[i], std::numeric_limits<double>::infinity());
        }
    }
}

}  // namespace
