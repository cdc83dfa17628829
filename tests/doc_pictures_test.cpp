/// Checks that the pictures of documents are those of the commands beside them, pixel by pixel.
///
/// The command of a picture is the one in a document that shows it whose output has the picture's name, or is
/// the folder that the picture is in (`nbody -o clumps` writes clumps/picture-0000016.png). Pictures that no
/// command makes, or none makes twice alike, are listed with the reason. Those that take a minute or more are
/// compared in long runs alone.
///
/// HEDGEROW_REWRITE=1 replaces the pictures that differ (scripts/pictures). Look at them.
#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <map>
#include <regex>

#include "long_runs.h"
#include "tool.h"

namespace {

using namespace hedgerow;
namespace fs = std::filesystem;

const fs::path source = HEDGEROW_SOURCE, folder_of_pictures = source / "docs" / "pictures";

/// Pictures that are compared with no command, by their path in docs/pictures, and why.
const std::map<std::string, std::string> not_compared = {
    {"bench.svg", "shows times"},
    {"bench-avx2.svg", "shows times"},
    {"particles/error.svg", "shows times"},
    {"visibility/terrain.svg", "shows times"},
    {"paths/convergence.svg", "is made by a benchmark, of errors that take hours to measure"},
    {"particles/spheres.png", "is written by the example bouncing_spheres"},
    {"fluids/water.png", "is a frame of a run that takes a minute"},
    {"visibility/points.png", "is written by the block of C++ above it"},
    {"visibility/areas.png", "is written by the block of C++ above it"},
};
/// How the names of pictures begin that take long: light of many samples, particles that move.
const std::vector<std::string> slow = {"paths/", "particles/clumps/", "particles/merger/"};

/// The share of a picture's pixels that may differ. Forces differ in their last bits from one instruction set
/// to another, and motions magnify that. With AVX2 12 of the 160,000 pixels differ from those with AVX-512; a
/// change of all last bits moved 545.
double share_that_may_differ(const std::string& name) {
    return name.starts_with("particles/clumps/") || name.starts_with("particles/merger/") ? 0.01 : 0;
}

/// What the first group of an expression matches in a text, from its beginning to its end.
std::vector<std::string> matches(const std::string& text, const char* expression) {
    const std::regex wanted(expression);
    std::vector<std::string> all;
    for (std::sregex_iterator i(text.begin(), text.end(), wanted), end; i != end; ++i) all.push_back((*i)[1]);
    return all;
}

/// A picture that documents show, and the command that should make it, without the name of its output.
struct Shown {
    std::string name, document, command, output;

    fs::path path() const { return folder_of_pictures / name; }
    /// Where the command writes it.
    fs::path written() const {
        return output == path().filename() ? fs::path(output) : fs::path(output) / path().filename();
    }
    bool is_slow() const {
        return std::any_of(slow.begin(), slow.end(),
                           [&](const auto& begin) { return name.starts_with(begin); });
    }
    friend std::ostream& operator<<(std::ostream& out, const Shown& s) {
        return out << s.name << " in " << s.document;
    }
};

/// Adds the pictures of a document, with their commands if those are there.
void add_pictures(const fs::path& document, std::map<std::string, Shown>& all) {
    const std::string text = bytes_of(document);
    const auto commands =
        matches(text, "(hedgerow (?:draw|render|nbody|particles|flow|compare|bench) [^`\n#]*-o [^ `\n]+)");
    auto shown = matches(text, R"(!\[[^\]]*\]\(([^)]*pictures/[^)]+)\))");
    for (auto& more : matches(text, "<img src=\"([^\"]*pictures/[^\"]+)\"")) shown.push_back(std::move(more));
    for (const std::string& reference : shown) {
        const fs::path path = (document.parent_path() / reference).lexically_normal();
        const std::string name = path.lexically_relative(folder_of_pictures).generic_string();
        Shown& s = all.try_emplace(name, Shown{name, document.filename().string(), "", ""}).first->second;
        for (const std::string& command : commands) {
            const std::size_t output_at = command.rfind(' ') + 1;
            const std::string output = fs::path(command.substr(output_at)).filename().string();
            const bool is_run = command.starts_with("hedgerow nbody gen:") ||
                                command.starts_with("hedgerow particles gen:") ||
                                command.starts_with("hedgerow flow gen:");
            const bool in_folder = is_run && path.parent_path().filename() == output;
            if (path.filename() == output || in_folder)
                s.document = document.filename().string(), s.output = output,
                s.command = command.substr(9, output_at - 9);  // without "hedgerow "
        }
    }
}
const std::vector<Shown>& pictures() {
    static const std::vector<Shown> list = [] {
        std::map<std::string, Shown> all;
        add_pictures(source / "README.md", all);
        for (const auto& entry : fs::directory_iterator(source / "docs"))
            if (entry.path().extension() == ".md") add_pictures(entry.path(), all);
        std::vector<Shown> found;
        for (auto& [name, s] : all) found.push_back(std::move(s));
        return found;
    }();
    return list;
}

TEST(DocPictures, HaveACommandOrAReasonWhyNot) {
    EXPECT_GT(pictures().size(), 50u) << "the pictures are no longer found";
    std::vector<std::string> names;
    for (const Shown& s : pictures()) {
        names.push_back(s.name);
        EXPECT_TRUE(fs::exists(s.path())) << s << " is missing";
        EXPECT_TRUE(!s.command.empty() || not_compared.count(s.name) > 0)
            << s << " has no command, and no reason in not_compared";
    }
    for (const auto& entry : fs::recursive_directory_iterator(folder_of_pictures)) {
        const std::string name = entry.path().lexically_relative(folder_of_pictures).generic_string();
        EXPECT_TRUE(entry.is_directory() || std::count(names.begin(), names.end(), name) == 1)
            << name << " is shown by no document";
    }
}

class DocPicture : public ToolTest, public testing::WithParamInterface<Shown> {
protected:
    /// Compares the pixels, without the notes on how they were made, or the text.
    static bool are_alike(const fs::path& a, const fs::path& b, double may_differ) {
        if (a.extension() != ".png") return bytes_of(a) == bytes_of(b);
        const Image one = load_png(a), other = load_png(b);
        if (one.width != other.width || one.height != other.height) return false;
        std::size_t differing = 0;
        for (std::size_t i = 0; i < one.pixels.size(); ++i) differing += one.pixels[i] != other.pixels[i];
        return static_cast<double>(differing) <= may_differ * static_cast<double>(one.pixels.size());
    }
};

TEST_P(DocPicture, IsThatOfItsCommand) {
    const Shown& s = GetParam();
    if (s.is_slow() && in_long_runs(0, 1) == 1) GTEST_SKIP() << "compared in long runs";
    // The command runs as a reader types it, so that a picture says no more than that of how it was made.
    fs::create_directory_symlink(source / "docs", folder / "docs");
    const auto made =
        run_shell("cd " + folder.string() + " && " HEDGEROW_TOOL_PATH " " + s.command + s.output + " 2>&1");
    ASSERT_EQ(made.code, 0) << s.command << "\n" << made.output;
    const fs::path picture = file(s.written().string());
    ASSERT_TRUE(fs::exists(picture)) << s.command << s.output << " does not write " << s.written();
    if (are_alike(picture, s.path(), share_that_may_differ(s.name))) return;
    if (std::getenv("HEDGEROW_REWRITE") != nullptr)
        fs::copy_file(picture, s.path(), fs::copy_options::overwrite_existing);
    else
        ADD_FAILURE() << s << " is not that of: hedgerow " << s.command << s.output
                      << "\nscripts/pictures makes such pictures anew; look at them";
}

std::vector<Shown> compared_pictures() {
    std::vector<Shown> all;
    for (const Shown& s : pictures())
        if (!s.command.empty() && not_compared.count(s.name) == 0) all.push_back(s);
    return all;
}
INSTANTIATE_TEST_SUITE_P(All, DocPicture, testing::ValuesIn(compared_pictures()), [](const auto& at) {
    std::string name;
    for (const char c : at.param.name) name += std::isalnum(static_cast<unsigned char>(c)) ? c : '_';
    return name;
});

}  // namespace
