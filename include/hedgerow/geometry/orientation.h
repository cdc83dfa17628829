/// Exact signs of orientations: the side of a line in the plane of two axes, and of a plane in space. A
/// filter in double decides unless the sign is in doubt (Shewchuk 1997); ExactSum decides then. Right for all
/// finite coordinates, whatever overflows.
#pragma once

#include <hedgerow/geometry/exact_sum.h>
#include <hedgerow/geometry/lanes.h>

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

/// The plane of three points, prepared for the sides of many others.
class PlaneOfPoints {
public:
    PlaneOfPoints(const Vec3d& a, const Vec3d& b, const Vec3d& c) : a_(a), b_(b), c_(c) {
        const Vec3d e = b - a, f = c - a;
        for (int i = 0; i < 3; ++i) {
            const int j = (i + 1) % 3, k = (i + 2) % 3;
            const double left = product(e[j], f[k]), right = product(e[k], f[j]);
            normal_[i] = left - right;
            tolerance_[i] =
                product(8 * unit_roundoff<double>, std::abs(left) + std::abs(right)) + detail::underflow;
        }
    }
    /// 1 if x is on the side of the plane to which (b − a) × (c − a) points, −1 if it is behind, 0 if it is
    /// on the plane or the three points have none. The determinant errs by at most (7 + 56ε)ε of the sum of
    /// its products' magnitudes (Shewchuk 1997, section 4.3); the filter takes 8ε, in sums that err by less
    /// than the difference.
    int side(const Vec3d& x) const {
        const Vec3d g = x - a_;
        double sum = 0, error = detail::underflow;
        for (int i = 0; i < 3; ++i) {
            sum += product(normal_[i], g[i]);
            error += product(tolerance_[i], std::abs(g[i]));
        }
        if (std::abs(sum) > error) [[likely]]
            return sum > 0 ? 1 : -1;
        if (x == a_ || x == b_ || x == c_ || in_plane_across_axis(x)) return 0;
        return exact_side(a_, b_, c_, x);
    }

private:
    /// Walls and floors across an axis are common.
    bool in_plane_across_axis(const Vec3d& x) const {
        for (int i = 0; i < 3; ++i)
            if (a_[i] == b_[i] && a_[i] == c_[i] && a_[i] == x[i]) return true;
        return false;
    }

    Vec3d a_, b_, c_;
    Vec3d normal_;     // (b − a) × (c − a)
    Vec3d tolerance_;  // what the error of a determinant is per unit of x − a
};
inline int side(const Vec3d& a, const Vec3d& b, const Vec3d& c, const Vec3d& x) {
    return PlaneOfPoints(a, b, c).side(x);
}

/// The filter of `side` alone, in the scalar of a set, for the three corners of a triangle at once.
template <std::floating_point T>
class SideFilter {
public:
    using L = Lanes<T>;

    SideFilter(const Vec<T, 3>& a, const Vec<T, 3>& b, const Vec<T, 3>& c) : a_(a) {
        const Vec<T, 3> e = b - a, f = c - a;
        for (int i = 0; i < 3; ++i) {
            const int j = (i + 1) % 3, k = (i + 2) % 3;
            const T left = product(e[j], f[k]), right = product(e[k], f[j]);
            const T size = std::abs(left) + std::abs(right);
            normal_[i] = left - right;
            // Where a determinant may overflow, nothing is sure.
            tolerance_[i] = size < most ? product(8 * unit_roundoff<T>, size) + underflow
                                        : std::numeric_limits<T>::infinity();
        }
    }
    /// Bit i of `in_front` or `behind` is set if corner i is surely on that side of the plane. The corners'
    /// coordinates are given by axis.
    void sure_sides(const T (&corners)[3][4], unsigned& in_front, unsigned& behind) const {
        L sum = L::all(0), error = L::all(underflow);
        for (int i = 0; i < 3; ++i) {
            const L g = L::load(corners[i]) - L::all(a_[i]);
            sum = sum + L::all(normal_[i]) * g;
            error = error + L::all(tolerance_[i]) * abs(g);
        }
        in_front = (sum - error).positive() & 7u;
        behind = (sum + error).negative() & 7u;
    }

private:
    static constexpr bool single = std::is_same_v<T, float>;
    static constexpr T underflow = single ? T(0x1p-120) : T(0x1p-1000L);
    static constexpr T most = single ? T(0x1p60) : T(0x1p500L);

    Vec<T, 3> a_, normal_, tolerance_;
};

}  // namespace hedgerow
