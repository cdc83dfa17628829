/// What a processor's caches decide.
#pragma once

#include <cstddef>

namespace hedgerow {

/// The bytes of a tree's nodes up to which batches of rays do not prefetch nodes and leaves. Leaves take some
/// six times as many. Up to 4 KiB all is in the first-level cache, whatever the processor. On AMD's first Zen
/// a prefetch costs more than a wait for the second level, up to 192 KiB
/// (docs/design/020-engine-beside-embree.md).
std::size_t nodes_at_hand();

}  // namespace hedgerow
