/// Codes of the cells of a cube along a Morton curve (Morton 1966), exact: the bits of the orthants that lead
/// to a cell.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include <hedgerow/geometry/cube.h>
#include <hedgerow/geometry/morton_code.h>
#include <hedgerow/structures/orthtree/root.h>

namespace hedgerow {

/// The cells of a cube that is halved `levels` times along every axis. Cells are half open: a point on a
/// plane is on its high side. The code of a cell has D bits a level, the cube's own orthants highest, and bit
/// k is that of axis k, as `Cube::orthant` numbers them.
template <std::floating_point T, int D>
class CellCodes {
public:
    /// As many levels as `bits` have room for, and as T resolves in the cube: all planes are numbers of T,
    /// and so are the middles of the cells. The cube's planes must be numbers of T (root.h), and so are its
    /// orthants'.
    CellCodes(const Cube<T, D>& cube, int bits) : low_(cube.middle - Vec<T, D>::all(cube.half)) {
        constexpr int most = D == 3 ? 21 : 31;
        const T largest = max_component(abs(cube.middle)) + cube.half;
        const T resolved =
            std::max(std::ldexp(detail::power_of_two_above(largest), -limits::digits), limits::denorm_min());
        levels_ = std::clamp(std::ilogb(cube.half) - std::ilogb(resolved), 0, std::min(bits / D, most));
        cell_ = std::ldexp(cube.half, 1 - levels_);
    }

    int levels() const { return levels_; }
    /// The code of the cell with a point of the cube.
    std::uint64_t code(const Vec<T, D>& p) const {
        std::uint64_t code = 0;
        for (int k = 0; k < D; ++k) {
            // The difference is rounded, so the quotient may be in the next cell. Planes are exact.
            auto i = static_cast<std::int64_t>((p[k] - low_[k]) / cell_);
            const T plane = low_[k] + static_cast<T>(i) * cell_;
            i += (p[k] >= plane + cell_ ? 1 : 0) - (p[k] < plane ? 1 : 0);
            code |= spread_bits<D>(static_cast<std::uint64_t>(i)) << k;
        }
        return code;
    }

private:
    using limits = std::numeric_limits<T>;

    Vec<T, D> low_;
    T cell_;
    int levels_;
};

}  // namespace hedgerow
