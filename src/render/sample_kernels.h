/// The numbers of many paths, as a plain loop that the compiler puts into vectors: one source gives the
/// numbers of one path and of many.
#pragma once

#include <cstddef>
#include <cstdint>

#include <hedgerow/base/instruction_set.h>
#include <hedgerow/render/sampling/sample_batch.h>

namespace hedgerow {

/// Writes a pair of each path: that of its dimension, or one that follows it.
template <Sampler sampler>
[[gnu::always_inline]] inline void fill_pairs_of(const PairKeys& of, std::uint32_t pair,
                                                 std::uint32_t* __restrict x, std::uint32_t* __restrict y) {
    for (std::size_t i = 0; i < of.count; ++i) {
        const FractionPair p =
            PixelSequence::fractions(sampler, of.seeds[i], of.samples[i], of.dimensions[i] + pair);
        x[i] = p.x, y[i] = p.y;
    }
}
[[gnu::always_inline]] inline void fill_pairs(Sampler sampler, const PairKeys& of, std::uint32_t pair,
                                              std::uint32_t* x, std::uint32_t* y) {
    if (sampler == Sampler::sobol)
        fill_pairs_of<Sampler::sobol>(of, pair, x, y);
    else
        fill_pairs_of<Sampler::independent>(of, pair, x, y);
}

struct SampleKernels {
    void (*fill_pairs)(Sampler, const PairKeys&, std::uint32_t pair, std::uint32_t* x, std::uint32_t* y);
};

/// The kernels in use, or nullptr.
template <>
const SampleKernels* in_use<SampleKernels>();

}  // namespace hedgerow
