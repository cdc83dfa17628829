/// The questions of a region, one at a time or many in a batch: what overlaps a box.
#pragma once

#include <vector>

#include <hedgerow/ask/asking.h>
#include <hedgerow/queries/overlapping.h>

namespace hedgerow {

/// Writes the primitives that overlap a box to `found`, ascending: their positions in the set, or PlacedIds
/// among instances. Returns how many there are.
template <class S, class P, class Count = const NoVisits>
std::size_t overlapping(const Index<S, P>& index, const Box<typename P::Scalar, P::dimension>& box,
                        std::vector<IdOf<P>>& found, Count& count = no_visits) {
    return index.template answer<Overlapping<P>>(count, box, found);
}

/// A list of primitives for each of many boxes (ask/asking.h).
template <class S, class P>
AnswerLists<IdOf<P>> overlapping(const Index<S, P>& index,
                                 const Strided<Box<typename P::Scalar, P::dimension>>& boxes,
                                 Threads threads = {}) {
    return answer_lists<IdOf<P>>(boxes.size(), threads.over(boxes.size()),
                                 [&](std::size_t i, auto& found) { overlapping(index, boxes[i], found); });
}

}  // namespace hedgerow
