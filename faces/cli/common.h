/// What the verbs share: options, loading with progress, interruption.
#pragma once

#include <atomic>
#include <mutex>
#include <string>
#include <string_view>
#include <vector>

#include <hedgerow/io/scene_file.h>
#include <hedgerow/parallel/progress.h>

namespace hedgerow::cli {

/// Set by SIGINT: long work ends early with what it has.
extern std::atomic<bool> interrupted;

/// Seconds on a clock that only goes forward.
double now();

/// A line on stderr with rate and time left; silent unless a person looks.
class ProgressLine {
public:
    ProgressLine(std::string what, bool quiet);
    ~ProgressLine();
    Progress progress();
    /// Says what is being done, where nobody knows how much there is to do.
    void say(const std::string& doing);

private:
    void show(std::uint64_t done, std::uint64_t total);

    std::string what_;
    bool shown_;
    double start_, last_ = 0;
    std::mutex mutex_;
};

struct Common {
    std::string scene, output, precision = "float";
    bool json = false, quiet = false, drop_bad = false;
    std::uint64_t seed = 0;
};

/// "cornell-box" of "gen:cornell-box:32"; empty for a file.
std::string generated_name(const Common& c);

template <class T>
Scene<T> load(const Common& c) {
    if (c.scene.starts_with("gen:")) {
        auto spec = parse_scene_spec(c.scene);
        spec.seed = c.seed;
        return generate<T>(spec);
    }
    ProgressLine line("loading", c.quiet);
    return load_scene<T>(c.scene, {c.drop_bad}, line.progress());
}

/// "float" or "double": as the user asked, or as a saved index is.
std::string precision_of(const Common& c);

/// Calls f with a float or a double.
template <class F>
int in_precision(const Common& c, F f) {
    return precision_of(c) == "double" ? f(double()) : f(float());
}

/// A text in lines of at most so many letters, broken at blanks; a longer word has a line of its own.
std::vector<std::string> wrapped(std::string_view text, std::size_t letters);

/// Throws InputError before any work is done for a path that cannot be written.
void check_writable(const std::string& path);
/// Beside the path first, so that what was there is lost only for something whole. Throws InputError.
void save_text(const std::string& path, const std::string& text);

}  // namespace hedgerow::cli
