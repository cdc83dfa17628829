#include "kernel_use.h"

#include <algorithm>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace hedgerow::cli {

std::string most_used(const KernelUse& use, std::uint64_t rays) {
    const std::size_t most = std::max({use.single, use.phased, use.packets});
    if (most == 0) return "";
    return fmt::format("{} {:.0f}%",
                       most == use.packets  ? "packets"
                       : most == use.phased ? "phased"
                                            : "single",
                       100 * static_cast<double>(most) / static_cast<double>(rays));
}

nlohmann::ordered_json rays_by(const KernelUse& use) {
    return {{"single", use.single}, {"phased", use.phased}, {"packets", use.packets}};
}

}  // namespace hedgerow::cli
