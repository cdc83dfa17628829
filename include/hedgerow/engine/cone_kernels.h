/// The engine's specialisation of Kernel (walks/kernel.h) for what a cone sees of float triangles in a
/// WideBvh in space.
#pragma once

#include <hedgerow/engine/kernel_scenes.h>
#include <hedgerow/queries/cone_fragments.h>
#include <hedgerow/walks/kernel.h>

namespace hedgerow {

struct ConeKernels {
    /// Takes all triangles that the cone's samples may see into account (ConeView).
    void (*look)(const WideScene&, const ConeProbe<float, 3>&, ConeView&);
    /// ConeView::share.
    ConeView::Share (*share)(const ConeView&, std::uint64_t id);
};
/// The kernels in use, or nullptr.
const ConeKernels* cone_kernels();

template <class Set, detail::TrianglesForKernels I>
requires std::same_as<Set, typename I::Primitives>
struct Kernel<ConeFragments<Set>, I> {
    explicit operator bool() const { return kernels_ != nullptr; }
    std::size_t answer(const I& index, const ConeRays<float, 3>& cone,
                       std::vector<ConeFragment<float>>& found) const {
        ConeView view;
        kernels_->look(detail::kernel_scene(index), {cone, index.bounds()}, view);
        return view.write(found, kernels_->share);
    }

private:
    const ConeKernels* kernels_ = cone_kernels();
};

}  // namespace hedgerow
