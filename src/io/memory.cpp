/// The system's own figures, where it gives them (Linux: /proc and /sys; elsewhere POSIX limits).
#include "memory.h"

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <limits>

#include <hedgerow/error.h>

#if __has_include(<sys/resource.h>)
#include <sys/resource.h>
#define HEDGEROW_HAS_RLIMIT 1
#else
#define HEDGEROW_HAS_RLIMIT 0
#endif

namespace hedgerow {

namespace {

constexpr std::uint64_t unlimited = std::numeric_limits<std::uint64_t>::max();

std::uint64_t difference(std::uint64_t a, std::uint64_t b) {
    return a == unlimited ? a : a - std::min(a, b);
}

/// The number behind a key of a file of "key: number kB" lines, in bytes.
std::uint64_t kilobytes(const char* path, const std::string& key, std::uint64_t otherwise) {
    std::ifstream file(path);
    for (std::string word; file >> word;) {
        std::uint64_t value = 0;
        if (word == key && file >> value) return value * 1024;
    }
    return otherwise;
}

std::uint64_t first_number(const char* path) {
    std::uint64_t value = 0;
    return std::ifstream(path) >> value ? value : unlimited;  // "max" is no number
}

#if HEDGEROW_HAS_RLIMIT
template <class Resource>
std::uint64_t soft_limit(Resource resource) {
    rlimit limit{};
    if (getrlimit(resource, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY) return unlimited;
    return limit.rlim_cur;
}
#endif

}  // namespace

std::uint64_t memory_left() {
    constexpr const char* status = "/proc/self/status";
    std::uint64_t left = kilobytes("/proc/meminfo", "MemAvailable:", unlimited);
    if (left != unlimited) left += kilobytes("/proc/meminfo", "SwapFree:", 0);
    for (const char* group : {"/sys/fs/cgroup/memory.max", "/sys/fs/cgroup/memory/memory.limit_in_bytes"})
        left = std::min(left, difference(first_number(group), kilobytes(status, "VmRSS:", 0)));
#if HEDGEROW_HAS_RLIMIT
    left = std::min(left, difference(soft_limit(RLIMIT_AS), kilobytes(status, "VmSize:", 0)));
    left = std::min(left, difference(soft_limit(RLIMIT_DATA), kilobytes(status, "VmData:", 0)));
#endif
    return left;
}

namespace detail {

std::string bytes_text(std::uint64_t bytes) {
    char text[32];
    const double b = static_cast<double>(bytes);
    if (b >= 1e9)
        std::snprintf(text, sizeof text, "%.1f GB", b / 1e9);
    else
        std::snprintf(text, sizeof text, "%.1f MB", b / 1e6);
    return text;
}

void expect_memory(const std::string& name, const std::string& what, std::uint64_t bytes) {
    const std::uint64_t left = memory_left();
    if (bytes <= left) return;
    throw InputError(name + ": " + what + " need " + bytes_text(bytes) + " of memory, but only " +
                     bytes_text(left) + " can be had. Split the file, or read it where there is more");
}

}  // namespace detail

}  // namespace hedgerow
