/// Sums over pairs one after the other, for whatever kernels leave: pairs of any distance that double has.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <vector>

#include <hedgerow/nbody/kernels.h>
#include <hedgerow/nbody/softening.h>

namespace hedgerow::detail {

/// What a charge of 1 does at an offset from it: the potential and its gradient. Nothing in its own place, if
/// it is bare.
inline PotentialAt<double> act_of_pair(const Vec3d& apart, double reach, SofteningKernel kernel) {
    double unit = 1, distance2 = length2(apart);
    if (!(distance2 >= 0x1p-600)) {  // the inverse of its cube may be beyond double
        const double size = std::max({std::abs(apart[0]), std::abs(apart[1]), std::abs(apart[2]), reach});
        if (size == 0) return {};
        unit = std::ldexp(1.0, -std::ilogb(size));
        distance2 = length2(apart * unit);
    }
    const KernelShare share =
        reach > 0 ? SoftenedInverse{kernel, reach * unit}(distance2) : InverseDistance()(distance2);
    return {share.potential * unit, apart * unit * share.slope * unit * unit};
}
/// What `DirectKernel` does, as the exact kernel does it.
template <class T>
void direct_plain(const ChargeRows<T>& sources, const TargetRows<T>& targets, SofteningKernel kernel) {
    const auto apart = [](T target, const T* low_target, std::size_t t, T source, const T* low_source,
                          std::size_t s) {
        const double high = static_cast<double>(target) - static_cast<double>(source);
        if (low_target == nullptr) return high;
        return high + (static_cast<double>(low_target[t]) - static_cast<double>(low_source[s]));
    };
    for (std::size_t t = 0; t < targets.count; ++t)
        for (std::size_t s = 0; s < sources.count; ++s) {
            if (targets.self != no_self && s == targets.self + t) continue;
            const Vec3d d(apart(targets.x[t], targets.low_x, t, sources.x[s], sources.low_x, s),
                          apart(targets.y[t], targets.low_y, t, sources.y[s], sources.low_y, s),
                          apart(targets.z[t], targets.low_z, t, sources.z[s], sources.low_z, s));
            const T reach = sources.reach == nullptr ? T(0) : std::max(sources.reach[s], targets.reach[t]);
            const PotentialAt<double> act = act_of_pair(d, static_cast<double>(reach), kernel);
            const double charge = static_cast<double>(sources.charge[s]);
            targets.potential[t] += charge * act.potential;
            targets.gx[t] += charge * act.gradient[0], targets.gy[t] += charge * act.gradient[1];
            targets.gz[t] += charge * act.gradient[2];
        }
}

/// Adds to the potential of each of some charges in one place what the others do that are softened with it:
/// a pair by its greater reach. O(n·log n).
template <class T>
void add_pile(const T* charge, const T* reach, std::size_t count, SofteningKernel kernel, double* potential) {
    std::vector<std::size_t> order(count);
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return reach[a] < reach[b]; });
    const auto central = [&](std::size_t i) {
        return act_of_pair(Vec3d(), static_cast<double>(reach[i]), kernel).potential;
    };
    double shorter = 0, longer = 0;  // Σ q of those before, and what those behind do
    for (const std::size_t i : order) longer += static_cast<double>(charge[i]) * central(i);
    for (const std::size_t i : order) {
        const double q = static_cast<double>(charge[i]);
        longer -= q * central(i);
        potential[i] += shorter * central(i) + longer;
        shorter += q;
    }
}

}  // namespace hedgerow::detail
