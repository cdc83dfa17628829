/// Embree 3 as a peer, if it was found (HEDGEROW_HAS_EMBREE).
#pragma once

#include "peer.h"

namespace hedgerow::benchmark {

std::unique_ptr<Peer> embree();

}  // namespace hedgerow::benchmark
