/// The expansion of the winding number of a cluster, and the bound of its error.
#pragma once

#include <numbers>

#include <hedgerow/queries/winding_moments.h>

namespace hedgerow {

/// The share of a winding number that a cluster has, and a bound of its error.
struct WindingTerm {
    double value, error;
};

/// The numbers that an expansion reads of a cluster, which lie in rows: number k of child i of a node is at
/// k·width + i. Kernels compute with a row of children at once.
///
/// With x at the distance r from the center, s = radius/r < 1 and u = 1/r, the value is the sum over degrees
/// 1 to 5 of the singular harmonics times the moments. The term of a degree n above that is at most
/// norm(n)·u²·sⁿ⁻¹, and those from degree 9 on together at most ∫(|y|/radius)⁸·u²·s⁸·(9 − 8s)/(1 − s)², since
/// |∇(ρⁿ Pₙ)| <= n·ρⁿ⁻¹. Roundings of moments and terms are taken to be below 2⁻³⁸ of area·u²/(1 − s)², the
/// bound of all terms. That is not derived step by step; `expansion_test` finds coefficients to err by 2⁻⁵¹
/// of the area after 64 levels of shifts.
struct WindingRow {
    static constexpr int summed = 5, bounded = WindingMoments::degrees;
    enum : int {
        center = 0,
        radius = 3,
        coefficients = 4,
        norms = coefficients + summed * (summed + 2),
        tail = norms + bounded - summed,
        roundings,
        count
    };
    /// No point nearer to the center than this many radii takes a cluster by its expansion.
    static constexpr double nearest = 0.99;

    /// Monic derivatives of Legendre polynomials p(n) of order m follow from those before by
    /// p(n + 1) = z·p(n) − step(n, m)·p(n − 1).
    static constexpr double step(int n, int m) { return double(n * n - m * m) / double(4 * n * n - 1); }

    /// Writes the numbers of a cluster. `eighth` is at least ∫(|y|/radius)⁸.
    static void write(double* row, int width, const Vec3d& middle, double reach, double area, double eighth,
                      const WindingMoments& moments) {
        const auto put = [&](int k, double x) { row[k * width] = x; };
        constexpr double per_turn = 1 / (4 * std::numbers::pi), up = 1 + 0x1p-40;
        for (int k = 0; k < 3; ++k) put(center + k, middle[k]);
        put(radius, reach);
        // A cluster without an extent has no area.
        const double of_term = reach > 0 ? per_turn / reach : 0;
        int at = coefficients;
        for (int m = 0; m <= summed; ++m)
            for (int n = m > 0 ? m : 1; n <= summed; ++n) {
                const auto [cosine, sine] = moments.coefficients(n, m);
                put(at++, product(cosine, of_term));
                if (m > 0) put(at++, product(sine, of_term));
            }
        for (int n = summed + 1; n <= bounded; ++n)
            put(norms + n - summed - 1, moments.norm(n) * per_turn * up);
        put(tail, eighth * per_turn * up);
        put(roundings, area * per_turn * 0x1p-38);
    }

    /// The term of a cluster. An infinite error where x is too near. The kernels (src/engine/winding-inl.h)
    /// do the same operations in the same order.
    static WindingTerm expanded(const double* row, int width, const Vec3d& x) {
        const auto get = [&](int k) { return row[k * width]; };
        const Vec3d d = x - Vec3d(get(0), get(1), get(2));
        const double u = 1 / std::sqrt(length2(d)), s = product(get(radius), u);
        const Vec3d e = d * product(s, u);  // a direction, s long
        const double s2 = product(s, s), s4 = product(s2, s2), value = summed_up(row, width, e, s2);
        const double near =
            product(product(s4, s), get(norms) + product(s, get(norms + 1) + product(s, get(norms + 2))));
        const double rest = product(product(get(tail), product(s4, s4)), 9 - product(8.0, s)), left = 1 - s;
        const double far = (rest + get(roundings)) / product(left, left);
        const double error = product(product(u, u), near + far);
        return {product(value, u), s < nearest ? error : std::numeric_limits<double>::infinity()};
    }

private:
    /// The sum of the harmonics times their coefficients, order by order.
    static double summed_up(const double* row, int width, const Vec3d& e, double s2) {
        double sum = 0, cosine = 1, sine = 0;
        const double* next = row + coefficients * width;
        const auto read = [&] {
            const double x = *next;
            next += width;
            return x;
        };
        for (int m = 0; m <= summed; ++m) {
            double before = 0, p = 1, of_cosine = 0, of_sine = 0;
            for (int n = m; n <= summed; ++n) {
                if (n > 0) of_cosine += product(read(), p);
                if (m > 0) of_sine += product(read(), p);
                const double up = product(e[2], p);
                const double after = n > m ? up - product(product(step(n, m), s2), before) : up;
                before = p, p = after;
            }
            sum += m == 0 ? of_cosine : product(cosine, of_cosine) + product(sine, of_sine);
            const double turned = product(e[0], cosine) - product(e[1], sine);
            sine = product(e[0], sine) + product(e[1], cosine);
            cosine = turned;
        }
        return sum;
    }
};
static_assert(WindingRow::bounded - WindingRow::summed == 3);

}  // namespace hedgerow
