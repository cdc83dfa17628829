/// What the sources of the kernels share: the list that kernels.cpp makes and choice.cpp chooses from.
#pragma once

#include <hedgerow/engine/kernels.h>

namespace hedgerow::detail {

/// The kernels of every instruction set that was compiled, best first. Empty in a build without Highway.
std::vector<const WideKernels*> compiled_wide_kernels();

}  // namespace hedgerow::detail
