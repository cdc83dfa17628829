/// Sums of singular harmonics over a lattice, split into two sums that converge fast (Ewald 1921; for
/// harmonics: Challacombe, White and Head-Gordon, Periodic boundary conditions and the fast multipole method,
/// 1997).
#include "lattice_sums.h"

#include <array>
#include <cmath>
#include <numbers>

#include <hedgerow/nbody/harmonics.h>

namespace hedgerow::detail {
namespace {

constexpr int order = 2 * most_far_order + 1;
using All = Harmonics<double, order>;
using Shares = std::array<double, order + 1>;  // by degree

/// 1/|v|²ⁿ⁺¹ is an integral over widths of Gaussians, 1/Γ(n + 1/2)·∫ tⁿ⁻½·exp(−t·|v|²) dt; above t = π it is
/// summed over the lattice. What is summed of S(n, m)(v), as a share of it, is Γ(n + 1/2, x)/Γ(n + 1/2) with
/// x = π·|v|². Near images are left out: what stays of them is minus the rest.
Shares above(double v2, bool near) {
    const double x = std::numbers::pi * v2;
    Shares shares;
    // By Γ(a + 1, x) = a·Γ(a, x) + xᵃ·exp(−x), or for what is left of it by its series.
    double upper = std::erfc(std::sqrt(x)), step = std::sqrt(x / std::numbers::pi) * 2 * std::exp(-x);
    for (int n = 0; n <= order; ++n) {
        const double next_step = step * x / (n + 1.5);
        double rest = 0;
        if (near)
            for (double term = step, a = n + 0.5; term > 1e-20 * rest; term *= x / ++a) rest += term;
        shares[std::size_t(n)] = near ? -rest : upper;
        upper += step, step = next_step;
    }
    return shares;
}
/// Below t = π it is summed over the reciprocal lattice, where the harmonic of a Gaussian is one again (Hecke
/// and Bochner): iⁿ·πⁿ⁻½/Γ(n + 1/2)·|k|²ⁿ⁻¹·exp(−π·k²), times S(n, m)(k). For even n.
Shares below(double k2) {
    Shares shares;
    double size = std::exp(-std::numbers::pi * k2) / (std::numbers::pi * std::sqrt(k2));
    for (int n = 0; n <= order; ++n) {
        shares[std::size_t(n)] = n % 4 == 0 ? size : -size;
        size *= std::numbers::pi * k2 / (n + 0.5);
    }
    return shares;
}

std::array<double, All::count> compute() {
    std::array<double, All::count> sums{};
    constexpr int most = 9;  // beyond it all terms are below roundings
    for (int x = 0; x <= most; ++x)
        for (int y = 0; y <= most; ++y)
            for (int z = 0; z <= most; ++z) {
                if (x + y + z == 0) continue;
                const Vec3d v(x, y, z);
                const Shares direct = above(length2(v), std::max({x, y, z}) <= near_images),
                             reciprocal = below(length2(v));
                const All s = singular_harmonics<order>(v);
                // The same for all signs of the coordinates.
                const double images = (x > 0 ? 2 : 1) * (y > 0 ? 2 : 1) * (z > 0 ? 2 : 1);
                for (int n = 0; n <= order; n += 2)
                    for (int m = 0; m <= n; m += 4)
                        sums[All::at(n, m)] += images * s.re[All::at(n, m)] *
                                               (direct[std::size_t(n)] + reciprocal[std::size_t(n)]);
            }
    // The mean of the Gaussians, and what they are in their own middle.
    sums[0] -= 1 + 2;
    // No harmonic of degree 2 has the cube's symmetry.
    for (int m = 0; m <= 2; ++m) sums[All::at(2, m)] = 0;
    return sums;
}

}  // namespace

std::span<const double> far_lattice_sums() {
    static const std::array<double, All::count> sums = compute();
    return sums;
}

}  // namespace hedgerow::detail
