/// The numbers of many vertices, as a plain loop that the compiler puts into vectors: one source gives the
/// numbers of one path and of many.
#pragma once

#include <cstddef>
#include <cstdint>

#include <hedgerow/base/instruction_set.h>
#include <hedgerow/render/sampling/vertex_sample_batch.h>

namespace hedgerow {

/// Writes a pair of each vertex.
template <Sampler sampler>
[[gnu::always_inline]] inline void fill_pair(const VertexKeys& of, std::uint32_t pair,
                                             std::uint32_t* __restrict x, std::uint32_t* __restrict y) {
    for (std::size_t i = 0; i < of.count; ++i) {
        const FractionPair p = PixelSequence::fractions(sampler, of.seeds[i], of.samples[i],
                                                        PathSamples::dimension(of.vertices[i], pair));
        x[i] = p.x, y[i] = p.y;
    }
}
/// Writes all rows of numbers.
[[gnu::always_inline]] inline void fill_rows(Sampler sampler, const VertexKeys& of, const VertexRows& rows) {
    for (std::uint32_t pair = 0; pair < VertexSamples::count; ++pair)
        if (sampler == Sampler::sobol)
            fill_pair<Sampler::sobol>(of, pair, rows[2 * pair], rows[2 * pair + 1]);
        else
            fill_pair<Sampler::independent>(of, pair, rows[2 * pair], rows[2 * pair + 1]);
}

struct SampleKernels {
    void (*fill_rows)(Sampler, const VertexKeys&, const VertexRows&);
};

/// The kernels in use, or nullptr.
const SampleKernels* sample_kernels();

}  // namespace hedgerow
