/// Mailboxing: a primitive that stands in several cells is tested once a query.
#pragma once

#include <algorithm>

#include <hedgerow/queries/concepts.h>

namespace hedgerow {

/// Primitives, and a mailbox for one query: the last primitive seen of each of 64 classes (Amanatides and Woo
/// 1987, hashed and in the ray instead of in the primitives, so that queries share nothing). What was seen is
/// passed over; `count.skip` is told of it. A hit found in any cell is kept, so nothing is lost.
template <class Primitives, class Count>
class Mailboxed {
public:
    /// With `on` false it passes nothing over: to show what it brings.
    Mailboxed(const Primitives& primitives, Count& count, bool on)
        : primitives_(primitives), count_(count), on_(on) {
        std::fill_n(last_, slots, none);
    }

    template <class Probe, class Query>
    Flow test_leaf(const Probe& probe, const Leaf& leaf, Query& query) {
        for (std::uint32_t i = leaf.first; i < leaf.first + leaf.count; ++i) {
            PrimitiveId& last = last_[leaf.ids[i] % slots];
            if (on_ && last == leaf.ids[i]) {
                count_.skip(leaf.ids[i]);
                continue;
            }
            last = leaf.ids[i];
            if (hedgerow::test_leaf(primitives_, probe, Leaf{leaf.ids, i, 1}, query) == Flow::stop)
                return Flow::stop;
        }
        return Flow::go_on;
    }

private:
    static constexpr std::size_t slots = 64;
    static constexpr PrimitiveId none = 0xFFFFFFFFu;

    const Primitives& primitives_;
    Count& count_;
    bool on_;
    PrimitiveId last_[slots];
};

template <class Primitives, class Count, class Probe, class Query>
Flow test_leaf(Mailboxed<Primitives, Count>& mailed, const Probe& probe, const Leaf& leaf, Query& query) {
    return mailed.test_leaf(probe, leaf, query);
}

}  // namespace hedgerow
