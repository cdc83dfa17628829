/// hedgerow query: answers rows of queries from a file, in chunks.
#include <algorithm>
#include <filesystem>
#include <iterator>
#include <memory>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <hedgerow/base/error.h>
#include <hedgerow/base/spelling.h>
#include <hedgerow/io/index_file.h>

#include "row_query.h"

namespace hedgerow::cli {

namespace {

RowOptions row_options(const QueryArguments& a) {
    RowOptions options{.count = a.count, .factor = a.factor, .solid = {.error = a.error}};
    if (a.radius >= 0) options.radius = a.radius;
    const auto by = std::find(std::begin(side_by_names), std::end(side_by_names), a.by);
    if (by != std::end(side_by_names)) options.solid.by = static_cast<SideBy>(by - std::begin(side_by_names));
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

template <std::floating_point T, int D>
int query(const QueryArguments& a, RowReader<T>& in, const AnyIndex<T, D>& index,
          const AnyQuestion<T, D>& question, QueryReport report) {
    RowsAsked<T, D> asked{.index = index, .options = row_options(a), .numbers = a.numbers.all()};
    report.primitives = index.size();
    std::unique_ptr<const AnySolid<T, D>> solid;
    if (question.info().of_solid) {
        ProgressLine line("looking for open edges", a.quiet);
        WatchedExecutor watched(default_executor(), line.progress());
        const double start = now();
        solid = index.make_solid(asked.options.solid, watched);
        asked.solid = solid.get();
        report.build_seconds += now() - start;
        warn_of_turns(a, *solid);
    }
    const QuestionInfo& info = question.info();
    return answer_all<T>(
        a, in, {info.asked.size(), info.answered, info.lists},
        [&](const T* rows, std::uint64_t first, std::size_t count, AnsweredRows& answers) {
            question.answer(asked, rows, first, count, answers);
        },
        report);
}

/// Throws UsageError for options that a question needs, and for those that it does not take.
void check_options(const QueryArguments& a, const QuestionInfo& info) {
    const std::pair<std::string_view, bool> given[] = {
        {"count", a.count != 0}, {"radius", a.radius >= 0}, {"factor", a.factor != 1}, {"by", !a.by.empty()}};
    for (const auto& [name, is_given] : given) {
        const QuestionOption* const option = info.option(name);
        if (option != nullptr && option->needed && !is_given)
            throw UsageError(fmt::format("{} needs --{}: {}", a.kind, name, option->meaning));
        if (option == nullptr && is_given) throw UsageError(fmt::format("{} takes no --{}", a.kind, name));
    }
    if (const QuestionOption* const by = info.option("by"); by != nullptr && !a.by.empty())
        if (std::find(by->choices.begin(), by->choices.end(), a.by) == by->choices.end())
            throw UsageError(
                fmt::format("{} is told by {}, not by {}", a.kind, fmt::join(by->choices, " or "), a.by));
}

/// The question that is asked: of two of a name, --feature chooses that which tells features, and --radius
/// that of balls.
template <std::floating_point T, int D>
const AnyQuestion<T, D>& asked_question(const QueryArguments& a) {
    const AnyQuestion<T, D>* question = any_question<T, D>(a.kind, a.feature ? "feature" : "");
    if (question == nullptr) throw UsageError(a.kind + " takes no --feature");
    if (a.radius >= 0)
        if (const auto* const of_balls = any_question<T, D>(a.kind, "radius")) question = of_balls;
    check_options(a, question->info());
    return *question;
}

/// Opens the rows, lets `make_index` build or load an index, and queries it.
template <class P, class F>
int query_set(const QueryArguments& a, F make_index) {
    using T = typename P::Scalar;
    constexpr int D = P::dimension;
    const AnyQuestion<T, D>& question = asked_question<T, D>(a);
    if (question.info().of_facets && !FacetSet<ViewOf<P>>)
        throw InputError(a.scene + ": " + a.kind + (a.feature ? " with --feature" : "") +
                         " is asked of triangles, or of segments in the plane. Name such a scene");
    if (question.info().of_rays && PointSet<ViewOf<P>>)
        throw InputError(a.scene + ": rays pass between points. Ask for what is near them, or name a mesh");
    const auto in =
        open_rows<T>(a.from, row_format(a.from, a.format), question.info().asked, {{}, &interrupted});
    QueryReport report;
    const double start = now();
    const auto index = make_index(report);
    report.build_seconds = now() - start;
    return query(a, *in, *index, question, report);
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
/// The names of the kinds of rows for which `holds` is true, in a sentence.
template <class Holds>
std::string kinds_that(Holds holds, bool pairs_of_points = false) {
    std::vector<std::string_view> names;
    for (const auto* const question : any_questions<float, 3>()) {
        const QuestionInfo& info = question->info();
        if (holds(info) && (names.empty() || names.back() != info.name)) names.push_back(info.name);
    }
    if (pairs_of_points)
        for (const PairKind& kind : pair_kinds())
            if (kind.takes_radius) names.push_back(kind.name);
    return fmt::format("{}", fmt::join(names, ", "));
}
/// The kinds that take an option, and what it means.
std::string option_help(std::string_view name) {
    std::string meaning;
    const auto kinds = kinds_that([&](const QuestionInfo& info) {
        const QuestionOption* const option = info.option(name);
        if (option != nullptr && meaning.empty()) meaning = option->meaning;
        return option != nullptr;
    });
    return kinds + ": " + meaning;
}
std::string radius_help() {
    const auto takes = [](bool needed) {
        return [needed](const QuestionInfo& info) {
            const QuestionOption* const option = info.option("radius");
            return option != nullptr && option->needed == needed && info.variant.empty();
        };
    };
    return fmt::format(
        "the distance, not squared. {} need it; {} find nothing beyond it; {} are asked of balls",
        kinds_that(takes(true), true), kinds_that(takes(false)),
        kinds_that([](const QuestionInfo& info) { return info.variant == "radius"; }));
}

/// The kinds of queries, with what each reads and writes, for people.
std::string kinds_help() {
    std::string text = "KIND, the columns of --from in space, and the columns of -o:\n";
    for (const auto* const question : any_questions<float, 3>()) {
        const QuestionInfo& info = question->info();
        const InputColumns& in = info.asked;
        std::string reads;
        for (std::size_t i = 0; i < in.size(); ++i)
            reads += (i == 0 ? "" : " ") + std::string(i == in.required() ? "[" : "") + in.names[i];
        if (!in.defaults.empty()) reads += "]";
        std::string writes;
        for (const Column& c : info.answered) writes += (writes.empty() ? "" : " ") + c.name;
        std::string name(info.name);
        if (const auto* const radius = info.option("radius"); radius != nullptr && radius->needed)
            name += " --radius";
        if (info.variant == "feature") name += " --feature";
        text += fmt::format("  {:19} {}\n  {:19}   {}\n  {:19}   -> {}\n", name, reads, "", info.meaning, "",
                            writes);
    }
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
    verb.add_option("-k,--count", a->count, option_help("count"));
    verb.add_option("--radius", a->radius, radius_help());
    verb.add_option(
            "--period", a->periods,
            "pairs-within, neighbours-within: the length after which space repeats, or one for each axis, "
            "0 where it does not: X,Y,Z. Distances are those to the nearest image")
        ->delimiter(',')
        ->expected(1, 3);
    verb.add_option("--factor", a->factor, option_help("factor"))->capture_default_str();
    verb.add_flag(
        "--feature", a->feature,
        "closest-point: also whether the point is on the face (0), an edge (1) or a vertex (2), its "
        "weights and the normal");
    verb.add_option("--by", a->by, option_help("by") + " (crossings)")
        ->check(CLI::IsMember(std::vector<std::string>(std::begin(side_by_names), std::end(side_by_names))));
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
