/// The tool as its user sees it: exit codes, messages, pictures.
#include <nlohmann/json.hpp>

#include <hedgerow/io/exr.h>
#include <hedgerow/io/image.h>
#include <hedgerow/io/npy.h>
#include <hedgerow/version.h>

#include "structure_names.h"
#include "tool.h"

namespace {

using namespace hedgerow;
using Cli = ToolTest;

TEST_F(Cli, HelpOpensWithExamples) {
    for (const char* verb :
         {"", "render ", "query ", "build ", "draw ", "compare ", "info ", "generate ", "structures "}) {
        const auto r = run(std::string(verb) + "--help");
        EXPECT_EQ(r.code, 0);
        EXPECT_EQ(r.output.rfind("Examples:", 0), 0u) << r.output;
    }
    EXPECT_EQ(run("--version").code, 0);
}

TEST_F(Cli, StructuresAreListedAndHaveTheirOptionsOnRequest) {
    const auto all = run("structures");
    EXPECT_EQ(all.code, 0);
    for (const StructureInfo& known : structure_list())
        EXPECT_NE(("\n" + all.output).find("\n" + std::string(known.name) + " "), std::string::npos)
            << known.name;
    EXPECT_EQ(all.output.find("traversal_cost"), std::string::npos) << "a short list";
    const auto one = run("structures kdtree");
    EXPECT_EQ(one.code, 0);
    EXPECT_NE(one.output.find("traversal_cost="), std::string::npos);
    EXPECT_EQ(one.output.find("heuristic="), std::string::npos) << "of another structure";
    EXPECT_NE(run("structures bvh --json").output.find("\"options\""), std::string::npos);
    expect_usage("structures kdtre", "did you mean 'kdtree'");
    for (const char* verb : {"", "render ", "compare ", "draw "})
        EXPECT_EQ(run(std::string(verb) + "--help").output.find("traversal_cost"), std::string::npos) << verb;
    EXPECT_NE(run("--help").output.find("interior"), std::string::npos) << "scenes are listed";
}

TEST_F(Cli, WrongUsageIsTwo) {
    EXPECT_EQ(run("").code, 2);
    EXPECT_EQ(run("rendr gen:cube").code, 2);
    EXPECT_EQ(run("render gen:cube").code, 2);
    EXPECT_EQ(run("render gen:cube -o " + file("x.png") + " --shading nonsense").code, 2);
}

TEST_F(Cli, BadInputIsThreeAndNamed) {
    const std::string to = " -o " + file("x.png");
    expect_bad("render " + file("missing.ply") + to, "missing.ply");
    std::ofstream(file("empty.ply")).flush();
    expect_bad("render " + file("empty.ply") + to, "empty.ply");
    std::ofstream(file("cut.ply"))
        << "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
           "element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n";
    expect_bad("info " + file("cut.ply"), "cut.ply");
    std::ofstream(file("range.obj")) << "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n";
    expect_bad("info " + file("range.obj"), "range.obj");
    std::ofstream(file("nothing.ply")) << "ply\nformat ascii 1.0\nelement vertex 0\nproperty float x\n"
                                          "property float y\nproperty float z\nend_header\n";
    expect_bad("render " + file("nothing.ply") + to, "nothing.ply");
    for (const char* bad : {"nan", "inf", "1e30"}) {
        std::ofstream(file("bad.obj")) << "v 0 0 0\nv 1 0 0\nv 0 " << bad << " 0\nf 1 2 3\n";
        expect_bad("render " + file("bad.obj") + to, "bad.obj");
    }
    expect_bad("render gen:points2d" + to, "can be rendered");
    expect_bad("build gen:spheres -o " + file("x.hedgerow"), "only an index of triangles");
}

TEST_F(Cli, AMeshWithoutAreaIsNeverHit) {
    std::ofstream(file("flat.obj")) << "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\nf 1 1 1\n";
    EXPECT_NE(run("info --json " + file("flat.obj")).output.find("\"zero_area_triangles\": 2"),
              std::string::npos);
    const auto r = run("render --quiet --size 32x24 " + file("flat.obj") + " -o " + file("flat.png"));
    ASSERT_EQ(r.code, 0) << r.output;
    const auto image = hedgerow::load_png(file("flat.png"));
    for (int x = 0; x < 32; ++x) EXPECT_EQ(image.at(x, 12), image.at(0, 0));
}

TEST_F(Cli, EveryStructureMakesTheSamePicture) {
    for (const char* shading : {"normals", "depth", "diffuse"}) {
        std::string first;
        for (const std::string& structure : structures_for<TriangleMesh<float>>({"bvh:builder=midpoint"})) {
            const auto r =
                run("render gen:teapot:500 --quiet --size 48x32 --shading " + std::string(shading) +
                    " --structure " + structure + " -o " + file("same.png"));
            ASSERT_EQ(r.code, 0) << r.output;
            const auto picture = pixels_of(file("same.png"));
            if (first.empty()) first = picture;
            EXPECT_EQ(picture, first) << structure << ", " << shading;
        }
        const auto image = hedgerow::load_png(file("same.png"));
        EXPECT_NE(image.at(24, 16), image.at(0, 0)) << "the teapot differs from what is behind it";
    }
}

TEST_F(Cli, ASavedIndexIsDescribedAndRendered) {
    const std::string saved = file("teapot.hedgerow"), view = " --quiet --size 48x32 -o " + file("saved.png");
    for (const char* precision : {"float", "double"}) {
        const std::string scene = "gen:teapot:500 --precision " + std::string(precision);
        const auto r = run("build --json --builder high --width 4 --threads 1 -o " + saved + " " + scene);
        ASSERT_EQ(r.code, 0) << r.output;
        EXPECT_NE(r.output.find("\"bytes_per_triangle\""), std::string::npos) << r.output;
        const std::string bytes = bytes_of(saved);
        ASSERT_EQ(run("build --quiet --builder high --width 4 -o " + saved + " " + scene).output, "");
        EXPECT_EQ(bytes_of(saved), bytes) << "by any number of threads";

        // `info` prints what the file has.
        const auto facts = run("info --json " + saved).output;
        for (const std::string fact :
             {"\"kind\": \"triangles\"", "\"builder\": \"high\"", "\"width\": 4", "\"format_version\": 3"})
            EXPECT_NE(facts.find(fact), std::string::npos) << fact << " in " << facts;
        EXPECT_NE(facts.find("\"precision\": \"" + std::string(precision)), std::string::npos) << facts;
        EXPECT_NE(facts.find("\"file_bytes\": " + std::to_string(bytes.size())), std::string::npos) << facts;

        // `compare` reads the file as a scene.
        const auto compared = run("compare --structures bvh --queries 16 --time 0.001 " + saved);
        EXPECT_EQ(compared.code, 0) << compared.output;

        // Pictures of the file are those of the scene.
        ASSERT_EQ(run("render " + scene + view).code, 0);
        const std::string picture = pixels_of(file("saved.png"));
        for (const std::string structure : {"", " --structure wide", " --structure kdtree"}) {
            // The file does not record the scene that the mesh is from, so the axis that is up is given.
            const auto rendered = run("render --json --up z " + saved + structure + view);
            ASSERT_EQ(rendered.code, 0) << rendered.output;
            EXPECT_EQ(pixels_of(file("saved.png")), picture) << precision << structure;
            const bool built = structure == " --structure kdtree";
            EXPECT_NE(rendered.output.find(built ? "\"build_seconds\"" : "\"load_seconds\""),
                      std::string::npos)
                << rendered.output;
        }
    }
    // A damaged file is refused.
    std::string damaged = bytes_of(saved);
    damaged[damaged.size() / 2] ^= 1;
    std::ofstream(file("damaged.hedgerow"), std::ios::binary) << damaged;
    for (const char* verb : {"render", "info", "draw"}) {
        const std::string to = std::string(verb) == "info" ? "" : " -o " + file("x.png");
        expect_bad(std::string(verb) + " " + file("damaged.hedgerow") + to, "save it again");
    }
}

TEST_F(Cli, StepsAreDrawnAndReported) {
    const auto r = run("render gen:teapot:500 --shading steps --json --size 320x240 -o " + file("steps.png"));
    ASSERT_EQ(r.code, 0) << r.output;
    EXPECT_NE(r.output.find("\"nodes_per_ray\""), std::string::npos);
    const auto image = hedgerow::load_png(file("steps.png"));
    EXPECT_NE(image.at(140, 120), image.at(0, 0));
}

TEST_F(Cli, KernelsRenderTheBitsOfWalksThatCount) {
    const std::string scene = "render gen:teapot-in-stadium:2000 --json --size 333x101 --spp 3 -o ";
    const auto fast = run(scene + file("fast.png")), counted = run(scene + file("counted.png") + " --counts"),
               other = run(scene + file("other.png") + " --structure kdtree");
    for (const auto& r : {fast, counted, other}) ASSERT_EQ(r.code, 0) << r.output;
    EXPECT_EQ(fast.output.find("nodes_per_ray"), std::string::npos) << fast.output;
    EXPECT_NE(counted.output.find("nodes_per_ray"), std::string::npos) << counted.output;
    EXPECT_NE(counted.output.find("\"packets\": 0"), std::string::npos) << counted.output;
    EXPECT_EQ(pixels_of(file("fast.png")), pixels_of(file("counted.png")));
    EXPECT_EQ(pixels_of(file("fast.png")), pixels_of(file("other.png")));
}

TEST_F(Cli, RasterisingMakesThePictureOfRays) {
    for (const std::string options :
         {"", " --shading normals --spp 2", " --shading depth --precision double"}) {
        const std::string scene = "render gen:teapot-in-stadium:2000 --json --size 133x71" + options + " -o ";
        const auto cast = run(scene + file("cast.png")),
                   drawn = run(scene + file("drawn.png") + " --visibility raster");
        ASSERT_EQ(cast.code, 0) << cast.output;
        ASSERT_EQ(drawn.code, 0) << drawn.output;
        EXPECT_EQ(pixels_of(file("cast.png")), pixels_of(file("drawn.png")));
        const auto beamed = run(scene + file("beamed.png") + " --visibility beams");
        ASSERT_EQ(beamed.code, 0) << beamed.output;
        EXPECT_EQ(pixels_of(file("cast.png")), pixels_of(file("beamed.png")));
        EXPECT_NE(drawn.output.find("\"triangles_drawn\""), std::string::npos) << drawn.output;
        // Without light there is no need for an index.
        EXPECT_EQ(drawn.output.find("\"rays\": 0") != std::string::npos, !options.empty()) << drawn.output;
    }
    // An STL file is drawn as it is read.
    ASSERT_EQ(run("generate gen:teapot:3000 -o " + file("a.stl")).code, 0);
    for (const std::string options : {"normals -o a.png", "depth --spp 3 -o a.png", "normals -o a.exr"}) {
        const std::string scene = "render " + file("a.stl") + " --quiet --size 133x71 --shading ";
        const std::string ending = options.substr(options.size() - 4);
        const auto words = options.substr(0, options.find("-o"));
        ASSERT_EQ(run(scene + words + "-o " + file("cast" + ending)).code, 0);
        ASSERT_EQ(run(scene + words + "--visibility raster -o " + file("drawn" + ending)).code, 0);
        if (ending == ".png") {
            EXPECT_EQ(pixels_of(file("cast.png")), pixels_of(file("drawn.png")));
        }
    }
    expect_usage("render gen:cube --visibility raster --shading steps -o " + file("x.png"),
                 "--visibility cast");
    expect_bad("render gen:points --visibility raster -o " + file("x.png"), "only triangles");
    expect_bad("render gen:points --visibility beams -o " + file("x.png"), "triangles alone");
    expect_usage("render gen:cube --visibility beams --structure bvh -o " + file("x.png"), "'wide' alone");
    expect_bad("render gen:cube --visibility raster --projection panorama -o " + file("x.png"), "panorama");
}

TEST_F(Cli, PicturesSayHowTheyWereMade) {
    for (const std::string name : {"a.png", "a.exr"}) {
        if (name == "a.exr" && !hedgerow::exr_supported()) continue;
        const std::string command = "render gen:soup:50 --seed 9 --quiet --size 16x9 -o " + file(name);
        ASSERT_EQ(run(command).code, 0);
        const std::string bytes = bytes_of(file(name));
        for (const std::string& note : {"hedgerow " + command, std::string("hedgerow ") + hedgerow::version})
            EXPECT_NE(bytes.find(note), bytes.npos) << note;
        EXPECT_EQ(run("--version").output, std::string("hedgerow ") + hedgerow::version + "\n");
    }
    ASSERT_EQ(run("draw gen:soup:50 --quiet -o '" + file("it is.png") + "'").code, 0);
    EXPECT_NE(bytes_of(file("it is.png")).find("-o '" + file("it is.png") + "'"), std::string::npos);
}

TEST_F(Cli, ColoursAreThoseOfTheScene) {
    const std::string scene = "render gen:cornell-box --quiet --size 64x64 -o ";
    ASSERT_EQ(run(scene + file("grey.png")).code, 0);
    ASSERT_EQ(run(scene + file("colour.png") + " --shading colour").code, 0);
    ASSERT_EQ(run(scene + file("drawn.png") + " --shading colour --visibility raster").code, 0);
    EXPECT_EQ(pixels_of(file("colour.png")), pixels_of(file("drawn.png")));
    const auto colour = hedgerow::load_png(file("colour.png")), grey = hedgerow::load_png(file("grey.png"));
    EXPECT_GT(colour.at(3, 32)[0], colour.at(3, 32)[1] + 40) << "the left wall is red";
    EXPECT_LT(std::abs(int(grey.at(3, 32)[0]) - int(grey.at(3, 32)[1])), 20);
    expect_usage("render gen:cube --shading colour --structure bvh -o " + file("x.png"), "--structure");
    expect_usage("render gen:cube --camera 0 -o " + file("x.png"), "--shading colour");
    expect_usage("render gen:cube --shading colour --camera 0 -o " + file("x.png"), "has 0 cameras");
}

TEST_F(Cli, LightGoesThroughSurfaces) {
    const std::string scene = "render gen:cornell-box --size 64x64 -o ";
    ASSERT_EQ(run(scene + file("opaque.png") + " --shading colour").code, 0);
    const auto clear = run(scene + file("clear.png") + " --shading colour --opacity 0.5 --json");
    ASSERT_EQ(clear.code, 0);
    const auto figures = nlohmann::json::parse(clear.output);
    EXPECT_GT(figures["layers"].get<int>(), 64 * 64);
    ASSERT_EQ(run(scene + file("drawn.png") + " --shading colour --opacity 0.5 --visibility raster").code, 0);
    EXPECT_EQ(pixels_of(file("clear.png")), pixels_of(file("drawn.png")));
    EXPECT_NE(pixels_of(file("clear.png")), pixels_of(file("opaque.png")));
    // Without looks, too. The box's materials are opaque.
    ASSERT_EQ(run(scene + file("grey.png") + " --opacity 0.5 --structure kdtree").code, 0);
    ASSERT_EQ(run(scene + file("beams.png") + " --opacity 0.5 --visibility beams").code, 0);
    EXPECT_EQ(pixels_of(file("grey.png")), pixels_of(file("beams.png")));
    ASSERT_EQ(run(scene + file("same.png") + " --shading colour --transparency").code, 0);
    EXPECT_EQ(pixels_of(file("same.png")), pixels_of(file("opaque.png")));
    expect_usage(scene + file("x.png") + " --transparency", "--opacity");
    expect_usage(scene + file("x.png") + " --opacity 1.5", "--opacity");
    expect_usage(scene + file("x.png") + " --opacity 0.5 --shading steps", "what rays cost");
}

TEST_F(Cli, ConesSmoothEdgesAndShadows) {
    const std::string scene = "render gen:cornell-box --size 64x64 -o ";
    ASSERT_EQ(run(scene + file("rays.png")).code, 0);
    const auto cones = run(scene + file("cones.png") + " --cones --json");
    ASSERT_EQ(cones.code, 0);
    EXPECT_EQ(nlohmann::json::parse(cones.output)["cones"].get<int>(), 64 * 64);
    ASSERT_EQ(run(scene + file("soft.png") + " --light-size 5 --visibility raster").code, 0);
    const auto rays = pixels_of(file("rays.png"));
    EXPECT_NE(pixels_of(file("cones.png")), rays);
    EXPECT_NE(pixels_of(file("soft.png")), rays);
    for (const char* options : {"--spp 4", "--visibility raster", "--structure bvh", "--shading steps",
                                "--opacity 0.5", "--counts", "--sheet"})
        expect_usage(scene + file("x.png") + " --cones " + options, "cones");
    ASSERT_EQ(run(scene + file("coloured.png") + " --cones --light-size 5 --shading colour").code, 0);
    EXPECT_NE(pixels_of(file("coloured.png")), pixels_of(file("soft.png")));
    ASSERT_EQ(run(scene + file("footprints.png") + " --footprints --shading colour").code, 0);
    expect_usage(scene + file("x.png") + " --footprints", "textures");
    expect_usage(scene + file("x.png") + " --light-size 100", "--light-size");
    expect_bad("render gen:points --cones -o " + file("x.png"), "triangles alone");
    expect_bad(scene + file("x.png") + " --cones --projection panorama", "panorama");
}

TEST_F(Cli, RefinementTakesFewerRays) {
    const std::string scene = "render gen:teapot:2000 --size 60x40 --json --spp 16 -o ";
    const auto all = run(scene + file("all.png")), some = run(scene + file("some.png") + " --refine");
    ASSERT_EQ(some.code, 0);
    EXPECT_LT(nlohmann::json::parse(some.output)["rays"].get<double>(),
              nlohmann::json::parse(all.output)["rays"].get<double>() / 2);
    for (const char* options : {"--visibility raster", "--sheet", "--shading steps", "--shading path"})
        expect_usage(scene + file("x.png") + " --refine " + options, "leave out");
    expect_usage("render gen:teapot:2000 --refine --spp 4 -o " + file("x.png"), "--spp");
}

TEST_F(Cli, PathsShowScatteredLight) {
    const std::string scene = "render gen:cornell-box --shading path --size 24x20 -o ";
    const auto made = run(scene + file("paths.png") + " --spp 4 --threads 1 --json");
    ASSERT_EQ(made.code, 0);
    const auto figures = nlohmann::json::parse(made.output);
    EXPECT_EQ(figures["lights"].get<int>(), 2);
    EXPECT_EQ(figures["samples"].get<int>(), 4);
    EXPECT_TRUE(figures["finished"].get<bool>());
    ASSERT_EQ(run(scene + file("threads.png") + " --spp 4 --threads 2").code, 0);
    EXPECT_EQ(pixels_of(file("paths.png")), pixels_of(file("threads.png")));
    for (const char* options : {"--seed 5", "--sampler independent", "--bounces 1", "--exposure 2",
                                "--filter gaussian", "--tone neutral"}) {
        ASSERT_EQ(run(scene + file("other.png") + " --spp 4 " + options).code, 0) << options;
        EXPECT_NE(pixels_of(file("paths.png")), pixels_of(file("other.png"))) << options;
    }
    const auto sky = run("render gen:teapot:1000 --shading path --spp 1 --size 16x16 -o " + file("sky.exr"));
    ASSERT_EQ(sky.code, 0);
    EXPECT_NE(sky.output.find("so it gets a sky"), std::string::npos);
    for (const char* options : {"--sheet", "--counts", "--cones", "--light-size 5", "--footprints",
                                "--opacity 0.5", "--visibility raster", "--structure bvh"})
        expect_usage(scene + file("x.png") + " " + options, "leave out");
    ASSERT_EQ(run(scene + file("adaptive.png") + " --spp 50 --adaptive --preview").code, 0);
    ASSERT_EQ(run(scene + file("even.png") + " --spp 50").code, 0);
    EXPECT_NE(pixels_of(file("adaptive.png")), pixels_of(file("even.png")));
    const auto calm = run(scene + file("calm.png") + " --noise 0.08 --json");
    ASSERT_EQ(calm.code, 0);
    const auto of_calm = nlohmann::json::parse(calm.output);
    EXPECT_LE(of_calm["noise"].get<double>(), 0.08);
    EXPECT_GT(of_calm["noise"].get<double>(), 0.06) << "no more samples than it takes";
    EXPECT_GT(of_calm["samples"].get<double>(), 31);
    expect_usage(scene + file("x.png") + " --noise 0", "--noise");
    ASSERT_EQ(run(scene + file("denoised.png") + " --spp 8 --denoise").code, 0);
    ASSERT_EQ(run(scene + file("raw.png") + " --spp 8").code, 0);
    EXPECT_NE(pixels_of(file("denoised.png")), pixels_of(file("raw.png")));
    expect_usage(scene + file("x.png") + " --denoise --spp 3", "four samples");
    expect_usage(scene + file("x.png") + " --sampler random", "--sampler");
    expect_usage(scene + file("x.png") + " --spp 0", "--spp");
}

/// The rays of a render, by bounce: those of all samples where they are few, or of a million paths.
TEST_F(Cli, PathsSaveTheirRays) {
    const std::string scene =
        "render gen:cornell-box --shading path --size 20x10 --bounces 2 -o " + file("x.png");
    const auto made = run(scene + " --spp 3 --save-rays " + file("rays"));
    ASSERT_EQ(made.code, 0);
    EXPECT_NE(made.output.find("rays of 600 of 600 paths"), std::string::npos) << made.output;
    std::size_t before = 600;
    for (const char* bounce : {"0", "1", "2"}) {
        const auto rays = load_npy(file("rays-" + std::string(bounce) + ".npy"));
        ASSERT_EQ(rays.shape.size(), 2u);
        EXPECT_EQ(rays.shape[1], 8u);
        EXPECT_LE(rays.shape[0], before);
        EXPECT_GT(rays.shape[0], 0u);
        before = rays.shape[0];
        EXPECT_EQ(std::filesystem::exists(file("rays-" + std::string(bounce) + "-shadow.npy")),
                  *bounce != '2')
            << "paths end at the third surface";
    }
    EXPECT_EQ(load_npy(file("rays-0.npy")).shape[0], 600u);
    EXPECT_FALSE(std::filesystem::exists(file("rays-3.npy")));
    for (const char* kind : {"closest-hit", "any-hit"})
        EXPECT_EQ(run("query " + std::string(kind) + " gen:cornell-box --from " + file("rays-1-shadow.npy") +
                      " -o " + file("answers.npy"))
                      .code,
                  0);
    expect_usage("render gen:cornell-box --save-rays " + file("rays") + " -o " + file("x.png"),
                 "--shading path");
    const auto refused = run(scene + " --save-rays " + file("no-folder/rays"));
    EXPECT_EQ(refused.code, 1);
    EXPECT_NE(refused.output.find("no-folder/rays-0.npy"), std::string::npos) << refused.output;
}

TEST_F(Cli, PathsGoOnAfterAnInterruption) {
    const std::string scene = "render gen:cornell-box --shading path --size 64x48 --spp 400 --threads 1 -o ";
    ASSERT_EQ(run(scene + file("at_once.png")).code, 0);
    const std::vector<std::string> words = {"render",    "gen:cornell-box",
                                            "--shading", "path",
                                            "--size",    "64x48",
                                            "--spp",     "400",
                                            "--threads", "1",
                                            "-o",        file("resumed.png"),
                                            "--resume",  file("state"),
                                            "--quiet"};
    EXPECT_EQ(run_interrupted(words, 700), 130);
    ASSERT_TRUE(std::filesystem::exists(file("state")));
    const auto resumed = run(scene + file("resumed.png") + " --json --resume " + file("state"));
    ASSERT_EQ(resumed.code, 0);
    EXPECT_EQ(nlohmann::json::parse(resumed.output)["samples"].get<int>(), 400);
    EXPECT_EQ(pixels_of(file("at_once.png")), pixels_of(file("resumed.png")));
    expect_bad(scene + file("x.png") + " --seed 3 --resume " + file("state"), "another seed: 0, not 3");
    expect_bad("render gen:cornell-box:500 --shading path --size 64x48 -o " + file("x.png") + " --resume " +
                   file("state"),
               "another scene");
    // Pictures in halves go on with both, and adaptive ones with the same shares of their pixels.
    for (const std::string halves : {"--denoise", "--adaptive"}) {
        const std::string small = "render gen:cornell-box --shading path --size 20x20 " + halves + " -o ";
        ASSERT_EQ(run(small + file("at_once.png") + " --spp 100").code, 0);
        for (const char* spp : {" --spp 40", " --spp 100"})
            ASSERT_EQ(run(small + file("resumed.png") + spp + " --resume " + file(halves)).code, 0);
        EXPECT_EQ(pixels_of(file("at_once.png")), pixels_of(file("resumed.png"))) << halves;
    }
    const auto timed =
        run("render gen:cornell-box --shading path --size 64x48 --time 0.5s --json -o " + file("timed.png"));
    ASSERT_EQ(timed.code, 0);
    EXPECT_LT(nlohmann::json::parse(timed.output)["samples"].get<int>(), 16384);
    for (const char* option : {"--time 5s", "--noise 0.1", "--adaptive", "--preview", "--tone neutral"})
        expect_usage("render gen:cornell-box -o " + file("x.png") + " " + option, "--shading path");
    expect_usage(scene + file("x.png") + " --time -5s", "--time");
}

TEST_F(Cli, ASheetShowsEveryShading) {
    const std::string scene = "render gen:cornell-box --quiet -o " + file("sheet.png") + " --sheet";
    ASSERT_EQ(run(scene + " --size 50x40 --structure kdtree").code, 0);
    const auto sheet = hedgerow::load_png(file("sheet.png"));
    EXPECT_EQ(sheet.width, 150);
    EXPECT_EQ(sheet.height, 80);
    ASSERT_EQ(run("render gen:cornell-box --quiet --size 50x40 --shading normals -o " + file("n.png")).code,
              0);
    const auto normals = hedgerow::load_png(file("n.png"));
    for (int y = 17; y < 40; ++y)  // below the note
        for (int x = 0; x < 50; ++x) ASSERT_EQ(sheet.at(100 + x, y), normals.at(x, y)) << x << ' ' << y;
    expect_usage(scene + " --structure nonsense", "nonsense");
    expect_usage(scene + " --visibility beams", "beams");
    expect_usage(scene + " --counts", "--counts");
    expect_usage(scene + " --size 20000x20", "32768");
    expect_usage("render gen:cube --sheet -o " + file("x.exr"), ".png");
}

TEST_F(Cli, ViewsAndProjectionsMakeDifferentPictures) {
    std::vector<std::string> pictures;
    for (const char* options :
         {"", "--view front", "--view back", "--view left", "--view right", "--view top", "--view bottom",
          "--view corner --projection orthographic", "--projection panorama", "--lens 0.3",
          "--lens 0.3 --focus 2", "--projection orthographic --height 1"}) {
        const auto r = run("render gen:teapot:500 --quiet --size 60x40 " + std::string(options) + " -o " +
                           file("a.png"));
        ASSERT_EQ(r.code, 0) << options << r.output;
        pictures.push_back(pixels_of(file("a.png")));
        for (std::size_t i = 0; i + 1 < pictures.size(); ++i)
            EXPECT_NE(pictures[i], pictures.back()) << options;
    }
    expect_usage("render gen:cube --view behind -o " + file("x.png"), "behind");
    expect_usage("render gen:cube --lens -1 -o " + file("x.png"), "--lens");
}

TEST_F(Cli, WhatIsGeneratedCanBeRead) {
    ASSERT_EQ(run("generate gen:cube:300 -o " + file("cube.ply")).code, 0);
    const auto r = run("info --json " + file("cube.ply"));
    EXPECT_EQ(r.code, 0);
    EXPECT_NE(r.output.find("\"closed\": true"), std::string::npos) << r.output;
}

TEST_F(Cli, FilesAreConverted) {
    EXPECT_EQ(run("generate gen:cube -o " + file("a.obj")).code, 0);
    EXPECT_EQ(run("convert " + file("a.obj") + " -o " + file("b.STL")).code, 0);
    EXPECT_EQ(run("convert " + file("b.STL") + " -o " + file("c.ply")).code, 0);
    EXPECT_EQ(run("info " + file("c.ply")).output, run("info " + file("a.obj")).output);
    EXPECT_EQ(run("generate gen:points:50 -o " + file("p.xyz")).code, 0);
    EXPECT_EQ(run("convert " + file("p.xyz") + " -o " + file("p.npy")).code, 0);
    EXPECT_EQ(run("convert " + file("p.npy") + " -o " + file("q.xyz")).code, 0);
    EXPECT_EQ(bytes_of(file("p.xyz")), bytes_of(file("q.xyz")));
    expect_bad("convert " + file("a.obj") + " -o " + file("a.csv"), "Known are .ply .stl .obj .off");
    expect_bad("convert " + file("p.npy") + " -o " + file("p.stl"), "Known are .ply .npy .csv .xyz");
    expect_usage("generate " + file("a.obj") + " -o " + file("b.ply"), "hedgerow convert");
}

TEST_F(Cli, FormatsAreRefusedBeforeAnyWork) {
    // None of the generated scenes fits into memory, and the file missing.ply does not exist.
    expect_usage("generate gen:terrain:2000M -o " + file("a.xyz"), ".ply .stl .obj .off");
    expect_usage("generate gen:points:2000M -o " + file("a.stl"), ".ply .npy .csv .xyz");
    expect_usage("generate gen:spheres:2000M -o " + file("a.ply"), "no file format here holds spheres");
    expect_usage("convert " + file("missing.ply") + " -o " + file("a.glb"), "Meshes are written as .ply");
    expect_usage("convert " + file("missing.ply") + " -o " + file("a"), "Points are written as .ply");
}

TEST_F(Cli, ExtensionsAreOfAnyCase) {
    EXPECT_EQ(run("generate gen:cube -o " + file("A.PLY")).code, 0);
    EXPECT_EQ(run("render " + file("A.PLY") + " --size 16x16 -o " + file("A.PNG")).code, 0);
    EXPECT_EQ(run("draw " + file("A.PLY") + " --slice y=0.5 -o " + file("A.SVG")).code, 0);
}

TEST_F(Cli, PointsAreKnownByWhatTheirFileHoldsAndDrawnAsSpheres) {
    for (const char* name : {"p.ply", "p.npy", "p.csv"}) {
        ASSERT_EQ(run("generate gen:points:100 -o " + file(name)).code, 0);
        const auto r = run("info --json " + file(name));
        EXPECT_NE(r.output.find("\"points\": 100"), std::string::npos) << r.output;
        ASSERT_EQ(run("render --quiet --size 64x48 " + file(name) + " -o " + file("p.png")).code, 0);
        const auto image = hedgerow::load_png(file("p.png"));
        int drawn = 0;
        for (int y = 0; y < 48; ++y)
            for (int x = 0; x < 64; ++x) drawn += image.at(x, y) != image.at(0, 0);
        EXPECT_GT(drawn, 50) << name;
    }
    ASSERT_EQ(run("generate gen:points2d:100 -o " + file("flat.npy")).code, 0);
    EXPECT_NE(run("info " + file("flat.npy")).output.find("dimension              2"), std::string::npos);
}

TEST_F(Cli, DoublesAreKept) {
    std::ofstream(file("one.csv")) << "0.123456789,0.2,0.3\n";
    EXPECT_NE(run("info --json --precision double " + file("one.csv")).output.find("0.123456789,"),
              std::string::npos);
    EXPECT_NE(run("info --json " + file("one.csv")).output.find("0.12345679,"), std::string::npos)
        << "with the digits of a float, not those of a double";
    ASSERT_EQ(run("convert " + file("one.csv") + " -o " + file("one.npy")).code, 0);
    EXPECT_NE(run("info --json --precision double " + file("one.npy")).output.find("0.123456789,"),
              std::string::npos)
        << "convert keeps them unless it is told not to";
    ASSERT_EQ(run("render gen:teapot:200 --quiet --size 32x24 --precision double -o " + file("d.png")).code,
              0);
}

}  // namespace
