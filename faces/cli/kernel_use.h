/// Which algorithms answered rays, as text and as JSON.
#pragma once

#include <string>

#include <nlohmann/json_fwd.hpp>

#include <hedgerow/structures/bvh/wide/kernels.h>

namespace hedgerow::cli {

/// What answered most of so many rays: "packets 97%"; "single" also where there is no kernel. Empty without
/// rays.
std::string most_used(const KernelUse& use, std::uint64_t rays);
nlohmann::ordered_json rays_by(const KernelUse& use);

}  // namespace hedgerow::cli
