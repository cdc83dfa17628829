#include "progress_line.h"

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <ctime>
#include <exception>
#include <utility>

#include <unistd.h>

#include <fmt/format.h>

namespace hedgerow::cli {

std::atomic<bool> interrupted{false};

namespace {

/// Milliseconds on a clock that only goes forward. May be called in signal handlers.
std::int64_t milliseconds() {
    timespec time{};
    clock_gettime(CLOCK_MONOTONIC, &time);
    return std::int64_t{time.tv_sec} * 1000 + time.tv_nsec / 1'000'000;
}

/// When the first signal came, in milliseconds; 0 before.
std::atomic<std::int64_t> first_signal{0};
static_assert(std::atomic<std::int64_t>::is_always_lock_free);

void stop(int signal) {
    interrupted = true;
    std::int64_t first = 0;
    if (first_signal.compare_exchange_strong(first, milliseconds())) return;
    // `timeout` sends each signal to the process and to its group. Such a pair is one request, so a second
    // Ctrl-C counts only a while after the first signal.
    constexpr std::int64_t pair = 100;
    if (signal == SIGINT && milliseconds() - first > pair) _exit(130);
}

}  // namespace

void listen_to_interrupts() {
    for (const int signal : {SIGINT, SIGTERM, SIGUSR1})
        if (std::signal(signal, stop) == SIG_IGN) std::signal(signal, SIG_IGN);
}

double now() {
    using namespace std::chrono;
    return duration<double>(steady_clock::now().time_since_epoch()).count();
}

namespace {

std::string& failed_work() {
    static std::string work;
    return work;
}

/// Replaces the line on stderr. Failure to write is ignored, since work continues when the terminal is gone.
void rewrite_line(const std::string& text) noexcept {
    std::fprintf(stderr, "\r\033[K%s", text.c_str());
}

/// A count as text: "1.23 million triangles" for 1234567 triangles, "1.23 MB" for as many bytes.
std::string amount(double count, const std::string& unit) {
    if (unit == "bytes") return fmt::format("{:.3g} MB", count * 1e-6);
    if (count >= 1e6) return fmt::format("{:.3g} million {}", count * 1e-6, unit);
    return fmt::format("{:.0f} {}", count, unit);
}

}  // namespace

ProgressLine::ProgressLine(std::string what, bool quiet, std::string unit)
    : what_(std::move(what)),
      unit_(std::move(unit)),
      shown_(!quiet && isatty(2)),
      exceptions_(std::uncaught_exceptions()),
      start_(now()) {}
ProgressLine::~ProgressLine() {
    if (std::uncaught_exceptions() > exceptions_) failed_work() = std::move(what_);  // allocates nothing
    if (shown_) rewrite_line("");
}
const std::string& ProgressLine::failed() {
    return failed_work();
}

Progress ProgressLine::progress() {
    return {[this](std::uint64_t done, std::uint64_t total) { show(done, total); }, &interrupted};
}
void ProgressLine::show(std::uint64_t done, std::uint64_t total) {
    for (std::uint64_t most = done_; done > most && !done_.compare_exchange_weak(most, done);) {
    }
    if (!shown_) return;
    const std::lock_guard lock(mutex_);
    if (now() - last_ < 0.1) return;
    last_ = now();
    rewrite_line(progress_text(what_, unit_, done, total, last_ - start_));
}
void ProgressLine::say(const std::string& doing) {
    const std::lock_guard lock(mutex_);
    if (shown_) rewrite_line(what_ + " " + doing);
}

void ProgressLine::rename(std::string what) {
    const std::lock_guard lock(mutex_);
    what_ = std::move(what);
}
void ProgressLine::show_above(const std::string& lines) {
    const std::lock_guard lock(mutex_);
    if (!isatty(2)) return;
    if (lines_above_ > 0) std::fprintf(stderr, "\033[%tdA", lines_above_);
    rewrite_line(lines);
    lines_above_ = std::ranges::count(lines, '\n');
}

std::string progress_text(const std::string& what, const std::string& unit, std::uint64_t done,
                          std::uint64_t total, double seconds) {
    const double rate = static_cast<double>(done) / std::max(seconds, 1e-9);
    std::string text = what;
    if (total > 0) text += fmt::format(" {:.0f}%", 100.0 * double(done) / double(total));
    if (total == 0 && !unit.empty()) text += " " + amount(double(done), unit);
    if (!unit.empty()) text += fmt::format(", {} a second", amount(rate, unit));
    if (total > 0 && done > 0) text += fmt::format(", {:.0f} s left", double(total - done) / rate);
    return text;
}

}  // namespace hedgerow::cli
