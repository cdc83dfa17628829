/// Clocks to measure with.
#pragma once

namespace hedgerow::compare {

/// Time on the wall, or what this thread, or all threads of the process, have worked: there what else runs on
/// the machine does not count.
enum class Clock { wall, thread, process };

/// Seconds since some start. Where the system does not tell what was worked, the clock on the wall.
double now(Clock clock);

template <class F>
double seconds_of(F f, Clock clock = Clock::thread) {
    const double start = now(clock);
    f();
    return now(clock) - start;
}

}  // namespace hedgerow::compare
