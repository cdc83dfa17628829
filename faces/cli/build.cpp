/// hedgerow build: builds an index and saves it in a file.
#include <optional>
#include <type_traits>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <hedgerow/base/error.h>
#include <hedgerow/io/index_file.h>
#include <hedgerow/io/scene_size.h>
#include <hedgerow/io/writable.h>
#include <hedgerow/predicted_memory.h>

#include "memory.h"
#include "verbs.h"

namespace hedgerow::cli {

namespace {

struct BuildArguments : Common {
    std::string structure = "wide", builder = "medium";
    int width = 0;
    unsigned threads = 0;
};

struct Seconds {
    double build = 0, save = 0;
};

void report(const BuildArguments& a, const Seconds& seconds) {
    const IndexFileInfo file = index_file_info(a.output);
    const char* const noun = file.holds_points ? "points" : "triangles";
    const std::string each = file.holds_points ? "point" : "triangle";
    const std::size_t count = file.holds_points ? file.points : file.triangles;
    const double bytes = double(file.index_bytes) / double(std::max<std::size_t>(1, count));
    if (a.json) {
        const nlohmann::ordered_json j = {{"output", a.output},           {noun, count},
                                          {"precision", file.scalar},     {"builder", a.builder},
                                          {"width", file.options.width},  {"build_seconds", seconds.build},
                                          {"save_seconds", seconds.save}, {"nodes", file.nodes},
                                          {"leaves", file.leaves},        {"bytes_per_" + each, bytes},
                                          {"file_bytes", file.file_bytes}};
        print_json(j);
    } else if (!a.quiet) {
        fmt::print("{}: {} {} ({}), built in {:.1f} ms, saved in {:.1f} ms\n", a.output, count, noun,
                   file.scalar, seconds.build * 1e3, seconds.save * 1e3);
        fmt::print("{} nodes of {} children, {} leaves: {:.1f} bytes a {}; the file, with its {}: {} bytes\n",
                   file.nodes, file.options.width, file.leaves, bytes, each,
                   file.holds_points ? "points" : "mesh", file.file_bytes);
    }
}

/// Throws InputError for a kind of primitives whose index no file can hold, and MemoryShort if the scene and
/// the build are predicted to need more memory than there is. Of the scene `loaded` bytes are in memory.
void refuse_unsavable(const BuildArguments& a, const SceneSize& size, bool in_double, double loaded) {
    if (size.kind != "triangles" && size.kind != "points")
        throw InputError(a.scene + ": only an index of triangles or of points can be saved, and these are " +
                         std::string(size.kind) + ". Name a mesh or a cloud");
    const std::string engine = "wide:builder=" + a.builder;
    const double build = predicted_memory(engine, size.kind, size.count, in_double).build_peak;
    const double scene = size.bytes(in_double ? sizeof(double) : sizeof(float));
    expect_memory(fmt::format("to build an index of {} {}", size.count, size.kind), build + scene - loaded,
                  "build where there is more, or a part of the scene");
}

template <class P>
int build_and_save(const BuildArguments& a, const P& set) {
    WideOptions options;
    options.width = a.width;
    options.builder = a.builder == "fast"   ? WideBuilder::fast
                      : a.builder == "high" ? WideBuilder::high
                                            : WideBuilder::medium;
    const ThreadLimit limit(a.threads);
    Seconds seconds;
    const double start = now();
    const auto index = [&] {
        ProgressLine line("building the index", a.quiet);
        WatchedExecutor watched(default_executor(), line.progress());
        return build<WideBvh>(set, options, watched);
    }();
    const double built = now();
    {
        ProgressLine line("saving " + a.output, a.quiet, "bytes");
        save_index(a.output, index, line.progress());
    }
    seconds.build = built - start, seconds.save = now() - built;
    report(a, seconds);
    return 0;
}
/// Refuses a scene, as soon as its size is known, or builds its index and saves it.
template <class T>
int load_and_build(const BuildArguments& a) {
    constexpr bool in_double = std::is_same_v<T, double>;
    const std::optional<SceneSize> size = known_size(a);
    if (size) refuse_unsavable(a, *size, in_double, 0);
    LoadReport told;
    const Scene<T> scene = load<T>(a, &told);
    if (!told.kept_points.empty())
        fmt::print(stderr, "hedgerow: {}: has no numbers of {}: it counts the points that are left\n",
                   a.output, a.scene);
    const SceneSize loaded = size_of(scene);
    refuse_unsavable(a, loaded, in_double, loaded.bytes(sizeof(T)));
    return std::visit(
        [&]<class P>(const P& set) {
            if constexpr (std::is_same_v<P, TriangleMesh<T>> || PointSet<ViewOf<P>>)
                return build_and_save(a, set);
            else
                return 3;  // not reached: refused above
        },
        scene);
}

}  // namespace

Run add_build(CLI::App& verb) {
    auto a = std::make_shared<BuildArguments>();
    add_common(verb, *a, true);
    verb.get_option("--output")->description("the file to write: NAME.hedgerow");
    verb.add_option("--structure", a->structure, "wide: a file holds no other structure")
        ->capture_default_str();
    verb.add_option("--builder", a->builder, "fast, medium or high: time to build against time of queries")
        ->capture_default_str()
        ->check(CLI::IsMember({"fast", "medium", "high"}));
    verb.add_option("--width", a->width, "children a node: 4, 8 or 16; 0: what this processor is best at")
        ->check(CLI::IsMember({0, 4, 8, 16}));
    verb.add_option("--threads", a->threads, "that build; 0: all cores")
        ->capture_default_str()
        ->check(CLI::Range(0, 1024));
    return [a] {
        if (!names_index_file(a->output) || a->output.ends_with(".gz"))
            throw UsageError(a->output + ": a saved index is known by its ending; call it NAME.hedgerow");
        if (a->structure != "wide")
            throw UsageError(a->structure +
                             ": a file holds 'wide' alone, with --builder and --width as its options; "
                             "compare, draw and query build any structure at once");
        check_writable(a->output);
        return in_precision(*a, [&]<class T>(T) { return load_and_build<T>(*a); });
    };
}

}  // namespace hedgerow::cli
