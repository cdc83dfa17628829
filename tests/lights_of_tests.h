/// What tests of lights share: random light sources, χ², and integrals over directions.
#pragma once

#include <cmath>
#include <cstddef>
#include <vector>

#include <hedgerow/render/lighting/emitters.h>
#include <hedgerow/scenes/random.h>

namespace hedgerow::test {

inline constexpr double pi = 3.14159265358979323846;

/// The direction of length 1 with this height and this angle around y.
inline Vec3f direction_at(double height, double angle) {
    const double radius = std::sqrt(std::max(0.0, 1 - height * height));
    return Vec3f(Vec3d(radius * std::cos(angle), height, radius * std::sin(angle)));
}

/// The cells of a grid over the sphere, of equal solid angle: rows by height, columns by angle around y.
struct SphereGrid {
    int columns, rows;

    std::size_t size() const { return static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows); }
    double solid_angle() const { return 4 * pi / static_cast<double>(size()); }
    std::size_t cell(const Vec3f& d) const {
        const double angle = std::atan2(double(d[2]), double(d[0])) / (2 * pi);
        const int column = std::min(columns - 1, int((angle < 0 ? angle + 1 : angle) * columns));
        const int row = std::min(rows - 1, int((double(d[1]) + 1) / 2 * rows));
        return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) +
               static_cast<std::size_t>(column);
    }
    /// The integral of f over each cell, by side² points.
    template <class F>
    std::vector<double> integrals(int side, const F& f) const {
        std::vector<double> sums;
        for (int row = 0; row < rows; ++row)
            for (int column = 0; column < columns; ++column) {
                double sum = 0;
                for (int j = 0; j < side; ++j)
                    for (int i = 0; i < side; ++i) {
                        const double height = 2 * (row + (j + 0.5) / side) / rows - 1;
                        const double angle = 2 * pi * (column + (i + 0.5) / side) / columns;
                        sum += f(direction_at(height, angle));
                    }
                sums.push_back(sum * solid_angle() / side / side);
            }
        return sums;
    }
};

/// How many standard deviations χ² of counts lies above its mean (Wilson & Hilferty 1931). Cells that expect
/// less than 5 count as one.
inline double chi_square_score(const std::vector<double>& counts, const std::vector<double>& probabilities,
                               double samples) {
    double sum = 0, few = 0, few_expected = 0;
    int cells = -1;
    const auto add = [&](double count, double expected) {
        sum += (count - expected) * (count - expected) / expected;
        ++cells;
    };
    for (std::size_t i = 0; i < counts.size(); ++i) {
        const double expected = probabilities[i] * samples;
        if (expected < 5)
            few += counts[i], few_expected += expected;
        else
            add(counts[i], expected);
    }
    if (few_expected > 1)
        add(few, few_expected);
    else if (few > 20)
        return 1e9;  // samples where there should be none
    if (cells < 1) return 0;
    const double spread = 2.0 / (9 * cells);
    return (std::cbrt(sum / cells) - (1 - spread)) / std::sqrt(spread);
}

/// A point of the unit square. The numbers are drawn in the same order by every compiler.
inline Vec2f in_square(Random& random) {
    return Vec2f(random.in_cube<2>());
}
inline Vec3f random_point(Random& random, double low, double high) {
    return Vec3f(random.in_cube<3>() * (high - low) + Vec3d::all(low));
}
/// A triangle in a cube from −1 to 1, of about this size.
inline EmissiveTriangle random_triangle(Random& random, double size) {
    const Vec3f a = random_point(random, -1, 1);
    const Vec3f b = a + random_point(random, -size, size), c = a + random_point(random, -size, size);
    return {a, b, c, random_point(random, 0.1, 3), random.uniform() < 0.5};
}

/// The irradiance by a triangle in its first colour, with side² samples at the middles of a grid.
inline double irradiance_by(const EmissiveTriangle& t, const Vec3f& point, const Vec3f& normal, int side) {
    double sum = 0;
    for (int j = 0; j < side; ++j)
        for (int i = 0; i < side; ++i) {
            const LightSample s =
                t.sample(point, (float(i) + 0.5f) / float(side), (float(j) + 0.5f) / float(side));
            if (s)
                sum += double(s.radiance[0]) * std::max(0.0, double(dot(normal, s.direction))) /
                       double(s.density);
        }
    return sum / side / side;
}

/// The irradiance by a polygon of radiance 1 wholly above the horizon (Lambert 1760).
inline double lambert(const std::vector<Vec3d>& corners, const Vec3d& point, const Vec3d& normal) {
    double sum = 0;
    for (std::size_t i = 0; i < corners.size(); ++i) {
        const Vec3d a = normalized(corners[i] - point),
                    b = normalized(corners[(i + 1) % corners.size()] - point);
        const Vec3d across = cross(a, b);
        sum += std::atan2(length(across), dot(a, b)) * dot(normalized(across), normal);
    }
    return std::abs(sum) / 2;
}

}  // namespace hedgerow::test
