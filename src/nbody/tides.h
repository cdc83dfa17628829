/// Second derivatives of potentials, from expansions of first ones.
#pragma once

#include <array>
#include <cstddef>

#include <hedgerow/nbody/kernels.h>
#include <hedgerow/nbody/potential.h>

#include "packed.h"

namespace hedgerow::detail {

/// The local expansions of ∂φ/∂x and ∂φ/∂y for a φ with a packed local expansion of an order; theirs is one
/// less. Of φ's numbers each gathers those of the degree above (as `l2p`).
struct LocalSlopes {
    std::array<double, packed_count(most_order_at_run_time)> x{}, y{};

    template <class T>
    LocalSlopes(const T* local, int order) {
        const auto real = [&](int k, int l) { return static_cast<double>(local[re(k, l)]); };
        const auto imaginary = [&](int k, int l) {
            return l > 0 ? static_cast<double>(local[im(k, l)]) : 0.0;
        };
        for (int n = 0; n < order; ++n)
            for (int m = 0; m <= n; ++m) {
                const double ur = real(n + 1, m + 1), ui = imaginary(n + 1, m + 1);
                const double dr = m == 0 ? -real(n + 1, 1) : real(n + 1, m - 1);
                const double di = m == 0 ? imaginary(n + 1, 1) : imaginary(n + 1, m - 1);
                x[std::size_t(re(n, m))] = 0.5 * (ur - dr), y[std::size_t(re(n, m))] = 0.5 * (ui + di);
                if (m == 0) continue;
                x[std::size_t(im(n, m))] = 0.5 * (ui - di), y[std::size_t(im(n, m))] = -0.5 * (ur + dr);
            }
    }
};

/// The six numbers of tidal tensors in rows, in the order of `Tides`.
struct TideRows {
    std::array<double*, 6> row{};

    TideRows() = default;
    TideRows(double* first, std::size_t stride) {
        for (std::size_t k = 0; k < 6; ++k) row[k] = first + k * stride;
    }
    TideRows from(std::size_t i) const {
        TideRows rows;
        for (std::size_t k = 0; k < 6; ++k) rows.row[k] = row[k] + i;
        return rows;
    }
    Tides operator[](std::size_t i) const {
        return {row[0][i], row[1][i], row[2][i], row[3][i], row[4][i], row[5][i]};
    }
    void add(std::size_t i, const Tides& t) const {
        row[0][i] += t.xx, row[1][i] += t.yy, row[2][i] += t.zz;
        row[3][i] += t.xy, row[4][i] += t.xz, row[5][i] += t.yz;
    }
};

/// Adds the tides of a packed local expansion at places in rows, of at most 256 places. `add_local` is the
/// kernel of that name.
template <class T>
void add_local_tides(const T* local, int order, const double* x, const double* y, const double* z,
                     std::size_t count, double unit, AddLocal add_local, const TideRows& tides) {
    constexpr std::size_t most = 256;
    const LocalSlopes slopes(local, order);
    // ∂φ/∂x has the slopes xx, xy, xz; ∂φ/∂y has xy, yy, yz; far charges leave no trace.
    alignas(64) std::array<double, most + row_padding> unused{}, xx{}, xy{}, xz{}, yy{}, yz{};
    add_local(slopes.x.data(), order - 1, {x, y, z, count, unused.data(), xx.data(), xy.data(), xz.data()});
    add_local(slopes.y.data(), order - 1,
              {x, y, z, count, unused.data(), unused.data(), yy.data(), yz.data()});
    for (std::size_t i = 0; i < count; ++i)
        tides.add(i, {xx[i] * unit, yy[i] * unit, -(xx[i] + yy[i]) * unit, xy[i] * unit, xz[i] * unit,
                      yz[i] * unit});
}

}  // namespace hedgerow::detail
