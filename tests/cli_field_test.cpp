/// `draw --field` shows the values that the library gives: in its report, and in the colours of the picture.
#include <cmath>
#include <fstream>

#include <nlohmann/json.hpp>

#include <hedgerow/ask/insides.h>
#include <hedgerow/hedgerow.h>
#include <hedgerow/io/image.h>
#include <hedgerow/scenes/generate.h>

#include "tool.h"

namespace {

using namespace hedgerow;
using nlohmann::json;

/// A picture of a field, with its report.
struct Drawn {
    Image image;
    json report;
    int width, top;

    double pixel() const {
        return (report["high"][0].get<double>() - report["low"][0].get<double>()) / width;
    }
    /// The colour at a point of the plane.
    Image::Pixel at(double right, double up) const {
        const int x = static_cast<int>((right - report["low"][0].get<double>()) / pixel());
        const int y = static_cast<int>((report["high"][1].get<double>() - up) / pixel());
        return image.at(x, y + top);
    }
    /// Calls f(right, up) for the middle of each pixel.
    template <class F>
    void for_each(F f) const {
        for (int y = 0; y < image.height - top; ++y)
            for (int x = 0; x < width; ++x)
                f(report["low"][0].get<double>() + (x + 0.5) * pixel(),
                  report["high"][1].get<double>() - (y + 0.5) * pixel());
    }
};

class FieldTest : public ToolTest {
protected:
    static constexpr int width = 400, field_width = 316;

    Drawn draw(const std::string& arguments) const {
        const auto r = run("draw --json --width 400 " + arguments + " -o " + file("field.png"));
        EXPECT_EQ(r.code, 0) << r.output;
        Drawn d{load_png(file("field.png")), json::parse(r.output), field_width, 0};
        EXPECT_EQ(d.image.width, width);
        const double high = d.report["high"][1].get<double>() - d.report["low"][1].get<double>();
        d.top = d.image.height - static_cast<int>(std::lround(high / d.pixel()));
        return d;
    }
};

TEST_F(FieldTest, SignedDistancesOfACube) {
    const Drawn d = draw("gen:cube:300 --field signed-distance --slice z=@0");
    EXPECT_EQ(d.report["axis"], "z");
    EXPECT_EQ(d.report["position"], 0);
    EXPECT_EQ(d.report["closed"], true);
    EXPECT_NEAR(d.report["least"].get<double>(), -1, d.pixel());
    EXPECT_NEAR(d.report["most"].get<double>(), std::hypot(0.2, 0.2), d.pixel());
    // Blue inside, brown outside, and a black line at the surface on all four sides.
    const auto inside = d.at(0.05, 0.05), outside = d.at(-1.19, 1.19);
    EXPECT_GT(inside[2], inside[0] + 50);
    EXPECT_GT(outside[0], outside[2] + 50);
    for (const double side : {-1.0, 1.0})
        for (double t = -0.9; t < 1; t += 0.1) {
            EXPECT_EQ(d.at(side, t), (Image::Pixel{0, 0, 0}));
            EXPECT_EQ(d.at(t, side), (Image::Pixel{0, 0, 0}));
        }
    // A contour at the multiple of the step before the surface is darker than the colours beside it.
    const double step = d.report["contour"].get<double>();
    EXPECT_EQ(step, 0.2);
    const auto light = [](const Image::Pixel& p) { return p[0] + p[1] + p[2]; };
    int darkest = 999, beside = light(d.at(0.9, 0.03));
    for (double x = 1 - step - 2 * d.pixel(); x < 1 - step + 2 * d.pixel(); x += d.pixel() / 2)
        darkest = std::min(darkest, light(d.at(x, 0.03)));
    EXPECT_LT(darkest, beside - 60);
}

TEST_F(FieldTest, DistancesAreThoseOfTheLibrary) {
    for (const char* precision : {"float", "double"}) {
        const Drawn d =
            draw("gen:teapot:500 --field distance --slice y=0.4 --precision " + std::string(precision));
        const auto expect = [&]<class T>(T) {
            const auto mesh = std::get<TriangleMesh<T>>(generate<T>(parse_scene_spec("gen:teapot:500")));
            const auto index = build<WideBvh>(mesh);
            double least = 1e9, most = 0;
            d.for_each([&](double right, double up) {
                const Vec<T, 3> p(T(right), T(d.report["position"].get<double>()), T(up));
                const double distance = std::sqrt(double(closest_point(index, p).distance2));
                least = std::min(least, distance), most = std::max(most, distance);
            });
            EXPECT_NEAR(d.report["least"].get<double>(), least, 1e-5);
            EXPECT_NEAR(d.report["most"].get<double>(), most, 1e-5);
        };
        precision == std::string("float") ? expect(float()) : expect(double());
        EXPECT_EQ(d.report["right"], "x");
    }
}

TEST_F(FieldTest, WindingNumbersOfAnOpenMesh) {
    // A square of two triangles, seen from above: +1/2 just below, −1/2 just above.
    std::ofstream(file("square.obj")) << "v -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nf 1 2 3\nf 1 3 4\n";
    const Drawn d = draw(file("square.obj") + " --up z --field winding");
    EXPECT_EQ(d.report["closed"], false);
    EXPECT_GT(d.report["most"].get<double>(), 0.45);
    EXPECT_LE(d.report["most"].get<double>(), 0.5);
    EXPECT_LT(d.report["least"].get<double>(), -0.45);
    const auto below = d.at(0.01, -0.03), above = d.at(0.01, 0.03);
    EXPECT_GT(below[2], below[0] + 30) << "blue, as inside";
    EXPECT_GT(above[0], above[2] + 50);
    // Signed distances are told by the winding number, and the picture says so.
    const auto r = run("draw " + file("square.obj") + " --field signed-distance -o " + file("s.png"));
    EXPECT_EQ(r.code, 0) << r.output;
    EXPECT_NE(r.output.find("the mesh is open"), std::string::npos) << r.output;
    EXPECT_EQ(run("draw gen:cube --field winding -o " + file("s.png")).output.find("open"),
              std::string::npos);
}

TEST_F(FieldTest, CountsWithinARadius) {
    std::ofstream(file("three.csv")) << "x,y,z\n0,0,0\n1,0,0\n10,0,5\n";
    const Drawn d = draw(file("three.csv") + " --field count --radius 2 --slice y=0.5");
    EXPECT_EQ(d.report["radius"], 2);
    EXPECT_EQ(d.report["least"], 0);
    EXPECT_EQ(d.report["most"], 2);
    EXPECT_EQ(d.report["contour"], 1);
    // Around the first two points it is 2, around the third 1, and 0 between.
    const auto two = d.at(0.5, 0.7), one = d.at(10, 3.5), none = d.at(5, 2.5);
    EXPECT_NE(two, one);
    EXPECT_NE(one, none);
    EXPECT_EQ(d.at(0.5, -0.7), two);
    EXPECT_EQ(d.at(9, 5.9), one);
    EXPECT_EQ(d.at(7, 0), none);
    EXPECT_EQ(d.at(10, 5), (Image::Pixel{255, 255, 255})) << "a point in the plane is a dot";
    // The default radius is a twentieth of the diagonal.
    EXPECT_NEAR(draw(file("three.csv") + " --field count").report["radius"].get<double>(),
                std::sqrt(125.0) / 20, 1e-6);
}

TEST_F(FieldTest, EveryKindOfSceneInSpace) {
    for (const char* scene : {"gen:teapot:300", "gen:points:300", "gen:spheres:100", "gen:cube"})
        for (const char* field : {"distance", "count"}) {
            const Drawn d = draw(scene + std::string(" --field ") + field);
            EXPECT_LT(d.report["least"].get<double>(), d.report["most"].get<double>()) << scene << field;
            EXPECT_EQ(d.report["finished"], true);
        }
    // One point has no extent, and a triangle may be anywhere.
    std::ofstream(file("one.csv")) << "x,y,z\n3,4,5\n";
    EXPECT_GT(draw(file("one.csv") + " --field distance").report["most"].get<double>(), 0.5);
    for (const char* scale : {"e30", "e-30"}) {
        const std::string s = scale;
        std::ofstream(file("far.obj")) << "v 1" + s + " 0 0\nv 0 1" + s + " 0\nv 0 0 1" + s + "\nf 1 2 3\n";
        for (const char* field : {"distance", "signed-distance", "winding", "count"})
            draw(file("far.obj") + " --precision double --field " + field);
    }
    // The picture does not depend on the number of threads.
    draw("gen:teapot:500 --field signed-distance --threads 1");
    const auto one = pixels_of(file("field.png"));
    draw("gen:teapot:500 --field signed-distance --threads 4");
    EXPECT_EQ(pixels_of(file("field.png")), one);
}

TEST_F(FieldTest, WrongUsageIsTwoAndBadInputIsThree) {
    const std::string png = " -o " + file("x.png"), draw = "draw " + file("missing.ply");
    EXPECT_EQ(run(draw + " --field colour" + png).code, 2);
    expect_usage(draw + " --field distance -o " + file("x.svg"), ".png");
    expect_usage(draw + " --field distance --slice w=1" + png, "--slice");
    expect_usage(draw + " --field distance --radius 2" + png, "--radius");
    for (const char* other : {"--size 64x48", "--structure bvh", "--beside bvh", "--heat steps", "--tree",
                              "--depth 2", "--height 2", "--width 10", "--ray 1,2,3,4,5,6"})
        EXPECT_EQ(run(draw + " --field distance " + other + png).code, 2) << other;
    EXPECT_EQ(run(draw + " --width 400" + png).code, 2);
    expect_bad("draw gen:points2d:20 --field distance" + png, "flat");
    expect_bad("draw gen:segments2d:20 --field count" + png, "flat");
    expect_bad("draw gen:points:20 --field signed-distance" + png, "no triangles");
    expect_bad("draw gen:spheres:20 --field winding" + png, "no triangles");
}

}  // namespace
