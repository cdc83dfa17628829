/// Prefetches the nodes and leaves that a walk will visit.
#if defined(HEDGEROW_ENGINE_PREFETCH_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef HEDGEROW_ENGINE_PREFETCH_INL_H
#undef HEDGEROW_ENGINE_PREFETCH_INL_H
#else
#define HEDGEROW_ENGINE_PREFETCH_INL_H
#endif

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>

#include <hwy/highway.h>

#include <hedgerow/engine/kernels.h>

HWY_BEFORE_NAMESPACE();
namespace hedgerow::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

template <int W, class Scene = WideScene>
class Prefetch {
public:
    explicit Prefetch(const Scene& scene)
        : start_{reinterpret_cast<const char*>(scene.tree.nodes.data()),
                 reinterpret_cast<const char*>(scene.blocks)} {}

    /// Prefetches what a child's word leads to: the lines that are read of a node, or of a leaf's block.
    HWY_INLINE void operator()(std::uint32_t word) const {
        // Found by arithmetic, since a branch would have to be predicted.
        const std::uint32_t leaf = word >> 31;
        const char* const from = start_[leaf] + std::size_t(word & ~WideChild::leaf_bit) * step_[leaf];
        // Of a node its planes and children are read; a leaf's block is read whole.
        constexpr int lines =
            std::max<int>((6 * sizeof(T) + 4) * W, sizeof(*std::declval<Scene>().blocks)) / 64;
        for (int line = 0; line < lines; ++line) __builtin_prefetch(from + 64 * line);
    }

private:
    using T = typename Scene::Scalar;
    const char* start_[2];  // of nodes and of leaves; step_: bytes from one to the next
    std::size_t step_[2] = {WideNodes<T, 3>::stride_of(W), sizeof(*std::declval<Scene>().blocks)};
};

}  // namespace hedgerow::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
