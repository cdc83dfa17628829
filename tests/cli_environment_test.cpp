/// `render --shading path --environment`: a scene in the light of an image, which is seen where it lies.
#include <cmath>

#include "tool.h"

namespace {

using namespace hedgerow;

class CliEnvironment : public ToolTest {
protected:
    static constexpr int width = 64, height = 32, block = 8;

    void SetUp() override {
        ToolTest::SetUp();
        // The smallest scene. It lies beyond the pixels that the tests look at.
        std::ofstream(file("scene.obj")) << "v 0 -10 0\nv 1e-4 -10 0\nv 0 -10 1e-4\nf 1 2 3\n";
        Image sky(width, height);
        for (int y = 0; y < height; ++y)
            for (int x = 0; x < width; ++x) sky.at(x, y) = colour(x / block, y / block);
        save_png(file("sky.png"), sky);
    }
    /// The colour of a block of the sky, which no other block has.
    static Image::Pixel colour(int column, int row) {
        return {std::uint8_t(40 + 25 * column), std::uint8_t(60 + 50 * row), 128};
    }
    /// All around from within the scene, with the target in the middle.
    Image seen(const std::string& options, int samples = 1) const {
        const std::string picture = file("seen.png");
        const auto r =
            run("render " + file("scene.obj") + " --shading path --spp " + std::to_string(samples) +
                " --projection panorama --eye 0,0,0 --size " + std::to_string(width) + "x" +
                std::to_string(height) + " " + options + " -o " + picture);
        EXPECT_EQ(r.code, 0) << r.output;
        EXPECT_EQ(r.output.find("so it gets a sky"), std::string::npos) << r.output;
        return load_png(picture);
    }
    /// Expects the sky's blocks in a picture, moved to the left by so many, all around.
    static void expect_sky(const Image& picture, int moved) {
        for (int row = 0; row < height / block; ++row)
            for (int column = 0; column < width / block; ++column) {
                const Image::Pixel there = picture.at(column * block + block / 2, row * block + block / 2),
                                   expected = colour((column + moved) % (width / block), row);
                for (std::size_t k = 0; k < 3; ++k)
                    EXPECT_NEAR(there[k], expected[k], 1) << column << ' ' << row << ' ' << k;
            }
    }
    /// A panorama in Radiance HDR, all of one brightness.
    std::string grey_hdr(const std::string& name, int columns, int rows, int exponent) const {
        std::ofstream out(file(name), std::ios::binary);
        out << "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y " << rows << " +X " << columns << "\n";
        for (int i = 0; i < columns * rows; ++i)
            out << char(128) << char(128) << char(128) << char(128 + 1 + exponent);
        return file(name);
    }
};

TEST_F(CliEnvironment, TheImageStandsUprightWithItsMiddleAhead) {
    const std::string sky = "--environment " + file("sky.png");
    expect_sky(seen(sky + " --target 0,0,-1"), 0);
    expect_sky(seen(sky + " --up z --target 0,1,0"), 0);
    expect_sky(seen(sky + " --target -1,0,0"), 6);  // two blocks to the left
}
TEST_F(CliEnvironment, ItTurnsCounterclockwiseFromAbove) {
    const std::string sky = "--environment " + file("sky.png") + " --environment-rotation ";
    expect_sky(seen(sky + "90 --target 0,0,-1"), 2);
    expect_sky(seen(sky + "-45 --up z --target 0,1,0"), 7);
}
TEST_F(CliEnvironment, ItsLightIsLinearAndHasAStrength) {
    // Eight times white, an eighth of that by the strength, and by the exposure.
    const std::string sky = "--target 0,0,-1 --environment " + grey_hdr("sky.hdr", 16, 8, 3);
    for (const char* const less : {" --environment-strength 0.0625", " --exposure -4"})
        EXPECT_NEAR(seen(sky + less).at(20, 9)[0], 188, 1) << less;  // ½ in sRGB
    EXPECT_EQ(seen(sky).at(20, 9)[0], 255);
    EXPECT_EQ(seen(sky + " --environment-strength 0").at(20, 9)[0], 0);
    // It is the only light of a white floor, which reflects what it gets.
    std::ofstream(file("scene.obj"))
        << "mtllib white.mtl\nusemtl white\nv -9 -1 -9\nv 9 -1 -9\nv 0 -1 9\nf 3 2 1\n";
    std::ofstream(file("white.mtl")) << "newmtl white\nKd 1 1 1\nillum 0\n";
    EXPECT_NEAR(seen(sky + " --environment-strength 0.0625", 16).at(32, 30)[0], 188, 3);
}
TEST_F(CliEnvironment, WhatIsNoPanoramaIsRefusedByName) {
    const std::string scene = "render " + file("scene.obj") + " --size 8x4 -o " + file("x.png") + " ",
                      paths = scene + "--shading path --environment ";
    expect_bad(paths + file("none.hdr"), "none.hdr");
    expect_bad(paths + file("scene.obj"), "scene.obj: ");
    expect_failure(0, paths + grey_hdr("square.hdr", 8, 8, 0) + " --spp 1",
                   "square.hdr has 8x8 pixels, where a panorama in latitude and longitude is twice as wide");
    expect_usage(scene + "--environment " + file("sky.png"), "--environment is of paths");
    expect_usage(scene + "--shading path --environment-rotation 5", "needs --environment");
    expect_usage(paths + file("sky.png") + " --environment-strength -1", "--environment-strength");
    expect_usage(paths + file("sky.png") + " --environment-rotation nan", "--environment-rotation");
}
/// A state of paths knows its light.
TEST_F(CliEnvironment, AStateInOtherLightIsRefused) {
    const std::string work = "render " + file("scene.obj") + " --shading path --size 8x4 --spp 1 --resume " +
                             file("state") + " -o " + file("x.png") + " --environment " + file("sky.png");
    EXPECT_EQ(run(work).code, 0);
    expect_bad(work + " --environment-rotation 1", "another scene");
    expect_bad(work + " --environment-strength 2", "another scene");
}
/// The sky of a scene without lights stays above, also for a camera that looks down.
TEST_F(CliEnvironment, TheDefaultSkyDoesNotTiltWithTheCamera) {
    ASSERT_EQ(run("render " + file("scene.obj") + " --shading path --spp 1 --size 9x9 --view top -o " +
                  file("x.png"))
                  .code,
              0);
    EXPECT_NEAR(load_png(file("x.png")).at(0, 0)[0], 144, 8);  // the ground's red, 0.28
}

}  // namespace
