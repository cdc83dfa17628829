/// The engine of what a cone sees of float triangles in a WideBvh in space (walks/engine.h).
#pragma once

#include <hedgerow/engine/kernel_scenes.h>
#include <hedgerow/queries/cone_fragments.h>
#include <hedgerow/walks/engine.h>

namespace hedgerow {

struct ConeKernels {
    /// Takes all triangles that the cone's samples may see into account (ConeView).
    void (*look)(const WideScene&, const ConeProbe<float, 3>&, ConeView&);
    /// ConeView::share.
    ConeView::Share (*share)(const ConeView&, std::uint64_t id);
};
/// The kernels in use, or nullptr.
template <>
const ConeKernels* in_use<ConeKernels>();

template <class Set, detail::TrianglesForKernels I>
requires std::same_as<Set, typename I::Primitives>
struct EngineFor<ConeFragments<Set>, I> {
    explicit EngineFor(const I& index) : index_(index) {}
    explicit operator bool() const { return kernels_ != nullptr; }
    std::size_t answer(const ConeRays<float, 3>& cone, std::vector<ConeFragment<float>>& found) const {
        ConeView view;
        kernels_->look(detail::kernel_scene(index_), {cone, index_.bounds()}, view);
        return view.write(found, kernels_->share);
    }

private:
    const I& index_;
    const ConeKernels* kernels_ = in_use<ConeKernels>();
};

}  // namespace hedgerow
