#include <hedgerow/render/sampling/sample_batch.h>

#include "sample_kernels.h"

void hedgerow::SampleBatch::compute() {
    const PairKeys keys{seeds_.data(), samples_.data(), dimensions_.data(), seeds_.size()};
    const SampleKernels* const kernels = in_use<SampleKernels>();
    const auto fill = kernels ? kernels->fill_pairs : fill_pairs;
    for (std::uint32_t k = 0; k < pairs_; ++k)
        fill(sampler_, keys, k, numbers_.data() + 2 * k * most_, numbers_.data() + (2 * k + 1) * most_);
}
