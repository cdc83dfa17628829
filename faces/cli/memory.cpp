#include "memory.h"

#include <fmt/format.h>

#include <hedgerow/io/memory.h>

namespace hedgerow::cli {

void expect_memory(const std::string& what, double bytes, const std::string& instead) {
    const auto most = static_cast<double>(memory_left());
    if (bytes > most)
        throw MemoryShort(fmt::format("{} takes at least {:.3g} GB of memory, and there are {:.3g} GB: {}",
                                      what, bytes * 1e-9, most * 1e-9, instead));
}

}  // namespace hedgerow::cli
