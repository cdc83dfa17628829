#include <hedgerow/fluid/fluid_measures.h>

#include <algorithm>
#include <array>
#include <cmath>

#include <hedgerow/parallel/fixed_sums.h>

namespace hedgerow {

namespace {

/// Measures the compressions of particles whose surroundings are half full.
template <int D>
void measure_compressions(const FluidFlow<D>& flow, FluidMeasures<D>& m) {
    std::vector<double> sizes;
    for (std::size_t i = 0; i < flow.fills().size(); ++i)
        if (flow.fills()[i] >= 0.5f) sizes.push_back(std::abs(flow.state().compressions[i]));
    m.dense = sizes.size();
    m.far_from_rest = static_cast<std::size_t>(
        std::count_if(sizes.begin(), sizes.end(), [](double c) { return c > 0.05; }));
    if (sizes.empty()) return;
    const auto most = sizes.begin() + static_cast<std::ptrdiff_t>((sizes.size() - 1) * 999 / 1000);
    std::nth_element(sizes.begin(), most, sizes.end());
    m.compression_of_most = *most;
}

}  // namespace

template <int D>
FluidMeasures<D> measures(const FluidFlow<D>& flow, Threads threads) {
    const FluidState<D>& state = flow.state();
    const std::size_t n = state.size();
    const double mass = flow.mass();
    const auto sums = fixed_sums<3 + D>(n, threads.over(n), [&](std::size_t i) {
        const Vec<double, D>& v = state.velocities[i];
        std::array<double, 3 + D> share = {mass * length2(v) / 2,
                                           -mass * dot(flow.options().gravity, state.places[i]),
                                           std::abs(state.compressions[i])};
        for (int k = 0; k < D; ++k) share[3 + static_cast<std::size_t>(k)] = mass * v[k];
        return share;
    });
    FluidMeasures<D> m;
    m.kinetic = sums[0], m.potential = sums[1];
    m.mean_compression = n > 0 ? sums[2] / static_cast<double>(n) : 0;
    for (int k = 0; k < D; ++k) m.momentum[k] = sums[3 + static_cast<std::size_t>(k)];
    for (const auto& v : state.velocities) m.fastest = std::max(m.fastest, length(v));
    measure_compressions(flow, m);
    return m;
}

template FluidMeasures<2> measures(const FluidFlow<2>&, Threads);
template FluidMeasures<3> measures(const FluidFlow<3>&, Threads);

}  // namespace hedgerow
