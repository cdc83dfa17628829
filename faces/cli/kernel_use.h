/// The algorithms that answered rays, as text and as JSON.
#pragma once

#include <string>

#include <nlohmann/json_fwd.hpp>

#include <hedgerow/walks/engine.h>

namespace hedgerow::cli {

/// The algorithm that answered most of the rays, and its share of `rays`: "packets 97%". "single" also counts
/// rays that were answered without a kernel. Empty if `use` counts no rays.
std::string most_used(const KernelUse& use, std::uint64_t rays);
nlohmann::ordered_json rays_by(const KernelUse& use);

}  // namespace hedgerow::cli
