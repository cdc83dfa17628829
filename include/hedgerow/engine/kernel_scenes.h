/// Which indexes the kernels can search, and what they read of each.
#pragma once

#include <concepts>

#include <hedgerow/engine/kernels.h>

namespace hedgerow::detail {

/// Indexes of triangles that the kernels can search.
template <class I>
concept TrianglesForKernels = requires(const I& index) {
    { index.structure().tree() } -> std::same_as<const WideTree<float, 3>&>;
    { index.packed() } -> std::same_as<const TriangleBlocks<float>&>;
    { index.primitives().faces() } -> std::same_as<const Strided<std::uint32_t>&>;
};
/// Indexes of points that the kernels can search.
template <class I>
concept CloudForKernels = requires(const I& index) {
    { index.structure().tree() } -> std::same_as<const WideTree<float, 3>&>;
    { index.packed() } -> std::same_as<const PointBlocks<float, 3>&>;
};
/// Indexes of triangles of double.
template <class I>
concept DoublesForKernels = requires(const I& index) {
    { index.structure().tree() } -> std::same_as<const WideTree<double, 3>&>;
    { index.packed() } -> std::same_as<const TriangleBlocks<double>&>;
    { index.primitives().faces() } -> std::same_as<const Strided<std::uint32_t>&>;
};
/// Indexes of any primitives, over a tree that the kernels can walk.
template <class I>
concept WideForKernels = requires(const I& index) {
    { index.structure().tree() } -> std::same_as<const WideTree<typename I::Primitives::Scalar, 3>&>;
};
/// Indexes of instances of TrianglesForKernels.
template <class I>
concept InstancesForKernels = requires(const I& index) {
    { index.structure().tree() } -> std::same_as<const WideTree<float, 3>&>;
    { index.primitives().for_kernels() } -> std::same_as<const WideInstance*>;
};

template <TrianglesForKernels I>
WideScene kernel_scene(const I& index, const Ray<float, 3>&, const HitFilter& filter) {
    return {index.structure().tree(), index.packed().data(), index.primitives().faces(), filter};
}
template <InstancesForKernels I>
WideInstances kernel_scene(const I& index, const Ray<float, 3>& ray, const HitFilter& filter) {
    return {index.structure().tree(), index.primitives().for_kernels(), index.primitives().hit_error(ray),
            filter};
}
template <TrianglesForKernels I>
WideScene kernel_scene(const I& index) {
    return kernel_scene(index, {}, {});
}
template <DoublesForKernels I>
WideDoubles kernel_scene(const I& index) {
    return {index.structure().tree(), index.packed().data(), index.primitives().faces()};
}
template <CloudForKernels I>
WidePoints kernel_scene(const I& index) {
    return {index.structure().tree(), index.packed().data()};
}

}  // namespace hedgerow::detail
