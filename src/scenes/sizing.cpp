/// Searches for the division of a shape nearest to a size.
#include "sizing.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <hedgerow/geometry/rounding.h>

namespace hedgerow::detail {

std::uint64_t Composition::count(const Split& s) const {
    const auto in_column = per_cell * static_cast<std::int64_t>(s.rows) + per_column;
    return s.columns * static_cast<std::uint64_t>(in_column);
}

Split nearest_split(std::uint64_t size, const Composition& shape) {
    const double wanted = static_cast<double>(std::max<std::uint64_t>(size, 1));
    // Try up to twice the number of rows that has the best ratio.
    const double even =
        std::sqrt(wanted / product(static_cast<double>(shape.per_cell), shape.columns_per_row));
    const std::uint64_t most_rows = 2 * static_cast<std::uint64_t>(even) + 2;
    Split best{1, shape.least_columns};
    double least_cost = std::numeric_limits<double>::infinity();
    for (std::uint64_t rows = 1; rows <= most_rows; ++rows) {
        const auto in_column = shape.count({rows, 1});
        const Split split{rows, std::max(shape.least_columns, (size + in_column / 2) / in_column)};
        const double ratio =
            static_cast<double>(split.columns) / product(static_cast<double>(rows), shape.columns_per_row);
        const double miss = std::fabs(static_cast<double>(shape.count(split)) - wanted) / wanted;
        // A ratio that is off by a factor of 2 counts as much as a miss of 5 %.
        const double cost = miss + product(0.05, std::max(ratio, 1 / ratio) - 1);
        if (cost < least_cost) best = split, least_cost = cost;
    }
    return best;
}

std::array<std::uint32_t, 3> nearest_box_split(std::uint64_t size,
                                               const std::array<std::uint64_t, 3>& weights) {
    using Split3 = std::array<std::uint32_t, 3>;
    const auto count = [&](const Split3& s) {
        const std::uint64_t a = s[0], b = s[1], c = s[2];
        return weights[0] * b * c + weights[1] * c * a + weights[2] * a * b;
    };
    const auto miss = [&](const Split3& s) {
        const std::uint64_t n = count(s);
        return n > size ? n - size : size - n;
    };
    // Try the same number of pieces on each axis, and then one more on the last one, two or three axes.
    const double even = std::sqrt(static_cast<double>(size) / static_cast<double>(count({1, 1, 1})));
    const auto k = std::max<std::uint32_t>(1, static_cast<std::uint32_t>(even));
    Split3 best{k, k, k};
    for (const Split3& s : {Split3{k, k, k + 1}, Split3{k, k + 1, k + 1}, Split3{k + 1, k + 1, k + 1}})
        if (miss(s) < miss(best)) best = s;
    return best;
}

double cube_root(double x) {
    double root = 1;
    while (product(product(root, root), root) < x) root += root;
    for (;;) {
        const double next = (root + root + x / product(root, root)) / 3;
        if (!(next < root)) return root;
        root = next;
    }
}

}  // namespace hedgerow::detail
