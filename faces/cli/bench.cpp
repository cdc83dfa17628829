/// hedgerow bench: rays per second of the engine and of every peer that is present.
#include <algorithm>
#include <filesystem>
#include <thread>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <hedgerow/base/error.h>
#include <hedgerow/base/spelling.h>
#include <hedgerow/measure/machine.h>
#include <hedgerow/render/camera/presets.h>

#include "bench_report.h"
#include "peers/peers.h"
#include "saved_rays.h"
#include "verbs.h"

namespace hedgerow::cli {

using namespace measure;

namespace {

struct BenchArguments : Common {
    std::vector<std::string> scenes, rays;
    std::string sets = fmt::format("{}", fmt::join(ray_kinds, ",")), modes = "one,batch",
                questions = "closest,any", builders = "medium,high", instruction_set, html;
    int width = 0, rounds = 0;
    unsigned threads = 1;
    bool quick = false, makes_sets = true;
};

constexpr const char* usual_scenes[] = {
    "gen:teapot-in-stadium:50000", "gen:turned-stadium:200000", "gen:terrain:500000",
    "gen:hairball:500000",         "gen:grass:300000",          "gen:soup:200000",
    "gen:boulder:1000000",         "gen:interior:1000000"};

/// Parses a comma-separated list of known words. The position of a word in `known` is its value in E. A word
/// that is repeated counts once. Throws UsageError for an unknown word.
template <class E, std::size_t N>
std::vector<E> list_of(const std::string& option, const std::string& list,
                       const std::string_view (&known)[N]) {
    std::vector<E> all;
    std::size_t begin = 0;
    while (begin <= list.size()) {
        const std::size_t end = std::min(list.find(',', begin), list.size());
        const std::string word = list.substr(begin, end - begin);
        const auto at = std::find(std::begin(known), std::end(known), word);
        if (at == std::end(known))
            throw UsageError(fmt::format("{}: there is no '{}'{}; there are {}", option, word,
                                         suggestion(word, known), fmt::join(known, ", ")));
        const auto value = static_cast<E>(at - std::begin(known));
        if (std::find(all.begin(), all.end(), value) == all.end()) all.push_back(value);
        begin = end + 1;
    }
    return all;
}

EngineOptions options_of(const BenchArguments& a) {
    EngineOptions o;
    o.sets.clear();
    if (a.makes_sets) o.sets = list_of<RayKind>("--sets", a.sets, ray_kinds);
    o.questions = list_of<Question>("--questions", a.questions, questions);
    o.modes = list_of<Mode>("--modes", a.modes, modes);
    o.builders = list_of<WideBuilder>("--builders", a.builders, wide_builder_names);
    if (a.makes_sets && std::all_of(o.sets.begin(), o.sets.end(), only_any_hit) &&
        o.questions == std::vector{Question::closest})
        throw UsageError("--sets " + a.sets + ": these rays are asked for any hit; add --questions any");
    if (a.quick) o.rounds = 3, o.picture = 128, o.random = 1 << 14, o.sample = 2000;
    if (a.rounds > 0) o.rounds = a.rounds;
    o.seed = a.seed, o.cancel = &interrupted;
    o.threads = a.threads > 0 ? a.threads : std::max(1u, std::thread::hardware_concurrency());
    WideOptions tree;
    tree.width = a.width;
    o.width = resolved(tree).width;
    return o;
}

struct NamedMesh {
    std::string name;
    TriangleMesh<float> mesh;
    std::optional<Camera> camera;  // of the scene's own
};

/// Loads all scenes before anything is measured, so that a bad scene is reported before a long run. Throws
/// InputError for a scene without triangles.
std::vector<NamedMesh> load_all(const BenchArguments& a) {
    std::vector<std::string> scenes = a.scenes;
    if (scenes.empty()) scenes.assign(std::begin(usual_scenes), std::end(usual_scenes));
    std::vector<NamedMesh> all;
    for (const std::string& scene : scenes) {
        Common one = a;
        one.scene = scene, one.precision = "float";
        const std::string name =
            scene.starts_with("gen:") ? scene : std::filesystem::path(scene).filename().string();
        auto loaded = load<float>(one);
        auto* const mesh = std::get_if<TriangleMesh<float>>(&loaded);
        if (mesh == nullptr)
            throw InputError(scene +
                             ": holds no triangles; bench is about rays against triangles: see "
                             "compare for other primitives");
        if (mesh->size() == 0) throw InputError(scene + ": is empty, so there is nothing to measure");
        all.push_back({name, std::move(*mesh), camera_for(generated_name(one))});
    }
    return all;
}

BenchReport report_for(const EngineOptions& options, const std::vector<std::unique_ptr<Peer>>& peers) {
    BenchReport r;
    r.processor = processor(), r.avx512_rate = avx512_rate(), r.compiler = compiler(),
    r.cores = std::thread::hardware_concurrency();
    r.instruction_set = name_of(instruction_set());
    r.gigahertz = clock_rate();
    r.width = options.width, r.threads = options.threads, r.options = options;
    for (const auto& peer : peers) {
        r.peers.push_back({peer->name(), peer->version(), {}});
        for (const PeerBuild& b : peer->builds()) r.peers.back().builds.push_back(b.name);
    }
    r.notes.push_back(
        fmt::format("medians of {} rounds, which go through all in turn; one thread each, and only "
                    "what it works counts{}",
                    options.rounds, options.threads > 1 ? "; on several threads the clock on the wall" : ""));
    if (peers.empty())
        r.notes.emplace_back(
            "no peer is present, so these are our own figures alone; for Embree: apt-get install "
            "libembree-dev, then configure and build again");
    return r;
}

void show(const BenchArguments& a, const BenchReport& r) {
    if (a.json) return print_json(json_of(r));
    std::string text = machine_of(r) + "\n\n";
    for (const Table& t : tables_of(r)) text += text_of(t) + "\n";
    for (const std::string& n : r.notes) text += "Note: " + n + ".\n";
    fmt::print("{}", text);
}
/// Saves the page and the chart. An interrupted run saves under other names, so that complete files of an
/// earlier run stay.
void save_pages(const BenchArguments& a, const BenchReport& r) {
    std::fflush(stdout);  // prints the tables even if a file cannot be saved
    const auto save = [&](const std::string& path, const std::string& text) {
        const std::string to = r.finished ? path : unfinished_name(path);
        save_text(to, text);
        if (!a.json) fmt::print("{}\n", to);
    };
    if (!a.html.empty()) save(a.html, page_of(r));
    if (!a.output.empty()) save(a.output, chart_of(r));
}

int bench(const BenchArguments& a) {
    if (!a.instruction_set.empty()) use_instruction_set(a.instruction_set);
    EngineOptions options = options_of(a);
    std::vector<RaySet> saved;
    for (const std::string& file : a.rays) saved.push_back(load_rays(file));
    options.more_sets = saved;
    // Load all scenes, and find the peers.
    const auto scenes = load_all(a);
    const auto peers = measure::peers();
    BenchReport report = report_for(options, peers);
    // Measure one scene after the other until interrupted.
    {
        ProgressLine line("bench", a.quiet);
        const GoOn go_on = [&line](const std::string& next) {
            line.say(next);
            return !interrupted;
        };
        for (const NamedMesh& s : scenes) {
            if (interrupted) break;
            EngineOptions of_scene = options;
            of_scene.camera = s.camera;
            report.scenes.push_back(measure_engine(s.name, s.mesh, peers, of_scene, go_on));
        }
    }
    // Report what was finished, if anything was.
    report.finished = !interrupted;
    if (interrupted) report.notes.emplace_back("interrupted: only what was finished is here");
    if (!report.finished && std::all_of(report.scenes.begin(), report.scenes.end(), [](const SceneCosts& s) {
            return s.rows.empty() && s.builds.empty();
        }))
        throw Cancelled("nothing was measured");
    show(a, report);
    save_pages(a, report);
    return interrupted ? 130 : 0;
}

}  // namespace

Run add_bench(CLI::App& verb) {
    auto a = std::make_shared<BenchArguments>();
    verb.add_option(
        "scenes", a->scenes,
        fmt::format("mesh files or gen:NAME[:SIZE]; without any {}", fmt::join(usual_scenes, " ")));
    verb.add_option("-o,--output", a->output, "also write a chart of the rates, as .svg");
    verb.add_option("--html", a->html, "also write one page with plots, that needs no other file");
    verb.add_flag("--quick", a->quick, "fewer rays and rounds");
    const auto* const sets =
        verb.add_option("--sets", a->sets, fmt::format("of rays, as {}", fmt::join(ray_kinds, ",")))
            ->capture_default_str();
    verb.add_option(
        "--rays", a->rays,
        "files of rays, as render --save-rays writes them and query reads them, of one scene; they "
        "take the place of --sets, unless that is given too");
    verb.add_option("--questions", a->questions, "closest,any; shadow and ambient rays are asked any")
        ->capture_default_str();
    verb.add_option("--modes", a->modes, "one: a call a ray; batch: a call for all")->capture_default_str();
    verb.add_option("--builders", a->builders, "whose trees are traced, as fast,medium,high; the best counts")
        ->capture_default_str();
    verb.add_option("--width", a->width, "children a node: 4, 8 or 16; 0: the best for the instruction set")
        ->capture_default_str();
    verb.add_option("--instruction-set", a->instruction_set,
                    fmt::format("one of {}; peers use no more than it", fmt::join(instruction_sets(), ", ")));
    verb.add_option("--threads", a->threads,
                    "more than 1: our batches and builds on so many too; 0: all cores")
        ->capture_default_str()
        ->check(CLI::Range(0, 1024));
    verb.add_option("--rounds", a->rounds, "whose median is taken; 5, with --quick 3")
        ->check(CLI::Range(1, 1000));
    add_reporting(verb, *a);
    add_drop_bad(verb, *a);
    return [a, sets] {
        if (!a->rays.empty() && a->scenes.size() != 1)
            throw UsageError("--rays are those of one scene: name it, and no other");
        a->makes_sets = a->rays.empty() || sets->count() > 0;
        if (!a->html.empty()) check_writable(a->html);
        if (!a->output.empty()) {
            if (ending_of(a->output) != ".svg")
                throw UsageError(a->output + ": the chart is written as .svg; let the output end so");
            check_writable(a->output);
        }
        return bench(*a);
    };
}

}  // namespace hedgerow::cli
