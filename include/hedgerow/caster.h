/// Casts rays one by one in a loop, at less cost than by the functions of ask.h.
#pragma once

#include <hedgerow/ask.h>

namespace hedgerow {

namespace detail {

/// Answers a query Q of one ray after the other: by an engine that is prepared once, or as `Index::answer`.
template <class Q, class I>
class SingleRays {
public:
    explicit SingleRays(const I& index) : index_(index) {}
    auto operator()(const RayOf<I>& ray) const {
        return index_.template answer<Q>(no_visits, ray, KeepAll{});
    }

private:
    const I& index_;
};
template <class Q, class I>
requires requires(const EngineFor<Q, I>& engine) {
    engine.single();
}
class SingleRays<Q, I> {
public:
    explicit SingleRays(const I& index) : index_(index), engine_(index), answer_(engine_.single()) {}
    auto operator()(const RayOf<I>& ray) const {
        if (engine_) [[likely]]
            return answer_(ray);
        return index_.template answer<Q>(no_visits, ray, KeepAll{});
    }

private:
    const I& index_;
    const EngineFor<Q, I> engine_;
    const decltype(std::declval<const EngineFor<Q, I>&>().single()) answer_;
};

}  // namespace detail

/// Answers closest and any hits of single rays, with the bits of `closest_hit` and `any_hit`. Those look up
/// the kernels, describe the index and check the thread's floating-point mode for each ray; a Caster does so
/// once, which saves 3 to 7% of a ray (docs/design/019-caster.md). Made for a loop:
///
///     const Caster cast(index);
///     for (...) if (const auto hit = cast.closest_hit(ray)) ...
///
/// It serves the thread that made it, and keeps that thread in IEEE mode (IeeeMode) while it exists. Casters
/// of one thread have to end in the reverse order of their beginnings, as variables of blocks do. The index
/// must stay as it is meanwhile, and so must the instruction set (use_instruction_set). Allocates nothing.
template <class I>
class Caster {
public:
    using Scalar = typename I::Scalar;

    explicit Caster(const I& index) : closest_(index), any_(index) {}
    explicit Caster(const I&&) = delete;  // the index must outlive it

    /// The hit of least t in [t_min, t_max]; a Hit that is false if nothing is hit.
    Hit<Scalar> closest_hit(const RayOf<I>& ray) const { return closest_(ray); }
    /// Whether the ray hits anything in [t_min, t_max].
    bool any_hit(const RayOf<I>& ray) const { return any_(ray); }

private:
    using P = typename I::Primitives;

    IeeeMode mode_;
    detail::SingleRays<ClosestHit<P, KeepAll>, I> closest_;
    detail::SingleRays<AnyHit<P, KeepAll>, I> any_;
};

}  // namespace hedgerow
