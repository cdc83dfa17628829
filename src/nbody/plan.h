/// How the fast multipole method reaches an accuracy.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <iterator>
#include <string>

#include <hedgerow/base/error.h>

namespace hedgerow::detail {

/// What is computed in float: all; pairs alone, of places in two parts; or nothing.
enum class Precision { single, mixed, twofold };
/// How an accuracy is reached: the order of multipoles, the precision, at most what the rms error of the
/// gradients is to the bound that each conversion keeps where charges fill space, how long leaves are, so
/// that pairs and conversions take about as long, and below how many charges a direct sum is faster. Errors
/// were measured on a cube, a lattice, Plummer's and Hernquist's spheres, a disc, two unlike clusters, and
/// charges that cancel.
struct Plan {
    double least_accuracy;
    int order;
    Precision precision;
    double error_per_bound;
    std::uint32_t leaf_size;
    std::size_t least_charges;
};
inline constexpr Plan plans[] = {
    {3e-3, 3, Precision::single, 0.85, 80, 1000},   {2e-4, 4, Precision::single, 1.0, 80, 1500},
    {1e-5, 6, Precision::single, 0.75, 80, 2500},   {1e-6, 8, Precision::mixed, 1.0, 80, 6000},
    {3e-7, 11, Precision::mixed, 0.4, 80, 8000},    {1e-8, 11, Precision::twofold, 0.4, 80, 8000},
    {1e-9, 11, Precision::twofold, 0.8, 80, 12000},
};
/// Targets that are fewer are summed directly, since the charges' cells take longer.
inline constexpr std::size_t least_targets = 256;
/// So few charges of a periodic cube are summed directly, and so few where expansions are in double.
inline constexpr std::size_t least_charges_in_cube = 32, least_charges_in_cube_of_double = 256;
inline constexpr double most_accuracy = 0.1;
/// In a periodic cube gradients are small sums of large parts, whose errors count so many times, and so do
/// roundings of sums in float; and cubes of even charge have a moment of degree 4, which the lowest order
/// lacks in all images alike.
inline constexpr double errors_in_cube = 2.6, errors_in_cube_of_double = 3, least_in_cube = 2e-3,
                        least_for_floats_in_cube = 2e-6;

/// Gradients in float are rounded by some 3e-8.
inline constexpr double least_accuracy_of_float = 1e-7;
/// What roundings of pairs may do, as a share of the error that is asked for.
inline constexpr double share_of_pairs = 0.5;

inline const Plan& plan_for(double accuracy, bool periodic) {
    const Plan& finest = plans[std::size(plans) - 1];
    if (!(accuracy >= finest.least_accuracy && accuracy <= most_accuracy)) {
        char given[32];
        std::snprintf(given, sizeof given, "%g", accuracy);
        throw UsageError(std::string("an accuracy of ") + given + " is not from 1e-9 to 0.1");
    }
    const double needed = periodic ? std::min(accuracy / 2, least_in_cube) : accuracy;
    for (const Plan& plan : plans)
        if (needed >= plan.least_accuracy &&
            !(periodic && plan.precision == Precision::mixed && needed < least_for_floats_in_cube))
            return plan;
    return finest;
}

}  // namespace hedgerow::detail
