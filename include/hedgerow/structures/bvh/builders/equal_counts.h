/// Splits by count on the widest axis of the centers: balanced, and blind to area.
#pragma once

#include <hedgerow/structures/bvh/builders/top_down.h>

namespace hedgerow {

template <std::floating_point T, int D>
class EqualCountsSplitter : public ReferenceSplitter<T, D> {
public:
    EqualCountsSplitter(ReferenceList<T, D> references, const SahOptions&)
        : ReferenceSplitter<T, D>(std::move(references)) {}
    bool split(const Range<T, D>&, Range<T, D>&, Range<T, D>&) { return false; }  // always halved
};

}  // namespace hedgerow
