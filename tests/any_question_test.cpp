/// The questions of the table behind one type: what they say of themselves, and their answers to rows.
#include <gtest/gtest.h>

#include <set>

#include <hedgerow/any_question.h>
#include <hedgerow/hedgerow.h>
#include <hedgerow/scenes/meshes.h>
#include <hedgerow/scenes/sets.h>

using namespace hedgerow;

namespace {

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
        EXPECT_EQ(question->answered_by(*index), !info.of_facets && !info.of_rays) << info.name;
    }
}

}  // namespace
