/// What the verbs share: options, loading and building with progress, results and files.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include <hedgerow/any_index.h>
#include <hedgerow/io/scene_file.h>
#include <hedgerow/io/text_file.h>
#include <hedgerow/io/writable.h>
#include <hedgerow/parallel/watched_executor.h>

#include "progress_line.h"

namespace hedgerow::cli {

struct Common {
    std::string scene, output, precision = "float";
    bool json = false, quiet = false, drop_bad = false;
    std::uint64_t seed = 0;
};

/// "cornell-box" of "gen:cornell-box:32"; empty for a file.
std::string generated_name(const Common& c);

/// Throws MemoryShort for a scene that is known to be too large.
void check_memory(const SceneSpec& spec);

template <class T>
Scene<T> generate_scene(const Common& c, SceneSpec spec) {
    spec.seed = c.seed;
    check_memory(spec);
    ProgressLine line("generating gen:" + spec.name, c.quiet, "elements");
    return generate<T>(spec, line.progress());
}
template <class T>
Scene<T> load(const Common& c) {
    if (c.scene.starts_with("gen:")) return generate_scene<T>(c, parse_scene_spec(c.scene));
    ProgressLine line("loading " + c.scene, c.quiet, "bytes");
    return load_scene<T>(c.scene, {c.drop_bad}, line.progress());
}

/// All cores, until Ctrl-C: then they throw Cancelled.
Executor& interruptible_executor();

/// What `structure` names over the primitives, with progress. Throws Cancelled when interrupted.
template <class P>
auto build_shown(const Common& c, const std::string& structure, const P& primitives) {
    ProgressLine line("building " + structure, c.quiet);
    WatchedExecutor watched(default_executor(), line.progress());
    return build_any(structure, primitives, watched);
}

/// "float" or "double": as the user asked, or as a saved index is.
std::string precision_of(const Common& c);

/// Calls f with a float or a double.
template <class F>
int in_precision(const Common& c, F f) {
    return precision_of(c) == "double" ? f(double()) : f(float());
}

/// A number in double that has the digits of its own type: 0.05f is 0.05, not 0.05000000074505806.
double shortest(float number);
inline double shortest(double number) {
    return number;
}

/// Prints results. Bytes of names that are no UTF-8 are replaced.
void print_json(const nlohmann::ordered_json& results);

/// A text in lines of at most so many letters, broken at blanks; a longer word has a line of its own.
std::vector<std::string> wrapped(std::string_view text, std::size_t letters);

/// The extension of a path in lower case, as ".png".
std::string ending_of(const std::string& path);

/// Where what was finished before an interruption goes: "a.unfinished.png" beside "a.png", which stays as it
/// was.
std::string unfinished_name(const std::string& path);

}  // namespace hedgerow::cli
