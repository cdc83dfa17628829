/// Eigenvectors of small symmetric matrices.
#pragma once

#include <hedgerow/geometry/vec.h>

namespace hedgerow {

/// A D×D matrix, stored by rows.
template <int D>
using Rows = std::array<Vec<double, D>, static_cast<std::size_t>(D)>;

/// Eigenvalues and orthonormal eigenvectors: vectors[i] belongs to values[i]. The order is arbitrary.
template <int D>
struct Eigen {
    Vec<double, D> values;
    Rows<D> vectors;
};

/// Eigenvalues and eigenvectors by cyclic Jacobi rotations (Jacobi 1846; Golub and Van Loan, Matrix
/// Computations, 8.5). Each rotation makes one pair of entries 0, and a few sweeps leave only negligible
/// entries off the diagonal. Products of three entries must neither overflow nor underflow.
template <int D>
Eigen<D> eigen_of_symmetric(Rows<D> m) {
    Eigen<D> e;
    for (int i = 0; i < D; ++i) e.vectors[static_cast<std::size_t>(i)][i] = 1;
    for (int sweep = 0; sweep < 16; ++sweep) {
        for (int p = 0; p < D; ++p) {
            for (int q = p + 1; q < D; ++q) {
                const auto i = static_cast<std::size_t>(p), j = static_cast<std::size_t>(q);
                // Skip a pair that is negligible beside its diagonal entries.
                if (std::abs(m[i][q]) <= 0x1p-60 * (std::abs(m[i][p]) + std::abs(m[j][q]))) continue;
                // The smaller rotation that makes the pair 0: tangent, cosine and sine of its angle.
                const double theta = (m[j][q] - m[i][p]) / (2 * m[i][q]);
                const double tangent =
                    std::copysign(1 / (std::abs(theta) + std::sqrt(product(theta, theta) + 1)), theta);
                const double c = 1 / std::sqrt(product(tangent, tangent) + 1), s = tangent * c;
                // Rotate columns p and q.
                for (auto& row : m) {
                    const double x = row[p], y = row[q];
                    row[p] = product(c, x) - product(s, y);
                    row[q] = product(s, x) + product(c, y);
                }
                // Rotate rows p and q, and the eigenvectors with them.
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
