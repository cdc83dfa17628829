/// The concept of a probe, which is the geometry of a query. A probe enters volumes, is cut by planes, and
/// sweeps a lattice; it knows no structure and no result.
#pragma once

#include <concepts>

#include <hedgerow/geometry/box.h>
#include <hedgerow/geometry/shapes.h>

namespace hedgerow {

/// Whether a walk goes on after it visited a cell or a primitive.
enum class Flow : bool { stop, go_on };

/// The result of a visit to a cell of a lattice: whether the sweep goes on, and the block of cells around it
/// that is known to be empty. The block has 2^empty_bits cells along each axis and is aligned to multiples of
/// 2^empty_bits. With empty_bits = 0 nothing is known to be empty.
struct Looked {
    Flow flow;
    int empty_bits;

    // NOLINTNEXTLINE(google-explicit-constructor): most looks say no more
    constexpr Looked(Flow f, int empty = 0) : flow(f), empty_bits(empty) {}
};

/// The result of cutting a probe by a plane: the states in which a walk continues on the near and on the far
/// side, and whether each side has a part of the probe within the limit.
template <class State>
struct Cut {
    bool near_is_high;
    State near, far;
    bool to_near, to_far;
};

/// `enter` returns whether a volume may hold a result within the limit. It sets `at` to where the probe
/// enters the volume, in the units of the query's limit: t of a ray, distance² of a point. `within` returns
/// whether a cell still has a part of the probe that begins within the limit. `cut` requires a state that was
/// within the limit.
template <class P>
concept Probe = requires(const P& p, const Box<typename P::Scalar, P::dimension>& box,
                         typename P::Scalar limit, typename P::Scalar& at, const typename P::State& state,
                         const AxisPlane<typename P::Scalar>& plane) {
    { p.enter(box, limit, at) } -> std::same_as<bool>;
    { p.root(box) } -> std::same_as<typename P::State>;
    { p.within(state, limit) } -> std::same_as<bool>;
    { p.cut(state, plane, limit) } -> std::same_as<Cut<typename P::State>>;
};

/// Tests the volumes of a pack one by one, for probes with no faster way. Bit i of the result is set if
/// volume i is entered, and at[i] counts only then. A pack that may hold fewer volumes than its width has a
/// `size()`.
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
