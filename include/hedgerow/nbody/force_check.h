/// What errors forces have, by whatever method they were found: against sums over all pairs at some of the
/// charges.
#pragma once

#include <concepts>
#include <span>
#include <vector>

#include <hedgerow/nbody/direct_sum.h>

namespace hedgerow {

/// Errors of gradients, as shares of the gradients, or of a hundredth of Σ |q|/r² where that is more (in a
/// periodic cube over nearest images).
struct ForceErrors {
    std::size_t targets = 0;  ///< at how many they were measured
    double rms = 0;           ///< the root of the mean square
    double most = 0;          ///< of all targets but a thousandth
    double largest = 0;
    /// What forces add up to, as a share of the sum of their sizes, over all charges.
    double imbalance = 0;
};

/// Holds what forces should be at some of the charges, to measure any that are found.
class ForceCheck {
public:
    /// Sums over all pairs in double, at charges as far apart in the caller's arrays as makes about so many.
    /// O(targets · charges), in a periodic cube 125 times as long.
    ///
    /// Throws as `direct_sum` does. T is float or double. In the library `nbody`.
    template <std::floating_point T>
    explicit ForceCheck(const Charges<T>& charges, std::size_t targets = 1000, Threads threads = {});

    /// The errors of what was found at each of the charges. Throws InputError if there is not one element
    /// for each. O(charges).
    template <std::floating_point T>
    ForceErrors errors_of(std::span<const PotentialAt<T>> found) const;
    /// Of a vector or another array of them.
    template <class Found>
    requires(std::convertible_to<const Found&, std::span<const PotentialAt<float>>> ||
             std::convertible_to<const Found&, std::span<const PotentialAt<double>>>) ForceErrors
        errors_of(const Found& found)
    const {
        if constexpr (std::convertible_to<const Found&, std::span<const PotentialAt<float>>>)
            return errors_of(std::span<const PotentialAt<float>>(found));
        else
            return errors_of(std::span<const PotentialAt<double>>(found));
    }

private:
    std::vector<double> charges_;
    std::size_t step_;
    std::vector<PotentialAt<double>> want_;
    std::vector<double> sizes_;
};

}  // namespace hedgerow
