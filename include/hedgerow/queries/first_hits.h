/// The next hits of a ray after a place in the order of (t, instance, element). Calls that each go on after
/// the last hit of the call before give every hit once: a list of all hits in pieces.
///
/// Gribble, Naveros and Kerzner, "Multi-Hit Ray Traversal", JCGT 3(1), 2014: the walk keeps the k nearest
/// hits so far, sorted, and once there are k the last of them is its limit.
#pragma once

#include <algorithm>
#include <cassert>
#include <limits>
#include <span>
#include <string>

#include <hedgerow/base/error.h>
#include <hedgerow/geometry/radius.h>
#include <hedgerow/primitives/boundary.h>
#include <hedgerow/queries/ray_query.h>

namespace hedgerow {

/// Whether a hit or candidate comes before another along the ray; equal t goes to the lower (instance,
/// element).
template <class A, class B>
constexpr bool hit_before(const A& a, const B& b) {
    return a.t != b.t ? a.t < b.t : comes_before(a, b);
}

/// A place among the hits of a ray, in the order of (t, instance, element), after which a list of hits goes
/// on: that of a hit. The default is before all hits. After the place of a Hit that is false (where a list
/// has ended) there are no hits, nor after a t that is NaN.
struct AfterHit {
    double t = -std::numeric_limits<double>::infinity();
    std::uint32_t instance = 0, element = 0;

    constexpr AfterHit() = default;
    constexpr AfterHit(double at, std::uint32_t in, std::uint32_t of) : t(at), instance(in), element(of) {}
    template <std::floating_point T>
    constexpr AfterHit(const Hit<T>& hit)  // NOLINT(google-explicit-constructor)
        : AfterHit(static_cast<double>(hit.t), hit.instance, hit.element) {}
};

/// Where lists of hits go on: after no hit, after one place for all rays, or after one for each of a batch.
class AfterHits {
public:
    AfterHits() = default;
    AfterHits(const AfterHit& place) : place_(place) {}  // NOLINT(google-explicit-constructor)
    template <std::floating_point T>
    AfterHits(const Hit<T>& hit) : place_(hit) {}  // NOLINT(google-explicit-constructor)
    /// Views an array: a vector, a span, or Strided.
    template <class Each>
    requires std::convertible_to<const Each&, Strided<AfterHit>> AfterHits(const Each& each)
        : each_(each), of_each_(true) {}  // NOLINT(google-explicit-constructor)

    AfterHit of(std::size_t ray) const { return of_each_ ? each_[ray] : place_; }
    /// Throws InputError if there is an array that is shorter than the batch.
    void expect(std::size_t rays) const {
        if (of_each_ && each_.size() < rays)
            throw InputError("there are " + std::to_string(rays) + " rays, but places to go on from for " +
                             std::to_string(each_.size()) + ": give one for each ray, or none");
    }

private:
    AfterHit place_;
    Strided<AfterHit> each_;
    bool of_each_ = false;
};

/// The options of first hits, which may go on after others.
struct HitsOptions {
    AfterHits after = {};
    LeaveOut leave_out = {};
    Mask mask = {};
    Threads threads = {};
};

/// A place as a walk compares it with hits, whose t is a T.
template <std::floating_point T>
struct PlaceOfHit {
    T t = -std::numeric_limits<T>::infinity();
    std::uint32_t instance = 0, element = 0;

    constexpr PlaceOfHit() = default;
    PlaceOfHit(const AfterHit& after)  // NOLINT(google-explicit-constructor)
        : t(greatest_at_most<T>(after.t)), instance(after.instance), element(after.element) {
        // No hit of a lesser t is after the place, whatever its number.
        if (static_cast<double>(t) < after.t) instance = element = no_primitive;
    }

    /// Whether no hit can come after the place, since t of a hit is finite.
    constexpr bool at_end() const { return !(t < std::numeric_limits<T>::infinity()); }
};

/// The least hits after a place in the order of `hit_before`, in an array of the caller's: sorted, each
/// primitive once, at most as many as the array has room for.
template <std::floating_point T>
class SortedHits {
public:
    SortedHits(std::span<Hit<T>> hits, const PlaceOfHit<T>& after) : hits_(hits), after_(after) {}

    std::size_t size() const { return size_; }
    bool full() const { return size_ == hits_.size(); }
    /// The last hit; there must be one.
    const Hit<T>& back() const { return hits_[size_ - 1]; }
    /// The number of the place at which to insert a candidate; `nowhere` if the candidate is not among the
    /// least hits, or has been inserted. Candidates come roughly in order, so the search starts at the end.
    template <class Candidate>
    std::size_t place_of(const Candidate& c) const {
        if (!hit_before(after_, c) || (full() && (size_ == 0 || !hit_before(c, back())))) return nowhere;
        std::size_t place = size_;
        while (place > 0 && hit_before(c, hits_[place - 1])) --place;
        return place > 0 && same_primitive(hits_[place - 1], c) ? nowhere : place;
    }
    /// Inserts a hit at its place. A full array drops its last hit.
    void insert(std::size_t place, const Hit<T>& hit) {
        assert(place < hits_.size());
        if (!full()) ++size_;
        for (std::size_t i = size_ - 1; i > place; --i) hits_[i] = hits_[i - 1];
        hits_[place] = hit;
    }

    static constexpr std::size_t nowhere = std::numeric_limits<std::size_t>::max();

private:
    std::span<Hit<T>> hits_;
    PlaceOfHit<T> after_;
    std::size_t size_ = 0;
};

namespace detail {
/// Whether a ray hits each primitive at one t at most, wherever the ray's interval begins. A sphere is hit
/// where the ray enters it, but where it leaves if the interval begins inside.
template <class P>
bool hit_at_one_t(const P& set) {
    if constexpr (FacetSet<P>)
        return true;
    else if constexpr (Instanced<P>)
        return FacetSet<std::remove_cvref_t<decltype(set[0].index().primitives())>>;
    else if constexpr (requires { set.has_facets(); })
        return set.has_facets();
    else
        return false;
}
}  // namespace detail

/// Writes the hits after `after` to `hits`, as many as there is room for: O(k) for each candidate that
/// counts, for k hits, since it is inserted into a sorted list; beyond some hundred hits AllHits is faster.
/// Where a primitive has one t, cells before `after` are pruned too, so the pieces of a long list cost little
/// more than the list.
template <class Set, class Filter = KeepAll>
class FirstHits : public RayQuery<Set, Filter> {
public:
    using Base = RayQuery<Set, Filter>;
    using Scalar = typename Base::Scalar;
    static constexpr Order order = Order::nearest;

    template <class Index, class Ray>
    FirstHits(const Index& index, const Ray& ray, std::span<Hit<Scalar>> hits,
              const PlaceOfHit<Scalar>& after, const Filter& filter = {})
        : Base(index, part_after(index.primitives(), ray, after), filter),
          hits_(hits, after),
          limit_(ray.t_max),
          no_more_(hits.empty() || after.at_end()) {}

    bool done() const { return no_more_ || Base::done(); }
    Scalar limit() const { return limit_; }
    Flow offer(const RayCandidate<Scalar>& c) {
        const std::size_t place = hits_.place_of(c);
        if (place == SortedHits<Scalar>::nowhere || !this->counts(c)) return Flow::go_on;
        hits_.insert(place, this->hit(c));
        if (hits_.full()) limit_ = hits_.back().t;
        return Flow::go_on;
    }
    /// How many hits were written.
    std::size_t answer() const { return hits_.size(); }

private:
    /// The part of the ray in which hits after the place are.
    template <class Ray>
    static Ray part_after(const Set& set, Ray ray, const PlaceOfHit<Scalar>& after) {
        if (detail::hit_at_one_t(set)) ray.t_min = std::max(ray.t_min, after.t);
        return ray;
    }

    SortedHits<Scalar> hits_;
    Scalar limit_;
    bool no_more_;
};

}  // namespace hedgerow
