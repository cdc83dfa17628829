/// hedgerow query: answers rows of queries from a file, in chunks.
#include <algorithm>
#include <filesystem>
#include <memory>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <hedgerow/base/error.h>
#include <hedgerow/base/spelling.h>

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

/// Puts a question to an index for each of `count` rows.
template <class Question, std::floating_point T, int D>
void answer_piece(const AnyIndex<T, D>& index, const RowOptions& options, const T* numbers,
                  std::uint64_t first, std::size_t count, AnsweredRows& answers) {
    using Given = typename Question::Given;
    using Answer = typename Question::Answer;
    if constexpr (is_list<Answer>) {
        answer_by_lists<Given, typename Answer::value_type>(
            options, numbers, first, count, answers,
            [&](const Given& given, Answer& found) { Question::ask(index, given, found); },
            [&](const auto& item, Record& record) { list_item_columns(index, item, record); });
    } else {
        answer_by_rows<Given>(
            options, numbers, first, count, answers, Answer(),
            [&](std::span<const Given> given, std::span<Answer> found) {
                if constexpr (AsksMany<Question>) {
                    Question::ask_all(index, given, found);
                } else {
                    Visits nobodys;
                    for (std::size_t i = 0; i < count; ++i) Question::ask(index, given[i], found[i], nobodys);
                }
            },
            [](const Answer& answer, Record& record) { list_answer<Question>(answer, record); });
    }
}

template <class Question, std::floating_point T, int D>
int query(const QueryArguments& a, RowReader<T>& in, const AnyIndex<T, D>& index, QueryReport report) {
    const RowOptions options{a.count, a.radius};
    const std::size_t columns = RowsOf<typename Question::Given>::columns().size();
    report.primitives = index.size();
    return answer_all<T>(
        a, in, {columns, answer_columns<Question>(), is_list<typename Question::Answer>},
        [&](const T* numbers, std::uint64_t first, std::size_t count, AnsweredRows& answers) {
            answer_piece<Question>(index, options, numbers, first, count, answers);
        },
        report);
}

/// Opens the rows, lets `make_index` build or load an index, and queries it.
template <class P, class F>
int query_set(const QueryArguments& a, F make_index) {
    using T = typename P::Scalar;
    int code = 2;
    for_each_question<T, P::dimension>([&]<class Question>(Question) {
        if (Question::name != a.kind) return;
        if constexpr (!answered_by<Question, P>) {
            throw InputError(a.scene +
                             ": rays pass between points. Ask for what is near them, or name a mesh");
        } else {
            using Rows = RowsOf<typename Question::Given>;
            if (Rows::takes_count && a.count == 0)
                throw UsageError(a.kind + " needs --count: how many neighbours, at least 1");
            if (Rows::takes_radius && a.radius < 0)
                throw UsageError(a.kind + " needs --radius: a distance, at least 0");
            if (!Rows::takes_count && a.count != 0) throw UsageError(a.kind + " takes no --count");
            if (!Rows::takes_radius && a.radius >= 0) throw UsageError(a.kind + " takes no --radius");
            const auto in =
                open_rows<T>(a.from, row_format(a.from, a.format), Rows::columns(), {{}, &interrupted});
            QueryReport report;
            const double start = now();
            const auto index = make_index(report);
            report.build_seconds = now() - start;
            code = query<Question>(a, *in, *index, report);
        }
    });
    return code;
}
template <class P>
int query_set(const QueryArguments& a, const P& primitives) {
    return query_set<P>(a, [&](QueryReport&) { return build_shown(a, a.structure, primitives); });
}
template <class T>
int query_saved(const QueryArguments& a) {
    return query_set<TriangleMesh<T>>(a, [&](QueryReport& report) {
        ProgressLine line("loading " + a.scene, a.quiet, "bytes");
        WatchedExecutor watched(default_executor(), line.progress());
        report.loaded = true;
        return any_index(load_index<T>(a.scene, {}, watched));
    });
}

std::vector<std::string_view> kind_names() {
    auto names = question_names<TriangleMesh<float>>();
    for (const EngineKind& kind : region_kinds()) names.push_back(kind.name);
    for (const EngineKind& kind : inside_kinds()) names.push_back(kind.name);
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
        text += fmt::format("  {:19} {}\n  {:19}   -> {}\n", Question::name, reads, "", writes);
    });
    for (const auto kinds : {region_kinds(), inside_kinds()})
        for (const EngineKind& kind : kinds)
            text += fmt::format("  {:19} {}\n  {:19}   -> {}\n", kind.name, kind.reads, "", kind.writes);
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
            "hedgerow: {}: row {}, counted from 0, is not finite, so it has no answer{}. Repair the row\n",
            a.from, r.first_unusable,
            r.unusable > 1 ? fmt::format("; nor have {} later rows", r.unusable - 1) : "");
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
        fmt::print(to, "{}: {} rows, {} of {} primitives, {} in {:.1f} ms", r.output, r.answered, a.kind,
                   r.primitives, r.loaded ? "loaded" : "built", r.build_seconds * 1e3);
        if (r.asked > 0) fmt::print(to, "; {} queries, {:.3f} million a second", r.asked, rate * 1e-6);
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
    verb.add_option("-k,--count", a->count, "nearest: how many neighbours");
    verb.add_option("--radius", a->radius, "within, balls, pairs-within: the distance, not squared");
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
        if (verb.count("--count") > 0 && a->count == 0) throw UsageError("--count 0: ask for at least 1");
        row_format(a->output, a->output_format);
        if (a->output != "-") check_writable(a->output);
        const ThreadLimit limit(a->threads);
        const auto is_one_of = [&](const auto& kinds) {
            return std::any_of(kinds.begin(), kinds.end(), [&](const auto& k) { return k.name == a->kind; });
        };
        const bool of_inside = is_one_of(inside_kinds()), of_region = is_one_of(region_kinds());
        if (!of_inside && !a->by.empty()) throw UsageError(a->kind + " takes no --by");
        if (verb.count("--error") > 0 && a->by != "expansion")
            throw UsageError("--error is the promise of --by expansion: ask for both");
        if (verb.count("--tolerance") > 0 && a->kind != "hausdorff")
            throw UsageError(a->kind + " takes no --tolerance");
        if (is_one_of(pair_kinds())) return query_pairs(*a);
        if (!a->with.empty()) throw UsageError(a->kind + " is asked of one scene: leave out --with");
        if (a->from.empty()) throw UsageError(a->kind + " needs --from: the file of rows, or - for a pipe");
        row_format(a->from, a->format);
        if (a->from != "-" && !std::filesystem::exists(a->from))
            throw InputError(a->from + ": there is no such file. Check the path");
        if (of_inside || of_region) {
            if (a->structure != "wide")
                throw UsageError(a->kind + " is answered by the engine: leave out --structure");
            if (a->count != 0) throw UsageError(a->kind + " takes no --count");
            return of_inside ? query_inside(*a) : query_region(*a);
        }
        return in_precision(*a, [&]<class T>(T) {
            if (names_index_file(a->scene) && a->structure == "wide") return query_saved<T>(*a);
            return std::visit([&](const auto& set) { return query_set(*a, set); }, load<T>(*a));
        });
    };
}

}  // namespace hedgerow::cli
