/// The engine's specialisations of Kernel (walks/kernel.h) for the crossings that tell the sides of a solid:
/// of triangles of float and of double in a WideBvh in space.
#pragma once

#include <span>

#include <hedgerow/engine/kernel_scenes.h>

namespace hedgerow {

template <class Set, class I>
requires(detail::TrianglesForKernels<I> || detail::DoublesForKernels<I>)  //
    struct Kernel<SignedCrossings<Set>, I> {
    using T = typename I::Primitives::Scalar;

    explicit operator bool() const { return kernels_ != nullptr; }
    CrossingCount answer(const I& index, const RayInBounds<T, 3>& asked, bool past_surface) const {
        return kernels().one(detail::kernel_scene(index), asked, past_surface);
    }
    /// Writes counts[i] for rays[i].
    void answer_many(const I& index, std::span<const RayInBounds<T, 3>> rays, bool past_surface,
                     CrossingCount* counts) const {
        kernels().many(detail::kernel_scene(index), rays, past_surface, counts);
    }

private:
    const auto& kernels() const {
        if constexpr (detail::TrianglesForKernels<I>)
            return kernels_->crossings->floats;
        else
            return kernels_->crossings->doubles;
    }

    const WideKernels* kernels_ = wide_kernels();
};

}  // namespace hedgerow
