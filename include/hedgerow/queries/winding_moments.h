/// The moments of clusters of triangles or dipoles, of which winding numbers are expanded: solid harmonics.
#pragma once

#include <array>
#include <cstddef>
#include <utility>

#include <hedgerow/geometry/vec.h>

namespace hedgerow {

/// Moments M = ∫ n·∇R dA of regular solid harmonics R of the degrees 1 to 8 over triangles, or Σ n·∇R over
/// dipoles n. An expansion sums the first degrees; the norms of the others bound what it leaves out.
///
/// R = rⁿ·P(cos θ)·e^(imφ)/(n + m)!, for which ∂R/∂z and ∂R/∂x ± i∂R/∂y are harmonics of the degree below,
/// and R(a + b) is a sum of products (Epton and Dembart 1995). Positions are offsets from the cluster's
/// center, in units of its radius; normals have the area as their length, in units of the caller.
class WindingMoments {
public:
    static constexpr int degrees = 8;

    /// Adds a triangle, by a rule of 16 points that is exact for its degree of 8 (Dunavant 1985).
    void add_triangle(const std::array<Vec3d, 3>& corners, const Vec3d& normal);
    void add_dipole(const Vec3d& position, const Vec3d& normal);
    /// Adds the moments of a part of the cluster. `shift` is the offset of the part's center; `ratio` its
    /// radius over that of the cluster.
    void add_part(const WindingMoments& part, const Vec3d& shift, double ratio);

    /// The mean of |y|⁸ over a triangle, by the same rule.
    static double mean_of_eighth_power(const std::array<Vec3d, 3>& corners);

    /// The greatest magnitude that the term of a degree has in any direction, at the distance of one radius.
    double norm(int degree) const;
    /// What an expansion multiplies with cos and sin of m times the azimuth, of a degree n.
    std::pair<double, double> coefficients(int n, int m) const;

private:
    static constexpr std::size_t count = (degrees + 1) * (degrees + 1);
    /// A harmonic of degree n and order m, −n <= m <= n.
    static constexpr std::size_t at(int n, int m) {
        const int place = n * n + n + m;
        return static_cast<std::size_t>(place);
    }
    struct Harmonics {
        double re[count] = {}, im[count] = {};
    };
    void add_gradient(const Harmonics& sum, const Vec3d& normal);

    Harmonics moments_;
};

}  // namespace hedgerow
