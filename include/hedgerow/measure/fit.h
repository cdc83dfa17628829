/// Growth of a cost with the number of primitives: laws with two parameters, fitted by least squares.
#pragma once

#include <span>
#include <string_view>
#include <vector>

namespace hedgerow::measure {

enum class Law {
    power,      ///< a · n^b
    logarithm,  ///< a + b · log2 n
    root,       ///< a + b · n^(1/D): the cells that a line crosses in a grid of n cells
    linear,     ///< a + b · n
    n_log_n     ///< a + b · n log2 n
};
inline constexpr std::string_view law_names[] = {"power", "logarithm", "root", "linear", "n log n"};
constexpr std::string_view name_of(Law law) {
    return law_names[static_cast<std::size_t>(law)];
}

struct Fit {
    Law law = Law::power;
    int dimension = 3;  ///< D in Law::root
    double a = 0, b = 0;
    /// Root mean square of the relative errors (law − value) / value.
    double residual = 0;

    double operator()(double n) const;
};

/// Fits the law's parameters to values at sizes. Both are positive, and there are at least two. Least squares
/// are of the relative errors (of the errors of logarithms, for the power law), so that small sizes count as
/// much as large ones.
Fit fit(Law law, std::span<const double> sizes, std::span<const double> values, int dimension = 3);

/// Fits all laws and returns them by residual, the least first.
std::vector<Fit> fits(std::span<const double> sizes, std::span<const double> values, int dimension = 3);

}  // namespace hedgerow::measure
