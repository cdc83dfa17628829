/// Comparing structures on figures made up: break-even points, laws of growth, advice, lists of structures
/// and sizes.
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include <hedgerow/any_index.h>
#include <hedgerow/base/error.h>
#include <hedgerow/measure/advice.h>
#include <hedgerow/measure/break_even.h>
#include <hedgerow/measure/growth.h>
#include <hedgerow/measure/lists.h>
#include <hedgerow/measure/quantity.h>
#include <hedgerow/measure/query_set.h>
#include <hedgerow/measure/reason.h>

namespace hedgerow::measure {
namespace {

using When = BreakEven::When;

TEST(BreakEven, IsWhereTheCostsCross) {
    EXPECT_EQ(break_even({8, 1}, {0, 3}), (BreakEven{When::from, 4}));
    EXPECT_EQ(break_even({0, 3}, {8, 1}), (BreakEven{When::until, 4}));
    EXPECT_EQ(break_even({1, 1}, {2, 2}), (BreakEven{When::always, 0}));
    EXPECT_EQ(break_even({1, 1}, {1, 2}), (BreakEven{When::always, 0}));
    EXPECT_EQ(break_even({2, 2}, {1, 1}), (BreakEven{When::never, 0}));
    EXPECT_EQ(break_even({1, 1}, {1, 1}), (BreakEven{When::never, 0}));
    const Cost slow{5, 0.25}, quick{1, 0.75};
    const auto b = break_even(slow, quick);
    EXPECT_EQ(slow.after(b.queries), quick.after(b.queries));
    EXPECT_LT(slow.after(b.queries + 1), quick.after(b.queries + 1));
}

constexpr double sizes[] = {1000, 3000, 10'000, 50'000, 200'000};

TEST(Fits, FindTheParametersOfExactLaws) {
    for (const Law law : {Law::power, Law::logarithm, Law::root, Law::linear, Law::n_log_n})
        for (const int dimension : {2, 3}) {
            const Fit exact{law, dimension, 3.5, law == Law::power ? 0.7 : 1.25, 0};
            std::vector<double> values;
            for (const double n : sizes) values.push_back(exact(n));
            const Fit found = fit(law, sizes, values, dimension);
            // The offset of 3.5 keeps fewer digits beside values of millions.
            EXPECT_NEAR(found.a, exact.a, 1e-6) << name_of(law);
            EXPECT_NEAR(found.b, exact.b, 1e-9) << name_of(law);
            EXPECT_LT(found.residual, 1e-10);
            EXPECT_EQ(fits(sizes, values, dimension).front().law, law) << name_of(law);
        }
}
TEST(Fits, MeanWhatTheySay) {
    EXPECT_DOUBLE_EQ((Fit{Law::power, 3, 2, 0.5, 0})(100), 20);
    EXPECT_DOUBLE_EQ((Fit{Law::logarithm, 3, 1, 2, 0})(1024), 21);
    EXPECT_DOUBLE_EQ((Fit{Law::root, 3, 1, 2, 0})(1000), 21);
    EXPECT_DOUBLE_EQ((Fit{Law::root, 2, 1, 2, 0})(100), 21);
    EXPECT_DOUBLE_EQ((Fit{Law::linear, 3, 1, 2, 0})(10), 21);
    EXPECT_DOUBLE_EQ((Fit{Law::n_log_n, 3, 1, 2, 0})(8), 49);
}
TEST(Fits, SayHowFarTheyMiss) {
    const std::vector<double> at = {1, 2, 3, 4}, values = {1.1, 0.9, 1.1, 0.9};
    const Fit f = fit(Law::linear, at, values);
    double sum = 0;
    for (std::size_t i = 0; i < at.size(); ++i) sum += std::pow(f(at[i]) / values[i] - 1, 2);
    EXPECT_DOUBLE_EQ(f.residual, std::sqrt(sum / 4));
    EXPECT_NEAR(f.residual, 0.1, 0.02);
}

/// A structure with made-up figures: seconds of the build and of a query, bytes, seconds of an update of one
/// or all primitives, and the slowdown of queries after a refit.
StructureCost costing(std::string name, double build, double query, std::size_t bytes, double all,
                      double slowdown = 1) {
    StructureCost s;
    s.structure = std::move(name), s.build_seconds = build, s.bytes = bytes;
    s.queries = {{"closest-hit", "closest hit, coherent rays", 10, query * 0.5},
                 {"closest-hit", "closest hit, random rays", 10, query * 1.5},
                 {"nearest", "8 nearest", 10, 1 / query}};
    s.update.one = s.update.all = all, s.update.slowdown = slowdown;
    return s;
}
const Comparison made_up{"made up",
                         "triangles",
                         1'000'000,
                         3,
                         {costing("none", 0, 1e-3, 10, 0), costing("quick", 0.1, 2e-6, 5000, 0.1),
                          costing("best", 9, 1e-6, 9000, 9), costing("lean", 0.5, 2.9e-6, 100, 0.5),
                          costing("supple", 0.6, 1.5e-6, 8000, 0.01, 1.2)},
                         {},
                         1,
                         true};

TEST(Advice, RestsOnTheFigures) {
    const auto all = advise(made_up, "closest-hit");
    ASSERT_EQ(all.size(), 4u);
    // Each need ranks the structure with the least figure first.
    EXPECT_EQ(all[0].need, "a few queries");
    EXPECT_EQ(all[0].ranking[0].structure, "quick");
    EXPECT_DOUBLE_EQ(all[0].ranking[0].figure, 0.1 + 1000 * 2e-6);
    EXPECT_EQ(all[1].ranking[0].structure, "best");
    EXPECT_DOUBLE_EQ(all[1].ranking[0].figure, 1e-6);
    EXPECT_EQ(all[2].ranking[0].structure, "supple");
    EXPECT_DOUBLE_EQ(all[2].ranking[0].figure, 0.01 + 1e6 * 1.5e-6 * 1.2);
    EXPECT_EQ(all[3].ranking[0].structure, "lean");
    EXPECT_EQ(all[3].ranking.size(), 4u) << "what is too slow is not among them";
    // The engine may be several times as fast as all other structures. A slow and small structure still ranks
    // then.
    Comparison with_engine = made_up;
    with_engine.structures.push_back(costing("engine", 1, 4e-7, 20'000, 1));
    EXPECT_EQ(advise(with_engine, "closest-hit")[3].ranking[0].structure, "lean");
    EXPECT_NE(all[3].reason.find("absurdly slow: none (1,000 times)"), std::string::npos) << all[3].reason;
    // A structure is left out if it is absurdly slow for only one set of rays.
    with_engine.structures.push_back(costing("uneven", 1, 5e-7, 50, 1));
    with_engine.structures.back().queries[0].seconds = 30 * 2e-7;
    EXPECT_EQ(advise(with_engine, "closest-hit")[3].ranking[0].structure, "lean");
    EXPECT_NE(all[0].reason.find("that of best"), std::string::npos) << all[0].reason;
    EXPECT_NE(all[2].reason.find("anew"), std::string::npos) << all[2].reason;
    for (const auto& r : all) {
        EXPECT_TRUE(std::is_sorted(r.ranking.begin(), r.ranking.end(),
                                   [](const auto& a, const auto& b) { return a.figure < b.figure; }));
        EXPECT_FALSE(r.ranking[0].terms.empty());
    }
}
/// A structure with made-up counts: its items and leaves, and the nodes, leaves and tests of a query.
StructureCost counting(std::string name, std::size_t items, std::size_t leaves, double nodes_met,
                       double leaves_met, double tests) {
    StructureCost s;
    s.structure = std::move(name), s.nodes = leaves == 1 ? 0 : leaves, s.leaves = leaves, s.items = items;
    s.queries = {{"closest-hit", "closest hit, coherent rays", 10, 1e-6, 0, nodes_met, leaves_met, tests, 0}};
    return s;
}
TEST(Advice, GivesAReasonFromTheCounts) {
    Comparison c{"made up", "triangles", 10'000, 3, {}, {}, 1, true};
    const auto said = [&](const StructureCost& s) { return reason(s, c, "closest-hit"); };
    EXPECT_EQ(said(counting("brute-force", 10'000, 1, 0, 1, 10'000)),
              "10,000 tests a query of all 10,000 triangles");
    EXPECT_EQ(
        said(counting("grid", 30'000, 10'000, 9.9, 7, 1'568)),
        "1,568 tests a query: a leaf that it looks into holds 224 triangles, a leaf on the mean 3, so the "
        "detail lies in few leaves");
    EXPECT_EQ(said(counting("kdtree", 250'000, 50'000, 50, 4, 21.5)),
              "50 nodes and 21.5 tests a query: each of the triangles stands in 25 leaves");
    EXPECT_EQ(said(counting("bvh", 10'000, 3'000, 20, 1.5, 4.5)), "20 nodes and 4.50 tests a query");
    EXPECT_NE(said(counting("wide:width=8", 10'000, 3'000, 5, 1.5, 9)).find("vector instructions"),
              std::string::npos);

    c.structures = {counting("bvh", 10'000, 3'000, 20, 1.5, 4.5),
                    counting("grid", 30'000, 10'000, 9.9, 7, 1'568)};
    c.structures[1].queries[0].seconds = 4e-6;
    const std::string why = advise(c, "closest-hit")[1].reason;
    EXPECT_NE(why.find("grid takes 4 times as long with 1,568 tests"), std::string::npos) << why;
}
TEST(Advice, RanksTheLeastSlowWhereEachStructureIsSlowForSomeRays) {
    Comparison c = made_up;
    c.structures = {costing("one", 1, 1, 500, 1), costing("other", 1, 1, 100, 1)};
    for (std::size_t i = 0; i < 2; ++i) {
        c.structures[i].queries[0].seconds = i == 0 ? 1 : 20;
        c.structures[i].queries[1].seconds = i == 0 ? 20 : 1;
    }
    const auto memory = advise(c, "closest-hit")[3];
    ASSERT_EQ(memory.ranking.size(), 2u);
    EXPECT_EQ(memory.ranking[0].structure, "other");
    EXPECT_NE(memory.rule.find("at most 20 times"), std::string::npos) << memory.rule;
}
TEST(Advice, IsForTheQueryThatIsAsked) {
    EXPECT_EQ(advise(made_up, "nearest")[1].ranking[0].structure, "none");
    EXPECT_EQ(advise(made_up, "closest-hit", {.few = 1})[0].ranking[0].structure, "none");
    EXPECT_EQ(advise(made_up, "closest-hit", {.slack = 1.1})[3].ranking[0].structure, "best");
    EXPECT_TRUE(advise({}, "nearest").empty());
    EXPECT_EQ(usual_ask(made_up), "closest-hit");
    EXPECT_EQ(usual_ask({}), "nearest");
}

TEST(Growth, FindsTheLawOfEachFigure) {
    std::vector<Comparison> by_size;
    for (const double n : sizes) {
        Comparison c;
        c.size = static_cast<std::size_t>(n);
        StructureCost s;
        s.structure = "s", s.build_seconds = 1e-9 * n * std::log2(n);
        s.queries = {{"closest-hit", "", 1, 1e-7 * std::cbrt(n), 0, 2 + std::log2(n)}};
        c.structures = {s};
        by_size.push_back(c);
    }
    const auto all = growth_of(by_size, "closest-hit");
    ASSERT_EQ(all.size(), 3u) << "it tested no primitive, so that figure has no law";
    EXPECT_EQ(all[0].fits.front().law, Law::n_log_n);
    for (const Fit& f : all[1].fits) {
        EXPECT_EQ(f.residual < 1e-9, f.law == Law::power || f.law == Law::root) << name_of(f.law);
    }
    EXPECT_EQ(all[2].fits.front().law, Law::logarithm);
    EXPECT_TRUE(growth_of(std::span(by_size).first(2), "closest-hit").empty());
}

TEST(Quantities, HaveThreeDigitsAndAUnit) {
    EXPECT_EQ(seconds_text(1.5e-3), "1.50 ms");
    EXPECT_EQ(seconds_text(812.4e-9), "812 ns");
    EXPECT_EQ(seconds_text(0.9999e-6), "1.00 us");
    EXPECT_EQ(seconds_text(1e-5), "10 us");
    EXPECT_EQ(seconds_text(123.4), "123 s");
    EXPECT_EQ(seconds_text(0), "0 ns");
    EXPECT_EQ(bytes_text(1.72e6), "1.72 MB");
    EXPECT_EQ(count_text(121), "121");
    EXPECT_EQ(count_text(5993), "5.99k");
    EXPECT_EQ(count_text(1'200'000), "1.20M");
    EXPECT_EQ(number_text(0.01234), "0.0123");
    EXPECT_EQ(number_text(12345.6), "12,346");
    EXPECT_EQ(number_text(1234567), "1,234,567");
    EXPECT_EQ(number_text(-4.5), "-4.50");
    EXPECT_EQ(number_text(1.5e-9), "1.50e-09");
}

using Strings = std::vector<std::string>;

TEST(Lists, AreTakenApartWhereStructuresBegin) {
    EXPECT_EQ(structures_of("grid,bvh:builder=sweep,bins=8,kdtree"),
              (Strings{"grid", "bvh:builder=sweep,bins=8", "kdtree"}));
    EXPECT_EQ(structures_of("bvh,bins=8"), Strings{"bvh:bins=8"});
    EXPECT_THROW(structures_of("grid,,bvh"), InputError);
    EXPECT_THROW(structures_of(""), InputError);
    EXPECT_THROW(structures_of("bins=8"), InputError);
}
TEST(Lists, SweepOneOption) {
    const Sweep range = sweep_of("grid:resolution=8..256");
    EXPECT_EQ(range.structure, "grid");
    EXPECT_EQ(range.option, "resolution");
    EXPECT_EQ(range.values, (Strings{"8", "16", "32", "64", "128", "256"}));
    EXPECT_EQ(range.structures[1], "grid:resolution=16");
    const Sweep list = sweep_of("bvh:bins=8,builder=binned,sweep,reinsertion=1");
    EXPECT_EQ(list.structure, "bvh:bins=8,reinsertion=1");
    EXPECT_EQ(list.values, (Strings{"binned", "sweep"}));
    EXPECT_EQ(list.structures[1], "bvh:bins=8,reinsertion=1,builder=sweep");
    EXPECT_EQ(sweep_of("grid:density=0.5..4").values, (Strings{"0.5", "1", "2", "4"}));
    for (const char* bad :
         {"grid", "grid:", "grid:resolution=8", "grid:8..16", "grid:resolution=16..8", "grid:resolution=a..b",
          "grid:resolution=1,2,density=1,2", "grid:=1,2", "grid:resolution=1,,2"})
        EXPECT_THROW(sweep_of(bad), InputError) << bad;
}
TEST(Lists, HaveRangesWithBothEnds) {
    EXPECT_EQ(range_of("0..4"), (std::vector<double>{0, 1, 2, 3, 4}));
    EXPECT_EQ(range_of("1..1k").back(), 1000);
    EXPECT_EQ(range_of("3..100"), (std::vector<double>{3, 6, 12, 24, 48, 100}));
    EXPECT_EQ(range_of("0..0.8").size(), 9u);
    EXPECT_EQ(sizes_of("1k,4000,2M"), (std::vector<std::uint64_t>{1000, 4000, 2'000'000}));
    EXPECT_EQ(sizes_of("1000..8000"), (std::vector<std::uint64_t>{1000, 2000, 4000, 8000}));
    for (const char* bad : {"", "5,4", "1.5,2", "0,1", "x", "1,2,", "8..1"})
        EXPECT_THROW(sizes_of(bad), InputError) << bad;
}
TEST(Lists, NameStructuresThatCanBeBuilt) {
    for (const int dimension : {2, 3})
        for (const std::size_t size : {std::size_t{10}, std::size_t{100'000'000}}) {
            Strings left_out, usual = usual_structures(dimension, true, size, left_out);
            EXPECT_EQ(left_out.empty(), size == 10);
            usual.insert(usual.end(), left_out.begin(), left_out.end());
            for (const auto& info : structure_list())
                EXPECT_EQ(std::count(usual.begin(), usual.end(), info.name),
                          info.dimension == 0 || info.dimension == dimension)
                    << info.name;
            for (const auto& s : usual) {
                if (dimension == 2)
                    EXPECT_EQ(build_any(s, PointCloud<float, 2>{{{0, 0}, {1, 0}}}.view())->size(), 2u) << s;
                else
                    EXPECT_EQ(build_any(s, PointCloud<float, 3>{{{0, 0, 0}, {1, 0, 0}}}.view())->size(), 2u)
                        << s;
            }
        }
}

TEST(Fingerprint, TellsAnswersApart) {
    const auto print = [](const auto& answer) {
        Fingerprint f;
        f.add(answer);
        return f.value();
    };
    Hit<float> hit;
    hit.t = 0.f;
    const auto first = print(hit);
    hit.t = -0.f;
    EXPECT_EQ(print(hit), first);
    hit.primitive = 7;
    EXPECT_NE(print(hit), first);
    hit = {};
    hit.t = std::nextafter(0.f, 1.f);
    EXPECT_NE(print(hit), first);
    EXPECT_NE(print(true), print(false));
    EXPECT_NE(print(std::vector<PrimitiveId>{1}), print(std::vector<PrimitiveId>{1, 1}));
}

}  // namespace
}  // namespace hedgerow::measure
