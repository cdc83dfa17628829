/// The questions of the table behind one type: what they say of themselves, and their answers to rows.
#include <gtest/gtest.h>

#include <fstream>
#include <set>
#include <sstream>

#include <hedgerow/any_question.h>
#include <hedgerow/hedgerow.h>
#include <hedgerow/scenes/meshes.h>
#include <hedgerow/scenes/sets.h>

using namespace hedgerow;

namespace {

std::string joined(const std::vector<std::string>& words) {
    std::string all;
    for (const auto& word : words) all += (all.empty() ? "" : " ") + word;
    return all;
}
std::string columns_of(const QuestionInfo& info) {
    std::vector<std::string> names;
    for (const Column& c : info.answered) names.push_back(c.name);
    return joined(names);
}

template <class T, int D>
void expect_described() {
    std::set<std::pair<std::string_view, std::string_view>> names;
    for (const auto* const question : any_questions<T, D>()) {
        const QuestionInfo& info = question->info();
        EXPECT_TRUE(names.insert({info.name, info.variant}).second) << info.name;
        EXPECT_EQ((any_question<T, D>(info.name, info.variant)), question);
        for (const auto text : {info.words, info.meaning, info.function, info.batch})
            EXPECT_FALSE(text.empty()) << info.name;
        for (const auto& name : info.asked.names) EXPECT_NE(meaning_of_column(name), "") << name;
        for (const Column& c : info.answered) EXPECT_NE(meaning_of_column(c.name), "") << c.name;
        EXPECT_EQ(info.lists, info.answered[0].name == "query");
        for (const auto& option : info.options) {
            EXPECT_FALSE(option.values.empty() || option.meaning.empty()) << option.name;
            EXPECT_EQ(info.option(option.name), &option);
        }
        EXPECT_EQ(info.option("colour"), nullptr);
    }
    EXPECT_EQ(names.size(), 21u);
    EXPECT_EQ((any_question<T, D>("closest")), nullptr);
    EXPECT_EQ((any_question<T, D>("nearest", "feature")), nullptr);
}

TEST(AnyQuestion, DescribesItself) {
    expect_described<float, 2>();
    expect_described<float, 3>();
    expect_described<double, 2>();
    expect_described<double, 3>();
    EXPECT_EQ(meaning_of_column("colour"), "");
    const auto& nearest = any_question<float, 3>("nearest")->info();
    EXPECT_TRUE(nearest.option("count")->needed);
    EXPECT_FALSE(nearest.option("radius")->needed);
    EXPECT_EQ(nearest.option("factor")->values, "1..inf");
    EXPECT_TRUE((any_question<float, 3>("within")->info().option("radius")->needed));
    EXPECT_EQ((any_question<double, 2>("side")->info().option("by")->choices.size()), 4u);
    EXPECT_EQ((any_question<double, 2>("winding-number")->info().option("by")->values),
              "crossings|expansion");
}

TEST(AnyQuestion, AnswersRowsWithTheNumbersOfTheReader) {
    const auto mesh = teapot<float>(300);
    const auto index = build_any("wide", mesh);
    std::vector<std::uint32_t> numbers;
    for (std::uint32_t i = 0; i < mesh.size(); ++i) numbers.push_back(1000 + i);
    constexpr float nan = std::numeric_limits<float>::quiet_NaN();
    const float rows[] = {0, 0, 0, 1, 2, 3, nan, 0, 0, 3, 2, 1};
    const auto read = [](const std::string& records, std::size_t at, auto value) {
        std::memcpy(&value, records.data() + at, sizeof(value));
        return value;
    };

    AnsweredRows closest;
    any_question<float, 3>("closest-point")
        ->answer({.index = *index, .numbers = numbers}, rows, 7, 4, closest);
    EXPECT_EQ(closest.rows, 4u);
    EXPECT_EQ(closest.unusable, 1u);
    EXPECT_EQ(closest.first_unusable, 9u);
    ASSERT_EQ(closest.records.size(), 4 * 20u);
    for (const std::size_t i : {0u, 1u, 3u}) {
        const auto near = closest_point(*index, Vec3f(rows[3 * i], rows[3 * i + 1], rows[3 * i + 2]));
        EXPECT_EQ(read(closest.records, 20 * i, std::uint32_t()), 1000 + near.primitive);
        EXPECT_EQ(read(closest.records, 20 * i + 4, float()), distance_of(near));
    }
    EXPECT_EQ(read(closest.records, 40, std::uint32_t()), no_primitive);

    AnsweredRows lists;
    any_question<float, 3>("nearest")->answer({.index = *index, .options = {.count = 2}}, rows, 7, 4, lists);
    EXPECT_EQ(lists.rows, 6u);
    EXPECT_EQ(read(lists.records, 4 * 16, std::uint64_t()), 10u) << "the row without an answer has no list";

    AnsweredRows none;
    const RowsAsked<float, 3> without_solid{.index = *index};
    EXPECT_THROW((any_question<float, 3>("side")->answer(without_solid, rows, 0, 4, none)), UsageError);
    const auto solid = index->make_solid();
    AnsweredRows sides;
    any_question<float, 3>("side")->answer({.index = *index, .solid = solid.get()}, rows, 0, 4, sides);
    EXPECT_EQ(sides.records.size(), 4u);
    EXPECT_EQ(read(sides.records, 2, std::int8_t()), std::int8_t(-128));
}

TEST(AnyQuestion, KnowsWhoAnswers) {
    const auto cloud = points<float>(50);
    const auto index = build_any("kdtree", cloud);
    for (const auto* const question : any_questions<float, 3>()) {
        const auto& info = question->info();
        // A k-d tree walks rays, and finds that they pass between points.
        EXPECT_EQ(question->answered_by(*index), !info.of_facets) << info.name;
    }
}

// The table of docs/queries.md is what the questions say.
TEST(AnyQuestion, IsWhatTheDocumentSays) {
    std::ifstream file(std::string(HEDGEROW_SOURCE) + "/docs/queries.md");
    std::vector<std::vector<std::string>> table;  // the three cells of each row
    for (std::string line; std::getline(file, line);) {
        if (!line.starts_with("| `")) continue;
        std::vector<std::string> cells;
        std::istringstream in(line.substr(2));
        for (std::string cell; std::getline(in, cell, '|');) cells.push_back(cell);
        if (cells[1] == " the same ") cells[1] = table.back()[1];
        table.push_back(cells);
    }
    for (const auto* const question : any_questions<float, 3>()) {
        const QuestionInfo& info = question->info();
        const std::string name = "`" + std::string(info.name) + "`";
        const auto row = std::find_if(table.begin(), table.end(),
                                      [&](const auto& cells) { return cells[0].starts_with(name); });
        ASSERT_NE(row, table.end()) << name << " is not in docs/queries.md";
        std::vector<std::string> asked = info.asked.names;
        if (!info.asked.defaults.empty()) asked[info.asked.required()].insert(0, "["), asked.back() += "]";
        EXPECT_NE((*row)[1].find(joined(asked)), std::string::npos) << name << " reads " << joined(asked);
        // What a feature tells comes after what a closest point does.
        std::string columns = columns_of(info);
        if (info.variant == "feature") columns = columns.substr(columns.find("feature"));
        EXPECT_NE((*row)[2].find(columns), std::string::npos) << name << " answers " << columns;
        for (const auto& option : info.options) {
            if (option.name == "error") continue;  // of `--by expansion`, below the table
            const std::string said = (*row)[0] + (*row)[1];
            EXPECT_NE(said.find("--" + std::string(option.name)), std::string::npos)
                << name << " takes --" << option.name;
        }
    }
}

}  // namespace
