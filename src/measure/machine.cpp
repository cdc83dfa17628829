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

#if defined(__x86_64__)
namespace {

using Floats8 [[gnu::vector_size(32)]] = float;
using Floats16 [[gnu::vector_size(64)]] = float;

/// Multiplies eight independent vectors by a factor, many times, so that the multipliers are the limit. The
/// vectors have names, since g++ keeps arrays of vectors in memory.
template <class V>
[[gnu::target("avx512f,avx512vl"), gnu::noinline]] void multiply(int times) {
    const V by = V{} + 1.0001f;
    V a = by, b = by, c = by, d = by, e = by, f = by, g = by, h = by;
    for (int n = 0; n < times; ++n) {
        a *= by, b *= by, c *= by, d *= by, e *= by, f *= by, g *= by, h *= by;
        asm volatile("" : "+v"(a), "+v"(b), "+v"(c), "+v"(d), "+v"(e), "+v"(f), "+v"(g), "+v"(h));
    }
}
template <class V>
double seconds_of_products() {
    double least = 1e300;
    for (int r = 0; r < 20; ++r) least = std::min(least, seconds_of([] { multiply<V>(10'000); }));
    return least;
}

}  // namespace

std::string avx512_rate() {
    __builtin_cpu_init();
    if (!__builtin_cpu_supports("avx512f") || !__builtin_cpu_supports("avx512vl")) return "no AVX-512";
    const double by_8 = seconds_of_products<Floats8>(), by_16 = seconds_of_products<Floats16>();
    return by_16 < 1.5 * by_8 ? "AVX-512 at full rate" : "AVX-512 at half rate";
}
#else
std::string avx512_rate() {
    return "no AVX-512";
}
#endif

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
