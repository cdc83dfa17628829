/// Clocks for measurements.
#pragma once

namespace hedgerow::measure {

/// Wall-clock time, or the processor time of this thread, or of all threads of the process. Processor time
/// leaves out other load on the machine.
enum class Clock { wall, thread, process };

/// Seconds since an arbitrary start. Where the system has no clock for processor time, the wall clock is
/// used.
double now(Clock clock);

/// Seconds that a call of f takes.
template <class F>
double seconds_of(F f, Clock clock = Clock::thread) {
    const double start = now(clock);
    f();
    return now(clock) - start;
}

}  // namespace hedgerow::measure
