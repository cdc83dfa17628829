/// Sums over all pairs at some of the charges, and errors of what was found.
#include <hedgerow/nbody/force_check.h>

#include <algorithm>
#include <cmath>

#include "rows.h"

namespace hedgerow {
namespace {

/// Σ |q|/r² at a charge, less where charges are softened; in a cube that repeats, of nearest images.
double sum_of_sizes(const Charges<double>& charges, std::size_t target) {
    const double own = detail::reach_of(charges, target);
    double sum = 0;
    for (std::size_t i = 0; i < charges.places.size(); ++i) {
        const Vec3d apart =
            detail::to_nearest_image(charges.places[i] - charges.places[target], charges.period);
        const double d2 = length2(apart), reach = std::max(own, detail::reach_of(charges, i));
        if (d2 > 0)
            sum += std::abs(charges.charges[i] * SoftenedInverse{charges.softening.kernel, reach}(d2).slope) *
                   std::sqrt(d2);
    }
    return sum;
}

}  // namespace

template <std::floating_point T>
ForceCheck::ForceCheck(const Charges<T>& charges, std::size_t targets, Threads threads)
    // An odd step, since neighbours in a list are often unlike each other.
    : step_(charges.places.size() / std::max<std::size_t>(1, targets) | 1) {
    const std::size_t n = charges.places.size();
    const detail::Extremes<T> extremes(charges);  // throws for bad numbers
    for (std::size_t i = 0; i < n; ++i) charges_.push_back(static_cast<double>(charges.charges[i]));
    // The charges at which it is checked come first.
    std::vector<Vec3d> places;
    std::vector<double> reordered, lengths;
    const auto add = [&](std::size_t i) {
        places.emplace_back(charges.places[i]), reordered.push_back(charges_[i]);
        if (!charges.lengths.empty()) lengths.push_back(static_cast<double>(charges.lengths[i]));
    };
    for (std::size_t i = 0; i < n; i += step_) add(i);
    want_.resize(places.size()), sizes_.resize(places.size());
    for (std::size_t i = 0; i < n; ++i)
        if (i % step_ != 0) add(i);
    const Charges<double> all{places, reordered, charges.softening, lengths, detail::side_of(charges)};
    direct_sum<double>(all, want_, {.threads = threads});
    threads.over(n * want_.size() / 16)
        .for_each_piece(want_.size(), 4, [&](std::size_t begin, std::size_t end) {
            for (std::size_t k = begin; k < end; ++k)
                sizes_[k] = std::max(length(want_[k].gradient), 0.01 * sum_of_sizes(all, k));
        });
}

template <std::floating_point T>
ForceErrors ForceCheck::errors_of(std::span<const PotentialAt<T>> found) const {
    if (found.size() != charges_.size())
        throw InputError(std::to_string(found.size()) + " forces of " + std::to_string(charges_.size()) +
                         " charges: give one each");
    ForceErrors errors;
    if (found.empty()) return errors;
    errors.targets = want_.size();
    std::vector<double> all;
    double sum2 = 0;
    for (std::size_t k = 0; k < want_.size(); ++k) {
        const double error = length(Vec3d(found[k * step_].gradient) - want_[k].gradient);
        all.push_back(error > 0 ? error / sizes_[k] : error);  // NaN stays
        sum2 += all.back() * all.back();
    }
    errors.rms = std::sqrt(sum2 / static_cast<double>(all.size()));
    std::sort(all.begin(), all.end());
    errors.most = all[(all.size() - 1) * 999 / 1000], errors.largest = all.back();
    Vec3d sum;
    double sizes = 0;
    for (std::size_t i = 0; i < found.size(); ++i) {
        const Vec3d force = Vec3d(found[i].gradient) * charges_[i];
        sum += force, sizes += length(force);
    }
    errors.imbalance = sizes > 0 ? length(sum) / sizes : 0;
    return errors;
}

template ForceCheck::ForceCheck(const Charges<float>&, std::size_t, Threads);
template ForceCheck::ForceCheck(const Charges<double>&, std::size_t, Threads);
template ForceErrors ForceCheck::errors_of(std::span<const PotentialAt<float>>) const;
template ForceErrors ForceCheck::errors_of(std::span<const PotentialAt<double>>) const;

}  // namespace hedgerow
