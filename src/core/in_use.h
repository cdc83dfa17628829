/// Defines the kernels of a kind that are in use. For the sources that foreach_target has compiled for all
/// targets, where HWY_ONCE is set; and for all where there is no Highway.
#pragma once

#include <hedgerow/base/instruction_set.h>

#if HEDGEROW_HAS_HIGHWAY
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

// Defines in_use<Kernels>, for kernels that each target's namespace calls `name`. Outside of all namespaces.
#define HEDGEROW_KERNELS_IN_USE(Kernels, name)                                                            \
    template <>                                                                                           \
    const hedgerow::Kernels* hedgerow::in_use<hedgerow::Kernels>() {                                      \
        static constexpr const hedgerow::Kernels* of_sets[] = {                                           \
            nullptr, HEDGEROW_IN_SSE4(name), HEDGEROW_IN_AVX2(name), HEDGEROW_IN_AVX512(name),            \
            HEDGEROW_IN_NEON(name)};                                                                      \
        return of_sets[static_cast<std::size_t>(instruction_set())]; /* in the order of InstructionSet */ \
    }

#else

#define HEDGEROW_KERNELS_IN_USE(Kernels, name)                       \
    template <>                                                      \
    const hedgerow::Kernels* hedgerow::in_use<hedgerow::Kernels>() { \
        return nullptr;                                              \
    }

#endif
