/// The input of every builder: the box of each primitive, checked.
#pragma once

#include <algorithm>
#include <atomic>
#include <span>
#include <string>
#include <vector>

#include <hedgerow/base/bare_vector.h>
#include <hedgerow/base/error.h>
#include <hedgerow/geometry/lanes.h>
#include <hedgerow/parallel/executor.h>
#include <hedgerow/primitives/concepts.h>

namespace hedgerow {

/// A box that only grows, in lanes.
template <std::floating_point T>
struct LaneBox {
    Lanes<T> low, high;

    static LaneBox none() {
        constexpr T infinity = std::numeric_limits<T>::infinity();
        return {Lanes<T>::all(infinity), Lanes<T>::all(-infinity)};
    }
    template <int D>
    static LaneBox of(const Box<T, D>& b) {
        return {Lanes<T>::of(b.low), Lanes<T>::of(b.high)};
    }

    void expand(const LaneBox& b) { low = min(low, b.low), high = max(high, b.high); }
    void expand(Lanes<T> p) { low = min(low, p), high = max(high, p); }
    /// Expands the box to p if `apart` is 0, and leaves it as it is if `apart` is infinite.
    void expand(Lanes<T> p, T apart) {
        const auto away = Lanes<T>::all(apart);
        low = min(low, p + away), high = max(high, p - away);
    }
    /// Box::half_area for a box that is not empty.
    template <int D>
    T half_area() const {
        alignas(32) T e[4];
        (high - low).store(e);
        if constexpr (D == 2)
            return e[0] + e[1];
        else
            return product(e[0] + e[1], e[2]) + product(e[0], e[1]);
    }
    template <int D>
    Box<T, D> box() const {
        alignas(32) T l[4], h[4];
        low.store(l);
        high.store(h);
        Box<T, D> b;
        for (int k = 0; k < D; ++k) b.low[k] = l[k], b.high[k] = h[k];
        return b;
    }
};

/// A primitive in a builder: its box, and its id in the fourth lane of `low`.
template <std::floating_point T, int D>
struct Reference {
    alignas(16) T low[4];
    T high[4];

    Reference() = default;  // bare, to be filled
    Reference(const Box<T, D>& b, PrimitiveId id) : low{}, high{} {
        for (int k = 0; k < D; ++k) low[k] = b.low[k], high[k] = b.high[k];
        low[3] = number_as_lane<T>(id);
    }
    PrimitiveId id() const { return number_of_lane(low[3]); }
    LaneBox<T> lanes() const { return {Lanes<T>::load(low), Lanes<T>::load(high)}; }
    Box<T, D> box() const { return lanes().template box<D>(); }
    /// Twice the center, which spares the halving.
    Lanes<T> center2() const { return Lanes<T>::load(low) + Lanes<T>::load(high); }
    T center2(int axis) const { return low[axis] + high[axis]; }
};

namespace detail {
/// Whether a primitive's coordinates are numbers within `largest_coordinate`.
template <PrimitiveSet P, class BoxType>
bool sound(const P& set, std::size_t i, const BoxType& box) {
    using T = typename P::Scalar;
    bool good = true;
    for (int k = 0; k < P::dimension; ++k) {
        good &= box.low[k] <= box.high[k];
        good &= box.low[k] >= -largest_coordinate<T>;
        good &= box.high[k] <= largest_coordinate<T>;
    }
    if constexpr (requires { set.finite(i); }) good = good && set.finite(i);
    return good;
}
template <std::floating_point T>
[[noreturn]] void refuse(std::size_t i) {
    throw InputError("primitive " + std::to_string(i) + " has a coordinate that is NaN, infinite or beyond " +
                     std::to_string(double(largest_coordinate<T>)) + ": mend it, or drop it when loading");
}
}  // namespace detail

/// A large list is aligned so that each reference lies in one cache line.
template <std::floating_point T, int D>
using ReferenceList = BareVector<Reference<T, D>>;

namespace detail {
inline constexpr std::size_t run = 4096;  // primitives that are visited in order by one thread

/// The number of primitives. Throws InputError for more than 2^31, before memory is spent on them.
template <PrimitiveSet P>
std::size_t count_of(const P& set) {
    const std::size_t n = set.size();
    if (n > 0x80000000u)
        throw InputError("an index holds at most 2^31 primitives, and was given " + std::to_string(n));
    return n;
}
/// Calls f(i, box) for every primitive. The primitives of a run are visited in order by one thread, and runs
/// perhaps at once. Throws InputError for the first bad primitive, after all calls.
template <PrimitiveSet P, class F>
void for_each_sound_box(const P& set, Executor& executor, F f) {
    using T = typename P::Scalar;
    const std::size_t n = set.size();
    if constexpr (requires { set.validate(); }) set.validate();
    std::atomic<std::size_t> first_bad{n};
    executor.for_each_piece((n + run - 1) / run, 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin * run; i < std::min(n, end * run); ++i) {
            const Box<T, P::dimension> b = set.bounds(i);
            const bool good = sound(set, i, b);
            f(i, b);
            for (std::size_t seen = first_bad;
                 !good && i < seen && !first_bad.compare_exchange_weak(seen, i);) {
            }
        }
    });
    if (first_bad < n) refuse<T>(first_bad.load());
}
}  // namespace detail

/// The references of all primitives, in the order of their ids. Throws InputError for the first primitive
/// with a coordinate that is NaN, infinite or beyond `largest_coordinate`, and for more than 2^31 primitives.
template <PrimitiveSet P>
auto references_of(const P& set, Executor& executor) {
    using R = Reference<typename P::Scalar, P::dimension>;
    ReferenceList<typename P::Scalar, P::dimension> references(detail::count_of(set));
    detail::for_each_sound_box(set, executor, [&](std::size_t i, const auto& box) {
        references[i] = R(box, static_cast<PrimitiveId>(i));
    });
    return references;
}
/// Throws what `references_of` throws.
template <PrimitiveSet P>
void refuse_unsound(const P& set, Executor& executor) {
    detail::for_each_sound_box(set, executor, [](std::size_t, const auto&) {});
}
/// The bounds of all primitives. Throws what `references_of` throws.
template <PrimitiveSet P>
auto bounds_of(const P& set, Executor& executor) {
    std::vector<Box<typename P::Scalar, P::dimension>> of_runs(detail::count_of(set) / detail::run + 1);
    detail::for_each_sound_box(set, executor,
                               [&](std::size_t i, const auto& box) { of_runs[i / detail::run].expand(box); });
    for (const auto& box : of_runs) of_runs[0].expand(box);
    return of_runs[0];
}

/// The reference of one primitive, of a set that has changed since the build. Throws InputError if the set
/// has no such primitive or it is bad.
template <PrimitiveSet P>
auto reference_of(const P& set, PrimitiveId id) {
    using T = typename P::Scalar;
    if (id >= set.size())
        throw InputError("there is no primitive " + std::to_string(id) + ": the set has " +
                         std::to_string(set.size()));
    if constexpr (requires { set.validate(std::size_t(id)); }) set.validate(std::size_t(id));
    const Box<T, P::dimension> box = set.bounds(id);
    if (!detail::sound(set, id, box)) detail::refuse<T>(id);
    return Reference<T, P::dimension>(box, id);
}

}  // namespace hedgerow
