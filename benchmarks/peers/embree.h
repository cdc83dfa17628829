/// Embree 3 as a peer, if it was found (HEDGEROW_HAS_EMBREE).
#pragma once

#include <hedgerow/measure/peer.h>

namespace hedgerow::measure {

std::unique_ptr<Peer> embree();

}  // namespace hedgerow::measure
