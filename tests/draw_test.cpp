/// Pictures that `draw` writes are well formed and have every cell, and its tables agree with the library's
/// traces.
#include <algorithm>
#include <regex>
#include <set>
#include <string>
#include <vector>

#include <hedgerow/any_index.h>
#include <hedgerow/io/image.h>
#include <hedgerow/scenes/generate.h>

#include "structure_names.h"
#include "svg_elements.h"
#include "tool.h"

namespace {

using namespace hedgerow;
using Draw = ToolTest;

std::size_t cells_of(const std::string& scene, const std::string& spec) {
    return std::visit([&](const auto& set) { return build_any(spec, set)->outline().size(); },
                      generate<float>(parse_scene_spec(scene)));
}

TEST_F(Draw, FlatScenesShowEveryCell) {
    for (const char* scene : {"gen:clusters2d:120", "gen:segments2d:80"})
        for (const std::string& spec : structures_for<SegmentSet<float>>()) {
            SCOPED_TRACE(std::string(scene) + " " + spec);
            const auto r =
                run(std::string("draw ") + scene + " --structure " + spec + " -o " + file("cells.svg"));
            ASSERT_EQ(r.code, 0) << r.output;
            const auto svg = bytes_of(file("cells.svg"));
            EXPECT_EQ(elements_with_class(svg, "cell"), cells_of(scene, spec));
            const auto primitives = elements_with_class(svg, "dot") + elements_with_class(svg, "line");
            EXPECT_EQ(primitives, std::string(scene).find("clusters") != std::string::npos ? 120u : 80u);
        }
}

TEST_F(Draw, SlicesShowWhatThePlaneCuts) {
    for (const std::string& spec : structures_for<TriangleMesh<float>>()) {
        SCOPED_TRACE(spec);
        const auto r = run(std::string("draw gen:teapot:300 --slice z=0.4 --structure ") + spec + " -o " +
                           file("slice.svg"));
        ASSERT_EQ(r.code, 0) << r.output;
        const auto svg = bytes_of(file("slice.svg"));
        const auto set = std::get<TriangleMesh<float>>(generate<float>(parse_scene_spec("gen:teapot:300")));
        const auto index = build_any(spec, set);
        const double low = static_cast<double>(index->bounds().low[2]);
        // Count the cells and triangles that the plane cuts.
        const double z = low + 0.4 * (static_cast<double>(index->bounds().high[2]) - low);
        OutlineLimits<3> limits;
        limits.within.low[2] = limits.within.high[2] = z;
        std::size_t cut = 0, crossed = 0;
        for (const auto& c : index->outline(limits)) cut += c.box.low[2] < z && z < c.box.high[2];
        for (std::size_t i = 0; i < set.size(); ++i) {
            const auto b = set.view().bounds(i);
            crossed += static_cast<double>(b.low[2]) < z && z < static_cast<double>(b.high[2]);
        }
        EXPECT_EQ(elements_with_class(svg, "cell"), cut);
        EXPECT_EQ(elements_with_class(svg, "line"), crossed);
    }
    // The position @0.5 in the cube from -1 to 1 makes the same slice as the fraction 0.75.
    ASSERT_EQ(run("draw gen:cube:300 --quiet --slice x=0.75 -o " + file("a.svg")).code, 0);
    ASSERT_EQ(run("draw gen:cube:300 --quiet --slice x=@0.5 -o " + file("b.svg")).code, 0);
    EXPECT_EQ(elements_with_class(bytes_of(file("a.svg")), "cell"),
              elements_with_class(bytes_of(file("b.svg")), "cell"));
}

TEST_F(Draw, DepthLimitsTheLevels) {
    const auto cells = [&](const std::string& depth) {
        EXPECT_EQ(
            run("draw gen:points2d:200 --quiet --structure kdtree --depth " + depth + " -o " + file("d.svg"))
                .code,
            0);
        return elements_with_class(bytes_of(file("d.svg")), "cell");
    };
    EXPECT_EQ(cells("1"), 1u);
    EXPECT_EQ(cells("3"), 7u);
    EXPECT_LT(cells("4"), cells("0"));
}

TEST_F(Draw, TwoBuildersShowWhatSiblingsShare) {
    const auto r = run("draw gen:segments2d:200 --json --structure bvh:builder=midpoint --beside kdtree -o " +
                       file("two.svg"));
    ASSERT_EQ(r.code, 0) << r.output;
    const auto svg = bytes_of(file("two.svg"));
    EXPECT_EQ(elements_with_class(svg, "cell"), cells_of("gen:segments2d:200", "bvh:builder=midpoint") +
                                                    cells_of("gen:segments2d:200", "kdtree"));
    EXPECT_GT(elements_with_class(svg, "shared"), 1u);
    EXPECT_NE(r.output.find("\"sibling_overlap\": 0.0"), std::string::npos)
        << "a partition's siblings share nothing";
}

TEST_F(Draw, ARaysTableIsItsTrace) {
    const std::string ray = " --ray=-0.2,0.31,1,0.35";
    for (const std::string& spec : structures_for<SegmentSet<float>>()) {
        SCOPED_TRACE(spec);
        const auto set = std::get<SegmentSet<float>>(generate<float>(parse_scene_spec("gen:segments2d:80")));
        const auto walked = trace(*build_any(spec, set), Ray2f{{-0.2f, 0.31f}, {1, 0.35f}});
        const auto r = run("draw gen:segments2d:80 --structure " + spec + ray + " -o " + file("ray.svg"));
        ASSERT_EQ(r.code, 0) << r.output;
        // The picture has a cell for each step of the trace, and the table a line.
        EXPECT_EQ(elements_with_class(bytes_of(file("ray.svg")), "cell visited"), walked.steps.size());
        EXPECT_EQ(static_cast<std::size_t>(std::count(r.output.begin(), r.output.end(), '\n')),
                  walked.steps.size() + 2)
            << "a head, a line a step, and the sum";
        ASSERT_TRUE(walked.hit);
        EXPECT_NE(r.output.find("hits primitive " + std::to_string(walked.hit.element)), std::string::npos);
        // The JSON has the counts of the trace.
        const auto json =
            run("draw gen:segments2d:80 --json --structure " + spec + ray + " -o " + file("ray.svg"));
        EXPECT_NE(json.output.find("\"primitives\": " + std::to_string(walked.visits.primitives)),
                  std::string::npos);
    }
    // A page shows the steps one by one.
    ASSERT_EQ(run("draw gen:segments2d:80 --quiet --frames" + ray + " -o " + file("ray.html")).code, 0);
    auto page = bytes_of(file("ray.html"));
    const auto begin = page.find("<svg"), end = page.find("</svg>") + 6;
    ASSERT_LT(begin, end);
    EXPECT_GT(elements_with_class(page.substr(begin, end - begin), "step"), 2u);
    // A ray in space is drawn too.
    const auto space =
        run("draw gen:teapot:400 --structure octree --ray=-5,0.1,1,1,0,0.05 -o " + file("space.svg"));
    EXPECT_EQ(space.code, 0) << space.output;
    EXPECT_GT(elements_with_class(bytes_of(file("space.svg")), "cell visited"), 3u);
}

TEST_F(Draw, NumbersOfStepsDoNotCollide) {
    for (const char* scene : {"gen:segments2d:60", "gen:segments2d:400"})
        for (const char* spec : {"quadtree:leaf_size=2", "kdtree:traversal_cost=1", "grid", "bvh"}) {
            SCOPED_TRACE(std::string(scene) + " " + spec);
            ASSERT_EQ(run(std::string("draw ") + scene + " --quiet --structure " + spec +
                          " --ray=-0.1,0.3,1,0.3 --size 720x560 -o " + file("ray.svg"))
                          .code,
                      0);
            const auto svg = bytes_of(file("ray.svg"));
            const auto labels = rectangles_with_class(svg, "badge");
            EXPECT_GT(labels.size(), 3u);
            for (std::size_t i = 0; i < labels.size(); ++i) {
                EXPECT_TRUE(labels[i].low[0] >= 0 && labels[i].high[0] <= 720 && labels[i].low[1] >= 0 &&
                            labels[i].high[1] <= 560);
                for (std::size_t k = 0; k < i; ++k)
                    EXPECT_FALSE(overlap(labels[i], labels[k])) << "labels " << k << " and " << i;
            }
            for (const char* entry : {"visited, first to last", "tested, missed", "tested, met", "the hit"})
                EXPECT_NE(svg.find(entry), svg.npos) << "the legend lacks: " << entry;
        }
}

TEST_F(Draw, ARayIsDrawnInSeveralStructuresSideBySide) {
    const std::vector<std::string> specs = {"grid", "kdtree", "quadtree", "bsp"};
    const auto set = std::get<SegmentSet<float>>(generate<float>(parse_scene_spec("gen:segments2d:60")));
    std::size_t steps = 0;
    for (const auto& spec : specs)
        steps += trace(*build_any(spec, set), Ray2f{{-0.2f, 0.31f}, {1, 0.35f}}).steps.size();
    const auto r =
        run("draw gen:segments2d:60 --json --ray=-0.2,0.31,1,0.35 --structure grid --beside kdtree "
            "--beside quadtree --beside bsp -o " +
            file("four.svg"));
    ASSERT_EQ(r.code, 0) << r.output;
    EXPECT_EQ(elements_with_class(bytes_of(file("four.svg")), "cell visited"), steps);
    for (const auto& spec : specs) EXPECT_NE(r.output.find("\"structure\": \"" + spec + "\""), r.output.npos);
}

TEST_F(Draw, FourStructuresStandInOnePicture) {
    const std::string four = " --quiet --structure grid --beside kdtree --beside octree --beside bsp ";
    ASSERT_EQ(run("draw gen:cube:48 --slice z=0.5" + four + "-o " + file("four.svg")).code, 0);
    for (const char* name : {">grid<", ">kdtree<", ">octree<", ">bsp<"})
        EXPECT_NE(bytes_of(file("four.svg")).find(name), std::string::npos) << name;
    ASSERT_EQ(run("draw gen:cube:300" + four + "--size 204x154 -o " + file("four.png")).code, 0);
    EXPECT_EQ(load_png(file("four.png")).width, 204);
    EXPECT_EQ(load_png(file("four.png")).height, 154);
}

TEST_F(Draw, ATreeStandsBesideItsCells) {
    for (const char* spec : {"kdtree", "quadtree:leaf_size=3", "bsp", "bvh", "wide"}) {
        SCOPED_TRACE(spec);
        const std::string what = "draw gen:segments2d:30 --quiet --structure " + std::string(spec);
        ASSERT_EQ(run(what + " --tree -o " + file("tree.svg")).code, 0);
        const auto svg = bytes_of(file("tree.svg"));
        const auto cells = cells_of("gen:segments2d:30", spec);
        EXPECT_EQ(elements_with_class(svg, "cell"), cells);
        EXPECT_EQ(elements_with_class(svg, "node") - elements_with_class(svg, "nodeid"), cells);
        EXPECT_EQ(elements_with_class(svg, "link"), cells - 1);
        // The page highlights the node of each step.
        ASSERT_EQ(run(what + " --ray=-0.1,0.3,1,0.3 --frames -o " + file("ray.html")).code, 0);
        const auto page = bytes_of(file("ray.html"));
        const auto begin = page.find("<svg"), end = page.find("</svg>") + 6;
        const auto frames = page.substr(begin, end - begin);
        const auto steps = elements_with_class(frames, "step");
        EXPECT_EQ(elements_with_class(frames, "interval"), steps);
        EXPECT_EQ(elements_with_class(frames, "node") - elements_with_class(frames, "node off") -
                      elements_with_class(frames, "nodeid"),
                  steps);
    }
    expect_bad("draw gen:segments2d:30 --structure grid --tree -o " + file("x.svg"), "no tree");
    expect_usage("draw gen:cube --tree -o " + file("x.png"), "--slice");
}

TEST_F(Draw, EmptyCellsOfAGridAreMarkedAsPruned) {
    ASSERT_EQ(run("draw gen:segments2d:60 --quiet --structure grid -o " + file("grid.svg")).code, 0);
    const auto set = std::get<SegmentSet<float>>(generate<float>(parse_scene_spec("gen:segments2d:60")));
    std::size_t empty = 0;
    for (const auto& c : build_any("grid", set)->outline()) empty += c.items.empty();
    EXPECT_EQ(elements_with_class(bytes_of(file("grid.svg")), "cell leaf void"), empty);
    EXPECT_NE(bytes_of(file("grid.svg")).find("empty: " + std::to_string(empty) + ", pruned"),
              std::string::npos);
}

TEST_F(Draw, StoppingAtTheFirstHitShowsTheWrongOne) {
    const std::string what =
        "draw gen:segments2d:24 --seed 1 --structure grid:resolution=4 --ray=-0.1,0.3,1,0.1 --json ";
    const auto right = run(what + "-o " + file("ray.svg"));
    const auto wrong = run(what + "--stop-at-first -o " + file("ray.svg"));
    ASSERT_EQ(wrong.code, 0) << wrong.output;
    const auto nearest = right.output.substr(right.output.find("\"hit\""), 60);
    EXPECT_NE(wrong.output.substr(wrong.output.find("\"hit\""), 60), nearest);
    EXPECT_NE(bytes_of(file("ray.svg")).find("WRONG"), std::string::npos);
    EXPECT_EQ(elements_with_class(bytes_of(file("ray.svg")), "nearest"), 1u);
}

/// A numeric attribute of the k-th element, from 0, that has `text` in it.
double attribute(const std::string& xml, const std::string& text, std::size_t k, const std::string& name) {
    std::size_t at = xml.find(text);
    for (; k > 0; --k) at = xml.find(text, at + 1);
    const std::size_t begin = xml.rfind('<', at);
    const std::size_t value = xml.find(" " + name + "=\"", begin) + name.size() + 3;
    return std::stod(xml.substr(value));
}
TEST_F(Draw, EachStructureShowsItsOwnFirstHit) {
    const auto r = run(
        "draw gen:segments2d:24 --seed 1 --structure kdtree --beside grid:resolution=4 --ray=-0.1,0.3,1,0.1 "
        "--stop-at-first --json -o " +
        file("ray.svg"));
    ASSERT_EQ(r.code, 0) << r.output;
    const auto t = [&](std::size_t k) {
        std::size_t at = r.output.find("\"hit\": {");
        for (; k > 0; --k) at = r.output.find("\"hit\": {", at + 1);
        return std::stod(r.output.substr(r.output.find("\"t\": ", at) + 5));
    };
    ASSERT_LT(t(0), t(1)) << "the second one lies farther";
    const auto svg = bytes_of(file("ray.svg"));
    double lengths[2];
    for (std::size_t k = 0; k < 2; ++k) {
        const double from = attribute(svg, "class=\"origin\"", k, "cx");
        lengths[k] = attribute(svg, "class=\"hit\"", k, "cx") - from;
        EXPECT_NEAR(attribute(svg, "marker-end", k, "x2") - from, lengths[k], 0.02) << "where the ray ends";
    }
    EXPECT_NEAR(lengths[1] / lengths[0], t(1) / t(0), 0.01);
}
TEST_F(Draw, AnEquallyNearHitIsNotWrong) {
    // The ray hits both triangles at their common edge. The second one slopes towards the ray's origin, the
    // first one away from it.
    std::ofstream(file("edge.obj")) << "v -1 0 0\nv 1 0 0\nv 0 1 -1\nv 0 -1 1\nf 1 2 3\nf 2 1 4\n";
    for (const char* structure : {"bvh:max_leaf_size=1", "brute-force"}) {
        const auto r = run("draw " + file("edge.obj") + " --structure " + structure +
                           " --ray=0,0,5,0,0,-1 --stop-at-first -o " + file("ray.svg"));
        ASSERT_EQ(r.code, 0) << r.output;
        EXPECT_EQ(r.output.find("WRONG"), std::string::npos) << r.output;
        EXPECT_EQ(elements_with_class(bytes_of(file("ray.svg")), "nearest"), 0u);
    }
}

TEST_F(Draw, HeightShowsATreeFromItsLeaves) {
    const auto cells = [&](const std::string& more) {
        EXPECT_EQ(
            run("draw gen:segments2d:16 --quiet --structure bvh:builder=agglomerative,max_leaf_size=1 " +
                more + " -o " + file("h.svg"))
                .code,
            0);
        return elements_with_class(bytes_of(file("h.svg")), "cell");
    };
    EXPECT_EQ(cells("--height 0"), 16u) << "the leaves";
    EXPECT_LT(cells("--height 1"), cells("--height 2"));
    EXPECT_EQ(cells("--height 20"), 31u);
    EXPECT_EQ(cells("--height 0 --depth 2"), 0u) << "the children of the root have cells below them";
    EXPECT_EQ(cells("--height 20 --depth 2"), 3u);

    // In a slice, heights are counted in the whole tree.
    ASSERT_EQ(
        run("draw gen:teapot:300 --quiet --structure bvh --slice z=0.4 --height 0 -o " + file("s.svg")).code,
        0);
    const auto slice = bytes_of(file("s.svg"));
    EXPECT_GT(elements_with_class(slice, "cell"), 0u);
    EXPECT_EQ(elements_with_class(slice, "cell"), elements_with_class(slice, "cell leaf"));
}

TEST_F(Draw, ASliceOfManyTrianglesMakesASmallFile) {
    ASSERT_EQ(run("draw gen:terrain:200k --quiet --structure bvh --slice z=0.5 -o " + file("s.svg")).code, 0);
    const auto svg = bytes_of(file("s.svg"));
    EXPECT_LT(svg.size(), 400'000u);
    EXPECT_GT(elements_with_class(svg, "cell"), 3u);
    EXPECT_GT(elements_with_class(svg, "line"), 0u);
}

TEST_F(Draw, BoxesAreDrawnOverAPictureOfTheMesh) {
    std::vector<Image> pictures;
    for (const char* depth : {"1", "2", "5"}) {
        const auto r =
            run("draw gen:teapot:500 --size 160x120 --depth " + std::string(depth) + " -o " + file("b.png"));
        ASSERT_EQ(r.code, 0) << r.output;
        pictures.push_back(load_png(file("b.png")));
    }
    const auto differing = [](const Image& a, const Image& b) {
        std::size_t n = 0;
        for (std::size_t i = 0; i < a.pixels.size(); ++i) n += a.pixels[i] != b.pixels[i];
        return n;
    };
    // Deeper levels draw more boxes.
    EXPECT_GT(differing(pictures[0], pictures[1]), 100u);
    EXPECT_GT(differing(pictures[0], pictures[2]), differing(pictures[0], pictures[1]));
    // Points are drawn in two structures side by side.
    ASSERT_EQ(
        run("draw gen:points:300 --quiet --size 160x120 --structure octree --beside bsp -o " + file("b.png"))
            .code,
        0);
    EXPECT_EQ(load_png(file("b.png")).width, 160);
    const auto r = run("draw gen:cube --json --size 64x48 --depth 1 -o " + file("b.png"));
    EXPECT_NE(r.output.find("\"cells_drawn\": 1"), std::string::npos) << r.output;
}

/// Heat maps with the same scale have the same bar, whatever they show.
TEST_F(Draw, HeatMapsCompareByAFixedScale) {
    const auto map = [&](const std::string& more) {
        const auto r = run("draw gen:teapot:500 --size 320x240 " + more + " -o " + file("h.png"));
        EXPECT_EQ(r.code, 0) << r.output;
        return load_png(file("h.png"));
    };
    const auto bar = [](const Image& i) {
        std::vector<Image::Pixel> strip;
        for (int y = i.height / 5; y < i.height; ++y)  // below the title
            for (int x = i.width - 8; x < i.width; ++x) strip.push_back(i.at(x, y));
        return strip;
    };
    const auto one = map("--heat tests"), other = map("--heat tests --structure bvh:max_leaf_size=1"),
               wider = map("--heat tests --scale 1000");
    EXPECT_EQ(bar(one), bar(other));
    EXPECT_NE(one, other);
    EXPECT_NE(bar(one), bar(wider));
    // A long title does not overlap the bar.
    const auto right = [](const Image& i) {
        std::vector<Image::Pixel> strip;
        for (int y = i.height / 8; y < i.height / 3; ++y)
            for (int x = i.width - 16; x < i.width; ++x) strip.push_back(i.at(x, y));
        return strip;
    };
    EXPECT_EQ(
        right(map("--heat tests --structure bvh:traversal_cost=2.00,intersection_cost=1.0,builder=binned")),
        right(one));
    EXPECT_NE(bar(map("--heat tests --log")), bar(one)) << "other labels";
    EXPECT_NE(map("--heat tests --log"), one);
    // A logarithmic scale ends at the most that a ray has.
    const auto logarithmic =
        run("draw gen:teapot:500 --size 64x48 --heat tests --structure brute-force --log --json -o " +
            file("h.png"));
    EXPECT_NE(logarithmic.output.find("\"scale\": 496,"), std::string::npos) << logarithmic.output;
    EXPECT_NE(logarithmic.output.find("\"share_beyond_scale\": 0.0"), std::string::npos)
        << logarithmic.output;
    EXPECT_EQ(map("--heat steps --scale 100").width, 320);
    EXPECT_EQ(map("--heat time").width, 320);
    EXPECT_NE(run("draw gen:teapot:500 --size 64x48 --heat tests --scale 1 --json -o " + file("h.png"))
                  .output.find("\"share_beyond_scale\""),
              std::string::npos);
    const auto named = run("draw gen:teapot:500 --size 64x48 --heat tests --json -o " + file("h\xff.png"));
    EXPECT_EQ(named.code, 0) << "whatever bytes a name has";
    EXPECT_NE(named.output.find("\"mean\""), std::string::npos) << named.output;
}

/// The empty cells of a quadtree reach far beyond the segments, and do not make other structures small.
TEST_F(Draw, StructuresSideBySideFillTheirFrames) {
    const auto frame_width = [&](const std::string& structures) {
        const auto r =
            run("draw gen:segments2d:24 --quiet --structure grid" + structures + " -o " + file("f.svg"));
        EXPECT_EQ(r.code, 0) << r.output;
        const std::string svg = bytes_of(file("f.svg"));
        // The coordinates of the frame's lower left and upper right corner.
        const std::regex corner("class=\"quiet\"[^>]*>([-0-9.]+), [-0-9.]+<");
        std::vector<double> x;
        for (std::sregex_iterator i(svg.begin(), svg.end(), corner), end; i != end; ++i)
            x.push_back(std::stod((*i)[1]));
        return x.size() < 2 ? 0 : x[1] - x[0];
    };
    const double alone = frame_width("");
    EXPECT_GT(alone, 0.5);
    EXPECT_GE(frame_width(" --beside quadtree:leaf_size=2"), alone);
    EXPECT_LT(frame_width(" --beside quadtree:leaf_size=2"), 1.2 * alone);
}

TEST_F(Draw, SixVolumesAroundEverythingFitInOnePicture) {
    const std::string volumes =
        "draw gen:teapot:200 --quiet --depth 1 --structure bvh --beside bvh:volume=sphere --beside "
        "bvh:volume=obb "
        "--beside bvh:volume=cylinder --beside bvh:volume=kdop14 --beside bvh:volume=hull";
    ASSERT_EQ(run(volumes + " --size 608x404 -o " + file("six.png")).code, 0);
    const Image six = load_png(file("six.png"));
    EXPECT_EQ(six.width, 608);
    EXPECT_EQ(six.height, 404);
    // The parts below the captions: each shows another volume.
    std::set<std::vector<Image::Pixel>> parts;
    for (int i = 0; i < 6; ++i) {
        std::vector<Image::Pixel> part;
        for (int y = 80; y < 200; ++y)
            for (int x = 0; x < 200; ++x) part.push_back(six.at(i % 3 * 204 + x, i / 3 * 204 + y));
        parts.insert(part);
    }
    EXPECT_EQ(parts.size(), 6u);
    expect_usage(volumes + " --beside octree -o " + file("x.png"), "six");
}

TEST_F(Draw, WrongUsageIsTwoAndBadInputIsThree) {
    const std::string svg = " -o " + file("x.svg"), png = " -o " + file("x.png");
    EXPECT_EQ(run("draw gen:cube").code, 2);
    EXPECT_EQ(run("draw gen:cube --frames" + svg).code, 2);
    EXPECT_EQ(run("draw gen:cube --heat colour" + png).code, 2);
    EXPECT_EQ(run("draw gen:cube --scale 5" + png).code, 2);
    EXPECT_EQ(run("draw gen:cube --heat steps --slice z=0.5" + png).code, 2);
    EXPECT_EQ(run("draw gen:cube --depth -1" + png).code, 2);
    EXPECT_EQ(run("draw gen:cube --log" + png).code, 2);
    EXPECT_EQ(run("draw gen:points2d:20 --stop-at-first" + svg).code, 2);
    // Usage is checked before the scene is read: the file missing.ply does not exist.
    const std::string draw = "draw " + file("missing.ply");
    expect_usage(draw + " --beside bvh --beside grid --beside bsp --beside kdtree" + svg, "--beside");
    expect_usage(draw + " --beside bvh --beside grid --slice x=0.5 --tree" + svg, "trees of two");
    expect_usage(draw + " --height 2" + png, "--slice");
    EXPECT_EQ(run(draw + " --height 2 --heat steps" + png).code, 2);
    expect_usage("draw gen:points2d:20" + png, ".svg");
    expect_usage("draw gen:cube" + svg, ".png");
    expect_usage("draw gen:cube --slice z=0.5" + png, ".svg");
    for (const char* slice : {"w=0.5", "z=2", "z", "z=", "z=@", "z=0.5x", "z=nan"})
        expect_usage(draw + " --slice " + slice + svg, "--slice");
    expect_bad("draw gen:points2d:20 --slice x=0.5" + svg, "flat");
    expect_bad("draw gen:points2d:20 --heat steps" + png, "flat");
    expect_bad("draw gen:points2d:20 --ray 1,2,3,4,5,6" + svg, "4 are needed");
    expect_bad("draw gen:cube --ray 1,2,3,4" + svg, "6 are needed");
    expect_usage(draw + " --ray 1,2,3,0,0,0" + svg, "direction");
    expect_usage(draw + " --ray 1,2,0,0,1" + svg, "5 numbers");
    expect_usage("draw gen:cube --ray 1,2,3,0,0,1 --frames" + svg, ".html");
    expect_usage("draw gen:cube --structure kdtre" + png, "did you mean 'kdtree'");
    expect_usage("draw gen:cube --structure bvh --beside octre --slice x=0.5" + svg, "did you mean 'octree'");
    expect_bad("draw gen:points2d:300k" + svg, "too many");
    expect_usage("draw gen:cube --size 0x0" + png, "--size");
    expect_failure(1, "draw gen:cube -o " + file("no/such/folder/x.png"), "no folder");
}

}  // namespace
