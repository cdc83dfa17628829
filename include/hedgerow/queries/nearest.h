/// The k nearest primitives, in the order of (distance², instance, element), each once.
#pragma once

#include <algorithm>
#include <vector>

#include <hedgerow/queries/point_query.h>

namespace hedgerow {

/// Stores the k nearest so far as a heap in the caller's vector, which is cleared and whose capacity is
/// reused. A candidate that counts costs O(log k) for the heap, and a search through the k, since structures
/// may offer a primitive twice.
template <class Set, class Filter = KeepAll>
class Nearest : public PointQuery<Set, Filter> {
public:
    using Base = PointQuery<Set, Filter>;
    using typename Base::Candidate, typename Base::Found, typename Base::Scalar;
    static constexpr Order order = Order::nearest;

    template <class Index>
    Nearest(const Index& index, const Vec<Scalar, Base::dimension>& p, std::size_t k,
            const NearLimits<Scalar>& limits, std::vector<Found>& found, const Filter& filter = {})
        : Base(index, p, limits, filter), k_(k), found_(found) {
        found_.clear();
    }

    bool done() const { return k_ == 0 || Base::done(); }
    Scalar limit() const {
        return limit_of_boxes(found_.size() < k_ ? this->limits().distance2
                                                 : this->limits().after(found_.front().distance2));
    }
    Flow offer(const Candidate& c) {
        const Found f = this->found(c);
        if (!(c.distance2 <= this->limits().distance2)) return Flow::go_on;
        if (found_.size() == k_ && !nearer(f, found_.front())) return Flow::go_on;
        if (!this->counts(c)) return Flow::go_on;
        for (const Found& g : found_)
            if (same_primitive(g, c)) return Flow::go_on;
        if (found_.size() == k_) {
            std::pop_heap(found_.begin(), found_.end(), nearer<Found, Found>);
            found_.pop_back();
        }
        found_.push_back(f);
        std::push_heap(found_.begin(), found_.end(), nearer<Found, Found>);
        return Flow::go_on;
    }
    /// Whether `offer` would keep a candidate that it has not seen.
    bool would_keep(const Candidate& c) const {
        return c.distance2 <= this->limits().distance2 && (found_.size() < k_ || nearer(c, found_.front()));
    }
    std::size_t answer() {
        std::sort_heap(found_.begin(), found_.end(), nearer<Found, Found>);
        return found_.size();
    }

private:
    std::size_t k_;
    std::vector<Found>& found_;
};

/// The k nearest points, in a tree whose nodes at one place list their points ascending by id, and where many
/// points may be at one place. Of such a node it takes the first that count, and looks at no others: a node's
/// least id is its first.
template <class Set>
class NearestAmongTies : public Nearest<Set> {
public:
    using Base = Nearest<Set>;

    template <class Index>
    NearestAmongTies(const Index& index, const Vec<typename Base::Scalar, Base::dimension>& p, std::size_t k,
                     const NearLimits<typename Base::Scalar>& limits,
                     std::vector<typename Base::Found>& found)
        : Base(index, p, k, limits, found), set_(index.primitives()) {}

    template <class Node>
    Verdict accept(const Node& node) {
        // A leaf's points are in any order.
        constexpr std::size_t most_in_leaf = 8;
        const auto& box = node.volume();
        if (!(box.low == box.high) || node.count() <= most_in_leaf) return Verdict::open;
        node.for_leaves_in_order([&](const Leaf& leaf) {
            for (std::uint32_t i = 0; i < leaf.count; ++i) {
                const PrimitiveId id = leaf.ids[leaf.first + i];
                const auto foot = closest_point(this->probe().point(), set_.point(id));
                const typename Base::Candidate candidate{foot.distance2, id, foot.point};
                if (!this->would_keep(candidate)) return Flow::stop;
                this->offer(candidate);
            }
            return Flow::go_on;
        });
        return Verdict::accept;
    }

private:
    const Set& set_;
};

}  // namespace hedgerow
