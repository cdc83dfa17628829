#include <hedgerow/render/sampling/vertex_sample_batch.h>

#include "sample_kernels.h"

void hedgerow::VertexSampleBatch::compute() {
    const VertexKeys keys{seeds_.data(), samples_.data(), vertices_.data(), seeds_.size()};
    VertexRows rows;
    for (std::size_t r = 0; r < rows.size(); ++r) rows[r] = numbers_.data() + r * most_;
    if (const SampleKernels* const kernels = sample_kernels())
        kernels->fill_rows(sampler_, keys, rows);
    else
        fill_rows(sampler_, keys, rows);
}
