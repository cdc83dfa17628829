/// Mailboxing: a primitive that is in several cells is seldom tested twice in a query.
#pragma once

#include <algorithm>
#include <string_view>

#include <hedgerow/walks/query.h>
#include <hedgerow/walks/visits.h>

namespace hedgerow {

/// What the option `mailbox` of a structure means.
inline constexpr std::string_view mailbox_meaning =
    "test a primitive once a query, in however many cells it is";

/// Primitives with a mailbox for one query: the ids of 64 that were tested, the last four of each of 16
/// classes (Amanatides and Woo 1987, but hashed, and in the ray instead of in the primitives, so that queries
/// share nothing). A primitive in the mailbox is skipped and reported to `count.skip`. A hit found in any
/// cell is kept, so nothing is lost. The mailbox saves at least nine in ten of the repeated tests on every
/// scene measured (`structures_benchmark`). One place a class saved seven to nine in ten. Classes by the last
/// bits of the id saved four to nine on meshes that are made in rows or fans, and classes by the topmost bits
/// of the product not many more.
template <class Primitives, class Count>
class Mailboxed {
public:
    /// With `on` false nothing is skipped, to measure what the mailbox saves.
    Mailboxed(const Primitives& primitives, Count& count, bool on)
        : primitives_(primitives), count_(count), on_(on) {
        std::fill_n(last_, slots, none);
    }

    template <class Probe, class Query>
    Flow test_leaf(const Probe& probe, const Leaf& leaf, Query& query) {
        if constexpr (requires { primitives_.prefetch(leaf); }) primitives_.prefetch(leaf);
        for (std::uint32_t i = leaf.first; i < leaf.first + leaf.count; ++i) {
            if (on_ && seen(leaf.ids[i])) {
                count_.skip(leaf.ids[i]);
                continue;
            }
            if (hedgerow::test_leaf(primitives_, probe, Leaf{leaf.ids, i, 1}, query) == Flow::stop)
                return Flow::stop;
        }
        return Flow::go_on;
    }

private:
    /// Whether an id is in the mailbox. If not, inserts it in place of the oldest id in its class. The class
    /// is found by multiplicative hashing (Knuth, vol. 3, 6.4).
    bool seen(PrimitiveId id) {
        PrimitiveId* const last = last_ + (id * 0x9E3779B1u >> 16) % classes * together;
        bool found = false;
        for (std::size_t i = 0; i < together; ++i) found |= last[i] == id;
        if (found) return true;
        for (std::size_t i = together; i-- > 1;) last[i] = last[i - 1];
        last[0] = id;
        return false;
    }

    static constexpr std::size_t slots = 64, together = 4, classes = slots / together;
    static constexpr PrimitiveId none = 0xFFFFFFFFu;

    const Primitives& primitives_;
    Count& count_;
    bool on_;
    alignas(16) PrimitiveId last_[slots];
};

template <class Primitives, class Count, class Probe, class Query>
Flow test_leaf(Mailboxed<Primitives, Count>& mailed, const Probe& probe, const Leaf& leaf, Query& query) {
    return mailed.test_leaf(probe, leaf, query);
}

}  // namespace hedgerow
