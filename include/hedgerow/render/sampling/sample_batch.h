/// The random numbers of many paths at once. The component `render` has it compiled.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <hedgerow/render/sampling/path_samples.h>

namespace hedgerow {

/// What pairs of numbers are functions of: the seeds of their pixels' sequences, the numbers of their
/// samples, and their dimensions.
struct PairKeys {
    const std::uint32_t *seeds, *samples, *dimensions;
    std::size_t count;
};

/// Numbers of many paths, computed with the processor's vectors. They are those of PathSamples.
class SampleBatch {
public:
    /// For up to so many paths, with so many pairs of each.
    SampleBatch(std::size_t most, std::uint32_t pairs)
        : most_(most), pairs_(pairs), numbers_(2 * pairs * most) {
        for (auto* keys : {&seeds_, &samples_, &dimensions_}) keys->reserve(most);
    }

    void clear() {
        for (auto* keys : {&seeds_, &samples_, &dimensions_}) keys->clear();
    }
    /// Adds the pairs of a path from a dimension on. The paths have the same sampler.
    void add(const PathSamples& path, std::uint32_t dimension) {
        sampler_ = path.pixel().sampler();
        seeds_.push_back(path.pixel().seed()), samples_.push_back(path.sample());
        dimensions_.push_back(dimension);
    }
    /// Computes the pairs of all paths that were added.
    void compute();
    /// The numbers of the i-th path that was added, at its vertex or at the camera. Pairs that the batch does
    /// not have are 0.
    VertexSamples at_vertex(std::size_t i) const { return at<VertexSamples>(i); }
    CameraSamples at_camera(std::size_t i) const { return at<CameraSamples>(i); }

private:
    template <class Samples>
    Samples at(std::size_t i) const {
        Samples s{};
        for (std::size_t k = 0; k < Samples::count && k < pairs_; ++k)
            s.pairs[k] = {numbers_[2 * k * most_ + i], numbers_[(2 * k + 1) * most_ + i]};
        return s;
    }

    std::size_t most_;
    std::uint32_t pairs_;
    Sampler sampler_ = Sampler::sobol;
    std::vector<std::uint32_t> seeds_, samples_, dimensions_;
    std::vector<std::uint32_t> numbers_;  // rows: x and y of each pair
};

}  // namespace hedgerow
