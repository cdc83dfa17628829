/// The instruction sets that kernels are not compiled for; all others that the compiler knows, they are. Must
/// come before Highway's headers, of which nothing is linked.
#pragma once

// Not worth their code: SSSE3 beside SSE4, and what AVX-512 has gained since its beginnings. Not possible:
// SVE, whose vectors have no known length and so cannot be members.
#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_AVX3_DL | HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128)
