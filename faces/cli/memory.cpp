#include "memory.h"

#include <algorithm>
#include <fstream>

#include <sys/resource.h>
#include <unistd.h>

#if __has_include(<sys/sysinfo.h>)
#include <sys/sysinfo.h>
#define HEDGEROW_SYSINFO 1
#else
#define HEDGEROW_SYSINFO 0
#endif

#include <fmt/format.h>

namespace hedgerow::cli {

namespace {

double memory_of_machine() {
#if HEDGEROW_SYSINFO
    struct sysinfo all {};
    if (sysinfo(&all) == 0)
        return (static_cast<double>(all.totalram) + static_cast<double>(all.totalswap)) * all.mem_unit;
#endif
    return static_cast<double>(sysconf(_SC_PHYS_PAGES)) * static_cast<double>(sysconf(_SC_PAGE_SIZE));
}

}  // namespace

double memory_at_hand() {
    double bytes = memory_of_machine();
    rlimit limit{};
    if (getrlimit(RLIMIT_AS, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY)
        bytes = std::min(bytes, static_cast<double>(limit.rlim_cur));
    for (const char* file : {"/sys/fs/cgroup/memory.max", "/sys/fs/cgroup/memory/memory.limit_in_bytes"}) {
        double group = 0;
        if (std::ifstream(file) >> group) bytes = std::min(bytes, group);
    }
    return bytes;
}

void expect_memory(const std::string& what, double bytes, const std::string& instead) {
    const double most = memory_at_hand();
    if (bytes > most)
        throw MemoryShort(fmt::format("{} takes at least {:.3g} GB of memory, and there are {:.3g} GB: {}",
                                      what, bytes * 1e-9, most * 1e-9, instead));
}

}  // namespace hedgerow::cli
