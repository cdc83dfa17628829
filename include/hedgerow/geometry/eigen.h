/// Eigenvectors of small symmetric matrices.
#pragma once

#include <hedgerow/geometry/vec.h>

namespace hedgerow {

/// A matrix by its rows.
template <int D>
using Rows = std::array<Vec<double, D>, static_cast<std::size_t>(D)>;

/// Eigenvalues, and orthonormal eigenvectors in the same order: none in particular.
template <int D>
struct Eigen {
    Vec<double, D> values;
    Rows<D> vectors;
};

/// Cyclic Jacobi rotations (Jacobi 1846; Golub and Van Loan, Matrix Computations, 8.5): each makes one pair
/// of entries 0, and a few sweeps leave nothing beside the diagonal that counts. Entries are to be neither so
/// large nor so small that products of three leave a double's range.
template <int D>
Eigen<D> eigen_of_symmetric(Rows<D> m) {
    Eigen<D> e;
    for (int i = 0; i < D; ++i) e.vectors[static_cast<std::size_t>(i)][i] = 1;
    for (int sweep = 0; sweep < 16; ++sweep) {
        for (int p = 0; p < D; ++p) {
            for (int q = p + 1; q < D; ++q) {
                const auto i = static_cast<std::size_t>(p), j = static_cast<std::size_t>(q);
                if (std::abs(m[i][q]) <= 0x1p-60 * (std::abs(m[i][p]) + std::abs(m[j][q]))) continue;
                const double theta = (m[j][q] - m[i][p]) / (2 * m[i][q]);
                const double tangent =
                    std::copysign(1 / (std::abs(theta) + std::sqrt(product(theta, theta) + 1)), theta);
                const double c = 1 / std::sqrt(product(tangent, tangent) + 1), s = tangent * c;
                for (auto& row : m) {  // columns p and q
                    const double x = row[p], y = row[q];
                    row[p] = product(c, x) - product(s, y);
                    row[q] = product(s, x) + product(c, y);
                }
                const auto turn = [&](Vec<double, D>& x, Vec<double, D>& y) {
                    const Vec<double, D> old = x;
                    x = old * c - y * s;
                    y = old * s + y * c;
                };
                turn(m[i], m[j]);
                turn(e.vectors[i], e.vectors[j]);
            }
        }
    }
    for (int i = 0; i < D; ++i) e.values[i] = m[static_cast<std::size_t>(i)][i];
    return e;
}

}  // namespace hedgerow
