/// What a probe is: the geometry of a question. It enters volumes, is cut by planes, sweeps a lattice; it
/// knows no structure and no answer.
#pragma once

#include <concepts>

#include <hedgerow/geometry/box.h>
#include <hedgerow/geometry/shapes.h>

namespace hedgerow {

/// Whether a walk goes on after it was offered something.
enum class Flow : bool { stop, go_on };

/// What a look into a cell of a lattice tells a sweep: whether to go on, and that nothing stands in the whole
/// block of 2^empty_bits cells along each axis (aligned to multiples of it) in which the cell lies.
struct Looked {
    Flow flow;
    int empty_bits;

    // NOLINTNEXTLINE(google-explicit-constructor): most looks say no more
    constexpr Looked(Flow f, int empty = 0) : flow(f), empty_bits(empty) {}
};

/// What a walk by planes carries into the two sides of a cut, and whether anything of the probe within the
/// limit is there.
template <class State>
struct Cut {
    bool near_is_high;
    State near, far;
    bool to_near, to_far;
};

/// `at` is where the probe enters a volume in the units of the query's limit: t of a ray, distance² of a
/// point. A volume is entered when it may hold an answer within the limit. `within` asks the same of a cell:
/// whether something of the probe is left there, and begins within the limit. What is cut was within it.
template <class P>
concept Probe = requires(const P& p, const Box<typename P::Scalar, P::dimension>& box,
                         typename P::Scalar limit, typename P::Scalar& at, const typename P::State& state,
                         const AxisPlane<typename P::Scalar>& plane) {
    { p.enter(box, limit, at) } -> std::same_as<bool>;
    { p.root(box) } -> std::same_as<typename P::State>;
    { p.within(state, limit) } -> std::same_as<bool>;
    { p.cut(state, plane, limit) } -> std::same_as<Cut<typename P::State>>;
};

/// Enters each volume of a pack one by one: for probes with no faster way. Bit i of the result: at[i] counts.
/// A pack that may hold fewer than its width says how many.
template <class P, class Pack>
unsigned enter_each(const P& probe, const Pack& pack, typename P::Scalar limit, typename P::Scalar* at) {
    int volumes = Pack::width;
    if constexpr (requires { pack.size(); }) volumes = pack.size();
    unsigned entered = 0;
    for (int i = 0; i < volumes; ++i)
        entered |= static_cast<unsigned>(probe.enter(pack[i], limit, at[i])) << i;
    return entered;
}

}  // namespace hedgerow
