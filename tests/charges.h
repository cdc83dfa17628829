/// Charges for tests of forces, and sums over all pairs of them.
#pragma once

#include <vector>

#include <hedgerow/nbody/potential.h>
#include <hedgerow/scenes/random.h>

namespace hedgerow {

/// Charges between 1/2 and 3/2, of alternating signs if they are to be neutral.
inline std::vector<double> some_charges(std::size_t count, bool neutral) {
    std::vector<double> charges;
    for (std::uint64_t i = 0; i < count; ++i)
        charges.push_back((neutral && i % 2 == 1 ? -1 : 1) * (0.5 + Random(7, i).uniform()));
    return charges;
}
/// What all other charges do at one of them.
template <class Kernel, class Cloud, int D = Cloud::dimension>
PotentialAt<double, D> sum_of_pairs(const Cloud& cloud, const std::vector<double>& charges,
                                    std::size_t target) {
    PotentialAt<double, D> sum;
    for (std::size_t i = 0; i < cloud.size(); ++i) {
        const Vec<double, D> apart = Vec<double, D>(cloud.points[target]) - Vec<double, D>(cloud.points[i]);
        if (i == target) continue;
        const auto [potential, slope] = Kernel()(length2(apart));
        sum.potential += charges[i] * potential;
        sum.gradient = sum.gradient + apart * (charges[i] * slope);
    }
    return sum;
}

}  // namespace hedgerow
