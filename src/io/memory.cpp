/// Memory figures from the system, where it gives them (Linux: /proc and /sys; elsewhere POSIX limits).
#include "memory.h"

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <limits>
#include <optional>

#include <hedgerow/base/error.h>

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

/// The number after a key in a file of "key number" lines.
std::optional<std::uint64_t> number_behind(const std::filesystem::path& path, const std::string& key) {
    std::ifstream file(path);
    for (std::string word; file >> word;) {
        std::uint64_t value = 0;
        if (word == key && file >> value) return value;
    }
    return std::nullopt;
}

/// The number after a key in a file of "key: number kB" lines, in bytes.
std::uint64_t kilobytes(const char* path, const std::string& key, std::uint64_t otherwise) {
    const auto found = number_behind(path, key);
    return found ? *found * 1024 : otherwise;
}

std::uint64_t first_number(const std::filesystem::path& path, std::uint64_t otherwise) {
    std::uint64_t value = 0;
    return std::ifstream(path) >> value ? value : otherwise;  // "max" is no number
}

/// Where a hierarchy of control groups is mounted, and the names of its files.
struct Hierarchy {
    const char *folder, *limit, *use, *idle_cache;
};
constexpr Hierarchy version_1{"memory", "memory.limit_in_bytes", "memory.usage_in_bytes",
                              "total_inactive_file"};
constexpr Hierarchy version_2{"", "memory.max", "memory.current", "inactive_file"};
constexpr Hierarchy version_2_beside_1{"unified", version_2.limit, version_2.use, version_2.idle_cache};

/// The least that a group and the groups around it leave. Cached files that are not in use are freed when
/// memory is short, so they do not count as used. In a container the group's own path may be missing: the
/// process's group is then the one that is mounted at the root.
std::uint64_t left_in_groups(const std::filesystem::path& mounted, const Hierarchy& files,
                             std::filesystem::path group) {
    std::uint64_t left = unlimited;
    for (;; group = group.parent_path()) {
        const auto folder = mounted / files.folder / group.relative_path();
        const std::uint64_t limit = first_number(folder / files.limit, unlimited);
        if (limit != unlimited) {
            const std::uint64_t use = first_number(folder / files.use, 0);
            const auto cache = number_behind(folder / "memory.stat", files.idle_cache);
            left = std::min(left, difference(limit, difference(use, cache.value_or(0))));
        }
        if (!group.has_relative_path()) return left;
    }
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
    left = std::min(left, detail::memory_left_to_group("/proc/self/cgroup", "/sys/fs/cgroup"));
#if HEDGEROW_HAS_RLIMIT
    left = std::min(left, difference(soft_limit(RLIMIT_AS), kilobytes(status, "VmSize:", 0)));
    left = std::min(left, difference(soft_limit(RLIMIT_DATA), kilobytes(status, "VmData:", 0)));
#endif
    return left;
}

namespace detail {

std::uint64_t memory_left_to_group(const std::filesystem::path& groups,
                                   const std::filesystem::path& mounted) {
    std::uint64_t left = unlimited;
    std::ifstream file(groups);
    for (std::string line; std::getline(file, line);) {  // "number:controllers:path"
        const auto first = line.find(':'), second = line.find(':', first + 1);
        if (first == line.npos || second == line.npos) continue;
        const std::string controllers = "," + line.substr(first + 1, second - first - 1) + ",";
        const std::filesystem::path group = line.substr(second + 1);
        if (controllers.find(",memory,") != line.npos)
            left = std::min(left, left_in_groups(mounted, version_1, group));
        if (controllers == ",,")
            for (const Hierarchy& files : {version_2, version_2_beside_1})
                left = std::min(left, left_in_groups(mounted, files, group));
    }
    return left;
}

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
