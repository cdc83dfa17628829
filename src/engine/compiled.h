/// What the sources of the kernels share: the list that kernels.cpp makes and choice.cpp chooses from, and
/// what is compiled once for all instruction sets.
#pragma once

#include <hedgerow/engine/kernels.h>

namespace hedgerow::detail {

/// The kernels of every instruction set that was compiled, best first. Empty in a build without Highway.
std::vector<const WideKernels*> compiled_wide_kernels();

/// A foot on the triangle at a place of a block, rounded and clamped as `closest_point`
/// (geometry/distance.h) does it.
Vec<float, 3> clamped_into(const TriangleBlock<float>& block, std::uint32_t place,
                           const Vec<double, 3>& foot);

}  // namespace hedgerow::detail
