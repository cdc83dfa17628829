/// A line on the terminal that shows the current work, its rate and the time left.
#pragma once

#include <atomic>
#include <cstddef>
#include <mutex>
#include <string>

#include <hedgerow/parallel/progress.h>

namespace hedgerow::cli {

/// Set by Ctrl-C (SIGINT), SIGTERM and SIGUSR1. Long work then ends early, with the part that is finished.
extern std::atomic<bool> interrupted;
/// From here on SIGINT, SIGTERM and SIGUSR1 set `interrupted`. A second Ctrl-C ends the process at once with
/// code 130. SIGTERM and SIGUSR1 never do, since job schedulers repeat them while results are saved; they
/// have SIGKILL for that. A signal that was ignored before stays ignored.
void listen_to_interrupts();

/// Seconds on a clock that only goes forward.
double now();

/// Shows the progress of a piece of long work on stderr, if stderr is a terminal. If the work runs out of
/// memory, the error message names it.
class ProgressLine {
public:
    /// `what` names the work: "building kdtree". `unit` names the counted items, in the plural; without a
    /// unit no rate is shown.
    ProgressLine(std::string what, bool quiet, std::string unit = "");
    ~ProgressLine();
    ProgressLine(const ProgressLine&) = delete;
    ProgressLine& operator=(const ProgressLine&) = delete;

    /// The progress to give to the work. It borrows this line, and is cancelled by Ctrl-C.
    Progress progress();
    /// Shows the current step, for work of unknown length.
    void say(const std::string& doing);
    /// Gives the work another name.
    void rename(std::string what);
    /// Shows lines of text above the progress, in place of those before, even where there is none to show.
    /// Nothing is shown unless stderr is a terminal.
    void show_above(const std::string& lines);
    /// The largest amount that the work has reported as done.
    std::uint64_t done() const { return done_; }
    /// The name of the last work that ended in an exception; empty if none did.
    static const std::string& failed();

private:
    void show(std::uint64_t done, std::uint64_t total);

    std::string what_, unit_;
    bool shown_;
    int exceptions_;  // exceptions in flight when the work began
    double start_, last_ = 0;
    std::ptrdiff_t lines_above_ = 0;
    std::atomic<std::uint64_t> done_{0};
    std::mutex mutex_;
};

/// The text of the line: share done, rate and time left, as far as they are known. `seconds` is the time
/// since the work began.
std::string progress_text(const std::string& what, const std::string& unit, std::uint64_t done,
                          std::uint64_t total, double seconds);

}  // namespace hedgerow::cli
