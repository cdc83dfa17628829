/// How finely to divide a shape to come near a wanted number of elements.
#pragma once

#include <array>
#include <cstdint>

namespace hedgerow::detail {

struct Split {
    std::uint64_t rows, columns;
};

/// The number of triangles of a shape of rows and columns: columns·(per_cell·rows + per_column).
struct Composition {
    std::int64_t per_cell, per_column = 0;
    double columns_per_row = 1;  ///< the ratio that looks best
    std::uint64_t least_columns = 1;

    std::uint64_t count(const Split& s) const;
};

/// The split whose count is nearest to `size`. A better ratio of columns to rows outweighs a miss of a few
/// per cent at most. O(√size).
Split nearest_split(std::uint64_t size, const Composition& shape);

/// Divisions (a, b, c) of a box along its axes, which differ by 1 at most, such that the weighted sum of
/// pairs w0·b·c + w1·c·a + w2·a·b is nearest to `size`.
std::array<std::uint32_t, 3> nearest_box_split(std::uint64_t size,
                                               const std::array<std::uint64_t, 3>& weights);

/// The cube root to a few roundings, by Newton's iteration from above. x >= 1.
double cube_root(double x);

}  // namespace hedgerow::detail
