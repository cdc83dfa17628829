/// hedgerow query: answers rows of queries from a file, in chunks.
#include <algorithm>
#include <filesystem>
#include <limits>
#include <memory>
#include <optional>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <hedgerow/base/error.h>
#include <hedgerow/base/spelling.h>
#include <hedgerow/io/index_file.h>

#include "row_query.h"

namespace hedgerow::cli {

namespace {

template <class Answer>
inline constexpr bool is_list = false;
template <class Item>
inline constexpr bool is_list<std::vector<Item>> = true;

/// An index whose ids are the positions, for the columns of answers that are not there yet.
struct NoIndex {
    std::uint32_t id(PrimitiveId element) const { return element; }
};

/// The columns that answers to a question have.
template <class Question>
std::vector<Column> answer_columns() {
    using Answer = typename Question::Answer;
    ColumnList list;
    if constexpr (is_list<Answer>) {
        list("query", std::uint64_t());
        list_item_columns(NoIndex(), typename Answer::value_type(), list);
    } else {
        list_answer<Question>(Answer(), list);
    }
    return list.all;
}

/// Questions of points that take PointOptions beside the points.
template <class Question, class T, int D>
concept TakesPointOptions = requires(const AnyIndex<T, D>& index, std::span<const Vec<T, D>> given,
                                     std::span<typename Question::Answer> found) {
    Question::ask_all(index, given, found, {}, PointOptions());
};

/// An index, and the solid that is made of it where a question is asked of that.
template <std::floating_point T, int D>
struct Answering {
    const AnyIndex<T, D>& index;
    std::unique_ptr<const AnySolid<T, D>> solid;
    const FileNumbers& numbers;
};

/// Puts a question to an index for each of `count` rows.
template <class Question, std::floating_point T, int D>
void answer_piece(const Answering<T, D>& by, const RowOptions& options, const T* numbers, std::uint64_t first,
                  std::size_t count, AnsweredRows& answers) {
    using Given = typename Question::Given;
    using Answer = typename Question::Answer;
    const AnyIndex<T, D>& index = by.index;
    if constexpr (is_list<Answer>) {
        answer_by_lists<Given, typename Answer::value_type>(
            options, numbers, first, count, answers,
            [&](const Given& given, Answer& found) { Question::ask(index, given, found); },
            [&](const auto& item, Record& record) {
                ByFileNumbers<Record> numbered{record, by.numbers};
                list_item_columns(index, item, numbered);
            });
    } else {
        answer_by_rows<Given>(
            options, numbers, first, count, answers, no_answer<Question>(),
            [&](std::span<const Given> given, std::span<Answer> found) {
                if constexpr (AsksSolid<Question>)
                    Question::ask_solid(*by.solid, given, found);
                else if constexpr (TakesPointOptions<Question, T, D>)
                    Question::ask_all(index, given, found, {}, options.near<T>());
                else if constexpr (AsksMany<Question>)
                    Question::ask_all(index, given, found);
                else
                    for (std::size_t i = 0; i < count; ++i) Question::ask(index, given[i], found[i]);
            },
            [&]<class R>(const Answer& answer, R& record) {
                ByFileNumbers<R> numbered{record, by.numbers};
                list_answer<Question>(answer, numbered);
            });
    }
}

SolidOptions solid_options(const QueryArguments& a) {
    constexpr std::pair<std::string_view, SideBy> ways[] = {{"crossings", SideBy::crossings},
                                                            {"parity", SideBy::parity},
                                                            {"pseudonormal", SideBy::pseudonormal},
                                                            {"expansion", SideBy::expansion}};
    SolidOptions options{.error = a.error};
    for (const auto& [name, by] : ways)
        if (a.by == name) options.by = by;
    return options;
}

/// Says what it means for sides that neighbours are turned in opposite ways.
template <std::floating_point T, int D>
void warn_of_turns(const QueryArguments& a, const AnySolid<T, D>& solid) {
    if (solid.oriented() || a.by == "parity" || a.by == "expansion") return;
    fmt::print(stderr,
               "hedgerow: {}: some neighbours are turned in opposite ways, so it counts as open where they "
               "meet. {}\n",
               a.scene,
               solid.closed() ? "It is closed: --by parity tells sides whichever way they are turned"
                              : "Turn them the same way");
}

template <class Question, std::floating_point T, int D>
int query(const QueryArguments& a, RowReader<T>& in, const AnyIndex<T, D>& index, QueryReport report) {
    const RowOptions options{a.count, a.radius >= 0 ? a.radius : std::numeric_limits<double>::infinity(),
                             a.factor};
    const std::size_t columns = RowsOf<typename Question::Given>::columns().size();
    report.primitives = index.size();
    Answering<T, D> by{index, nullptr, a.numbers};
    if constexpr (AsksSolid<Question>) {
        ProgressLine line("looking for open edges", a.quiet);
        WatchedExecutor watched(default_executor(), line.progress());
        const double start = now();
        by.solid = index.make_solid(solid_options(a), watched);
        report.build_seconds += now() - start;
        warn_of_turns(a, *by.solid);
    }
    return answer_all<T>(
        a, in, {columns, answer_columns<Question>(), is_list<typename Question::Answer>},
        [&](const T* numbers, std::uint64_t first, std::size_t count, AnsweredRows& answers) {
            answer_piece<Question>(by, options, numbers, first, count, answers);
        },
        report);
}

/// Whether a question tells where on its primitive a closest point is.
template <class Question>
concept TellsFeatures = requires {
    requires Question::tells_features;
};

/// Throws UsageError for options that a question lacks, and for those that it does not take.
template <class Question, std::floating_point T, int D>
void check_options(const QueryArguments& a) {
    using Rows = RowsOf<typename Question::Given>;
    constexpr bool near =
        TakesPointOptions<Question, T, D> || (Rows::takes_count && !detail::is_ray<typename Question::Given>);
    if (Rows::takes_count && a.count == 0)
        throw UsageError(a.kind + " needs --count: how many to find, at least 1");
    if (Rows::takes_radius && a.radius < 0)
        throw UsageError(a.kind + " needs --radius: a distance, at least 0");
    if (!Rows::takes_count && a.count != 0) throw UsageError(a.kind + " takes no --count");
    if (!Rows::takes_radius && !near && a.radius >= 0) throw UsageError(a.kind + " takes no --radius");
    if (!near && a.factor != 1) throw UsageError(a.kind + " takes no --factor");
    if (!AsksSolid<Question> && !a.by.empty()) throw UsageError(a.kind + " takes no --by");
    if (Question::name == AskWindingNumber<T, D>::name && (a.by == "parity" || a.by == "pseudonormal"))
        throw UsageError("winding numbers are told by crossings or expansion, not by " + a.by);
}

/// Whether a question has the name and is of the variant that the options choose. --feature chooses the
/// question that tells features. Of two questions of a name, of boxes and of balls, --radius chooses that of
/// balls.
template <class Question, std::floating_point T, int D>
bool is_asked(const QueryArguments& a) {
    if (Question::name != a.kind || TellsFeatures<Question> != a.feature) return false;
    const bool by_radius = a.radius >= 0;
    if (RowsOf<typename Question::Given>::takes_radius == by_radius) return true;
    bool other = false;
    for_each_question<T, D>([&]<class Other>(Other) {
        other = other || (Other::name == a.kind && RowsOf<typename Other::Given>::takes_radius == by_radius);
    });
    return !other;
}

/// Opens the rows, lets `make_index` build or load an index, and queries it.
template <class P, class F>
int query_set(const QueryArguments& a, F make_index) {
    using T = typename P::Scalar;
    constexpr int D = P::dimension;
    std::optional<int> code;
    for_each_question<T, D>([&]<class Question>(Question) {
        if (!is_asked<Question, T, D>(a)) return;
        check_options<Question, T, D>(a);
        if constexpr (!answered_by<Question, P>) {
            if constexpr (AsksFacets<Question>)
                throw InputError(a.scene + ": " + a.kind + (a.feature ? " with --feature" : "") +
                                 " is asked of triangles, or of segments in the plane. Name such a scene");
            else
                throw InputError(a.scene +
                                 ": rays pass between points. Ask for what is near them, or name a mesh");
        } else {
            const auto in = open_rows<T>(a.from, row_format(a.from, a.format),
                                         RowsOf<typename Question::Given>::columns(), {{}, &interrupted});
            QueryReport report;
            const double start = now();
            const auto index = make_index(report);
            report.build_seconds = now() - start;
            code = query<Question>(a, *in, *index, report);
        }
    });
    if (!code) throw UsageError(a.kind + " takes no --feature");
    return *code;
}
template <class P>
int query_set(const QueryArguments& a, const P& primitives) {
    return query_set<P>(a, [&](QueryReport&) { return build_shown(a, a.structure, primitives); });
}
/// Queries the index of a file, which `load` maps: load(options, executor).
template <class P, class Load>
int query_saved(const QueryArguments& a, Load load) {
    return query_set<P>(a, [&](QueryReport& report) {
        ProgressLine line("loading " + a.scene, a.quiet, "bytes");
        WatchedExecutor watched(default_executor(), line.progress());
        report.loaded = true;
        return any_index(load(LoadIndexOptions(), watched));
    });
}
template <class T>
int query_saved(const QueryArguments& a) {
    const IndexFileInfo info = index_file_info(a.scene);
    if (!info.holds_points)
        return query_saved<TriangleMesh<T>>(
            a, [&](const auto& o, auto& threads) { return load_index<T>(a.scene, o, threads); });
    if (info.dimension == 2)
        return query_saved<PointCloud<T, 2>>(
            a, [&](const auto& o, auto& threads) { return load_point_index<T, 2>(a.scene, o, threads); });
    return query_saved<PointCloud<T, 3>>(
        a, [&](const auto& o, auto& threads) { return load_point_index<T, 3>(a.scene, o, threads); });
}

std::vector<std::string_view> kind_names() {
    auto names = question_names<TriangleMesh<float>>();
    for (const PairKind& kind : pair_kinds()) names.push_back(kind.name);
    return names;
}

/// The kinds of queries, with what each reads and writes, for people.
std::string kinds_help() {
    std::string text = "KIND, the columns of --from in space, and the columns of -o:\n";
    for_each_question<float, 3>([&]<class Question>(Question) {
        const InputColumns in = RowsOf<typename Question::Given>::columns();
        std::string reads;
        for (std::size_t i = 0; i < in.size(); ++i)
            reads += (i == 0 ? "" : " ") + std::string(i == in.required() ? "[" : "") + in.names[i];
        if (!in.defaults.empty()) reads += "]";
        std::string writes;
        for (const Column& c : answer_columns<Question>()) writes += (writes.empty() ? "" : " ") + c.name;
        std::string name(Question::name);
        if (RowsOf<typename Question::Given>::takes_radius) name += " --radius";
        if (TellsFeatures<Question>) name += " --feature";
        text += fmt::format("  {:19} {}\n  {:19}   -> {}\n", name, reads, "", writes);
    });
    for (const PairKind& kind : pair_kinds()) text += fmt::format("  {:19} {}\n", kind.name, kind.meaning);
    return text + "\n";
}

}  // namespace

int print_report(const QueryArguments& a, const QueryReport& r) {
    const double rate = r.seconds > 0 ? double(r.asked) / r.seconds : 0;
    const bool to_pipe = a.output == "-";
    std::FILE* const to = to_pipe ? stderr : stdout;
    if (r.unusable > 0)
        fmt::print(
            stderr,
            "hedgerow: {}: row {}, counted from 0, has no answer{}: a number is not finite, or a place "
            "is farther than 2^60 from 0 (2^480 with --precision double). Repair the row\n",
            a.from, r.first_unusable,
            r.unusable > 1 ? fmt::format(", nor have {} later rows", r.unusable - 1) : "");
    if (a.json && !to_pipe) {
        print_json({{"kind", a.kind},
                    {"structure", a.structure},
                    {"output", r.output},
                    {"primitives", r.primitives},
                    {r.loaded ? "load_seconds" : "build_seconds", r.build_seconds},
                    {"queries", r.asked},
                    {"rows", r.answered},
                    {"unusable", r.unusable},
                    {"seconds", r.seconds},
                    {"queries_per_second", rate},
                    {"finished", r.finished}});
    } else if (!a.quiet && !r.output.empty()) {
        fmt::print(to, "{}: {} rows, {} of {} primitives", r.output, r.answered, a.kind, r.primitives);
        if (r.build_seconds > 0)
            fmt::print(to, ", {} in {:.1f} ms", r.loaded ? "loaded" : "built", r.build_seconds * 1e3);
        if (r.asked > 0)
            fmt::print(to, "; {} queries, {:.3f} million a second", r.asked, rate * 1e-6);
        else
            fmt::print(to, "; found in {:.1f} ms", r.seconds * 1e3);
        fmt::print(to, "\n");
    }
    if (!r.finished)
        fmt::print(stderr, "hedgerow: interrupted; {}\n",
                   r.output.empty()
                       ? "nothing was finished, so nothing is written"
                       : fmt::format("{} has the {} rows that were finished", r.output, r.answered));
    return r.finished ? 0 : 130;
}

Run add_query(CLI::App& verb) {
    auto a = std::make_shared<QueryArguments>();
    verb.add_option("kind", a->kind, "what is asked: see below")->required();
    add_common(verb, *a, true);
    verb.get_option("--output")->description("the file to write: .npy, .csv or .json; - is standard output");
    verb.add_option("--from", a->from, "the rows: .npy, .csv or .json; - is standard input");
    verb.add_option("--with", a->with, "the other scene, for kinds between two");
    verb.add_option("--format", a->format, "of --from: npy, csv or json; needed for a pipe");
    verb.add_option("--output-format", a->output_format, "of -o: npy, csv or json; needed for a pipe");
    verb.add_option("-k,--count", a->count, "nearest, first-hits: how many to find");
    verb.add_option(
        "--radius", a->radius,
        "the distance, not squared. within, pairs-within and neighbours-within need it; closest-point, "
        "farthest-point and nearest find nothing beyond it; overlap, contained, count and any-overlap are "
        "asked of balls");
    verb.add_option(
            "--period", a->periods,
            "pairs-within, neighbours-within: the length after which space repeats, or one for each axis, "
            "0 where it does not: X,Y,Z. Distances are those to the nearest image")
        ->delimiter(',')
        ->expected(1, 3);
    verb.add_option("--factor", a->factor,
                    "closest-point, nearest: how many times as far away as the exact answer one may be; "
                    "farthest-point: how many times less")
        ->capture_default_str();
    verb.add_flag(
        "--feature", a->feature,
        "closest-point: also whether the point is on the face (0), an edge (1) or a vertex (2), its "
        "weights and the normal");
    verb.add_option(
            "--by", a->by,
            "side, signed-distance: how insides are told, crossings (default), parity, pseudonormal or "
            "expansion; winding-number: crossings or expansion")
        ->check(CLI::IsMember({"crossings", "parity", "pseudonormal", "expansion"}));
    verb.add_option("--error", a->error,
                    "--by expansion: how far winding numbers may be off, 1e-9 to 1 (1e-3)");
    verb.add_option("--tolerance", a->tolerance,
                    "hausdorff: how wide the interval may be, in parts of the distance")
        ->capture_default_str();
    verb.add_option("--structure", a->structure,
                    "NAME[:OPTION=VALUE,...]; of a .hedgerow file 'wide' is the index as it was saved")
        ->capture_default_str();
    verb.add_option("--threads", a->threads, "that build and answer; 0: all cores")
        ->capture_default_str()
        ->check(CLI::Range(0, 1024));
    verb.footer(kinds_help() + verb.get_footer());
    return [a, &verb] {
        // Check all that can be checked before any work.
        const auto names = kind_names();
        if (std::find(names.begin(), names.end(), a->kind) == names.end())
            throw UsageError(fmt::format("there is no query '{}'{}; there are {}", a->kind,
                                         suggestion(a->kind, names), fmt::join(names, ", ")));
        if (verb.count("--radius") > 0 && a->radius < 0)
            throw UsageError(fmt::format("--radius {}: a distance is at least 0", a->radius));
        if (!(a->factor >= 1))
            throw UsageError(fmt::format("--factor {}: a factor is at least 1", a->factor));
        if (verb.count("--count") > 0 && a->count == 0) throw UsageError("--count 0: ask for at least 1");
        row_format(a->output, a->output_format);
        if (a->output != "-") check_writable(a->output);
        const ThreadLimit limit(a->threads);
        const auto is_one_of = [&](const auto& kinds) {
            return std::any_of(kinds.begin(), kinds.end(), [&](const auto& k) { return k.name == a->kind; });
        };
        if (verb.count("--error") > 0 && a->by != "expansion")
            throw UsageError("--error is the promise of --by expansion: ask for both");
        if (verb.count("--tolerance") > 0 && a->kind != "hausdorff")
            throw UsageError(a->kind + " takes no --tolerance");
        if (!a->periods.empty() && a->kind != "pairs-within" && a->kind != "neighbours-within")
            throw UsageError(a->kind + " takes no --period");
        if (is_one_of(pair_kinds())) {
            if (!a->by.empty()) throw UsageError(a->kind + " takes no --by");
            if (a->factor != 1) throw UsageError(a->kind + " takes no --factor");
            if (a->feature) throw UsageError(a->kind + " takes no --feature");
            return query_pairs(*a);
        }
        if (!a->with.empty()) throw UsageError(a->kind + " is asked of one scene: leave out --with");
        if (a->from.empty()) throw UsageError(a->kind + " needs --from: the file of rows, or - for a pipe");
        row_format(a->from, a->format);
        if (a->from != "-" && !std::filesystem::exists(a->from))
            throw InputError(a->from + ": there is no such file. Check the path");
        return in_precision(*a, [&]<class T>(T) {
            if (names_index_file(a->scene) && a->structure == "wide") return query_saved<T>(*a);
            QueryArguments numbered = *a;
            LoadReport report;
            const Scene<T> scene = load<T>(*a, &report);
            numbered.numbers = FileNumbers(std::move(report.kept_points));
            return std::visit([&](const auto& set) { return query_set(numbered, set); }, scene);
        });
    };
}

}  // namespace hedgerow::cli
