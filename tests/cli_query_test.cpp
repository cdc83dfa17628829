/// `hedgerow query`: every kind against the library, in every format, by pipe, interrupted, and asked badly.
#include <hedgerow/columns.h>
#include <hedgerow/hedgerow.h>
#include <hedgerow/io/npy.h>
#include <hedgerow/io/rows.h>
#include <hedgerow/scenes/generate.h>
#include <hedgerow/scenes/random.h>

#include <nlohmann/json.hpp>

#include "tool.h"

namespace {

using namespace hedgerow;
namespace fs = std::filesystem;

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

class Query : public ToolTest {
protected:
    /// All numbers of the columns in a file.
    static std::vector<double> rows_of(const fs::path& path, const std::vector<std::string>& names) {
        std::vector<double> all, some;
        const auto reader = open_rows<double>(path, row_format(path), InputColumns{names});
        while (reader->read(some, 1000) > 0) all.insert(all.end(), some.begin(), some.end());
        return all;
    }
    /// Random numbers around the unit cube, as rows.
    template <class T>
    void write_rows(const std::string& name, std::size_t rows, std::size_t columns, double last = 0) const {
        std::vector<T> numbers(rows * columns);
        Random random(7, 0);
        for (std::size_t i = 0; i < numbers.size(); ++i) {
            numbers[i] = static_cast<T>(random.uniform() * 4 - 2);
            // Boxes have a high corner above the low one.
            if (last > 0 && i % columns >= columns / 2)
                numbers[i] = numbers[i - columns / 2] + static_cast<T>(last * random.uniform());
        }
        save_npy<T>(file(name), numbers, {rows, columns});
    }
    static void expect_done(const std::string& arguments) {
        const auto r = run(arguments);
        EXPECT_EQ(r.code, 0) << arguments << "\n" << r.output;
    }
    void write(const std::string& name, const std::string& text) const {
        std::ofstream(file(name), std::ios::binary) << text;
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
            if (RowsOf<Given>::takes_radius) options.radius = 0.3;
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
                precision + (RowsOf<Given>::takes_count ? " --count 3" : "") +
                (RowsOf<Given>::takes_radius ? " --radius 0.3" : "") +
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
    // More rows than one chunk of lists.
    constexpr std::size_t rows = 33000;
    write_rows<float>("3.npy", rows, 3), write_rows<float>("6.npy", rows, 6, 0.2);
    write_rows<float>("rays3.npy", rows, 6);
    expect_library_answers<float, TriangleMesh<float>>("gen:teapot:300", folder.string(), rows);
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
                ASSERT_EQ(sides[i], T(static_cast<int>(solid.side(p)) - 1)) << rest << ", row " << i;
                ASSERT_EQ(distances[i], solid.signed_distance(p).distance) << rest << ", row " << i;
                if (!windings.empty()) {
                    ASSERT_EQ(windings[i], solid.winding_number(p)) << rest << ", row " << i;
                }
                inside += sides[i] > 0;
            }
            EXPECT_GT(inside, 0) << rest;
        }
    }
}

TEST_F(Query, InsidesAnswerAsTheLibraryDoes) {
    expect_insides<float, TriangleMesh<float>>("gen:teapot:300", folder);
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
         {std::pair<std::string, NearOptions<float>>{" --radius 0.3", {.radius = 0.3f}},
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
    pairs_within(build(a), {.radius = 0.25}, pairs);
    expect_pairs("gen:points:500");
    pairs_within(build(a), build(b), {.radius = 0.25}, pairs);
    expect_pairs("gen:points:500 --with gen:points:200");
    const std::string to = " -o " + file("x.csv");
    expect_usage("query pairs-within gen:points" + to, "needs --radius");
    expect_usage("query pairs-within gen:points --radius -1" + to, "at least 0");
    expect_bad("query pairs-within gen:cube --radius 1" + to, "points");
    expect_bad("query pairs-within gen:points --with gen:cube --radius 1" + to, "points in one space");
    expect_bad("query self-intersections gen:points" + to, "triangles");
}

TEST_F(Query, ReadsAndWritesPipes) {
    const std::string tool = HEDGEROW_TOOL_PATH " query closest-point gen:cube --quiet --from - ";
    EXPECT_EQ(
        run_shell("printf '0,0,9\\n9,0,0\\n' | " + tool + "--format csv --output-format csv -o -").output,
        run_shell("echo '[[0,0,9],[9,0,0]]' | " + tool + "--format json --output-format csv -o -").output);
    const auto json =
        run_shell("printf '0 0 9\\n' | " + tool + "--format csv --output-format json -o -").output;
    const auto parsed = nlohmann::json::parse(json);
    ASSERT_EQ(parsed.size(), 1u);
    EXPECT_GT(parsed[0]["distance"].get<double>(), 7.0);
    // A million rows by pipe are the same as from a file.
    write_rows<float>("rows.npy", 300000, 3);
    expect_done("query closest-point gen:cube --quiet --from " + file("rows.npy") + " -o " + file("a.npy"));
    EXPECT_EQ(run_shell("cat " + file("rows.npy") + " | " + tool + "--format npy -o " + file("b.npy")).code,
              0);
    EXPECT_EQ(run_shell("cat " + file("rows.npy") + " | " + tool +
                        "--format npy --output-format npy -o - | cat > " + file("c.npy"))
                  .code,
              0);
    EXPECT_EQ(run_shell("mkfifo " + file("f") + "; cat " + file("rows.npy") + " > " + file("f") + " & " +
                        HEDGEROW_TOOL_PATH + " query closest-point gen:cube --quiet --format npy --from " +
                        file("f") + " -o " + file("d.npy"))
                  .code,
              0);
    for (const char* name : {"b.npy", "c.npy", "d.npy"})
        EXPECT_TRUE(bytes_of(file(name)) == bytes_of(file("a.npy"))) << name;
    EXPECT_EQ(run_shell(tool + "--format csv -o " + file("x.csv") + " </dev/null 2>&1").code, 3);
    EXPECT_EQ(run_shell(tool + "--format csv -o " + file("x.csv") + " <&- 2>&1").code, 3);
    expect_usage("query closest-point gen:cube --from - -o " + file("x.csv"), "--format");
    const auto lists =
        run_shell("echo 0,0,0 | " HEDGEROW_TOOL_PATH
                  " query within gen:cube --radius 1 --from - --format csv --output-format npy -o - "
                  "2>&1 | cat");
    EXPECT_NE(lists.output.find("number of rows"), std::string::npos) << lists.output;
}

TEST_F(Query, SavedIndexesAreQueried) {
    expect_done("build gen:teapot:300 --quiet -o " + file("t.hedgerow"));
    write_rows<float>("3.npy", 100, 3);
    for (const std::string scene : {"gen:teapot:300", "t.hedgerow"})
        expect_done("query nearest " + (scene[0] == 'g' ? scene : file(scene)) + " -k 2 --from " +
                    file("3.npy") + " -o " + file(scene[0] == 'g' ? "a.npy" : "b.npy"));
    EXPECT_TRUE(bytes_of(file("a.npy")) == bytes_of(file("b.npy")));
}

TEST_F(Query, SavedIndexesOfPointsAreQueried) {
    write_rows<float>("3.npy", 100, 3), write_rows<float>("2.npy", 100, 2);
    for (const auto& [scene, rows] : {std::pair<std::string, std::string>{"gen:points:300", "3.npy"},
                                      {"gen:points2d:300", "2.npy"},
                                      {"gen:points:300 --precision double", "3.npy"}}) {
        expect_done("build " + scene + " --quiet -o " + file("p.hedgerow"));
        const std::string rest = " --from " + file(rows) + " -o ";
        for (const std::string kind : {"nearest -k 2 ", "closest-point ", "count --radius 0.2 "}) {
            expect_done("query " + kind + scene + rest + file("a.npy"));
            expect_done("query " + kind + file("p.hedgerow") + rest + file("b.npy"));
            EXPECT_TRUE(bytes_of(file("a.npy")) == bytes_of(file("b.npy"))) << kind << scene;
            expect_done("query " + kind + file("p.hedgerow") + " --structure kdtree" + rest + file("b.npy"));
            EXPECT_TRUE(bytes_of(file("a.npy")) == bytes_of(file("b.npy"))) << kind << scene;
        }
    }
    const auto built = run("build gen:points:300 -o " + file("p.hedgerow"));
    EXPECT_NE(built.output.find("300 points (float)"), std::string::npos) << built.output;
    EXPECT_NE(run("info " + file("p.hedgerow")).output.find("coincident_points"), std::string::npos);
    expect_done("render " + file("p.hedgerow") + " --quiet --size 32x32 -o " + file("p.png"));
    expect_bad("build gen:spheres:10 -o " + file("s.hedgerow"), "triangles or of points");
    EXPECT_FALSE(fs::exists(file("s.hedgerow")));
}

TEST_F(Query, RowsThatAreNotFiniteHaveNoAnswerAndAreNamed) {
    write("p.csv", "0,0,9\n1,nan,0\n0,0,-9\ninf,0,0\n");
    auto r = run("query closest-point gen:cube --quiet --from " + file("p.csv") + " -o " + file("a.csv"));
    EXPECT_EQ(r.code, 0) << r.output;
    EXPECT_NE(r.output.find("p.csv: row 1,"), std::string::npos) << r.output;
    EXPECT_NE(r.output.find("1 later"), std::string::npos) << r.output;
    const auto ids = rows_of(file("a.csv"), {"primitive"});
    EXPECT_EQ(ids[1], 4294967295.0);
    EXPECT_EQ(ids[3], 4294967295.0);
    EXPECT_LT(ids[2], 12.0);
    r = run("query within gen:cube --radius 9 --quiet --from " + file("p.csv") + " -o " + file("a.csv"));
    for (const double query : rows_of(file("a.csv"), {"query"})) EXPECT_TRUE(query == 0 || query == 2);
    write("r.json", "[[0,0,9,0,0,-1],[0,0,9,0,0,null],[null,0,9,0,0,-1],[0,0,9,0,0,-1,0,null]]");
    for (const std::string kind : {"closest-hit", "any-hit", "all-hits"}) {
        r = run("query " + kind + " gen:cube --quiet --from " + file("r.json") + " -o " + file("a.json"));
        EXPECT_EQ(r.code, 0) << r.output;
        EXPECT_NE(r.output.find("r.json: row 1,"), std::string::npos) << r.output;
        const auto answers = nlohmann::json::parse(bytes_of(file("a.json")));
        if (kind == "any-hit") {
            EXPECT_EQ(answers,
                      nlohmann::json::parse(R"([{"hit":true},{"hit":false},{"hit":false},{"hit":true}])"));
        }
    }
    write("b.csv", "-inf,-inf,-inf,inf,inf,inf\n1,1,1,0,0,0\nnan,0,0,1,1,1\n");
    r = run("query overlap gen:cube --quiet --from " + file("b.csv") + " -o " + file("a.csv"));
    EXPECT_NE(r.output.find("b.csv: row 2,"), std::string::npos) << r.output;
    EXPECT_EQ(rows_of(file("a.csv"), {"query"}), std::vector<double>(12, 0.0))
        << "all of the cube, or nothing";
}

TEST_F(Query, MoreNeighboursThanThereAreAreAllOfThem) {
    write("p.csv", "0,0,9\n");
    expect_done("query nearest gen:cube -k 1000 --from " + file("p.csv") + " -o " + file("a.csv"));
    EXPECT_EQ(rows_of(file("a.csv"), {"query"}).size(), 12u);
    expect_done("query within gen:cube --radius 0 --from " + file("p.csv") + " -o " + file("a.csv"));
    EXPECT_TRUE(rows_of(file("a.csv"), {"query"}).empty());
    // Rows without a query in them are no fault.
    write("none.csv", "x,y,z\n");
    expect_done("query nearest gen:cube -k 3 --from " + file("none.csv") + " -o " + file("a.npy"));
    EXPECT_TRUE(rows_of(file("a.npy"), {"query"}).empty());
}

TEST_F(Query, MoreAnswersThanWaitInMemoryAreInTheirOrder) {
    // About 48 MB of records in one chunk, of which 32 MB may wait.
    write_rows<float>("3.npy", 10000, 3);
    expect_done("query within gen:teapot:300 --radius 1e9 --quiet --from " + file("3.npy") + " -o " +
                file("a.npy"));
    const auto set = std::get<TriangleMesh<float>>(generate<float>(parse_scene_spec("gen:teapot:300")));
    const auto queries = rows_of(file("a.npy"), {"query"});
    ASSERT_EQ(queries.size(), 10000 * set.size());
    ASSERT_GT(queries.size() * 16, std::size_t(1) << 25);
    for (std::size_t i = 0; i < queries.size(); ++i) ASSERT_EQ(queries[i], double(i / set.size()));
}

TEST_F(Query, MemoryDoesNotGrowWithTheRows) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
    GTEST_SKIP() << "sanitizers keep memory that was freed";
#endif
    // Rows and answers of the larger file take 72 MB and 120 MB.
    write_rows<float>("few.npy", 600000, 3), write_rows<float>("many.npy", 6000000, 3);
    const std::string asked = "query closest-point gen:cube --quiet -o " + file("a.npy") + " --from ";
    const long few = peak_memory(asked + file("few.npy")), many = peak_memory(asked + file("many.npy"));
    EXPECT_LT(many, few + 20000) << few << " and " << many << " KiB";
    EXPECT_LT(many, 200000);
}

TEST_F(Query, WrongUsageIsTwo) {
    write("p.csv", "0,0,9\n");
    const std::string from = " --from " + file("p.csv"), to = " -o " + file("x.csv");
    expect_usage("query closest-pint gen:cube" + from + to, "did you mean 'closest-point'");
    expect_usage("query nearest gen:cube" + from + to, "needs --count");
    expect_usage("query nearest gen:cube --count 0" + from + to, "at least 1");
    expect_usage("query within gen:cube" + from + to, "needs --radius");
    expect_usage("query within gen:cube --radius -1" + from + to, "at least 0");
    expect_usage("query within gen:cube --radius nan" + from + to, "finite");
    expect_usage("query closest-hit gen:cube --radius 1" + from + to, "takes no --radius");
    expect_usage("query side gen:cube --radius 1" + from + to, "takes no --radius");
    expect_usage("query closest-point gen:cube --radius -1" + from + to, "at least 0");
    expect_usage("query nearest gen:cube -k 1 --radius nan" + from + to, "finite");
    for (const std::string bad : {"0.99", "-2", "0"})
        expect_usage("query closest-point gen:cube --factor " + bad + from + to, "at least 1");
    expect_usage("query nearest gen:cube -k 1 --factor nan" + from + to, "finite");
    expect_usage("query within gen:cube --radius 1 --factor 2" + from + to, "takes no --factor");
    expect_usage("query pairs-within gen:points --radius 1 --factor 2" + to, "takes no --factor");
    expect_usage("query nearest gen:cube -k 1 --feature" + from + to, "takes no --feature");
    expect_usage("query self-intersections gen:cube --feature" + to, "takes no --feature");
    expect_usage("query closest-point gen:cube --count 1" + from + to, "takes no --count");
    expect_usage("query closest-point gen:cube --with gen:cube" + from + to, "leave out --with");
    expect_usage("query closest-point gen:cube" + to, "needs --from");
    expect_usage("query closest-point gen:cube" + from + " -o " + file("x.txt"), "npy, csv or json");
    expect_usage("query closest-point gen:cube --structure kdtre" + from + to, "did you mean 'kdtree'");
    EXPECT_FALSE(fs::exists(file("x.csv")));
}

TEST_F(Query, BadInputIsThreeAndNamed) {
    const auto expect_refused = [&](const std::string& name, const std::string& said) {
        expect_bad("query closest-point gen:cube --from " + file(name) + " -o " + file("x.npy"), said);
        EXPECT_FALSE(fs::exists(file("x.npy")));
    };
    expect_refused("missing.csv", "no such file");
    write("p.csv", "1,2,3\n1,2\n");
    expect_refused("p.csv", "line 2");
    write_rows<float>("6.npy", 10, 6);
    expect_refused("6.npy", "(N, 3)");
    write_rows<float>("3.npy", 1000, 3);
    for (const std::size_t length : {5, 60, 128, 1000, 12000}) {
        write("cut.npy", bytes_of(file("3.npy")).substr(0, length));
        expect_refused("cut.npy", "cut.npy");
    }
    const std::string from = " --from " + file("3.npy") + " -o " + file("x.npy");
    expect_bad("query closest-hit gen:points" + from, "rays pass between points");
    expect_bad("query closest-point " + file("missing.ply") + from, "missing.ply");
    write("none.csv", "x,y,z\n");
    expect_bad("query closest-point " + file("none.csv") + from, "none.csv");
    expect_usage("query closest-point gen:cube --structure hash-grid" + from, "holds points alone");
}

TEST_F(Query, RowsBeforeAFaultAreAnswered) {
    std::string text;
    for (int i = 0; i < 200000; ++i) text += "0,0,9\n";
    write("p.csv", text + "0,0,oops\n");
    expect_bad("query closest-point gen:cube --from " + file("p.csv") + " -o " + file("a.npy"),
               "line 200001: 'oops' where a number should stand");
    EXPECT_FALSE(fs::exists(file("a.npy")));
    EXPECT_EQ(rows_of(file("a.unfinished.npy"), {"primitive"}).size(), 200000u);
}

TEST_F(Query, FullDisksAreOne) {
    if (!fs::exists("/dev/full")) GTEST_SKIP();
    write_rows<float>("3.npy", 20000, 3);
    for (const char* format : {"npy", "csv", "json"})
        expect_failure(1,
                       "query closest-point gen:cube --from " + file("3.npy") + " --output-format " + format +
                           " -o /dev/full",
                       "No space left");
    EXPECT_EQ(run_shell(HEDGEROW_TOOL_PATH " query closest-point gen:cube --from " + file("3.npy") +
                        " --output-format csv -o - >/dev/full 2>&1")
                  .code,
              1);
    expect_failure(1, "query closest-point gen:cube --from " + file("3.npy") + " -o " + file("no/x.npy"),
                   "no folder");
}

TEST_F(Query, AnInterruptLeavesTheRowsThatWereFinished) {
    // Brute force over enough triangles takes minutes over these rows.
    write_rows<float>("3.npy", 3000000, 3);
    for (const std::string ending : {"npy", "csv", "json"}) {
        const std::string output = file("a." + ending), unfinished = file("a.unfinished." + ending);
        std::ofstream(output) << "precious";
        for (int milliseconds = 2000; milliseconds <= 60000; milliseconds *= 3) {
            EXPECT_EQ(run_interrupted({"query", "nearest", "gen:teapot:3000", "-k", "4", "--structure",
                                       "brute-force", "--from", file("3.npy"), "--quiet", "-o", output},
                                      milliseconds),
                      130);
            if (fs::exists(unfinished)) break;
        }
        EXPECT_EQ(bytes_of(output), "precious");
        ASSERT_TRUE(fs::exists(unfinished));
        const auto rows = rows_of(unfinished, {"query"});
        ASSERT_GT(rows.size(), 0u);
        for (std::size_t i = 0; i < rows.size(); ++i) ASSERT_EQ(rows[i], double(i / 4));
    }
}

TEST_F(Query, TheSummaryIsJsonWhereAsked) {
    write_rows<float>("3.npy", 100, 3);
    const auto r =
        run("query nearest gen:cube -k 2 --json --quiet --from " + file("3.npy") + " -o " + file("a.csv"));
    ASSERT_EQ(r.code, 0) << r.output;
    const auto j = nlohmann::json::parse(r.output);
    EXPECT_EQ(j["queries"], 100);
    EXPECT_EQ(j["rows"], 200);
    EXPECT_EQ(j["unusable"], 0);
    EXPECT_EQ(j["finished"], true);
    EXPECT_EQ(j["output"], file("a.csv"));
}

}  // namespace
