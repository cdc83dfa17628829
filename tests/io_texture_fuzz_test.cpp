/// Thousands of damaged images: every outcome is an image of the size that it says, or an InputError.
#include <hedgerow/io/texture_file.h>

#include <hedgerow/io/exr.h>

#include "chart.h"
#include "damage.h"

namespace hedgerow {
namespace {

using namespace testing_chart;
using namespace testing_io;

/// Small enough that no damage makes the test slow.
constexpr PixelLimits limits{.most_pixels = 1 << 16};

/// Decodes an image. Checks the size of what comes of it, or that the error names the image.
bool decodes(const std::string& bytes) {
    try {
        const Pixels pixels = decode_pixels(bytes, "the image", limits);
        const auto count = static_cast<std::size_t>(pixels.width) * static_cast<std::size_t>(pixels.height) *
                           static_cast<std::size_t>(pixels.channels);
        EXPECT_EQ(std::visit([](const auto& s) { return s.size(); }, pixels.samples), count);
        if (const auto* const floats = std::get_if<std::vector<float>>(&pixels.samples)) {
            EXPECT_TRUE(
                std::all_of(floats->begin(), floats->end(), [](float x) { return std::isfinite(x); }));
        }
        return true;
    } catch (const InputError& error) {
        EXPECT_TRUE(std::string_view(error.what()).starts_with("the image: ")) << error.what();
        return false;
    }
}

/// Every byte with every bit flipped, alone, every length, and random damage. Returns how many decode.
int survivors_of(const std::string& whole, int rounds) {
    EXPECT_TRUE(decodes(whole));
    int well = 0;
    const std::size_t step = 1 + whole.size() / 1500;
    for (std::size_t at = 0; at < whole.size(); at += step) {
        decodes(whole.substr(0, at));
        for (int bit = 0; bit < 8; ++bit) {
            std::string changed = whole;
            changed[at] = static_cast<char>(changed[at] ^ (1 << bit));
            well += decodes(changed);
        }
    }
    std::mt19937_64 random(whole.size());
    for (int i = 0; i < rounds; ++i) well += decodes(damaged(whole, random));
    return well;
}

TEST(TextureFuzz, Png) {
    survivors_of(png_chart(8), 500);
    survivors_of(png_chart(16), 500);
    // Damage behind sums that are right.
    const auto with_sums = [](const std::string& header, const std::string& packed) {
        return "\x89PNG\r\n\x1a\n" + png_chunk("IHDR", header) +
               png_chunk("PLTE", text_of({1, 2, 3, 4, 5, 6})) + png_chunk("IDAT", packed) +
               png_chunk("IEND", "");
    };
    const std::string file = png_chart();
    const std::string header = file.substr(16, 13);
    const std::string packed = file.substr(41, file.size() - 41 - 4 - 12);
    ASSERT_TRUE(decodes(with_sums(header, packed)));
    std::mt19937_64 random(1);
    int well = 0;
    for (int i = 0; i < 3000; ++i) {
        std::string changed = header;
        changed[random() % 13] = static_cast<char>(random() % 20);
        well +=
            decodes(with_sums(i % 2 == 0 ? header : changed, i % 3 == 0 ? packed : damaged(packed, random)));
    }
    EXPECT_GT(well, 5);
}

TEST(TextureFuzz, Jpeg) {
    EXPECT_GT(survivors_of(jpeg_chart(), 1000), 50);
    EXPECT_GT(survivors_of(jpeg_chart(TJSAMP_420, TJFLAG_PROGRESSIVE), 1000), 50);
}

TEST(TextureFuzz, Hdr) {
    std::string lines;
    for (int y = 0; y < 4; ++y)
        lines += text_of({2,   2,   0,  9, 131, 128, 134, 64,  3,   32,  32,  32,  134,
                          128, 137, 64, 9, 129, 129, 129, 130, 130, 130, 130, 130, 130});
    EXPECT_GT(survivors_of(hdr("-Y 4 +X 9", lines, "EXPOSURE=2\n"), 3000), 300);
    EXPECT_GT(survivors_of(hdr("+X 3 +Y 2", text_of({9, 8, 7, 128, 1, 1, 1, 1,   9, 8, 7, 129,
                                                     1, 1, 1, 1,   9, 8, 7, 130, 1, 1, 1, 1})),
                           3000),
              300);
}

TEST(TextureFuzz, Exr) {
    if (!exr_supported()) GTEST_SKIP();
    TempFolder folder;
    std::vector<float> values(40 * 30);
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = static_cast<float>(i % 7);
    const Strided<float> channel{std::span<const float>(values)};
    save_exr(folder / "a.exr", {40, 30, {{"R", channel}, {"G", channel}, {"B", channel}, {"A", channel}}});
    EXPECT_GT(survivors_of(contents(folder / "a.exr"), 2000), 100);
}

}  // namespace
}  // namespace hedgerow
