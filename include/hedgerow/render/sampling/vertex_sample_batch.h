/// The random numbers of many paths at once. The component `render` has it compiled.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <hedgerow/render/sampling/path_samples.h>

namespace hedgerow {

/// Rows of numbers, one number a vertex: x and y of each pair.
using VertexRows = std::array<std::uint32_t*, 2 * VertexSamples::count>;

/// What the numbers of vertices are functions of: the seeds of their pixels' sequences, the numbers of their
/// samples, and their numbers on their paths.
struct VertexKeys {
    const std::uint32_t *seeds, *samples, *vertices;
    std::size_t count;
};

/// The numbers of vertices, each of another path: those of PathSamples::at, computed with the processor's
/// vectors.
class VertexSampleBatch {
public:
    /// For up to so many vertices.
    explicit VertexSampleBatch(std::size_t most) : most_(most), numbers_(most * VertexRows().size()) {
        for (auto* keys : {&seeds_, &samples_, &vertices_}) keys->reserve(most);
    }

    void clear() {
        for (auto* keys : {&seeds_, &samples_, &vertices_}) keys->clear();
    }
    /// Adds a vertex. The paths have the same sampler.
    void add(const PathSamples& path, std::uint32_t vertex) {
        sampler_ = path.pixel().sampler();
        seeds_.push_back(path.pixel().seed()), samples_.push_back(path.sample());
        vertices_.push_back(vertex);
    }
    /// Computes the numbers of all vertices that were added.
    void compute();
    /// The numbers of the i-th vertex that was added.
    VertexSamples operator[](std::size_t i) const {
        VertexSamples s;
        for (std::size_t pair = 0; pair < VertexSamples::count; ++pair)
            s.pairs[pair] = {numbers_[2 * pair * most_ + i], numbers_[(2 * pair + 1) * most_ + i]};
        return s;
    }

private:
    std::size_t most_;
    Sampler sampler_ = Sampler::sobol;
    std::vector<std::uint32_t> seeds_, samples_, vertices_;
    std::vector<std::uint32_t> numbers_;  // row by row
};

}  // namespace hedgerow
