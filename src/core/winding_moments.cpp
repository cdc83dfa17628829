/// Moments of clusters, from which winding numbers are expanded.
#include <hedgerow/queries/winding_moments.h>

#include <algorithm>
#include <cmath>

namespace hedgerow {
namespace {

constexpr int top = WindingMoments::degrees;

constexpr auto factorials = [] {
    std::array<double, 2 * top + 1> f{1};
    for (std::size_t i = 1; i < f.size(); ++i) f[i] = f[i - 1] * static_cast<double>(i);
    return f;
}();
double factorial(int n) {
    return factorials[static_cast<std::size_t>(n)];
}

constexpr int rule_size = 16;
struct Rule {
    double weight[rule_size], corner[3][rule_size];  // barycentric coordinates
};
/// Dunavant's rule of degree 8: the centroid, three orbits of 3 points and one of 6.
constexpr Rule rule_of_degree_8() {
    Rule rule{};
    int n = 0;
    const auto add = [&](double weight, double a, double b, double c) {
        rule.weight[n] = weight;
        rule.corner[0][n] = a, rule.corner[1][n] = b, rule.corner[2][n] = c;
        ++n;
    };
    const auto add_turned = [&](double weight, double a, double b, double c) {
        add(weight, a, b, c), add(weight, b, c, a), add(weight, c, a, b);
    };
    add(0.144315607677787, 1.0 / 3, 1.0 / 3, 1.0 / 3);
    add_turned(0.095091634267285, 0.081414823414554, 0.459292588292723, 0.459292588292723);
    add_turned(0.103217370534718, 0.658861384496480, 0.170569307751760, 0.170569307751760);
    add_turned(0.032458497623198, 0.898905543365938, 0.050547228317031, 0.050547228317031);
    add_turned(0.027230314174435, 0.008394777409958, 0.263112829634638, 0.728492392955404);
    add_turned(0.027230314174435, 0.008394777409958, 0.728492392955404, 0.263112829634638);
    return rule;
}
constexpr Rule rule = rule_of_degree_8();

struct Places {
    double x[rule_size], y[rule_size], z[rule_size];

    explicit Places(const std::array<Vec3d, 3>& t) {
        const auto fill = [&](double(&to)[rule_size], int k) {
            for (int i = 0; i < rule_size; ++i)
                to[i] =
                    t[0][k] * rule.corner[0][i] + t[1][k] * rule.corner[1][i] + t[2][k] * rule.corner[2][i];
        };
        fill(x, 0), fill(y, 1), fill(z, 2);
    }
};

/// Calls f(n, m, re, im) for the regular harmonics of N points, of degree n <= most and order 0 <= m <= n.
template <int N, class F>
void for_each_regular(int most, const double (&x)[N], const double (&y)[N], const double (&z)[N], F f) {
    double first_re[N], first_im[N], r2[N];  // of degree and order m
    for (int i = 0; i < N; ++i) {
        first_re[i] = 1, first_im[i] = 0;
        r2[i] = x[i] * x[i] + y[i] * y[i] + z[i] * z[i];
    }
    for (int m = 0; m <= most; ++m) {
        double re[N], im[N], before_re[N] = {}, before_im[N] = {};
        std::copy_n(first_re, N, re), std::copy_n(first_im, N, im);
        for (int n = m;; ++n) {
            f(n, m, re, im);
            if (n == most) break;
            const double a = 2 * n + 1, b = 1.0 / ((n + 1) * (n + 1) - m * m);
            for (int i = 0; i < N; ++i) {
                const double next_re = (a * z[i] * re[i] - r2[i] * before_re[i]) * b;
                const double next_im = (a * z[i] * im[i] - r2[i] * before_im[i]) * b;
                before_re[i] = re[i], before_im[i] = im[i];
                re[i] = next_re, im[i] = next_im;
            }
        }
        const double c = -1.0 / (2 * m + 2);
        for (int i = 0; i < N; ++i) {
            const double next_re = (x[i] * first_re[i] - y[i] * first_im[i]) * c;
            first_im[i] = (x[i] * first_im[i] + y[i] * first_re[i]) * c;
            first_re[i] = next_re;
        }
    }
}

}  // namespace

// Of two harmonics of orders m and −m, the second is (−1)^m times the conjugate of the first.
void WindingMoments::add_triangle(const std::array<Vec3d, 3>& corners, const Vec3d& normal) {
    const Places places(corners);
    Harmonics mean;
    for_each_regular(top - 1, places.x, places.y, places.z,
                     [&](int n, int m, const auto& re, const auto& im) {
                         double a = 0, b = 0;
                         for (int i = 0; i < rule_size; ++i)
                             a += rule.weight[i] * re[i], b += rule.weight[i] * im[i];
                         const double sign = m % 2 == 0 ? 1 : -1;
                         mean.re[at(n, -m)] = sign * a, mean.im[at(n, -m)] = -sign * b;
                         mean.re[at(n, m)] = a, mean.im[at(n, m)] = b;
                     });
    add_gradient(mean, normal);
}
void WindingMoments::add_dipole(const Vec3d& position, const Vec3d& normal) {
    const double x[] = {position[0]}, y[] = {position[1]}, z[] = {position[2]};
    Harmonics there;
    for_each_regular(top - 1, x, y, z, [&](int n, int m, const auto& re, const auto& im) {
        const double sign = m % 2 == 0 ? 1 : -1;
        there.re[at(n, -m)] = sign * re[0], there.im[at(n, -m)] = -sign * im[0];
        there.re[at(n, m)] = re[0], there.im[at(n, m)] = im[0];
    });
    add_gradient(there, normal);
}

// n·∇R is n_z·R' + ((n_x − i·n_y)·R'⁺ − (n_x + i·n_y)·R'⁻)/2, with R' of the degree below and of the same
// order, and R'⁺ and R'⁻ of the next order and the one before.
void WindingMoments::add_gradient(const Harmonics& sum, const Vec3d& normal) {
    for (int n = 1; n <= top; ++n)
        for (int m = -n; m <= n; ++m) {
            double re = 0, im = 0;
            if (std::abs(m) < n) {
                re += normal[2] * sum.re[at(n - 1, m)];
                im += normal[2] * sum.im[at(n - 1, m)];
            }
            if (m + 1 < n) {
                const double a = sum.re[at(n - 1, m + 1)] / 2, b = sum.im[at(n - 1, m + 1)] / 2;
                re += normal[0] * a + normal[1] * b, im += normal[0] * b - normal[1] * a;
            }
            if (m - 1 > -n) {
                const double a = sum.re[at(n - 1, m - 1)] / 2, b = sum.im[at(n - 1, m - 1)] / 2;
                re -= normal[0] * a - normal[1] * b, im -= normal[0] * b + normal[1] * a;
            }
            moments_.re[at(n, m)] += re, moments_.im[at(n, m)] += im;
        }
}

// M'(n, m) = Σ M(j, k)·R(n − j, m − k), with R of the shift. Moments of degree j of the part are in units of
// its radius to the power of j − 1.
void WindingMoments::add_part(const WindingMoments& part, const Vec3d& shift, double ratio) {
    const double x[] = {shift[0]}, y[] = {shift[1]}, z[] = {shift[2]};
    Harmonics moved;
    for_each_regular(top - 1, x, y, z, [&](int n, int m, const auto& re, const auto& im) {
        const double sign = m % 2 == 0 ? 1 : -1;
        moved.re[at(n, -m)] = sign * re[0], moved.im[at(n, -m)] = -sign * im[0];
        moved.re[at(n, m)] = re[0], moved.im[at(n, m)] = im[0];
    });
    Harmonics all = part.moments_;
    double power = 1;
    for (int j = 1; j <= top; ++j, power *= ratio)
        for (int k = -j; k <= j; ++k) all.re[at(j, k)] *= power, all.im[at(j, k)] *= power;
    for (int n = 1; n <= top; ++n)
        for (int m = 0; m <= n; ++m) {
            double re = 0, im = 0;
            for (int j = 1; j <= n; ++j) {
                const double *const a = &all.re[at(j, 0)], *const b = &all.im[at(j, 0)];
                const double *const c = &moved.re[at(n - j, m)], *const d = &moved.im[at(n - j, m)];
                for (int k = std::max(-j, m - n + j); k <= std::min(j, m + n - j); ++k) {
                    re += a[k] * c[-k] - b[k] * d[-k];
                    im += a[k] * d[-k] + b[k] * c[-k];
                }
            }
            const double sign = m % 2 == 0 ? 1 : -1;
            moments_.re[at(n, m)] += re, moments_.im[at(n, m)] += im;
            if (m > 0) moments_.re[at(n, -m)] += sign * re, moments_.im[at(n, -m)] -= sign * im;
        }
}

double WindingMoments::mean_of_eighth_power(const std::array<Vec3d, 3>& corners) {
    const Places p(corners);
    double terms[rule_size], sum = 0;
    for (int i = 0; i < rule_size; ++i) {
        const double r2 = p.x[i] * p.x[i] + p.y[i] * p.y[i] + p.z[i] * p.z[i], r4 = r2 * r2;
        terms[i] = rule.weight[i] * (r4 * r4);
    }
    for (const double term : terms) sum += term;
    return sum;
}

// By Cauchy and Schwarz, since Σ P²·(n − m)!/(n + m)! over all orders is 1 in every direction.
double WindingMoments::norm(int degree) const {
    double sum = 0;
    for (int m = -degree; m <= degree; ++m) {
        const double a = moments_.re[at(degree, m)], b = moments_.im[at(degree, m)];
        sum += factorial(degree - m) * factorial(degree + m) * (a * a + b * b);
    }
    return std::sqrt(sum);
}
// The singular harmonic of degree n is (−1)^m·(2n − 1)!!·p(z)·(x + iy)^m/r^(2n + 1) for unit directions, with
// p the derivative of a Legendre polynomial over its leading coefficient. The sign is that of a potential
// whose gradient is taken at the source.
std::pair<double, double> WindingMoments::coefficients(int n, int m) const {
    double factor = m == 0 ? -1 : m % 2 == 0 ? -2 : 2;
    for (int i = 1; i < n; ++i) factor *= 2 * i + 1;
    return {factor * moments_.re[at(n, m)], factor * moments_.im[at(n, m)]};
}

}  // namespace hedgerow
