/// States of interrupted work: round trips, and files that are no states, of other work, cut or damaged.
#include <gtest/gtest.h>

#include <array>
#include <filesystem>
#include <fstream>
#include <span>

#include <hedgerow/base/error.h>
#include <hedgerow/io/state_file.h>

namespace hedgerow {
namespace {

using Lines = std::vector<std::pair<std::string, std::string>>;

class States : public testing::Test {
protected:
    States()
        : path_(std::filesystem::temp_directory_path() /
                ("hedgerow_state_" +
                 std::string(testing::UnitTest::GetInstance()->current_test_info()->name()))) {}
    ~States() override { std::filesystem::remove(path_); }

    static WorkState some_state() {
        WorkState state{{{"scene", "a = b"}, {"seed", "7"}, {"camera", ""}}, {}};
        for (int i = 0; i < 300; ++i) state.bytes.push_back(static_cast<std::byte>(i * 7));
        return state;
    }
    /// Saves a state in three parts, one of them empty.
    void save(const WorkState& state) const {
        const std::span<const std::byte> all(state.bytes);
        const std::size_t some = all.size() / 3;
        const std::array parts = {all.first(some), all.first(0), all.subspan(some)};
        save_state(path_, "paths", 3, state.of, parts);
    }
    std::string file() const {
        std::ifstream in(path_, std::ios::binary);
        return {std::istreambuf_iterator<char>(in), {}};
    }
    void write(const std::string& bytes) const {
        std::ofstream out(path_, std::ios::binary);
        out.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    }
    /// The message of the error, or nothing.
    std::string error(const Lines& expected, const char* kind = "paths", std::uint32_t version = 3) const {
        try {
            load_state(path_, kind, version, expected);
        } catch (const InputError& e) {
            return e.what();
        }
        return "";
    }

    const std::filesystem::path path_;
};

TEST_F(States, ComeBackAsTheyWere) {
    const WorkState state = some_state();
    save(state);
    const WorkState again = load_state(path_, "paths", 3, state.of);
    EXPECT_EQ(again.of, state.of);
    EXPECT_EQ(again.bytes, state.bytes);
    save_state(path_, "paths", 3, {}, {});
    EXPECT_TRUE(load_state(path_, "paths", 3, {}).bytes.empty())
        << "a state takes the place of the one before";
}

TEST_F(States, OfOtherWorkAreRefusedByName) {
    save(some_state());
    Lines expected = some_state().of;
    EXPECT_EQ(error(expected), "");
    EXPECT_NE(error(expected, "motion").find("other work: paths, not motion"), std::string::npos);
    EXPECT_NE(error(expected, "paths", 4).find("another version"), std::string::npos);
    expected[1].second = "8";
    EXPECT_NE(error(expected).find("another seed: 7, not 8"), std::string::npos);
    expected[1].second = "7", expected.emplace_back("size", "2x2");
    EXPECT_NE(error(expected).find("size"), std::string::npos);
    EXPECT_THROW(save({{{"a=b", "c"}}, {}}), InputError);
    EXPECT_THROW(save({{{"a", "b\nc"}}, {}}), InputError);
}

TEST_F(States, CutOrDamagedAreRefused) {
    EXPECT_NE(error({}), "") << "there is no file";
    save(some_state());
    const std::string whole = file();
    for (std::size_t length = 0; length < whole.size(); ++length) {
        write(whole.substr(0, length));
        ASSERT_NE(error({}), "") << length;
    }
    for (std::size_t i = 0; i < whole.size(); ++i)
        for (const int bit : {0, 3, 7}) {
            std::string damaged = whole;
            damaged[i] = static_cast<char>(damaged[i] ^ (1 << bit));
            write(damaged);
            ASSERT_NE(error({}), "") << i << ' ' << bit;
        }
    write(whole + "x");
    EXPECT_NE(error({}), "");
    write("hedgerow state paths 3 little 99999999999999 99999999999999\n\n");
    EXPECT_NE(error({}), "");
}

}  // namespace
}  // namespace hedgerow
