/// Faults that the hunter has found, each as the test that failed then.
#include <cmath>

#include <gtest/gtest.h>

#include "hunter/answers.h"
#include "hunter/oracle.h"
#include "hunter/pairs.h"

using namespace hedgerow;
using namespace hedgerow::hunter;

namespace {

/// A ray that starts so far away that its error spans the whole grid once visited all cells again from each
/// cell on its way.
TEST(Found, RaysFromFarAwayVisitACellOfAGridOnce) {
    std::vector<Sphere<float, 3>> shapes;
    shapes.reserve(8);
    for (int i = 0; i < 8; ++i) shapes.push_back({{float(i & 1), float(i >> 1 & 1), float(i >> 2)}, 0.1f});
    const auto set = set_of(shapes);
    const Ray3f ray{{-1e12f, -1e12f, -1e12f}, {1, 1, 1}};
    for (const char* spec : {"grid:resolution=20,skip_empty=off", "grid:resolution=20"}) {
        const auto grid = build_any(spec, set);
        Hit<float> hit;
        Visits visits;
        closest_hits(*grid, {&ray, 1}, {&hit, 1}, {}, KeepAll(), std::span(&visits, 1));
        EXPECT_LE(visits.nodes, 20u * 20 * 20) << spec;
        EXPECT_GE(visits.nodes, 8u) << spec;
    }
    EXPECT_TRUE(as_brute_force("grid:resolution=20", shapes, ray));
}

// ---- An oriented box around a needle, whose axes were not at right angles

TEST(Found, Round1120270x13273) {
    const std::vector<Triangle<double, 3>> shapes = {
        {{-0x1.999999999999ap+0, -0x1.8p+0, -0x1.6666666666666p-1},
         {-0x1.9999999999994p+0, -0x1.8000000000002p+0, -0x1.6666666666669p-1},
         {-0x1.995fffffffffap+0, -0x1.7fa0000000002p+0, -0x1.66e6666666669p-1}},
        {{0, 0, 0}, {0, 0, 0}, {-2, -0x1.6p+0, -1}},
    };
    const Vec<double, 3> question = {-0x1.cp+0, -0x1.6p+0, -1};
    EXPECT_TRUE(as_brute_force("bvh:volume=obb,overlap=0.1,intersection_cost=4", shapes, question));
}

// ---- Box overlaps, from the time before they were exact (docs/design/013-exact-overlaps.md)

TEST(Found, Round1x7) {
    const std::vector<Triangle<double, 3>> shapes = {
        {{0, 0, -0x1.6e1f9b5e323a9p-22},
         {0, 0x1p-19, -0x1.6e1f9b5e323a8p-22},
         {-0x1.666666p-22, 0, -0x1.6e1f9b5e323a8p-22}},
    };
    const Ray<double, 3> question = {{0, 0x1.54ae24p-20, -0x1.6e1f9b5e323a6p-22}, {0, 0, -0x1.8p-73}, 0, 1};
    EXPECT_TRUE(as_brute_force("grid:resolution=33,skip_empty=on", shapes, question));
}
TEST(Found, Round1x7InATwoLevelGrid) {
    const std::vector<Triangle<double, 3>> shapes = {
        {{0x1.333334p-22, 0, -0x1.6e1f9b5e323a9p-22},
         {0x1p-21, 0x1p-19, -0x1.6e1f9b5e323a8p-22},
         {-0x1.666666p-22, 0x1.8p-20, -0x1.6e1f9b5e323a8p-22}},
        {{0, 0, 0}, {0, 0x1p-20, -0x1.6e1f9cp-22}, {0, 0, 0}},
    };
    const Ray<double, 3> question = {
        {0x1.7dfdfp-22, 0x1.54ae24p-20, -0x1.6e1f9b5e323a6p-22}, {0, 0, -0x1.8p-73}, 0, 1};
    EXPECT_TRUE(as_brute_force("two-level-grid", shapes, question));
}
TEST(Found, Round1x7ByExactArithmetic) {
    const std::vector<Triangle<double, 3>> shapes = {
        {{0x1.3333333333335p-22, -0x1p-21, -0x1.6e1f9b5e323a9p-22},
         {0x1.0000000000001p-21, 0x1p-19, -0x1.6e1f9b5e323a8p-22},
         {-0x1.6666666666666p-22, 0x1.8p-20, -0x1.6e1f9b5e323a8p-22}},
    };
    const Box<double, 3> question = {{0x1.33598p-23, 0x1p-20, -0x1.6e1f9b5e323a9p-22},
                                     {0x1.ccccccccccccep-22, 0x1.0007f4p-20, -0x1.6e1f9b5e323a6p-22}};
    EXPECT_TRUE(is_exact(shapes[0], question));
}
TEST(Found, Round1x1) {
    const std::vector<Sphere<double, 3>> shapes = {
        {{0, -0x1.999999999999bp-2, -0x1.a7769b69feb6p+152}, 0x1.a7769b69feb6p+152},
    };
    const Box<double, 3> question = {{-0x1.2c1999999999bp+8, 0x1.cccccccccccccp-1, -0x1.47ea5ea76cc84p-360},
                                     {0x1.999999999999bp-4, 0x1.5e26666666664p+9, 0x1.cfd5efc46b1dp+335}};
    EXPECT_TRUE(is_exact(shapes[0], question));
}

// ---- Triangles in double that are 10^300 times as long as wide: products underflowed in the exact pass

TEST(Found, Round99x621) {
    const std::vector<Triangle<double, 3>> shapes = {
        {{0, 0, 0}, {0, 0x0.0000000000001p-1022, 0}, {0, 0, -3}},
    };
    const Ray<double, 3> question = {{0, 0, -0x1.bp+1}, {1, 0, 0}, 0, INFINITY};
    EXPECT_TRUE(as_brute_force("grid:resolution=33,skip_empty=on", shapes, question));
    EXPECT_TRUE(as_brute_force("bsp:max_depth=4,intersection_cost=20", shapes, question));
    EXPECT_TRUE(is_exact(shapes[0], question));
}
TEST(Found, Round99x621ByExactArithmetic) {
    const Triangle<double, 3> shape = {{-4, 0x0.0000000000002p-1022, -4},
                                       {1, 0, 4},
                                       {0x1.0000000000004p+0, 0x0.0000000000001p-1022, 0x1.ffffffffffffp+1}};
    const Ray<double, 3> question = {{0x1.fa34f0cbe4a2p-1, 0x0.0000000000001p-1022, 0x1.428df34673008p+1},
                                     {0, 0, 0x1.7ae4197319ff4p+0},
                                     0,
                                     INFINITY};
    EXPECT_TRUE(is_exact(shape, question));
}

/// The oracle was wrong: the hit's t is beyond the largest double.
TEST(Found, Round4711x4975) {
    const Triangle<double, 3> shape = {{-0x1p+24, 0x1.42d373ac61c9fp+23, 0x1.dcdb56e384443p+20},
                                       {0x1p+42, 0x1.42d373ac61c9fp+23, -0x1.2937cf873251p+23},
                                       {-0x1p+25, -0x1.cde1f04944752p+23, 0x1.fdb5b5cd917d2p+23}};
    const Ray<double, 3> question = {
        {0x1.6ddb9da469d87p+36, -0x1.a1ed9a6631d08p+20, 0x1.073823badb993p+23},
        {-0x1.6d5b9da469d87p-1005, 0x1.771126f92803dp-1018, 0x1.ecfb24256bc8p-1019},
        0,
        INFINITY};
    EXPECT_TRUE(is_exact(shape, question));
}

/// Planes that have no point in common, though any three of those that meet the ball do.
TEST(Found, ABallOverlapsNoRegionWithoutPoints) {
    const std::vector<Sphere<double, 3>> shapes = {{{86, 86, 159}, 79}};
    const RegionThrough<double, 3> question = {
        RegionKind::frustum,
        {92, 89, 159},
        {0x1.3e23138b636eep+7, 0x1.5629df12a9c7bp+6, 0x1.3e23138b636edp+7},
        {0x1.3e23138b636eep+7, 0x1.5629df12a9c7ap+6, 0x1.3e23138b636efp+7},
        0};
    EXPECT_TRUE(as_brute_force("grid", shapes, question));
    with_region(question, [&](const auto& region) { EXPECT_FALSE(overlap(shapes[0], region)); });
    // In the plane three lines have no point in common, though any two do.
    const HalfSpace<float, 2> lines[] = {{{1, 0}, 0}, {{0, 1}, 0}, {{-1, -1}, -1}};
    EXPECT_FALSE(overlap(Sphere<float, 2>{{0.25f, 0.25f}, 2}, Hull<float, 2>{lines}));
    const HalfSpace<float, 2> through_a_point[] = {{{1, 0}, 0}, {{0, 1}, 0}, {{-1, -1}, 0}};
    EXPECT_TRUE(overlap(Sphere<float, 2>{{0.25f, 0.25f}, 2}, Hull<float, 2>{through_a_point}));
}

/// The sides of an axis on which edges lie were told by roundings, of a triangle small beside its distance
/// from the apex.
TEST(Found, AThinConeFromFarAwayDoesNotMeetASmallTriangleFarFromItsAxis) {
    const std::vector<Triangle<double, 3>> shapes = {
        {{0, 0, 0}, {0, 0, 0}, {0, 0, 0}},
        {{0, 0, 0}, {0, 1, 0}, {0, 0x1.0a140053ecp+38, 0}},
        {{0, 0, 0}, {0, 0, 0}, {0, 0, 0}},
    };
    const RegionThrough<double, 3> question = {RegionKind::cone,
                                               {-0x1.8902487123de2p+394, 0, -0x1.d31c2ba866bp+318},
                                               {0, -0x1.235f750325a1p+421, 0},
                                               {0, 0, 0},
                                               0};
    EXPECT_TRUE(as_brute_force("bvh:max_leaf_size=2", shapes, question));
}

/// A triangle without area in a plane with the axis of a cone: the sides of its edges are roundings.
TEST(Found, AThinConeDoesNotMeetASegmentBesideItInAPlane) {
    const std::vector<Triangle<double, 3>> shapes = {
        {{-0x1.1a166f7ee197p-4, -0x1.b6051d05926a7p-1, -0x1.b6051d05926a6p-1},
         {1, -0x1.4e92cae539e7cp+0, -0x1.b6051d05926a6p-1},
         {-0x1.1a166f7ee197p-4, -0x1.b6051d05926a7p-1, -0x1.b6051d05926a6p-1}},
    };
    const RegionThrough<double, 3> question = {
        RegionKind::cone,
        {-0x1.1a166f7ee196p-4, -0x1.4e3ff5787bd3ep+0, -0x1.4e92cap+0},
        {-0x1.1a166f7ee197p-4, -0x1.b6051d05926a7p-1, -0x1.b6051d05926a6p-1},
        {0, -1, -0x1.b6p-1},
        0};
    EXPECT_TRUE(as_brute_force("grid", shapes, question));
    with_region(question, [&](const auto& region) { EXPECT_FALSE(overlap(shapes[0], region)); });
}

// ---- The farthest point of a sphere from a point whose offset from its centre is a subnormal number

TEST(Found, Round978562x1009) {
    const std::vector<Sphere<double, 3>> shapes = {
        {{2, 0, 0x1.47aadbee8c568p-2}, 1},
    };
    const Vec<double, 3> question = {2, -0x0.0000000000001p-1022, 0x1.47aadbee8c568p-2};
    EXPECT_TRUE(as_brute_force("brute-force", shapes, question));
}

// ---- Pairs of triangles whose coordinates differ by 600 powers of two

TEST(Found, Round1978562x1399) {
    const std::vector<Triangle<double, 3>> one = {
        {{0x1p+225, -0x1.037402c60bcf2p+279, -0x1.43673e11cdf56p+173},
         {0, 0, 0x1.f5e03af850239p+191},
         {2, 0, -0x1.6b213e3e11062p-219}},
    };
    const std::vector<Triangle<double, 3>> two = {
        {{-2, 0, 0x1.0bd6e9a3bfffp+351},
         {0, 0x1p-197, 0x1.e70195abd1ccep-144},
         {-0x1.8000000000001p+1, 0, 0x1.8256b228343d8p-85}},
        {{-0x1p+156, -0x1.366d23a97a81cp+210, 0},
         {-1, 0x1.924fdf96cc7cdp+366, 0},
         {0, 0x1.924fdf96cc7c6p+366, -0x1.8faaa497513d8p-331}},
        {{4, 0, 0}, {4, -0x1.abfb3a2c4a4a4p+324, 0}, {-1, 0x1.1ebb8c0a3518p-7, 0x1.d5dbfe66bc2dep+374}},
    };
    EXPECT_TRUE((pairs_as_all_pairs<Bvh, Bvh>(one, two, 0x1.07191e1e75b71p+452)));
}

}  // namespace
