/// hedgerow compare: measures every structure with every query, and recommends structures.
#include <algorithm>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <hedgerow/any_index.h>
#include <hedgerow/base/error.h>
#include <hedgerow/measure/compare.h>
#include <hedgerow/questions.h>
#include <hedgerow/render/camera/presets.h>

#include "compare_report.h"
#include "compare_visibility.h"
#include "verbs.h"
#include "view.h"

namespace hedgerow::cli {

namespace {

struct CompareArguments : Common {
    std::string structures, html, sizes, ask, pixels = "256x256,1024x1024";
    std::vector<std::string> sweeps;
    bool scale = false, full = false, counts = false, visibility = false;
    ViewArguments view;
    unsigned threads = 1;
    std::size_t queries = 10'000;
    double seconds = 0.1;
};

measure::MeasureOptions measure_options(const CompareArguments& a, bool all) {
    measure::MeasureOptions o;
    o.queries = a.queries, o.seconds = a.seconds, o.seed = a.seed;
    o.camera = camera_for(generated_name(a));
    o.updates = all;
    if (a.counts) {
        o.rounds = 0;
        if (!a.ask.empty()) o.asks = {a.ask};
    }
    return o;
}

/// The camera that the user placed, or nothing without camera options. Throws InputError for a flat scene
/// with camera options.
template <class P>
std::optional<Camera> placed_camera(const CompareArguments& a, const P& primitives) {
    if (a.view.eye.empty() && a.view.target.empty() && a.view.fov == 0 && a.view.up == "auto")
        return std::nullopt;
    if constexpr (P::dimension == 3) {
        const auto view = view_of(primitives);
        Box3f box;
        for (std::size_t i = 0; i < primitives.size(); ++i) {
            const auto bounds = view.bounds(i);
            box.expand(Vec3f(bounds.low)).expand(Vec3f(bounds.high));
        }
        return camera_of(a.view, a, box, upright_of(a.view, a, primitives));
    } else {
        throw InputError(a.scene + ": --eye, --target, --up and --fov are for scenes in space");
    }
}

/// Checks names and options before a long run, by building each structure over one primitive. Throws as
/// build_any does.
void check_structures(const std::vector<std::string>& structures, int dimension) {
    for (const std::string& s : structures) {
        if (dimension == 3)
            build_any(s, PointCloud<float, 3>{{{0, 0, 0}}}.view());
        else
            build_any(s, PointCloud<float, 2>{{{0, 0}}}.view());
    }
}

// ---- What is visible, by rasterising and by casting ----

/// The sizes of pictures in a list, as 256x256,1024x768.
std::vector<std::pair<int, int>> picture_sizes(const std::string& list) {
    std::vector<std::pair<int, int>> sizes;
    for (std::size_t at = 0; at <= list.size();) {
        const std::size_t comma = std::min(list.find(',', at), list.size());
        sizes.push_back(parse_size(list.substr(at, comma - at)));
        at = comma + 1;
    }
    return sizes;
}
template <class P>
void measure_visibility(const CompareArguments& a, const P& primitives, VisibilityReport& report) {
    if constexpr (!std::same_as<P, TriangleMesh<typename P::Scalar>>) {
        throw InputError(a.scene +
                         ": only triangles can be rasterised, so --visibility compares nothing here");
    } else {
        Box3f box;
        for (const auto& v : primitives.vertices) box.expand(Vec3f(v));
        for (const auto& [width, height] : picture_sizes(a.pixels)) {
            measure::VisibilityOptions options;
            options.width = width, options.height = height;
            ViewArguments view = a.view;
            view.size = fmt::format("{}x{}", width, height);
            options.camera = camera_of(view, a, box, upright_of(view, a, primitives));
            if (!a.structures.empty()) options.structures = measure::structures_of(a.structures);
            check_structures(options.structures, 3);
            ProgressLine line(fmt::format("{} triangles, {}", primitives.size(), view.size), a.quiet);
            report.cases.push_back(measure::compare_visibility(primitives, options, line.progress()));
        }
    }
}
/// Calls f with the scene, or with scenes of all --sizes, until an interrupt.
template <class T, class F>
void for_each_size(const CompareArguments& a, F f) {
    try {
        if (a.sizes.empty()) return std::visit(f, load<T>(a));
        if (!a.scene.starts_with("gen:"))
            throw UsageError(a.scene + ": --sizes needs a scene of any size, as gen:terrain");
        SceneSpec spec = parse_scene_spec(a.scene);
        for (const std::uint64_t size : measure::sizes_of(a.sizes)) {
            spec.size = size;
            std::visit(f, generate_scene<T>(a, spec));
        }
    } catch (const Cancelled&) {  // what was measured before is still shown
    }
}
template <class T>
int compare_visibility_in(const CompareArguments& a) {
    const ThreadLimit limit(1);
    VisibilityReport report{a.scene, {}};
    for_each_size<T>(a, [&](const auto& set) { measure_visibility(a, set, report); });
    if (report.cases.empty()) throw Cancelled("nothing was measured");
    if (a.json) {
        print_json(json_of(report));
    } else {
        fmt::print("{}\n\n", a.scene);
        for (const std::string& line : break_even_lines(report)) fmt::print("{}.\n", line);
        for (const Table& t : tables_of(report)) fmt::print("\n{}", text_of(t));
        fmt::print(
            "\nNote: one thread; times are medians of {} rounds, in which all ways take turns; every way "
            "found "
            "the same hits, bit for bit.\n",
            measure::VisibilityOptions().rounds);
        for (const auto& c : report.cases)
            for (const std::string& way : c.left_out)
                fmt::print("Note: {} is left out at {} triangles and {} x {} pixels: it would take long.\n",
                           way, c.triangles, c.width, c.height);
    }
    if (!a.html.empty()) {
        std::fflush(stdout);
        const std::string page = interrupted ? unfinished_name(a.html) : a.html;
        save_text(page, page_of(report));
        if (!a.json) fmt::print("{}\n", page);
    }
    return interrupted ? 130 : 0;
}

// ---- Structures ----

class Comparing {
public:
    explicit Comparing(const CompareArguments& a)
        : a_(a), limit_(a.threads), executor_(a.threads == 1 ? serial_executor() : default_executor()) {
        report_.scene = a.scene;
        report_.timed = !a.counts;
        if (!a.ask.empty()) report_.ask = a.ask;
        for (const std::string& s : a.sweeps) report_.sweeps.push_back({measure::sweep_of(s), {}});
    }

    template <class P>
    void compare_on(const P& primitives) {
        check_ask<P>();
        for (auto& s : report_.sweeps) check_structures(s.sweep.structures, P::dimension);
        const auto chosen = structures_for<P>(primitives.size());
        check_structures(chosen, P::dimension);
        if (report_.sweeps.empty() && !a_.scale)
            report_.comparison = measured(primitives, chosen, true, "comparing");
        for (auto& s : report_.sweeps) {
            if (interrupted) break;
            s.comparison = measured(primitives, s.sweep.structures, false, "sweeping " + s.sweep.option);
        }
    }
    template <class P>
    void scale_on(const P& primitives, const std::vector<std::string>& structures) {
        check_ask<P>();
        check_structures(structures, P::dimension);
        auto c = measured(primitives, structures, false, fmt::format("{} primitives", primitives.size()));
        if (!c.finished) return;
        report_.by_size.push_back(std::move(c));
    }

    /// The structures that the user named, or the usual ones for `size` primitives. Brute force is always
    /// among them, as the baseline of costs.
    template <class P>
    std::vector<std::string> structures_for(std::size_t size) {
        if (a_.structures.empty()) {
            std::vector<std::string> left_out;
            auto usual = measure::usual_structures(P::dimension, PointSet<ViewOf<P>>, size, left_out);
            for (const auto& s : left_out)
                note(fmt::format(
                    "{} is left out: it takes long to build over {} primitives; name it in --structures", s,
                    size));
            return usual;
        }
        auto structures = measure::structures_of(a_.structures);
        if (std::find(structures.begin(), structures.end(), "brute-force") == structures.end())
            structures.insert(structures.begin(), "brute-force");
        return structures;
    }

    /// Whether there is anything to show.
    bool measured_any() const {
        const auto& r = report_;
        return (r.comparison && !r.comparison->structures.empty()) || !r.by_size.empty() ||
               std::any_of(r.sweeps.begin(), r.sweeps.end(),
                           [](const auto& s) { return !s.comparison.structures.empty(); });
    }
    const CompareReport& report() {
        if (a_.counts) {
            note(fmt::format("{} queries of each kind, asked once; nothing is timed", a_.queries));
        } else {
            note(fmt::format(
                "built on {}, asked on one thread; times are medians of {} rounds; the counts beside "
                "them are the same on every machine where all queries were asked",
                a_.threads == 1   ? "one thread"
                : a_.threads == 0 ? "all cores"
                                  : fmt::format("{} threads", a_.threads),
                measure::MeasureOptions().rounds));
            note(fmt::format(
                "{} queries of each kind; where 'asked' (--full) is less, it was a sample of them, evenly "
                "taken, that fits into {} s",
                a_.queries, a_.seconds));
            note(
                "walks are compiled once for all kinds of primitives, at the price of a call a leaf: none "
                "that was measured in most cases, a quarter of a query's time at most; rays to triangles and "
                "the default structure are compiled by themselves");
        }
        if (interrupted) note("interrupted: only what was finished is here");
        std::erase_if(report_.sweeps, [](const auto& s) { return s.comparison.structures.empty(); });
        return report_;
    }

private:
    /// Throws UsageError, before anything is measured, if --for names a query that P does not support.
    template <class P>
    void check_ask() const {
        const auto names = question_names<P>();
        if (!a_.ask.empty() && std::find(names.begin(), names.end(), a_.ask) == names.end())
            throw UsageError(fmt::format("--for {}: points cannot be asked that; try --for nearest", a_.ask));
    }
    void note(std::string text) {
        if (std::find(report_.notes.begin(), report_.notes.end(), text) == report_.notes.end())
            report_.notes.push_back(std::move(text));
    }
    template <class P>
    measure::Comparison measured(const P& primitives, const std::vector<std::string>& structures, bool all,
                                 const std::string& what) {
        auto options = measure_options(a_, all);
        if (const auto placed = placed_camera(a_, primitives)) options.camera = placed;
        ProgressLine line(what, a_.quiet);
        measure::Comparison c;
        try {
            c = measure::compare(primitives, structures, by(executor_, options), line.progress());
        } catch (const Cancelled&) {  // comparisons measured before are still shown
            c.finished = false;
        }
        c.scene = a_.scene;
        if (a_.ask.empty() && !c.structures.empty()) report_.ask = measure::usual_ask(c);
        for (auto& text : ray_notes(c)) note(std::move(text));
        return c;
    }

    const CompareArguments& a_;
    ThreadLimit limit_;
    Executor& executor_;
    CompareReport report_;
};

template <class T>
void run_scale(const CompareArguments& a, Comparing& comparing) {
    if (!a.scene.starts_with("gen:"))
        throw UsageError(a.scene + ": --scale needs a scene of any size, as gen:terrain");
    SceneSpec spec = parse_scene_spec(a.scene);
    // Without --sizes measure from 1000 to the scene's SIZE (at least 8000), or to 64,000 if it has none.
    const std::string standard =
        fmt::format("1000..{}", std::max<std::uint64_t>(8000, spec.size.value_or(64'000)));
    const auto sizes = measure::sizes_of(a.sizes.empty() ? standard : a.sizes);
    if (sizes.size() < 3)
        throw UsageError("--sizes " + a.sizes + ": growth needs at least three sizes, as 1k,4k,16k");
    // Generate and measure a scene of each size, the smallest first.
    std::vector<std::string> structures;
    const auto scale = [&](const auto& set) {
        // Measure one list of structures at all sizes: the list for the largest size.
        if (structures.empty())
            structures = comparing.structures_for<std::remove_cvref_t<decltype(set)>>(sizes.back());
        comparing.scale_on(set, structures);
    };
    try {
        for (const std::uint64_t size : sizes) {
            if (interrupted) return;
            spec.size = size;
            std::visit(scale, generate_scene<T>(a, spec));
        }
    } catch (const Cancelled&) {  // interrupted while generating: the smaller sizes are still shown
    }
}

/// Wraps a text into lines of a terminal and indents all but the first.
std::string paragraph(const std::string& text) {
    constexpr std::size_t letters = 110;
    std::string result;
    for (const std::string& line : wrapped(text, letters))
        result += (result.empty() ? "" : "  ") + line + "\n";
    return result;
}

void show(const CompareArguments& a, const CompareReport& r) {
    if (a.json) {
        print_json(json_of(r));
    } else {
        // Collect the text: advice, summary, tables, notes.
        std::string text = r.scene;
        if (r.comparison) text += fmt::format(": {} {}", r.comparison->size, r.comparison->primitive);
        text += "\n\n";
        for (const std::string& line : advice_lines(r)) text += paragraph("For " + line);
        if (const auto summary = summary_of(r)) text += "\n" + text_of(*summary) + "\n";
        if (a.full || !r.comparison)
            for (const Table& t : tables_of(r)) text += text_of(t) + "\n";
        for (const std::string& n : r.notes) text += paragraph("Note: " + n + ".");
        if (r.comparison && !a.full)
            text += paragraph("Note: --full shows each kind of query, changes and break-even.");
        fmt::print("{}", text);
    }
    if (a.html.empty()) return;
    std::fflush(stdout);  // prints the results even if the page cannot be saved
    const std::string page = interrupted ? unfinished_name(a.html) : a.html;
    save_text(page, page_of(r));
    if (!a.json) fmt::print("{}\n", page);
}

template <class T>
int compare_in(const CompareArguments& a) {
    Comparing comparing(a);
    if (a.scale) run_scale<T>(a, comparing);
    try {
        if (!interrupted && (!a.scale || !a.sweeps.empty()))
            std::visit([&](const auto& set) { comparing.compare_on(set); }, load<T>(a));
    } catch (const Cancelled&) {  // interrupted while loading: growth measured before is still shown
    }
    if (!comparing.measured_any()) throw Cancelled("nothing was measured");
    show(a, comparing.report());
    return interrupted ? 130 : 0;
}

}  // namespace

Run add_compare(CLI::App& verb) {
    auto a = std::make_shared<CompareArguments>();
    add_common(verb, *a, false);
    verb.add_option("--structures", a->structures,
                    "which, as grid,bvh:builder=sweep,bins=8,kdtree; brute force is always among them");
    verb.add_option("--sweep", a->sweeps,
                    "STRUCTURE:option=FROM..TO, or a list of values: what an option does")
        ->allow_extra_args(false)
        ->option_text("TEXT, may be repeated");
    verb.add_flag("--scale", a->scale, "how costs grow with a generated scene, and which laws fit");
    verb.add_option("--sizes", a->sizes,
                    "of a generated scene, for --scale or --visibility: FROM..TO or a list; for --scale 1000 "
                    "to 64000 if not given");
    verb.add_flag("--visibility", a->visibility,
                  "what a picture costs by rasterising its triangles and by casting rays at --structures");
    verb.add_option("--pixels", a->pixels, "of --visibility: sizes of pictures, as 256x256,1024x768")
        ->capture_default_str()
        ->needs("--visibility");
    const auto names = question_names<TriangleMesh<float>>();
    verb.add_option("--for", a->ask, "the query that break-even, advice and growth are about")
        ->check(CLI::IsMember(std::vector<std::string>(names.begin(), names.end())));
    verb.add_flag("--full", a->full, "also a table for each kind of query, for changes and for break-even");
    verb.add_flag("--counts", a->counts, "counts alone: all queries are asked once, and nothing is timed");
    add_camera(verb, a->view);
    verb.add_option("--html", a->html, "also write one page with plots, that needs no other file");
    verb.add_option("--queries", a->queries, "of each kind")
        ->capture_default_str()
        ->check(CLI::Range(16, 10'000'000));
    verb.add_option("--time", a->seconds, "seconds for each structure and kind of query")
        ->capture_default_str()
        ->check(CLI::Range(0.001, 3600.0));
    verb.add_option("--threads", a->threads, "that build; 0: all cores")
        ->capture_default_str()
        ->check(CLI::Range(0, 1024));
    return [a] {
        if (!a->html.empty()) check_writable(a->html);
        if (!a->sizes.empty() && !a->scale && !a->visibility)
            throw UsageError("--sizes requires --scale or --visibility");
        if (a->visibility && (a->scale || !a->sweeps.empty() || !a->ask.empty() || a->counts || a->full))
            throw UsageError(
                "--visibility compares ways to see a picture: leave out --scale, --sweep, --for, --counts, "
                "--full");
        if (a->visibility) {
            picture_sizes(a->pixels);
            return in_precision(*a, [&]<class T>(T) { return compare_visibility_in<T>(*a); });
        }
        return in_precision(*a, [&]<class T>(T) { return compare_in<T>(*a); });
    };
}

}  // namespace hedgerow::cli
