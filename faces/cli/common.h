/// Code that the verbs share: options, loading and building with progress, results and files.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include <hedgerow/any_index.h>
#include <hedgerow/io/scene_file.h>
#include <hedgerow/io/scene_size.h>
#include <hedgerow/io/text_file.h>
#include <hedgerow/io/writable.h>
#include <hedgerow/parallel/watched_executor.h>

#include "progress_line.h"

namespace hedgerow::cli {

struct Common {
    std::string scene, output;
    std::string precision = "auto";  // float, double, or double where float loses detail of a file
    bool json = false, quiet = false, drop_bad = false;
    std::uint64_t seed = 0;
};

/// The name of a generated scene: "cornell-box" for "gen:cornell-box:32". Empty for a file.
std::string generated_name(const Common& c);

/// The number of a scene's primitives before it is loaded or generated: of a file, if its header says so.
/// Throws as parse_scene_spec and size_in_header do.
std::optional<SceneSize> known_size(const Common& c);

/// Throws MemoryShort if a generated scene is known to need more memory than there is.
void check_memory(const SceneSpec& spec);

template <class T>
Scene<T> generate_scene(const Common& c, SceneSpec spec) {
    spec.seed = c.seed;
    check_memory(spec);
    ProgressLine line("generating gen:" + spec.name, c.quiet, "elements");
    return generate<T>(spec, line.progress());
}
/// Thrown where floats lose detail of a file, and the user named no precision.
struct DoublesNeeded {};
/// Prints to stderr what the loader of a file reports, and remembers for print_json what was left out. Where
/// floats lose detail and the user named no precision: tells that the file will be read in double, and throws
/// DoublesNeeded.
void tell(const Common& c, const LoadReport& report);

/// Loads or generates the scene. `told`, if not null, gets what the loader of a file reports.
template <class T>
Scene<T> load(const Common& c, LoadReport* told = nullptr) {
    if (c.scene.starts_with("gen:")) return generate_scene<T>(c, parse_scene_spec(c.scene));
    LoadReport report;
    Scene<T> scene = [&] {
        ProgressLine line("loading " + c.scene, c.quiet, "bytes");
        return load_scene<T>(c.scene, {c.drop_bad, &report}, line.progress());
    }();
    tell(c, report);
    if (told != nullptr) *told = std::move(report);
    return scene;
}

/// An executor on all cores, whose work throws Cancelled after Ctrl-C.
Executor& interruptible_executor();

/// Builds the structure that `structure` names over the primitives, and shows progress. Throws Cancelled when
/// interrupted, and as build_any does.
template <class P>
auto build_shown(const Common& c, const std::string& structure, const P& primitives) {
    ProgressLine line("building " + structure, c.quiet);
    WatchedExecutor watched(default_executor(), line.progress());
    return build_any(structure, primitives, watched);
}

/// "float" or "double": the precision of a saved index, or else the one that the user chose, or else float.
std::string precision_of(const Common& c);

/// Calls f(float()) or f(double()), by `precision_of`; f(double()) also if f(float()) found that it needs
/// doubles. Returns the result of f.
template <class F>
int in_precision(const Common& c, F f) {
    if (precision_of(c) == "double") return f(double());
    try {
        return f(float());
    } catch (const DoublesNeeded&) {
        return f(double());
    }
}

/// The double with the shortest decimal digits of the number: 0.05f becomes 0.05, not 0.05000000074505806.
double shortest(float number);
inline double shortest(double number) {
    return number;
}

/// Prints results to stdout, with the number of points or faces that --drop-bad left out. Bytes of names that
/// are not UTF-8 are replaced.
void print_json(const nlohmann::ordered_json& results);

/// Breaks a text at blanks into lines of at most `letters` bytes. A longer word has a line of its own.
std::vector<std::string> wrapped(std::string_view text, std::size_t letters);

/// The extension of a path in lower case, with its dot: ".png".
std::string ending_of(const std::string& path);

/// The name under which an interrupted verb saves the finished part of `path`: "a.unfinished.png" for
/// "a.png". An earlier "a.png" stays as it was.
std::string unfinished_name(const std::string& path);

}  // namespace hedgerow::cli
