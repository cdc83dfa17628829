/// The primitives that overlap a region, or lie in it, ascending, each once.
#pragma once

#include <algorithm>
#include <vector>

#include <hedgerow/queries/region_query.h>

namespace hedgerow {

/// Collects elements in the caller's vector, which is cleared and whose capacity is reused. O(k log k) for k
/// offered, beyond the walk. What is below a node inside of the region is listed without a test.
template <class Set, Region R = Box<typename Set::Scalar, Set::dimension>>
class Overlapping : public RegionQuery<Set, R> {
public:
    using Base = RegionQuery<Set, R>;

    template <class Index>
    Overlapping(const Index& index, const R& region, std::vector<IdOf<Set>>& found,
                Finds finds = Finds::overlapping)
        : Base(index, region, finds), found_(found) {
        found_.clear();
    }

    Flow offer(const OverlapCandidate& c) {
        found_.push_back(Identity<Set>::of(c));
        return Flow::go_on;
    }
    template <class Node>
    Verdict accept(const Node& node) requires(!Instanced<Set>) {
        if (!this->takes(node)) return Verdict::open;
        node.for_each_leaf([&](const Leaf& leaf) {
            found_.insert(found_.end(), leaf.ids + leaf.first, leaf.ids + leaf.first + leaf.count);
        });
        return Verdict::accept;
    }
    std::size_t answer() {
        std::sort(found_.begin(), found_.end());
        found_.erase(std::unique(found_.begin(), found_.end()), found_.end());
        return found_.size();
    }

private:
    std::vector<IdOf<Set>>& found_;
};

}  // namespace hedgerow
