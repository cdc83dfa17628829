/// Calls the template that is compiled for the width of a tree's nodes.
#if defined(HEDGEROW_ENGINE_WIDTH_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef HEDGEROW_ENGINE_WIDTH_INL_H
#undef HEDGEROW_ENGINE_WIDTH_INL_H
#else
#define HEDGEROW_ENGINE_WIDTH_INL_H
#endif

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace hedgerow::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

// Calls F<W>::answer, where W is the width of the scene's nodes.
template <template <int> class F, class Scene, class... Arguments>
HWY_INLINE auto by_width(const Scene& scene, Arguments... arguments) {
    switch (scene.tree.nodes.width()) {
        case 4:
            return F<4>::answer(scene, arguments...);
        case 8:
            return F<8>::answer(scene, arguments...);
        default:
            return F<16>::answer(scene, arguments...);
    }
}

}  // namespace hedgerow::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
