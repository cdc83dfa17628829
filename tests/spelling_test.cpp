/// The helper behind "did you mean".
#include <gtest/gtest.h>

#include <array>

#include <hedgerow/base/spelling.h>

namespace hedgerow {
namespace {

constexpr std::array<std::string_view, 5> words = {"teapot", "terrain", "cornell-box", "bvh", "grid"};

TEST(Spelling, CountsEdits) {
    EXPECT_EQ(edit_distance("", ""), 0u);
    EXPECT_EQ(edit_distance("abc", ""), 3u);
    EXPECT_EQ(edit_distance("", "abc"), 3u);
    EXPECT_EQ(edit_distance("kitten", "sitting"), 3u);
    EXPECT_EQ(edit_distance("teapot", "taepot"), 1u);
    EXPECT_EQ(edit_distance("BVH", "bvh"), 0u);
}

TEST(Spelling, SuggestsTheNearestWord) {
    EXPECT_EQ(suggestion("terain", words), " (did you mean 'terrain'?)");
    EXPECT_EQ(suggestion("Teapto", words), " (did you mean 'teapot'?)");
    EXPECT_EQ(suggestion("hbv", words), "");
    EXPECT_EQ(suggestion("bvg", words), " (did you mean 'bvh'?)");
}

TEST(Spelling, SuggestsAWordThatContainsIt) {
    EXPECT_EQ(suggestion("cornell", words), " (did you mean 'cornell-box'?)");
    EXPECT_EQ(suggestion("box", words), " (did you mean 'cornell-box'?)");
}

TEST(Spelling, IsSilentWithoutANearWord) {
    EXPECT_EQ(suggestion("sphere", words), "");
    EXPECT_EQ(suggestion("", words), "");
    EXPECT_EQ(suggestion("teapot", {}), "");
}

}  // namespace
}  // namespace hedgerow
