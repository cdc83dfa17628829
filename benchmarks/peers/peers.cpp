#include "peers.h"

#ifdef HEDGEROW_HAS_EMBREE
#include "embree.h"
#endif

namespace hedgerow::measure {

std::vector<std::unique_ptr<Peer>> peers() {
    std::vector<std::unique_ptr<Peer>> all;
#ifdef HEDGEROW_HAS_EMBREE
    all.push_back(embree());
#endif
    return all;
}

}  // namespace hedgerow::measure
