/// The KernelTables of what each target's namespace calls by one name. For the sources that foreach_target
/// has compiled for all targets, where HWY_ONCE is set.
#pragma once

#include <hwy/highway.h>

#if HWY_TARGETS & HWY_SSE4
#define HEDGEROW_IN_SSE4(name) &N_SSE4::name
#else
#define HEDGEROW_IN_SSE4(name) nullptr
#endif
#if HWY_TARGETS & HWY_AVX2
#define HEDGEROW_IN_AVX2(name) &N_AVX2::name
#else
#define HEDGEROW_IN_AVX2(name) nullptr
#endif
#if HWY_TARGETS & HWY_AVX3
#define HEDGEROW_IN_AVX512(name) &N_AVX3::name
#else
#define HEDGEROW_IN_AVX512(name) nullptr
#endif
#if HWY_TARGETS & HWY_NEON
#define HEDGEROW_IN_NEON(name) &N_NEON::name
#else
#define HEDGEROW_IN_NEON(name) nullptr
#endif

// In the order of InstructionSet.
#define HEDGEROW_KERNEL_TABLES(name)                                                       \
    {                                                                                      \
        nullptr, HEDGEROW_IN_SSE4(name), HEDGEROW_IN_AVX2(name), HEDGEROW_IN_AVX512(name), \
            HEDGEROW_IN_NEON(name)                                                         \
    }
