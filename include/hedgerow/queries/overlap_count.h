/// How many primitives overlap a region, and whether any does.
#pragma once

#include <hedgerow/queries/region_query.h>

namespace hedgerow {

/// Counts the primitives that it is offered. Right only for structures that offer each primitive once. A
/// subtree inside of the region adds its count.
template <class Set, Region R>
class OverlapCount : public RegionQuery<Set, R> {
public:
    using Base = RegionQuery<Set, R>;

    template <class Index>
    OverlapCount(const Index& index, const R& region, Finds finds = Finds::overlapping)
        : Base(index, region, finds) {}

    Flow offer(const OverlapCandidate&) {
        ++found_;
        return Flow::go_on;
    }
    template <class Node>
    Verdict accept(const Node& node) requires(!Instanced<Set>) {
        if (!this->takes(node)) return Verdict::open;
        found_ += node.count();
        return Verdict::accept;
    }
    std::size_t answer() const { return found_; }

private:
    std::size_t found_ = 0;
};

/// Stops at the first primitive that overlaps the region, or at the first subtree inside of it.
template <class Set, Region R>
class AnyOverlap : public RegionQuery<Set, R> {
public:
    using Base = RegionQuery<Set, R>;

    template <class Index>
    AnyOverlap(const Index& index, const R& region) : Base(index, region, Finds::overlapping) {}

    Flow offer(const OverlapCandidate&) {
        found_ = true;
        return Flow::stop;
    }
    template <class Node>
    Verdict accept(const Node& node) requires(!Instanced<Set>) {
        if (found_) return Verdict::prune;
        if (!this->takes(node)) return Verdict::open;
        found_ = true;
        this->finish();
        return Verdict::accept;
    }
    bool answer() const { return found_; }

private:
    bool found_ = false;
};

}  // namespace hedgerow
