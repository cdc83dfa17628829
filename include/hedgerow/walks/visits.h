/// How much a query looked at.
#pragma once

#include <cstdint>

#include <hedgerow/primitives/concepts.h>

namespace hedgerow {

/// Two words that identify a node during a walk. Empty nodes may share them. `outline` finds the NodeId
/// (walks/outline.h).
struct Place {
    std::uint32_t first = 0, second = 0;
    friend constexpr bool operator==(const Place&, const Place&) = default;
};

/// Counts of one or more queries. `nodes`: inner nodes opened (cells of a grid); `leaves`; `primitives`
/// tested, and how many tests a mailbox `skipped`, since the primitive had been tested before. Walks also
/// pass the place in the structure and, if known, what is left of the probe there. A trace records both
/// (trace.h); Visits ignores both.
struct Visits {
    std::uint64_t nodes = 0, leaves = 0, primitives = 0, skipped = 0;

    template <class... Where>
    void node(const Where&...) {
        ++nodes;
    }
    template <class... Where>
    void leaf(std::uint64_t count, const Where&...) {
        ++leaves, primitives += count;
    }
    void own(PrimitiveId) { ++primitives; }
    void skip(PrimitiveId) { --primitives, ++skipped; }
    Visits& operator+=(const Visits& o) {
        nodes += o.nodes, leaves += o.leaves, primitives += o.primitives, skipped += o.skipped;
        return *this;
    }
    friend bool operator==(const Visits&, const Visits&) = default;
};

/// Counts nothing and costs nothing.
struct NoVisits {
    template <class... Where>
    void node(const Where&...) const {}
    template <class... Where>
    void leaf(std::uint64_t, const Where&...) const {}
    void own(PrimitiveId) const {}
    void skip(PrimitiveId) const {}
};

}  // namespace hedgerow
