/// A line on the terminal that says what is being done, how fast, and how long it will take.
#pragma once

#include <atomic>
#include <mutex>
#include <string>

#include <hedgerow/parallel/progress.h>

namespace hedgerow::cli {

/// Set by Ctrl-C: long work ends early with what it has.
extern std::atomic<bool> interrupted;
/// From here on the first Ctrl-C sets `interrupted`, and the second ends the process at once with code 130.
/// Nothing is changed where Ctrl-C was ignored before.
void listen_to_interrupts();

/// Seconds on a clock that only goes forward.
double now();

/// A piece of long work, as its user sees it on stderr; silent unless that is a terminal. It is also what
/// messages name when the work fails for want of memory.
class ProgressLine {
public:
    /// `what` as in "building kdtree"; `unit` is what is counted, in the plural. Without one no rate is
    /// shown.
    ProgressLine(std::string what, bool quiet, std::string unit = "");
    ~ProgressLine();
    ProgressLine(const ProgressLine&) = delete;
    ProgressLine& operator=(const ProgressLine&) = delete;

    Progress progress();
    /// Says what is being done, where nobody knows how much there is to do.
    void say(const std::string& doing);
    /// The most that the work said is done.
    std::uint64_t done() const { return done_; }
    /// The last work that ended in an exception; empty if there was none.
    static const std::string& failed();

private:
    void show(std::uint64_t done, std::uint64_t total);

    std::string what_, unit_;
    bool shown_;
    int exceptions_;  // under way when the work began
    double start_, last_ = 0;
    std::atomic<std::uint64_t> done_{0};
    std::mutex mutex_;
};

/// The line's text: share done, rate and time left, as far as they are known. `seconds` have passed.
std::string progress_text(const std::string& what, const std::string& unit, std::uint64_t done,
                          std::uint64_t total, double seconds);

}  // namespace hedgerow::cli
