/// Images as textures: the exact samples of every format, and files that are damaged or promise too much.
#include <hedgerow/io/texture_file.h>

#include <hedgerow/io/exr.h>

#include "chart.h"
#include "io_support.h"

namespace hedgerow {
namespace {

using namespace testing_chart;
using namespace testing_io;

template <class U>
std::vector<U> samples(const Pixels& pixels) {
    const auto* const values = std::get_if<std::vector<U>>(&pixels.samples);
    if (values == nullptr) ADD_FAILURE() << "samples of another type";
    return values == nullptr ? std::vector<U>() : *values;
}

Texture texture_of(Pixels pixels, ColourSpace space) {
    Texture texture;
    texture.pixels = std::make_shared<Pixels>(std::move(pixels));
    texture.space = space;
    texture.filter = TextureFilter::nearest;
    return texture;
}

/// Whether every patch has its exact linear value in the middle of its place.
void expect_chart(const Texture& texture, float error = 0) {
    for (int i = 0; i < columns * rows; ++i) {
        const int column = i % columns, row = i / columns;
        const Vec2f middle((static_cast<float>(column) + 0.5f) / columns,
                           (static_cast<float>(row) + 0.5f) / rows);
        const Rgba seen = texture.at(middle);
        for (int k = 0; k < 3; ++k)
            EXPECT_NEAR(seen.colour[k],
                        linear(patches[static_cast<std::size_t>(i)][static_cast<std::size_t>(k)]), error)
                << "patch " << i << ", component " << k;
        EXPECT_EQ(seen.alpha, 1);
    }
}

TEST(Png, ChartsComeOutExactly) {
    const Pixels eight = decode_pixels(png_chart(8), "a.png");
    EXPECT_EQ(eight.channels, 3);
    EXPECT_EQ(samples<std::uint8_t>(eight).size(), 72u);
    expect_chart(texture_of(eight, ColourSpace::srgb));
    const Pixels sixteen = decode_pixels(png_chart(16), "a.png");
    EXPECT_EQ(samples<std::uint16_t>(sixteen)[1], 82 * 257) << "16 bits, in the machine's order";
    expect_chart(texture_of(sixteen, ColourSpace::srgb));
}

TEST(Png, EveryKindOfSample) {
    const std::string name = "a.png";
    // Grey of 1 bit: white, black, white.
    const Pixels bits = decode_pixels(png(3, 1, 1, 0, text_of({0xA0}), 1), name);
    EXPECT_EQ(bits.channels, 1);
    EXPECT_EQ(samples<std::uint8_t>(bits), (std::vector<std::uint8_t>{255, 0, 255}));
    // Grey and opacity, of 8 and 16 bits.
    const Pixels grey = decode_pixels(png(1, 2, 8, 4, text_of({7, 9, 200, 255}), 2), name);
    EXPECT_EQ(grey.channels, 2);
    EXPECT_EQ(samples<std::uint8_t>(grey), (std::vector<std::uint8_t>{7, 9, 200, 255}));
    const Pixels deep = decode_pixels(png(1, 1, 16, 4, text_of({1, 2, 3, 4}), 4), name);
    EXPECT_EQ(samples<std::uint16_t>(deep), (std::vector<std::uint16_t>{258, 772}));
    // Colours with opacity: colours below an opacity of 0 stay.
    const Pixels rgba = decode_pixels(png(1, 1, 8, 6, text_of({1, 2, 3, 0}), 4), name);
    EXPECT_EQ(rgba.channels, 4);
    EXPECT_EQ(samples<std::uint8_t>(rgba), (std::vector<std::uint8_t>{1, 2, 3, 0}));
    // A palette of two colours, of which the second is half transparent.
    const std::string palette =
        png_chunk("PLTE", text_of({9, 8, 7, 40, 50, 60})) + png_chunk("tRNS", text_of({255, 128}));
    const Pixels named = decode_pixels(png(2, 1, 8, 3, text_of({1, 0}), 2, palette), name);
    EXPECT_EQ(samples<std::uint8_t>(named), (std::vector<std::uint8_t>{40, 50, 60, 128, 9, 8, 7, 255}));
    // Interlaced: the first pass has the left pixel, the sixth the right one.
    const Pixels passes = decode_pixels(png(2, 1, 8, 0, text_of({5, 6}), 1, "", true), name);
    EXPECT_EQ(samples<std::uint8_t>(passes), (std::vector<std::uint8_t>{5, 6}));
    // A chunk of gamma changes nothing.
    const std::string gamma = png_chunk("gAMA", big_endian(100000));
    EXPECT_EQ(samples<std::uint8_t>(decode_pixels(png(1, 1, 8, 0, text_of({77}), 1, gamma), name))[0], 77);
}

TEST(Png, DamageAndPromises) {
    const std::string whole = png_chart();
    for (std::size_t size = 4; size < whole.size(); ++size)
        expect_input_error([&] { decode_pixels(whole.substr(0, size), "cut.png"); }, {"cut.png", "PNG"});
    const std::string huge = png(100000, 100000, 8, 2, text_of({1, 2, 3}), 3);
    expect_input_error([&] { decode_pixels(huge, "huge.png"); }, {"huge.png", "100000x100000"});
    const std::string large = png(20000, 20000, 1, 0, std::string(2500 * 20000, '\0'), 2500);
    expect_input_error([&] { decode_pixels(large, "large.png"); },
                       {"large.png", "20000x20000", "no more than 268435456", "most_pixels"});
    expect_input_error([&] { decode_pixels(whole, "small.png", {.most_pixels = 23}); }, {"6x4", "than 23"});
    EXPECT_EQ(decode_pixels(whole, "fits.png", {.most_pixels = 24}).width, 6);
}

TEST(Jpeg, ChartsAreWithinTheFormatsRounding) {
    // Where the slope of the transfer function is steepest, a level of 8 bits is 0.009.
    for (const int flags : {0, TJFLAG_PROGRESSIVE}) {
        const Pixels pixels = decode_pixels(jpeg_chart(TJSAMP_444, flags), "a.jpg");
        EXPECT_EQ(pixels.width, 96);
        EXPECT_EQ(pixels.channels, 3);
        const auto values = samples<std::uint8_t>(pixels);
        for (std::size_t i = 0; i < values.size(); i += 3) {
            const std::size_t x = i / 3 % 96, y = i / 3 / 96;
            for (std::size_t k = 0; k < 3; ++k)
                EXPECT_NEAR(values[i + k], patches[y / 16 * columns + x / 16][k], 1);
        }
    }
    const Pixels grey = decode_pixels(jpeg_chart(TJSAMP_GRAY, 0, TJPF_GRAY), "a.jpg");
    EXPECT_EQ(grey.channels, 1);
    EXPECT_NEAR(samples<std::uint8_t>(grey)[0], 82, 1);
}

TEST(Jpeg, DamageAndPromises) {
    const std::string whole = jpeg_chart();
    for (std::size_t size = 3; size + 2 < whole.size(); size += 1 + size / 40)
        expect_input_error([&] { decode_pixels(whole.substr(0, size), "cut.jpg"); }, {"cut.jpg", "JPEG"});
    // Some cameras leave bytes between markers.
    const auto table = whole.find("\xFF\xC4");
    std::string stray = whole;
    stray.insert(table, "stray");
    EXPECT_EQ(samples<std::uint8_t>(decode_pixels(stray, "stray.jpg")),
              samples<std::uint8_t>(decode_pixels(whole, "a.jpg")));
    // Another size in the header: height and width are 5 bytes behind the marker.
    const auto frame = whole.find("\xFF\xC0");
    std::string huge = whole;
    huge.replace(frame + 5, 4, text_of({0xEA, 0x60, 0xEA, 0x60}));
    expect_input_error([&] { decode_pixels(huge, "huge.jpg"); }, {"huge.jpg", "60000x60000", "no more than"});
    expect_input_error([&] { decode_pixels(jpeg_chart(TJSAMP_444, 0, TJPF_CMYK), "print.jpg"); },
                       {"print.jpg", "CMYK"});
}

TEST(Hdr, ValuesAreMantissaAndExponent) {
    // 1 is 128 · 2^(129 − 136).
    const std::string two = text_of({128, 64, 0, 129, 3, 255, 1, 140});
    const auto values = samples<float>(decode_pixels(hdr("-Y 1 +X 2", two), "a.hdr"));
    EXPECT_EQ(values, (std::vector<float>{1, 0.5f, 0, 48, 4080, 16}));
    const auto exposed = decode_pixels(hdr("-Y 1 +X 2", two, "EXPOSURE=2\nEXPOSURE= 0.25\n"), "a.hdr");
    EXPECT_EQ(samples<float>(exposed), (std::vector<float>{2, 1, 0, 96, 8160, 32}));
    const auto dim = decode_pixels(hdr("-Y 1 +X 2", two, "EXPOSURE=1e-300\n"), "a.hdr");
    EXPECT_EQ(samples<float>(dim)[0], 65504) << "what no float holds";
    const auto extremes = decode_pixels(hdr("-Y 1 +X 2", text_of({255, 1, 0, 255, 9, 9, 9, 0})), "a.hdr");
    EXPECT_EQ(samples<float>(extremes)[0], 255 * 0x1p119f);
    EXPECT_EQ(samples<float>(extremes)[3], 0) << "an exponent of 0 is black";
}

TEST(Hdr, ChartsHaveAllTheBitsOfTheFormat) {
    std::string pixels;
    for (const Colour& c : patches) {
        int exponent = 0;
        const float most = std::max({linear(c[0]), linear(c[1]), linear(c[2])});
        std::frexp(most, &exponent);
        for (const std::uint8_t k : c)
            pixels += static_cast<char>(std::lround(std::ldexp(linear(k), 8 - exponent)));
        pixels += static_cast<char>(exponent + 128);
    }
    expect_chart(texture_of(decode_pixels(hdr("-Y 4 +X 6", pixels), "a.hdr"), ColourSpace::srgb), 1 / 512.f);
}

TEST(Hdr, BothRunLengthEncodings) {
    std::vector<float> expected;
    for (int i = 0; i < 9; ++i)
        expected.insert(expected.end(), {1, static_cast<float>(i < 3 ? 0.25 : 2), 0.5f});
    const std::string a = text_of({128, 32, 64, 129}), b = text_of({64, 128, 32, 130});
    const auto of = [](const std::string& pixels) {
        return samples<float>(decode_pixels(hdr("-Y 1 +X 9", pixels), "a.hdr"));
    };
    const std::string flat = a + a + a + b + b + b + b + b + b;
    EXPECT_EQ(of(flat), expected);
    EXPECT_EQ(of(a + text_of({1, 1, 1, 2}) + b + text_of({1, 1, 1, 4}) + b), expected) << "old";
    const std::string planes =
        text_of({2,       2,   0,       9,                              // the length
                 128 + 3, 128, 128 + 6, 64,                             // red in two runs
                 3,       32,  32,      32,      128 + 6, 128,          // green, three literally
                 2,       64,  64,      128 + 1, 64,      128 + 6, 32,  // blue
                 9,       129, 129,     129,     130,     130,     130, 130, 130, 130});
    EXPECT_EQ(of(planes), expected) << "new";
    // The digits of a long old run: 1 + 0x0103 pixels.
    const std::string long_run = a + text_of({1, 1, 1, 3, 1, 1, 1, 1});
    const auto many = samples<float>(decode_pixels(hdr("-Y 1 +X 260", long_run), "a.hdr"));
    EXPECT_EQ(many.size(), 780u);
    EXPECT_EQ(many[779], 0.5f);
}

TEST(Hdr, EveryOrientation) {
    // The picture has rows (1 2 3) and (4 5 6).
    const auto of = [](const std::string& size, std::initializer_list<int> greys) {
        std::string pixels;
        for (const int g : greys) pixels += text_of({g + 1, g + 1, g + 1, 136});
        const Pixels read = decode_pixels(hdr(size, pixels), "a.hdr");
        EXPECT_EQ(read.width, 3) << size;
        EXPECT_EQ(read.height, 2) << size;
        std::vector<int> seen;
        for (std::size_t i = 0; i < 6; ++i) seen.push_back(static_cast<int>(samples<float>(read)[3 * i]) - 1);
        EXPECT_EQ(seen, (std::vector<int>{1, 2, 3, 4, 5, 6})) << size;
    };
    of("-Y 2 +X 3", {1, 2, 3, 4, 5, 6});
    of("-Y 2 -X 3", {3, 2, 1, 6, 5, 4});
    of("+Y 2 +X 3", {4, 5, 6, 1, 2, 3});
    of("+Y 2 -X 3", {6, 5, 4, 3, 2, 1});
    of("+X 3 -Y 2", {1, 4, 2, 5, 3, 6});
    of("+X 3 +Y 2", {4, 1, 5, 2, 6, 3});
    of("-X 3 -Y 2", {3, 6, 2, 5, 1, 4});
    of("-X 3 +Y 2", {6, 3, 5, 2, 4, 1});
}

TEST(Hdr, DamageAndPromises) {
    const auto refuse = [](const std::string& file, std::vector<std::string> parts) {
        parts.insert(parts.begin(), "bad.hdr");
        expect_input_error([&] { decode_pixels(file, "bad.hdr"); }, parts);
    };
    const std::string whole = hdr("-Y 1 +X 2", text_of({128, 64, 0, 129, 3, 255, 1, 140}));
    for (std::size_t size = 2; size < whole.size(); ++size) refuse(whole.substr(0, size), {"etch it again"});
    refuse(hdr("-Y 100000 +X 100000", "x"), {"100000x100000", "no more than"});
    refuse(hdr("-Y 0 +X 2", "x"), {"2x0"});
    refuse(hdr("-Y 2 +Y 2", "x"), {"in Y alone"});
    refuse(hdr("-Y 2 +X two", "x"), {"where its size should stand"});
    refuse("#?RADIANCE\nFORMAT=32-bit_rle_xyze\n\n-Y 1 +X 1\n1234", {"32-bit_rle_xyze", "ra_xyze"});
    refuse(hdr("-Y 1 +X 1", "1234", "EXPOSURE=0\n"), {"exposure", "'0'"});
    refuse(hdr("-Y 1 +X 9", text_of({2, 2, 0, 8})), {"line 0", "a length of its own"});
    refuse(hdr("-Y 1 +X 9", text_of({2, 2, 0, 9, 138, 1})), {"run of 10", "9 are left"});
    refuse(hdr("-Y 1 +X 9", text_of({2, 2, 0, 9, 0})), {"run of 0"});
    refuse(hdr("-Y 1 +X 9", text_of({1, 1, 1, 3})), {"beyond its line"});
    refuse(hdr("-Y 1 +X 9", text_of({9, 9, 9, 9, 1, 1, 1, 9})), {"beyond its line"});
}

TEST(Exr, ChartsComeOutExactly) {
    if (!exr_supported()) GTEST_SKIP();
    TempFolder folder;
    std::vector<std::vector<float>> values(3);
    for (const Colour& c : patches)
        for (std::size_t k = 0; k < 3; ++k) values[k].push_back(linear(c[k]));
    values[0][23] = -0.5f, values[1][23] = 70000, values[2][23] = std::nanf("");
    Layers layers{columns, rows, {}};
    for (std::size_t k = 0; k < 3; ++k)
        layers.channels.push_back({std::string(1, "RGB"[k]), Strided<float>(std::span(values[k]))});
    save_exr(folder / "a.exr", layers);
    const Pixels pixels = load_pixels(folder / "a.exr");
    EXPECT_EQ(pixels.channels, 3);
    const auto seen = samples<float>(pixels);
    for (std::size_t i = 0; i < 23; ++i)
        for (std::size_t k = 0; k < 3; ++k) EXPECT_EQ(seen[3 * i + k], values[k][i]);
    EXPECT_EQ(seen[69], -0.5f);
    EXPECT_EQ(seen[70], 70000);
    EXPECT_EQ(seen[71], 0) << "NaN";
}

TEST(Exr, OpacityAndGrey) {
    if (!exr_supported()) GTEST_SKIP();
    TempFolder folder;
    const std::vector<float> y{0.25f, 3}, a{0.5f, 0};
    save_exr(folder / "a.exr",
             {2, 1, {{"Y", Strided<float>(std::span(y))}, {"A", Strided<float>(std::span(a))}}});
    const Pixels grey = load_pixels(folder / "a.exr");
    EXPECT_EQ(grey.channels, 2);
    EXPECT_EQ(samples<float>(grey), (std::vector<float>{0.5f, 0.5f, 3, 0})) << "not premultiplied";
    const float infinity = std::numeric_limits<float>::infinity();
    const std::vector<float> wild{infinity, -infinity};
    save_exr(folder / "b.exr", {2, 1, {{"Y", Strided<float>(std::span(wild))}}});
    EXPECT_EQ(samples<float>(load_pixels(folder / "b.exr")), (std::vector<float>{65504, -65504}));
    save_exr(folder / "c.exr", {2, 1, {{"depth", Strided<float>(std::span(y))}}});
    expect_input_error([&] { load_pixels(folder / "c.exr"); }, {"c.exr", "'depth'", "R, G and B"});
}

TEST(Exr, ThePictureIsTheDisplayWindow) {
    if (!exr_supported()) GTEST_SKIP();
    TempFolder folder;
    std::vector<float> y(6);
    for (std::size_t i = 0; i < y.size(); ++i) y[i] = static_cast<float>(i + 1);
    save_exr(folder / "a.exr", {3, 2, {{"Y", Strided<float>(std::span(y))}}});
    // Show columns 1 to 3 and rows -1 to 0 of the pixels, which have columns 0 to 2 and rows 0 to 1.
    std::string bytes = contents(folder / "a.exr");
    const std::string window = std::string("displayWindow\0box2i\0", 20) + text_of({16, 0, 0, 0});
    const auto place = bytes.find(window);
    ASSERT_NE(place, bytes.npos);
    bytes.replace(place + window.size(), 16,
                  text_of({1, 0, 0, 0, 255, 255, 255, 255, 3, 0, 0, 0, 0, 0, 0, 0}));
    const Pixels pixels = decode_pixels(bytes, "a.exr");
    EXPECT_EQ(pixels.width, 3);
    EXPECT_EQ(samples<float>(pixels), (std::vector<float>{0, 0, 0, 2, 3, 0}));
}

TEST(Exr, DamageAndPromises) {
    if (!exr_supported()) GTEST_SKIP();
    TempFolder folder;
    const std::vector<float> y(64, 0.5f);
    save_exr(folder / "a.exr", {8, 8, {{"Y", Strided<float>(std::span(y))}}});
    const std::string whole = contents(folder / "a.exr");
    EXPECT_EQ(decode_pixels(whole, "a.exr").width, 8);
    for (std::size_t size = 4; size < whole.size(); size += 1 + size / 50)
        expect_input_error([&] { decode_pixels(whole.substr(0, size), "cut.exr"); }, {"cut.exr"});
    // Windows of 2^31 lines, and of a width of 100,000 lines and columns.
    for (const std::string window : {"dataWindow", "displayWindow"}) {
        const auto place = whole.find(window) + window.size() + 1 + 6 + 4;  // "box2i", and the size
        std::string huge = whole;
        for (const std::size_t k : {8u, 12u}) huge.replace(place + k, 4, text_of({0x9F, 0x86, 0x01, 0}));
        expect_input_error([&] { decode_pixels(huge, "huge.exr"); },
                           {"huge.exr", "100000x100000", "no more"});
        huge.replace(place, 8, text_of({0, 0, 0, 0x80, 0, 0, 0, 0x80}));
        expect_input_error([&] { decode_pixels(huge, "huge.exr"); }, {"huge.exr", "no more than"});
        std::string empty = whole;
        empty.replace(place + 8, 4, text_of({0xFF, 0xFF, 0xFF, 0xFF}));
        expect_input_error([&] { decode_pixels(empty, "empty.exr"); }, {"empty.exr", "0x8"});
    }
}

TEST(Images, OthersAreRefusedByName) {
    TempFolder folder;
    expect_input_error([&] { decode_pixels("GIF89a", "a.gif"); }, {"a.gif", "'GIF89a'", "PNG, JPEG"});
    expect_input_error([&] { decode_pixels("", "a"); }, {"a: begins with ''"});
    expect_input_error([&] { load_pixels(folder / "none.png"); }, {"none.png", "no such file"});
    EXPECT_EQ(load_pixels(folder.file("misnamed.jpg", png_chart())).width, 6) << "by the bytes, not the name";
}

}  // namespace
}  // namespace hedgerow
