/// `hedgerow query`: every kind against the library.
#include <hedgerow/columns.h>
#include <hedgerow/hedgerow.h>
#include <hedgerow/io/npy.h>
#include <hedgerow/io/rows.h>
#include <hedgerow/scenes/generate.h>
#include <hedgerow/scenes/random.h>

#include <nlohmann/json.hpp>

#include "query_tool.h"

namespace {

using namespace hedgerow;
namespace fs = std::filesystem;
using Query = QueryTest;

template <class Answer>
inline constexpr bool is_list = false;
template <class Item>
inline constexpr bool is_list<std::vector<Item>> = true;

/// Collects numbers in double.
struct Numbers {
    std::vector<double> all;
    template <class N>
    void operator()(std::string_view, N number) {
        all.push_back(static_cast<double>(number));
    }
};
struct Names {
    std::vector<std::string> all;
    template <class N>
    void operator()(std::string_view name, N) {
        all.emplace_back(name);
    }
};

/// The numbers that a question's answers have in a file, by the library.
template <class Question, class T, int D>
std::vector<double> answers_of(const AnyIndex<T, D>& index, const std::vector<T>& rows,
                               const RowOptions& options, std::vector<std::string>& names) {
    using Given = typename Question::Given;
    using Answer = typename Question::Answer;
    const std::size_t columns = RowsOf<Given>::columns().size();
    Numbers numbers;
    Names all;
    if constexpr (is_list<Answer>) {
        all("query", 0), list_item_columns(index, typename Answer::value_type(), all);
        for (std::size_t i = 0; i < rows.size() / columns; ++i) {
            Answer found;
            Visits visits;
            Question::ask(index, RowsOf<Given>::of(&rows[i * columns], options), found, visits);
            for (const auto& item : found) numbers("query", i), list_item_columns(index, item, numbers);
        }
    } else {
        list_answer<Question>(Answer(), all);
        for (std::size_t i = 0; i < rows.size() / columns; ++i) {
            const Given given = RowsOf<Given>::of(&rows[i * columns], options);
            Answer answer[1];
            if constexpr (AsksMany<Question>)
                Question::ask_all(index, std::span(&given, 1), std::span(answer));
            else
                Question::ask(index, given, answer[0]);
            list_answer<Question>(answer[0], numbers);
        }
    }
    names = all.all;
    return numbers.all;
}

/// Compares the tool's answers to every question with the library's, over a scene of one kind.
template <class T, class P>
void expect_library_answers(const std::string& scene, const std::string& folder, std::size_t rows) {
    constexpr int D = P::dimension;
    const auto set = std::get<P>(generate<T>(parse_scene_spec(scene)));
    const auto index = build_any("brute-force", set);
    const std::string precision = std::is_same_v<T, double> ? " --precision double" : "";
    int kinds = 0;
    for_each_question<T, D>([&]<class Question>(Question) {
        if constexpr (answered_by<Question, P>) {
            using Given = typename Question::Given;
            RowOptions options{.count = 3};
            if (RowsOf<Given>::needs_radius) options.radius = 0.3;
            const std::string in = folder + "/in.npy";
            const InputColumns columns = RowsOf<Given>::columns();
            // Rays leave out their interval.
            std::vector<std::string> names;
            std::vector<double> every;
            std::vector<T> given;
            const auto reader = open_rows<T>(
                folder + (columns.defaults.empty() ? "/" + std::to_string(columns.size()) + ".npy"
                                                   : "/rays" + std::to_string(D) + ".npy"),
                RowFormat::npy, columns);
            ASSERT_EQ(reader->read(given, rows), rows);
            const auto want = answers_of<Question>(*index, given, options, names);
            save_npy<T>(in, given, {rows, columns.size()});
            const std::string asked =
                std::string("query ") + std::string(Question::name) + " " + scene + " --quiet --from " + in +
                precision + (RowsOf<Given>::needs_count ? " --count 3" : "") +
                (RowsOf<Given>::needs_radius ? " --radius 0.3" : "") +
                (std::same_as<Question, AskFeature<T, D>> ? " --feature" : "") + " -o " + folder;
            for (const std::string output :
                 {"/out.npy", "/out.csv", "/again.npy --structure bvh", "/one.csv --threads 1"}) {
                const auto r = run(asked + output);
                ASSERT_EQ(r.code, 0) << r.output;
                const std::string path = folder + output.substr(0, output.find(' '));
                const auto out = open_rows<double>(path, row_format(path), InputColumns{names});
                std::vector<double> got, some;
                while (out->read(some, 100) > 0) got.insert(got.end(), some.begin(), some.end());
                // Whole primitives lie in few of these boxes.
                if (Question::name != "contained") {
                    EXPECT_GT(want.size(), names.size()) << Question::name;
                }
                // A file of text has the shortest digits of a float, which are another double.
                ASSERT_EQ(got.size(), want.size()) << asked << output;
                for (std::size_t i = 0; i < got.size(); ++i)
                    ASSERT_EQ(static_cast<T>(got[i]), static_cast<T>(want[i]))
                        << asked << output << ", number " << i;
            }
            ++kinds;
        }
    });
    EXPECT_GE(kinds, 4);
}

TEST_F(Query, EveryKindAnswersAsTheLibraryDoes) {
    // More rows than one chunk of lists. Brute force answers all of them, so the scene is small.
    constexpr std::size_t rows = 33000;
    write_rows<float>("3.npy", rows, 3), write_rows<float>("6.npy", rows, 6, 0.2);
    write_rows<float>("rays3.npy", rows, 6);
    expect_library_answers<float, TriangleMesh<float>>("gen:teapot:60", folder.string(), rows);
    expect_library_answers<float, PointCloud<float, 3>>("gen:points:500", folder.string(), 5000);
}

TEST_F(Query, EveryKindAnswersInDoubleAndInThePlane) {
    write_rows<double>("3.npy", 2000, 3), write_rows<double>("6.npy", 2000, 6, 0.2);
    write_rows<double>("rays3.npy", 2000, 6);
    expect_library_answers<double, SphereSet<double, 3>>("gen:spheres:100", folder.string(), 2000);
    write_rows<double>("2.npy", 2000, 2), write_rows<double>("4.npy", 2000, 4, 0.2);
    write_rows<double>("rays2.npy", 2000, 4);
    expect_library_answers<double, SegmentSet<double>>("gen:segments2d:100", folder.string(), 2000);
    expect_library_answers<double, PointCloud<double, 2>>("gen:points2d:100", folder.string(), 2000);
}

TEST_F(Query, PairsAnswerAsTheLibraryDoes) {
    expect_done("generate gen:teapot:400 --quiet -o " + file("a.ply"));
    const auto a = std::get<TriangleMesh<float>>(generate<float>(parse_scene_spec("gen:teapot:400")));
    const auto b = std::get<TriangleMesh<float>>(generate<float>(parse_scene_spec("gen:soup:200")));
    const auto c = std::get<PointCloud<float, 3>>(generate<float>(parse_scene_spec("gen:points:50")));
    const auto of_a = build(a), of_b = build(b);
    std::vector<ElementPair> pairs;
    const auto expect_pairs = [&](const std::string& name) {
        std::vector<double> want;
        for (const ElementPair& p : pairs) want.push_back(p.a), want.push_back(p.b);
        EXPECT_GT(pairs.size(), 0u);
        EXPECT_EQ(rows_of(file(name), {"a", "b"}), want);
    };
    crossing_pairs(of_a, of_b, pairs);
    for (const std::string name : {"p.npy", "p.csv", "p.json"}) {
        expect_done("query crossings gen:teapot:400 --with gen:soup:200 --quiet -o " + file(name));
        expect_pairs(name);
    }
    self_intersections(of_b, pairs);
    expect_done("query self-intersections gen:soup:200 --quiet -o " + file("s.npy"));
    expect_pairs("s.npy");
    const auto apart = minimum_distance(of_a, build(c));
    expect_done("query minimum-distance gen:teapot:400 --with gen:points:50 --quiet -o " + file("m.npy"));
    const auto row = rows_of(file("m.npy"), {"a", "b", "distance", "ax", "by"});
    EXPECT_EQ(row, (std::vector<double>{double(apart.element_a), double(apart.element_b),
                                        double(std::sqrt(apart.distance2)), double(apart.point_a[0]),
                                        double(apart.point_b[1])}));
    expect_bad("query crossings gen:teapot --with gen:points -o " + file("x.csv"), "triangles");
    expect_bad("query self-intersections gen:points -o " + file("x.csv"), "triangles");
    expect_bad("query minimum-distance gen:points --with gen:points2d -o " + file("x.csv"), "one space");
    expect_usage("query crossings gen:teapot -o " + file("x.csv"), "needs --with");
    expect_usage("query crossings gen:cube --with gen:cube --from a.csv -o " + file("x.csv"), "no rows");
    expect_usage("query self-intersections gen:cube --with gen:cube -o " + file("x.csv"), "leave out --with");
}

/// A scene's set, its index, and rows around it of which one is not finite.
template <class T, class P>
struct Asked {
    static constexpr int dimension = P::dimension;
    P set;
    IndexOf<WideBvh, P> index;
    std::vector<Vec<T, P::dimension>> points;
    std::string query;  // the arguments behind the kind

    Asked(const std::string& scene, const fs::path& folder)
        : set(std::get<P>(generate<T>(parse_scene_spec(scene)))), index(build<WideBvh>(set)) {
        constexpr std::size_t rows = 3000;
        std::vector<T> numbers;
        Random random(5, 0);
        for (std::size_t i = 0; i < rows; ++i) {
            Vec<T, P::dimension> p;
            for (int k = 0; k < P::dimension; ++k)
                numbers.push_back(p[k] = static_cast<T>(random.uniform() * 4 - 2));
            points.push_back(p);
        }
        numbers[7 * P::dimension] = std::numeric_limits<T>::quiet_NaN();
        save_npy<T>((folder / "points.npy").string(), numbers, {rows, P::dimension});
        query = " " + scene + " --quiet" + (std::is_same_v<T, double> ? " --precision double" : "") +
                " --from " + (folder / "points.npy").string();
    }
};

/// Runs the tool over rows of which number 7 has no answer. Returns the column of its answers.
template <class T>
std::vector<T> column_of(const std::string& arguments, const std::string& output, const std::string& name) {
    const auto r = run(arguments + " -o " + output);
    EXPECT_EQ(r.code, 0) << arguments << "\n" << r.output;
    EXPECT_NE(r.output.find("row 7,"), std::string::npos) << arguments << "\n" << r.output;
    std::vector<T> all, some;
    const auto rows = open_rows<T>(output, row_format(output), InputColumns{{name}});
    while (rows->read(some, 1000) > 0) all.insert(all.end(), some.begin(), some.end());
    return all;
}

/// Compares what the tool says of insides with the library's answers, one by one.
template <class T, class P>
void expect_insides(const std::string& scene, const fs::path& folder) {
    const Asked<T, P> asked(scene, folder);
    constexpr std::pair<const char*, SideBy> ways[] = {{"", SideBy::crossings},
                                                       {" --by crossings", SideBy::crossings},
                                                       {" --by parity", SideBy::parity},
                                                       {" --by pseudonormal", SideBy::pseudonormal},
                                                       {" --by expansion --error 0.01", SideBy::expansion}};
    for (const auto& [by, way] : ways) {
        const bool expansion = way == SideBy::expansion;
        if (expansion && P::dimension == 2) continue;
        const Solid solid(asked.index, {way, expansion ? 0.01 : 1e-3});
        for (const std::string ending : {"npy", "csv", "json"}) {
            const std::string output = (folder / ("answers." + ending)).string(), rest = asked.query + by;
            const auto sides = column_of<T>("query side" + rest, output, "side");
            const auto distances = column_of<T>("query signed-distance" + rest, output, "distance");
            std::vector<double> windings;
            if (by == std::string() || expansion)
                windings = column_of<double>("query winding-number" + rest, output, "winding_number");
            ASSERT_EQ(sides.size(), asked.points.size());
            ASSERT_EQ(distances.size(), asked.points.size());
            int inside = 0;
            for (std::size_t i = 0; i < sides.size(); ++i) {
                if (i == 7) {
                    EXPECT_TRUE(ending == "json" ? std::isnan(sides[i]) : sides[i] == -128);
                    EXPECT_TRUE(std::isnan(distances[i]));
                    EXPECT_TRUE(windings.empty() || std::isnan(windings[i]));
                    continue;
                }
                const auto& p = asked.points[i];
                ASSERT_EQ(sides[i], T(static_cast<int>(side(solid, p)) - 1)) << rest << ", row " << i;
                ASSERT_EQ(distances[i], signed_distance(solid, p)) << rest << ", row " << i;
                if (!windings.empty()) {
                    ASSERT_EQ(windings[i], winding_number(solid, p)) << rest << ", row " << i;
                }
                inside += sides[i] > 0;
            }
            EXPECT_GT(inside, 0) << rest;
        }
    }
}

TEST_F(Query, InsidesAnswerAsTheLibraryDoes) {
    expect_insides<float, TriangleMesh<float>>("gen:teapot:60", folder);
    expect_insides<double, TriangleMesh<double>>("gen:cube", folder);
    expect_insides<double, SegmentSet<double>>("gen:segments2d:100", folder);
}

TEST_F(Query, InsidesOfACubeAreKnown) {
    const auto cube = std::get<TriangleMesh<float>>(generate<float>(parse_scene_spec("gen:cube")));
    const float end = max_component(abs(cube.vertices[0]));
    const std::string e = std::to_string(end), half = std::to_string(end / 2);
    write("p.csv", "0,0,0\n9,0,0\n" + e + ",0,0\n" + half + ",0,0\n0,nan,0\n");
    expect_done("query side gen:cube --quiet --from " + file("p.csv") + " -o " + file("s.json"));
    EXPECT_EQ(nlohmann::json::parse(bytes_of(file("s.json"))),
              nlohmann::json::parse(R"([{"side":1},{"side":-1},{"side":0},{"side":1},{"side":null}])"));
    expect_done("query signed-distance gen:cube --quiet --from " + file("p.csv") + " -o " + file("d.csv"));
    const auto distances = rows_of(file("d.csv"), {"distance"});
    EXPECT_EQ(distances[0], -double(end));
    EXPECT_EQ(distances[1], 9 - double(end));
    EXPECT_EQ(distances[2], 0.0);
    EXPECT_EQ(distances[3], -double(end / 2));
    // A saved index is asked, and a pipe.
    expect_done("build gen:cube --quiet -o " + file("c.hedgerow"));
    EXPECT_EQ(run_shell("cat " + file("p.csv") + " | " HEDGEROW_TOOL_PATH " query winding-number " +
                        file("c.hedgerow") + " --quiet --from - --format csv -o " + file("w.npy"))
                  .code,
              0);
    const auto windings = rows_of(file("w.npy"), {"winding_number"});
    EXPECT_EQ(std::vector<double>(windings.begin(), windings.begin() + 2), (std::vector<double>{1, 0}));
    const std::string rest = " --from " + file("p.csv") + " -o " + file("x.csv");
    expect_bad("query side gen:points" + rest, "triangles");
    expect_bad("query side gen:spheres" + rest, "triangles");
    expect_usage("query side gen:cube --by magic" + rest, "--by");
    expect_usage("query side gen:cube --error 0.1" + rest, "--by expansion");
    expect_usage("query side gen:cube --by expansion --error 2" + rest, "1e-9 to 1");
    expect_usage("query side gen:cube --radius 2" + rest, "no --radius");
    expect_usage("query side gen:cube --count 2" + rest, "no --count");
    expect_bad("query closest-point gen:points --feature" + rest, "triangles");
    expect_usage("query winding-number gen:cube --by parity" + rest, "crossings or expansion");
    expect_usage("query closest-point gen:cube --by parity" + rest, "no --by");
    EXPECT_FALSE(fs::exists(file("x.csv")));
}

/// Compares the tool's answers about regions with those of brute force over the rows of `in`.
template <class Region, class T, class P>
void expect_regions(const Asked<T, P>& asked, const std::string& in, std::size_t bad, double radius) {
    const auto all = build<BruteForce>(asked.set);
    const std::size_t columns = RowsOf<Region>::columns().size();
    std::vector<T> rows;
    open_rows<T>(in, RowFormat::npy, RowsOf<Region>::columns())->read(rows, 100000);
    const std::string scene = asked.query.substr(0, asked.query.find(" --from"));
    for (const std::string ending : {".npy", ".csv"}) {
        const std::string output = in + ending;
        const auto answers = [&](const std::string& kind, const std::vector<std::string>& names) {
            const auto r = run("query " + kind + scene + " --from " + in + " -o " + output +
                               (radius >= 0 ? " --radius " + std::to_string(radius) : ""));
            EXPECT_EQ(r.code, 0) << r.output;
            EXPECT_NE(r.output.find("row " + std::to_string(bad) + ","), std::string::npos) << r.output;
            std::vector<double> numbers;
            open_rows<double>(output, row_format(output), InputColumns{names})->read(numbers, 1000000);
            return numbers;
        };
        std::vector<double> lists, counts, any;
        for (std::size_t i = 0; i < rows.size() / columns; ++i) {
            const T* const row = &rows[i * columns];
            std::vector<PrimitiveId> found;
            if (i != bad) {
                const auto region = RowsOf<Region>::of(row, {.radius = radius});
                contained(all, region, found);
                for (const PrimitiveId id : found) lists.insert(lists.end(), {double(i), double(id)});
                overlapping(all, region, found);
            }
            counts.push_back(double(found.size())), any.push_back(!found.empty());
        }
        EXPECT_GT(lists.size(), 0u);
        EXPECT_EQ(answers("contained", {"query", "primitive"}), lists);
        EXPECT_EQ(answers("count", {"count"}), counts);
        EXPECT_EQ(answers("any-overlap", {"overlaps"}), any);
    }
}
template <class T, class P>
void expect_both_regions(const std::string& scene, const fs::path& folder) {
    constexpr int D = P::dimension;
    const Asked<T, P> asked(scene, folder);
    expect_regions<Sphere<T, D>>(asked, (folder / "points.npy").string(), 7, 0.5);
    std::vector<T> rows;
    for (std::size_t i = 0; i < 1000; ++i) {
        for (int k = 0; k < D; ++k) rows.push_back(asked.points[i][k]);
        for (int k = 0; k < D; ++k) rows.push_back(asked.points[i][k] + static_cast<T>(i % 3));
    }
    rows[2 * D * 20 + 1] = std::numeric_limits<T>::quiet_NaN();
    save_npy<T>((folder / "boxes.npy").string(), rows, {1000, 2 * D});
    expect_regions<Box<T, D>>(asked, (folder / "boxes.npy").string(), 20, -1);
}

TEST_F(Query, RegionsAnswerAsTheLibraryDoes) {
    expect_both_regions<float, TriangleMesh<float>>("gen:teapot:300", folder);
    expect_both_regions<double, SphereSet<double, 3>>("gen:spheres:100", folder);
    expect_both_regions<float, PointCloud<float, 3>>("gen:points:500", folder);
    expect_both_regions<double, SegmentSet<double>>("gen:segments2d:100", folder);
    expect_both_regions<float, PointCloud<float, 2>>("gen:points2d:100", folder);
    const std::string rest = " --from " + file("points.npy") + " -o " + file("x.csv");
    expect_bad("query contained gen:cube" + rest, "(N, 6)");
    expect_usage("query count gen:cube --radius -1" + rest, "at least 0");
    expect_usage("query any-overlap gen:cube -k 3" + rest, "no --count");
    expect_usage("query any-overlap gen:cube --by parity" + rest, "no --by");
}

TEST_F(Query, RadiiAndFactorsAreThoseOfTheLibrary) {
    const Asked<float, TriangleMesh<float>> asked("gen:teapot:300", folder);
    const std::string query = asked.query.substr(0, asked.query.find(" --from"));
    std::vector<float> numbers;
    for (const auto& p : asked.points) numbers.insert(numbers.end(), {p[0], p[1], p[2]});
    save_npy<float>(file("p.npy"), numbers, {asked.points.size(), 3});
    const std::string from = query + " --from " + file("p.npy") + " -o " + file("a.npy");
    std::size_t beyond = 0;
    for (const auto& [given, options] :
         {std::pair<std::string, PointOptions>{" --radius 0.3", {.radius = 0.3f}},
          {" --factor 1.5", {.factor = 1.5f}},
          {" --radius 0.3 --factor 2", {.radius = 0.3f, .factor = 2}}}) {
        std::vector<double> want, lists;
        for (std::size_t i = 0; i < asked.points.size(); ++i) {
            const auto near = closest_point(asked.index, asked.points[i], options);
            beyond += !near;
            want.insert(want.end(), {double(near.primitive), double(distance_of(near))});
            std::vector<Near<float, 3>> found;
            nearest(asked.index, asked.points[i], 3, found, options);
            for (const auto& n : found)
                lists.insert(lists.end(), {double(i), double(n.primitive), double(distance_of(n))});
        }
        expect_done("query closest-point" + from + given);
        EXPECT_EQ(rows_of(file("a.npy"), {"primitive", "distance"}), want) << given;
        expect_done("query nearest" + from + " -k 3" + given);
        EXPECT_EQ(rows_of(file("a.npy"), {"query", "primitive", "distance"}), lists) << given;
    }
    EXPECT_GT(beyond, 0u);
    // Where nothing is found, there is no feature.
    write("far.csv", "0,0,99\n");
    expect_done("query closest-point gen:cube --feature --radius 1 --quiet --from " + file("far.csv") +
                " -o " + file("f.json"));
    const auto none = nlohmann::json::parse(bytes_of(file("f.json")));
    EXPECT_TRUE(none[0]["feature"].is_null()) << none;
    EXPECT_TRUE(none[0]["primitive"].is_null() || none[0]["primitive"] == 4294967295u) << none;
}

/// Each distance that is printed finds its primitive as a radius, with the digits of text.
TEST_F(Query, PrintedDistancesAreRadii) {
    for (const std::string precision : {"", " --precision double"}) {
        const std::string scene = "gen:points:300";
        std::vector<double> numbers(60);
        Random random(9, 0);
        for (double& x : numbers) x = random.uniform();
        save_npy<double>(file("p.npy"), numbers, {numbers.size() / 3, 3});
        const std::string rest = " " + scene + precision + " --quiet --from " + file("p.npy") + " -o ";
        expect_done("query nearest -k 4" + rest + file("near.csv"));
        std::ifstream lines(file("near.csv"));
        std::string line;
        std::getline(lines, line);
        for (int row = 0; std::getline(lines, line); ++row) {
            if (row % 7 != 0) continue;
            const std::string query = line.substr(0, line.find(',')),
                              primitive = line.substr(query.size() + 1, line.rfind(',') - query.size() - 1),
                              distance = line.substr(line.rfind(',') + 1);
            expect_done("query within --radius " + distance + rest + file("within.csv"));
            EXPECT_NE(bytes_of(file("within.csv")).find("\n" + query + "," + primitive + ","),
                      std::string::npos)
                << line;
            expect_done("query overlap --radius " + distance + rest + file("overlap.csv"));
            const auto within = rows_of(file("within.csv"), {"query", "primitive"}),
                       overlap = rows_of(file("overlap.csv"), {"query", "primitive"});
            EXPECT_EQ(std::count(within.begin(), within.end(), std::stod(primitive)),
                      std::count(overlap.begin(), overlap.end(), std::stod(primitive)));
            EXPECT_EQ(within.size(), overlap.size());
        }
    }
}

/// Places so far away that squares may overflow have no answer, and the tool says so. Zeros of text have no
/// sign.
TEST_F(Query, FarPlacesHaveNoAnswer) {
    write("rays.csv", "0,0,-5,0,0,1\n0,0,-2e18,0,0,1\n");
    const std::string rest = " gen:cube --quiet -o " + file("a.csv") + " --from ";
    for (const std::string query : {"closest-hit", "any-hit"}) {
        const auto r = run("query " + query + rest + file("rays.csv"));
        EXPECT_EQ(r.code, 0);
        EXPECT_NE(r.output.find("row 1, counted from 0, has no answer"), std::string::npos) << r.output;
    }
    write("points.csv", "0,0,1e18\n0,0,2e19\n");
    for (const std::string query : {"closest-point", "side", "nearest -k 1"}) {
        const auto r = run("query " + query + rest + file("points.csv"));
        EXPECT_EQ(r.code, 0);
        EXPECT_NE(r.output.find("row 1, counted from 0, has no answer"), std::string::npos) << r.output;
    }
    write("flat.obj", "v 0 0 0\nv -1 0 0\nv -2 0 0\nf 1 2 3\n");
    write("at.csv", "-1.5,-0,3\n");
    expect_done("query closest-point " + file("flat.obj") + " --feature --quiet --from " + file("at.csv") +
                " -o " + file("flat.csv"));
    const std::string text = bytes_of(file("flat.csv"));
    EXPECT_EQ(text.find("nan"), std::string::npos) << text;
    EXPECT_EQ(text.find("-0,"), std::string::npos) << text;
}

/// Sides of a closed mesh with a triangle turned over: the tool says that the mesh counts as open.
TEST_F(Query, TurnedTrianglesAreTold) {
    write("turned.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 4 1\n");
    write("p.csv", "0.1,0.1,0.1\n");
    const std::string rest = file("turned.obj") + " --quiet --from " + file("p.csv") + " -o " + file("s.csv");
    EXPECT_NE(run("query side " + rest).output.find("--by parity"), std::string::npos);
    const auto r = run("query side --by parity " + rest);
    EXPECT_EQ(r.output, "");
    EXPECT_EQ(rows_of(file("s.csv"), {"side"}), std::vector<double>{1});
}

TEST_F(Query, HausdorffDistancesAnswerAsTheLibraryDoes) {
    const auto a = std::get<TriangleMesh<float>>(generate<float>(parse_scene_spec("gen:teapot:400")));
    const auto b = std::get<TriangleMesh<float>>(generate<float>(parse_scene_spec("gen:cube")));
    const auto c = std::get<PointCloud<float, 3>>(generate<float>(parse_scene_spec("gen:points:50")));
    const auto expect_interval = [&](const std::string& arguments, const auto& want) {
        expect_done("query hausdorff " + arguments + " --quiet -o " + file("h.npy"));
        EXPECT_EQ(rows_of(file("h.npy"), {"a", "b", "lower", "upper", "ax", "bz", "from_b"}),
                  (std::vector<double>{double(want.element_a), double(want.element_b), want.lower, want.upper,
                                       want.point_a[0], want.point_b[2], double(want.from_b)}))
            << arguments;
        EXPECT_GT(want.lower, 0);
    };
    expect_interval("gen:teapot:400 --with gen:cube", hausdorff_distance(build(a), build(b)));
    expect_interval("gen:teapot:400 --with gen:cube --tolerance 0.2",
                    hausdorff_distance(build(a), build(b), {.relative = 0.2}));
    expect_interval("gen:teapot:400 --with gen:points:50", hausdorff_distance(build(a), build(c)));
    expect_interval("gen:points:50 --with gen:cube", hausdorff_distance(build(c), build(b)));
    const auto flat = std::get<PointCloud<float, 2>>(generate<float>(parse_scene_spec("gen:points2d:30")));
    const auto more = std::get<PointCloud<float, 2>>(generate<float>(parse_scene_spec("gen:points2d:70")));
    expect_done("query hausdorff gen:points2d:30 --with gen:points2d:70 --quiet -o " + file("h.csv"));
    EXPECT_EQ(static_cast<float>(rows_of(file("h.csv"), {"upper"})[0]),
              hausdorff_distance(build(flat), build(more)).upper);
    const std::string to = " -o " + file("x.csv");
    expect_usage("query hausdorff gen:cube" + to, "needs --with");
    expect_usage("query hausdorff gen:cube --with gen:cube --tolerance -1" + to, "at least 0");
    expect_usage("query hausdorff gen:cube --with gen:cube --radius 1" + to, "no --radius");
    expect_usage("query crossings gen:cube --with gen:cube --tolerance 1" + to, "no --tolerance");
    expect_bad("query hausdorff gen:cube --with gen:spheres" + to, "triangles or points");
    expect_bad("query hausdorff gen:cube --with gen:points2d" + to, "one space");
    EXPECT_FALSE(fs::exists(file("x.csv")));
}

TEST_F(Query, PairsWithinARadiusAnswerAsTheLibraryDoes) {
    const auto a = std::get<PointCloud<double, 3>>(generate<double>(parse_scene_spec("gen:points:500")));
    const auto b = std::get<PointCloud<double, 3>>(generate<double>(parse_scene_spec("gen:points:200")));
    std::vector<PairWithin<double>> pairs;
    const auto expect_pairs = [&](const std::string& arguments) {
        std::vector<double> want;
        for (const auto& p : pairs)
            want.insert(want.end(), {double(p.a), double(p.b), std::sqrt(p.distance2)});
        EXPECT_GT(pairs.size(), 0u);
        for (const std::string name : {"w.npy", "w.csv", "w.json"}) {
            expect_done("query pairs-within " + arguments + " --radius 0.25 --precision double --quiet -o " +
                        file(name));
            EXPECT_EQ(rows_of(file(name), {"a", "b", "distance"}), want) << name;
        }
    };
    pairs_within(build(a), 0.25, pairs);
    expect_pairs("gen:points:500");
    pairs_within(build(a), build(b), 0.25, pairs);
    expect_pairs("gen:points:500 --with gen:points:200");
    // The neighbours of each, also where space repeats.
    NearLists<double> lists;
    for (const bool periodic : {false, true}) {
        const Periods<3> periods(periodic ? 1 : 0, periodic ? 1.5 : 0, 0);
        neighbours_within(a.points, 0.25, lists, {.periods = periods, .distances = true});
        std::vector<double> want;
        for (std::size_t i = 0; i < a.size(); ++i)
            for (std::size_t k = lists.offsets[i]; k < lists.offsets[i + 1]; ++k)
                want.insert(want.end(), {double(i), double(lists.ids[k]), std::sqrt(lists.distances2[k])});
        EXPECT_GT(want.size(), 0u);
        expect_done("query neighbours-within gen:points:500 --radius 0.25 --precision double --quiet -o " +
                    file("n.npy") + (periodic ? " --period 1,1.5,0" : ""));
        EXPECT_EQ(rows_of(file("n.npy"), {"a", "b", "distance"}), want);
    }
    const std::string to = " -o " + file("x.csv");
    expect_usage("query neighbours-within gen:points --radius 1 --period 1,2" + to, "give one length, or 3");
    expect_usage("query neighbours-within gen:points --radius 1 --period -1" + to, "is not a length");
    expect_usage("query pairs-within gen:points --with gen:points --radius 1 --period 1" + to,
                 "leave out --with");
    expect_usage("query nearest gen:points -k 1 --period 1 --from " + file("n.npy") + to,
                 "takes no --period");
    expect_bad("query neighbours-within gen:cube --radius 1" + to, "points");
    expect_usage("query pairs-within gen:points" + to, "needs --radius");
    expect_usage("query pairs-within gen:points --radius -1" + to, "at least 0");
    expect_bad("query pairs-within gen:cube --radius 1" + to, "points");
    expect_bad("query pairs-within gen:points --with gen:cube --radius 1" + to, "points in one space");
    expect_bad("query self-intersections gen:points" + to, "triangles");
}

}  // namespace
