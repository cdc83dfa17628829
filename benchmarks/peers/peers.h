/// The peers that benchmarks and the tool measure against.
#pragma once

#include <hedgerow/measure/peer.h>

namespace hedgerow::measure {

/// All peers that were found when the build was configured.
std::vector<std::unique_ptr<Peer>> peers();

}  // namespace hedgerow::measure
