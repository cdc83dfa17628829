/// No structure: every primitive is tested. The oracle of all others.
#pragma once

#include <hedgerow/queries/concepts.h>
#include <hedgerow/structures/references.h>

namespace hedgerow {

/// With `box`, one bounding box around everything is asked first, as a first idea of acceleration: a miss of
/// it then costs O(1), a hit still O(n).
template <std::floating_point T, int D>
class BruteForce {
public:
    struct Options {
        bool box = false;
    };
    /// Each primitive stands in `items` once.
    static constexpr bool exclusive = true;

    template <PrimitiveSet P>
    static BruteForce build(const P& set, const Options& options, Executor& executor) {
        BruteForce b;
        b.options_ = options;
        for (const auto& r : references_of(set, executor)) {
            b.bounds_.expand(r.box());
            b.items_.push_back(r.id());
        }
        return b;
    }

    const Box<T, D>& bounds() const { return bounds_; }
    std::span<const PrimitiveId> items() const { return items_; }
    std::size_t bytes() const { return items_.capacity() * sizeof(PrimitiveId); }
    std::size_t node_count() const { return 0; }
    std::size_t leaf_count() const { return items_.empty() ? 0 : 1; }
    int depth() const { return 0; }

    template <class Primitives, Query Q, class Count>
    void walk(const Primitives& primitives, Q& query, Count& count) const {
        if (items_.empty() || query.limit() < 0) return;
        if (options_.box) {
            T at;
            count.node();
            if (!query.probe().enter(bounds_, query.limit(), at)) return;
        }
        count.leaf(items_.size());
        test_leaf(primitives, query.probe(),
                  Leaf{items_.data(), 0, static_cast<std::uint32_t>(items_.size())}, query);
    }

    /// What is wrong with the structure; empty if nothing is.
    template <PrimitiveSet P>
    std::string validate(const P& set) const {
        return items_.size() == set.size() ? "" : "items do not match the primitives";
    }

private:
    Options options_;
    Box<T, D> bounds_;
    std::vector<PrimitiveId> items_;
};

}  // namespace hedgerow
