/// What kernels.cpp gives to choice.cpp.
#pragma once

#include <hedgerow/structures/bvh/wide/kernels.h>

namespace hedgerow::detail {

/// The kernels of every instruction set that was compiled, best first; none where Highway was not there.
std::vector<const WideKernels*> compiled_wide_kernels();

}  // namespace hedgerow::detail
