/// Images: round trips of PNG, bad input, and cancelled writers.
#include <atomic>

#include <hedgerow/io/exr.h>
#include <hedgerow/io/image.h>

#include "io_support.h"

namespace hedgerow {
namespace {

using namespace testing_io;

TEST(Png, WhatIsSavedIsReadBack) {
    TempFolder folder;
    std::mt19937_64 random(2);
    for (int round = 0; round < 50; ++round) {
        Image image(1 + static_cast<int>(random() % 40), 1 + static_cast<int>(random() % 40));
        for (auto& pixel : image.pixels)
            for (auto& c : pixel) c = static_cast<std::uint8_t>(random());
        save_png(folder / "a.png", image);
        ASSERT_EQ(load_png(folder / "a.png"), image);
    }
    EXPECT_EQ(folder.file_count(), 1u);
    const Image red(3000, 1000, {255, 0, 0});
    save_png(folder / "red.png", red);
    EXPECT_EQ(load_png(folder / "red.png"), red) << "packed most tightly";
}

TEST(Png, StaysAsItWasWhereSavingIsCancelled) {
    TempFolder folder;
    const std::atomic<bool> cancel = true;
    const auto path = folder.file("a.png", "old");
    EXPECT_THROW(save_png(path, Image(9, 9), {{}, &cancel}), Cancelled);
    EXPECT_EQ(contents(path), "old");
    EXPECT_EQ(folder.file_count(), 1u);
}

TEST(Exr, StaysAsItWasWhereSavingIsCancelled) {
    if (!exr_supported()) GTEST_SKIP() << "this build has no OpenEXR";
    TempFolder folder;
    const std::vector<float> values(100 * 100);
    const Layers layers{100, 100, {{"Y", Strided<float>(values)}}};
    std::atomic<bool> cancel = false;
    std::uint64_t told = 0;
    const Progress progress{[&](std::uint64_t done, std::uint64_t total) {
                                EXPECT_EQ(total, 10000u);
                                told = done, cancel = true;
                            },
                            &cancel};
    const auto path = folder.file("a.exr", "old");
    EXPECT_THROW(save_exr(path, layers, progress), Cancelled);
    EXPECT_LT(told, 5000u) << "the rest was not packed";
    EXPECT_EQ(contents(path), "old");
    EXPECT_EQ(folder.file_count(), 1u);
}

TEST(Png, KeepsNotes) {
    TempFolder folder;
    const Image image(30, 20, {1, 2, 3});
    save_png(folder / "a.png", image, {},
             {{"Software", "hedgerow"}, {"Seed", ""}, {"Command", "draw h\u00e4.ply"}});
    EXPECT_EQ(load_png(folder / "a.png"), image);
    const std::string bytes = contents(folder / "a.png");
    const std::string separators(5, '\0');  // of iTXt: word, not compressed, no language, no word in it
    EXPECT_NE(bytes.find("iTXtSoftware" + separators + "hedgerow"), bytes.npos);
    EXPECT_NE(bytes.find("iTXtCommand" + separators + "draw h\u00e4.ply"), bytes.npos);
    for (const Note& note : {Note{"", "a"}, Note{"two words", "a"}, Note{std::string(80, 'a'), "a"},
                             Note{"a", std::string(1, '\0')}})
        expect_input_error(
            [&] {
                save_png(folder / "b.png", image, {}, {{"Seed", "1"}, note});
            },
            {"b.png", "note 2"});
}

TEST(Png, BadInput) {
    TempFolder folder;
    expect_input_error([&] { save_png(folder / "a.png", Image()); }, {"a.png", "0x0"});
    Image odd(2, 2);
    odd.pixels.pop_back();
    expect_input_error([&] { save_png(folder / "a.png", odd); }, {"2x2", "3 pixels"});
    expect_output_error([&] { save_png(folder / "none/a.png", Image(1, 1)); }, {"cannot be written"});
    expect_input_error([&] { load_png(folder / "a.png"); }, {"no such file"});
    expect_input_error([&] { load_png(folder.file("a.png", "")); }, {"empty"});
    expect_input_error([&] { load_png(folder.file("a.png", "GIF89a")); }, {"not a sound PNG"});
    save_png(folder / "b.png", Image(50, 50, {1, 2, 3}));
    const std::string whole = contents(folder / "b.png");
    const std::size_t data_end = whole.size() - 16;  // its checksum (4 bytes) and IEND (12) follow
    for (std::size_t n = 1; n < data_end; ++n)
        expect_input_error([&] { load_png(folder.file("a.png", whole.substr(0, n))); }, {"a.png"});
}

}  // namespace
}  // namespace hedgerow
