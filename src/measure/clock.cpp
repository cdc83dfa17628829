#include <hedgerow/measure/clock.h>

#include <chrono>
#include <ctime>

namespace hedgerow::measure {

double now(Clock clock) {
#if defined(CLOCK_THREAD_CPUTIME_ID) && defined(CLOCK_PROCESS_CPUTIME_ID)
    timespec t{};
    if (clock != Clock::wall &&
        clock_gettime(clock == Clock::thread ? CLOCK_THREAD_CPUTIME_ID : CLOCK_PROCESS_CPUTIME_ID, &t) == 0)
        return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
#else
    static_cast<void>(clock);
#endif
    using namespace std::chrono;
    return duration<double>(steady_clock::now().time_since_epoch()).count();
}

}  // namespace hedgerow::measure
