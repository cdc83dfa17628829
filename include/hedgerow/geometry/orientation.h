/// Exact signs of orientations: the side of a line in the plane of two axes, and of a plane in space. A
/// filter in double decides unless the sign is in doubt (Shewchuk 1997); ExactSum decides then. Right for all
/// finite coordinates, whatever overflows.
#pragma once

#include <hedgerow/geometry/exact_sum.h>

namespace hedgerow {

namespace detail {
/// A bound of what underflow may add to a sum of few products. Far below what any filter must resolve.
inline constexpr double underflow = 0x1p-1000;
}  // namespace detail

/// 1 if p, q, x turn counterclockwise in the plane of axes u and v, −1 if clockwise, 0 if x is on the line.
/// `along` is q − p, rounded. With ε the unit roundoff, the sum errs by at most (3 + 16ε)ε of the products'
/// magnitudes (Shewchuk 1997, section 4.2); the filter takes 4ε.
template <int D>
int turn(const Vec<double, D>& p, const Vec<double, D>& q, const Vec<double, D>& along,
         const Vec<double, D>& x, int u, int v) {
    const double left = product(along[u], x[v] - p[v]), right = product(along[v], x[u] - p[u]);
    const double sum = left - right;
    const double error =
        product(4 * unit_roundoff<double>, std::abs(left) + std::abs(right)) + detail::underflow;
    if (std::abs(sum) > error) [[likely]]
        return sum > 0 ? 1 : -1;
    // Edges along an axis and corners on the edge are common; both products are then exactly 0.
    if ((along[u] == 0 || x[v] == p[v]) && (along[v] == 0 || x[u] == p[u])) return 0;
    return exact_turn(p, q, x, u, v);
}
template <int D>
int turn(const Vec<double, D>& p, const Vec<double, D>& q, const Vec<double, D>& x, int u, int v) {
    return turn(p, q, q - p, x, u, v);
}

/// 1 if x is on the side of the plane of a, b, c to which (b − a) × (c − a) points, −1 if it is behind, 0 if
/// it is on the plane or the three have none. The determinant errs by at most (7 + 56ε)ε of the sum of its
/// products' magnitudes (Shewchuk 1997, section 4.3); the filter takes 8ε.
inline int side(const Vec3d& a, const Vec3d& b, const Vec3d& c, const Vec3d& x) {
    const Vec3d e = b - a, f = c - a, g = x - a;
    double sum = 0, magnitude = 0, reach = 0;
    for (int i = 0; i < 3; ++i) {
        const int j = (i + 1) % 3, k = (i + 2) % 3;
        const double left = product(e[j], f[k]), right = product(e[k], f[j]);
        sum += product(left - right, g[i]);
        magnitude += product(std::abs(left) + std::abs(right), std::abs(g[i]));
        reach += std::abs(g[i]);
    }
    const double error =
        product(8 * unit_roundoff<double>, magnitude) + product(detail::underflow, reach) + detail::underflow;
    if (std::abs(sum) > error) [[likely]]
        return sum > 0 ? 1 : -1;
    return exact_side(a, b, c, x);
}

}  // namespace hedgerow
