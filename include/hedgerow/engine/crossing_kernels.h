/// The engine of the crossings that tell the sides of a solid (walks/engine.h): of triangles of float and of
/// double in a WideBvh in space.
#pragma once

#include <span>

#include <hedgerow/engine/kernel_scenes.h>
#include <hedgerow/walks/engine.h>

namespace hedgerow {

template <class Set, class I>
requires(detail::TrianglesForKernels<I> || detail::DoublesForKernels<I>)  //
    struct EngineFor<SignedCrossings<Set>, I> {
    using T = typename I::Primitives::Scalar;

    explicit EngineFor(const I& index) : index_(index) {}
    explicit operator bool() const { return kernels_ != nullptr; }
    CrossingCount answer(const RayInBounds<T, 3>& asked, bool past_surface) const {
        return kernels().one(detail::kernel_scene(index_), asked, past_surface);
    }
    /// Writes counts[i] for rays[i].
    void answer_some(std::span<const RayInBounds<T, 3>> rays, bool past_surface,
                     CrossingCount* counts) const {
        kernels().many(detail::kernel_scene(index_), rays, past_surface, counts);
    }

private:
    const auto& kernels() const {
        if constexpr (detail::TrianglesForKernels<I>)
            return kernels_->floats;
        else
            return kernels_->doubles;
    }

    const I& index_;
    const AllCrossingKernels* kernels_ = in_use<AllCrossingKernels>();
};

}  // namespace hedgerow
