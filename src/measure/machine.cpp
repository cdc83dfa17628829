#include <hedgerow/measure/machine.h>

#include <algorithm>
#include <cstdint>
#include <fstream>

#include <hedgerow/measure/clock.h>

namespace hedgerow::measure {

std::string processor() {
    std::ifstream info("/proc/cpuinfo");
    for (std::string line; std::getline(info, line);)
        if (line.starts_with("model name")) return line.substr(std::min(line.size(), line.find(':') + 2));
    return "unknown processor";
}

std::string compiler() {
#if defined(__clang__)
    return "clang++ " + std::to_string(__clang_major__) + "." + std::to_string(__clang_minor__);
#elif defined(__GNUC__)
    return "g++ " + std::to_string(__GNUC__) + "." + std::to_string(__GNUC_MINOR__);
#else
    return "unknown compiler";
#endif
}

double clock_rate() {
    // Each 64-bit product waits for the one before it. That takes 3 cycles on every processor of the last
    // decade.
    constexpr int products = 20'000'000;
    std::uint64_t x = 3;
    double least = 1e300;
    for (int r = 0; r < 5; ++r)
        least = std::min(least, measure::seconds_of([&] {
                             for (int i = 0; i < products; ++i) {
                                 x *= 0x9E3779B97F4A7C15u;
                                 asm volatile("" : "+r"(x));
                             }
                         }));
    return 3e-9 * products / least;
}

}  // namespace hedgerow::measure
