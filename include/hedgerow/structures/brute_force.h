/// Brute force: every query tests every primitive. The other structures are tested against it.
#pragma once

#include <hedgerow/structures/references.h>
#include <hedgerow/walks/query.h>
#include <hedgerow/walks/visits.h>

namespace hedgerow {

/// With `box`, a query first tests one box around all primitives. A query that misses the box then costs
/// O(1), and any other still O(n).
template <std::floating_point T, int D>
class BruteForce {
public:
    struct Options {
        bool box = false;

        /// Lists the options (option.h).
        template <class Option>
        void list(Option& option) {
            option("box", box, "test one box around all primitives first");
        }
    };
    /// Each primitive is in `items` once.
    static constexpr auto packed_order = PackedOrder::of_ids;
    static constexpr bool exclusive() { return true; }

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
        if (items_.empty()) return;
        if (options_.box) {
            T at;
            count.node(Place{});
            if (!query.probe().enter(bounds_, query.limit(), at)) return;
        }
        count.leaf(items_.size(), Place{});
        test_leaf(primitives, query.probe(),
                  Leaf{items_.data(), 0, static_cast<std::uint32_t>(items_.size())}, query);
    }

    /// Whether a primitive is in the structure: O(1) where none was erased before it, else O(log n).
    bool holds(PrimitiveId id) const {
        return (id < items_.size() && items_[id] == id) ||
               std::binary_search(items_.begin(), items_.end(), id);
    }
    /// Inserts primitive `id`. Returns false, and changes nothing, if it is already in the structure. Throws
    /// InputError if the set has no such primitive or it is bad. Does what Orthtree::insert does, as its
    /// oracle, but in O(n).
    template <PrimitiveSet P>
    bool insert(const P& set, PrimitiveId id) {
        const auto box = reference_of(set, id).box();
        const auto place = std::lower_bound(items_.begin(), items_.end(), id);
        if (place != items_.end() && *place == id) return false;
        items_.insert(place, id);
        bounds_.expand(box);
        return true;
    }
    /// Erases primitive `id`, in O(n). Returns false, and changes nothing, if it is not in the structure. The
    /// bounds do not shrink.
    template <PrimitiveSet P>
    bool erase(const P&, PrimitiveId id) {
        const auto place = std::lower_bound(items_.begin(), items_.end(), id);
        if (place == items_.end() || *place != id) return false;
        items_.erase(place);
        return true;
    }

    /// What is wrong with the structure; empty if nothing is.
    template <PrimitiveSet P>
    std::string validate(const P& set) const {
        if (!items_.empty() && items_.back() >= set.size()) return "items do not match the primitives";
        const bool ascend =
            std::adjacent_find(items_.begin(), items_.end(),
                               [](PrimitiveId a, PrimitiveId b) { return a >= b; }) == items_.end();
        return ascend ? "" : "items do not ascend";
    }

private:
    Options options_;
    Box<T, D> bounds_;
    std::vector<PrimitiveId> items_;
};

}  // namespace hedgerow
