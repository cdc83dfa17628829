/// What the hunter has found, each as the test that failed then.
#include <cmath>

#include <gtest/gtest.h>

#include "hunter/answers.h"

using namespace hedgerow;
using namespace hedgerow::hunter;

namespace {

/// A ray from so far away that its error spans the whole grid visited all cells again from each cell on its
/// way.
TEST(Found, RaysFromFarAwayVisitACellOfAGridOnce) {
    std::vector<Sphere<float, 3>> shapes;
    for (int i = 0; i < 8; ++i) shapes.push_back({{float(i & 1), float(i >> 1 & 1), float(i >> 2)}, 0.1f});
    const auto set = set_of(shapes);
    const Ray3f ray{{-1e12f, -1e12f, -1e12f}, {1, 1, 1}};
    for (const char* spec : {"grid:resolution=20,skip_empty=off", "grid:resolution=20"}) {
        const auto grid = build_any(spec, set);
        Hit<float> hit;
        Visits visits;
        grid->closest_hits({&ray, 1}, {&hit, 1}, {&visits, 1});
        EXPECT_LE(visits.nodes, 20u * 20 * 20) << spec;
        EXPECT_GE(visits.nodes, 8u) << spec;
    }
    EXPECT_TRUE(as_brute_force("grid:resolution=20", shapes, ray));
}

}  // namespace
