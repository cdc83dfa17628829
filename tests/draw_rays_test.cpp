/// Pictures of many rays, of beams and cones, and of where two sets are farthest: what they show is what the
/// library finds.
#include <cmath>
#include <regex>
#include <set>

#include <hedgerow/any_index.h>
#include <hedgerow/ask/hausdorff.h>
#include <hedgerow/io/image.h>
#include <hedgerow/scenes/generate.h>
#include <hedgerow/structures/brute_force.h>

#include "svg_elements.h"
#include "tool.h"

namespace {

using namespace hedgerow;
using DrawRays = ToolTest;

/// The hits of a fan of `n` rays over an angle in degrees, around the direction (1, 0), by brute force.
std::vector<Hit<float>> hits_of_fan(const SegmentSet<float>& set, const Vec2f& origin, int n, double angle) {
    std::vector<Ray2f> rays;
    for (int i = 0; i < n; ++i) {
        const double turn = (double(i) / (n - 1) - 0.5) * angle * 3.141592653589793 / 180;
        rays.push_back({origin, Vec2f(Vec2d(std::cos(turn), std::sin(turn)))});
    }
    std::vector<Hit<float>> hits(rays.size());
    closest_hits(*build_any("brute-force", set), rays, hits);
    return hits;
}
SegmentSet<float> segments(const std::string& spec) {
    return std::get<SegmentSet<float>>(generate<float>(parse_scene_spec(spec)));
}

TEST_F(DrawRays, AFanEndsWhereItsRaysHit) {
    const auto hits = hits_of_fan(segments("gen:segments2d:80"), {-0.1f, 0.5f}, 33, 70);
    std::size_t found = 0;
    for (const auto& h : hits) found += bool(h);
    ASSERT_GT(found, 10u);
    for (const std::string spec : {"grid", "kdtree:traversal_cost=1", "quadtree", "bvh", "bsp"}) {
        SCOPED_TRACE(spec);
        const auto r = run("draw gen:segments2d:80 --structure " + spec +
                           " --ray=-0.1,0.5,1,0 --fan 33 --angle 70 --json -o " + file("fan.svg"));
        ASSERT_EQ(r.code, 0) << r.output;
        const auto svg = bytes_of(file("fan.svg"));
        EXPECT_EQ(elements_with_class(svg, "stop"), found + 1) << "and one in the legend";
        EXPECT_EQ(elements_with_class(svg, "way gone"), hits.size() - found + 1);
        const std::size_t ended = elements_with_class(svg, "cell ended");
        EXPECT_GT(ended, 1u);
        EXPECT_LE(ended, found);
        EXPECT_NE(r.output.find("\"leaves_of_hits\": " + std::to_string(ended)), std::string::npos)
            << r.output;
    }
}

TEST_F(DrawRays, ABeamDividesIntoPartsThatSeeOneThing) {
    const int rays = 129;
    const auto hits = hits_of_fan(segments("gen:segments2d:20"), {-0.2f, 0.4f}, rays, 50);
    const auto r =
        run("draw gen:segments2d:20 --ray=-0.2,0.4,1,0 --fan 129 --angle 50 --beam -o " + file("beam.svg"));
    ASSERT_EQ(r.code, 0) << r.output;
    const auto svg = bytes_of(file("beam.svg"));
    const std::regex part("rays ([0-9]+) to ([0-9]+), halved ([0-9]+) times");
    std::size_t parts = 0, covered = 0;
    for (std::sregex_iterator m(svg.begin(), svg.end(), part), end; m != end; ++m, ++parts) {
        const std::size_t first = std::stoul((*m)[1]), last = std::stoul((*m)[2]);
        covered += last - first;
        EXPECT_LE(last - first, (std::size_t(rays - 1) >> std::stoul((*m)[3])));
        for (std::size_t i = first; i <= last; ++i) EXPECT_EQ(hits[i].element, hits[first].element) << i;
    }
    const std::size_t pairs = (elements_with_class(svg, "pair") - 2) / 2;  // two lines each, and the legend
    EXPECT_EQ(covered + pairs, std::size_t(rays - 1)) << "parts and pairs of rays are all of the beam";
    EXPECT_LT(parts + pairs, std::size_t(rays - 1) / 2);
}

TEST_F(DrawRays, AConesFootprintOnAPlaneIsAnEllipse) {
    // The axis falls by 0.5 to each 1 forward, from 1.25 above the cube's top.
    const auto r = run("draw gen:cube --ray=-2.5,0,2.25,1,0,-0.5 --cone 10 --size 160x120 --json -o " +
                       file("cone.png"));
    ASSERT_EQ(r.code, 0) << r.output;
    std::smatch found;
    ASSERT_TRUE(std::regex_search(
        r.output, found,
        std::regex("\"distance\": ([0-9.]+),\\s*\"footprint\": \\[\\s*([0-9.]+),\\s*([0-9.]+)")))
        << r.output;
    const double distance = 1.25 * std::sqrt(5.0),
                 wide = 2 * distance * std::tan(5 * 3.141592653589793 / 180);
    EXPECT_NEAR(std::stod(found[1]), distance, 1e-5);
    EXPECT_NEAR(std::stod(found[2]), wide * std::sqrt(5.0), 1e-4) << "longer by 1 over the sine of the slope";
    EXPECT_NEAR(std::stod(found[3]), wide, 1e-5);
    EXPECT_NE(r.output.find("\"rim_hits\": 240"), std::string::npos) << r.output;
    EXPECT_EQ(load_png(file("cone.png")).width, 160);
}

TEST_F(DrawRays, TwoMeshesAreFarthestWhereTheLibrarySays) {
    const auto fine = std::get<TriangleMesh<float>>(generate<float>(parse_scene_spec("gen:teapot:800"))),
               coarse = std::get<TriangleMesh<float>>(generate<float>(parse_scene_spec("gen:teapot:200")));
    const auto far = hausdorff_distance(build<BruteForce>(fine), build<BruteForce>(coarse));
    const auto r = run("draw gen:teapot:800 --hausdorff gen:teapot:200 --json -o " + file("far.svg"));
    ASSERT_EQ(r.code, 0) << r.output;
    const double lower = std::stod(r.output.substr(r.output.find("\"lower\": ") + 9));
    EXPECT_NEAR(lower, double(far.lower), 2e-3 * double(far.lower));
    const auto svg = bytes_of(file("far.svg"));
    EXPECT_GT(elements_with_class(svg, "line a"), 20u);
    EXPECT_GT(elements_with_class(svg, "line b"), 5u);
    EXPECT_EQ(elements_with_class(svg, "far"), 2u);
    // Flat clouds, too.
    EXPECT_EQ(run("draw gen:points2d:60 --quiet --hausdorff gen:points2d:40 -o " + file("p.svg")).code, 0);
    EXPECT_EQ(elements_with_class(bytes_of(file("p.svg")), "dot b"), 40u);
}

TEST_F(DrawRays, WhatHasNoSuchPictureIsRefused) {
    const std::string svg = " -o " + file("x.svg"), png = " -o " + file("x.png");
    expect_usage("draw gen:segments2d:9 --fan 9" + svg, "--fan requires --ray");
    expect_usage("draw gen:segments2d:9 --ray=0,0,1,0 --angle 9" + svg, "--angle requires --fan");
    expect_usage("draw gen:segments2d:9 --ray=0,0,1,0 --fan 9" + png, "is written as .svg");
    expect_bad("draw gen:teapot:200 --ray=9,0,1,-1,0,0 --fan 9 --beam" + svg, "flat scene of segments");
    expect_bad("draw gen:segments2d:9 --ray=0,0,1,0 --cone 9" + png, "is flat");
    expect_bad("draw gen:cube --ray=9,9,9,1,0,0 --cone 9" + png, "hits nothing");
    expect_bad("draw gen:cube --hausdorff gen:cube" + svg, "the same set");
    expect_bad("draw gen:cube --hausdorff gen:segments2d:9" + svg, "triangles or points in one space");
}

}  // namespace
