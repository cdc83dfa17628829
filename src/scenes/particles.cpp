/// Spheres, discs and galaxies of stars.
#include <hedgerow/scenes/particles.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include <hedgerow/scenes/random.h>

#include "sizing.h"
#include "steps.h"

namespace hedgerow {
namespace {

struct Star {
    Vec3d place, velocity;
};

double cube_root_below_1(double x) {
    return x > 0 ? 1 / detail::cube_root(1 / x) : 0;
}
/// A point of a ball, all equally likely.
Vec3d in_ball(Random& random, double radius) {
    const double distance = cube_root_below_1(random.uniform()) * radius;
    return random.direction<3>() * distance;
}

/// A speed of the density x²·f(x) on [0, most], by rejection below `bound` (von Neumann 1951).
template <class F>
double speed_below(Random& random, double most, double bound, F density) {
    for (;;) {
        const double speed = random.uniform() * most;
        if (random.uniform() * bound < density(speed)) return speed;
    }
}

Star of_plummer(Random& random) {
    constexpr double radius = 3 * std::numbers::pi / 16;
    // In units of the radius and the mass, M(r) = (1 + r⁻²)^(−3/2), and the speed of escape is √2·(1 +
    // r²)^(−1/4).
    const double c = cube_root_below_1(random.uniform() * 0.999), r = c / std::sqrt(1 - c * c);
    const double escape = std::sqrt(2 / std::sqrt(1 + r * r));
    const double part = speed_below(random, 1, 0.1, [](double x) {
        const double rest = 1 - x * x;
        return x * x * rest * rest * rest * std::sqrt(rest);
    });
    return {random.direction<3>() * (r * radius),
            random.direction<3>() * (part * escape / std::sqrt(radius))};
}

/// The arc whose sine is 0 <= x <= 1: thrice halved, then by its series.
double arc_of_sine(double x) {
    double tangent = x / (1 + std::sqrt(std::max(0.0, 1 - x * x)));  // of half the arc
    for (int i = 0; i < 2; ++i) tangent = tangent / (1 + std::sqrt(1 + tangent * tangent));
    double sum = 0, power = tangent;
    for (int n = 1; n < 40; n += 4) {
        sum += power / n;
        power *= tangent * tangent;
        sum -= power / (n + 2);
        power *= tangent * tangent;
    }
    return 8 * sum;
}
/// Hernquist's density of phase space at the energy −q², without the factor (1 − q²)^(−5/2). It grows with q.
double hernquist_phase_density(double q) {
    const double q2 = q * q;
    return 3 * arc_of_sine(q) +
           q * std::sqrt(std::max(0.0, 1 - q2)) * (1 - 2 * q2) * (8 * q2 * q2 - 8 * q2 - 3);
}
Star of_hernquist(Random& random) {
    constexpr double radius = 1.0 / 3, most = 300.0 / 301;
    // In units of the radius and the mass, M(r) = (r/(1 + r))², and the potential is −1/(1 + r).
    const double c = std::sqrt(random.uniform()) * most, r = c / (1 - c);
    const double depth = 1 / (1 + r), rest = r / (1 + r);  // depth + rest = 1
    const double escape2 = 2 * depth, peak2 = std::min(rest * 4 / 3, escape2);
    const auto inverse = [](double x) { return 1 / (x * x * std::sqrt(x)); };
    const double bound = hernquist_phase_density(std::sqrt(depth)) * peak2 * inverse(rest + peak2 / 2);
    const double speed = speed_below(random, std::sqrt(escape2), bound, [&](double v) {
        const double energy = std::max(0.0, depth - v * v / 2);
        return v * v * inverse(rest + v * v / 2) * hernquist_phase_density(std::sqrt(energy));
    });
    return {random.direction<3>() * (r * radius), random.direction<3>() * (speed / std::sqrt(radius))};
}

Star of_uniform_sphere(Random& random) {
    const Vec3d place = in_ball(random, 1.2);
    return {place, in_ball(random, std::sqrt(5.0 / 6))};
}
Star of_cold_collapse(Random& random) {
    return {in_ball(random, 1), Vec3d()};
}
Star of_cold_cube(Random& random) {
    return {random.in_cube<3>(), Vec3d()};
}
Star of_disc(Random& random) {
    // Kuzmin's disc is M(r) = 1 − 1/√(1 + r²), and v² = r²·(1 + r²)^(−3/2).
    const double most = 1 - 1 / std::sqrt(101.0), left = 1 - random.uniform() * most;
    const double r = std::sqrt(std::max(0.0, 1 / (left * left) - 1)), s = std::sqrt(1 + r * r);
    const Vec2d along = random.direction<2>();
    const double speed = r / (s * std::sqrt(s));
    double height = -2;
    for (int i = 0; i < 4; ++i) height += random.uniform();
    return {{along[0] * r, along[1] * r, height * 0.02}, {-along[1] * speed, along[0] * speed, 0}};
}
Star of_two_clusters(Random& random) {
    const double side = random.bits() % 2 == 0 ? 1 : -1;
    const Star star = of_plummer(random);
    return {star.place * 0.5 + Vec3d(2, 0.5, 0) * side, star.velocity - Vec3d(0.35, 0, 0) * side};
}

/// Stars of equal mass, each from the random numbers of its own.
Particles stars(Star star(Random&), std::uint64_t size, std::uint64_t seed, const Progress& progress) {
    return in_ieee_mode([&] {
        Particles all;
        all.resize(size);
        std::fill(all.masses.begin(), all.masses.end(), 1 / static_cast<double>(size));
        for (std::uint64_t i = 0; i < size; ++i) {
            detail::step(progress, i, size);
            Random random(seed, i);
            const Star made = star(random);
            all.places[i] = made.place, all.velocities[i] = made.velocity;
        }
        return all;
    });
}

}  // namespace

Particles plummer(std::uint64_t size, std::uint64_t seed, const Progress& progress) {
    return stars(of_plummer, size, seed, progress);
}
Particles hernquist(std::uint64_t size, std::uint64_t seed, const Progress& progress) {
    return stars(of_hernquist, size, seed, progress);
}
Particles uniform_sphere(std::uint64_t size, std::uint64_t seed, const Progress& progress) {
    return stars(of_uniform_sphere, size, seed, progress);
}
Particles cold_collapse(std::uint64_t size, std::uint64_t seed, const Progress& progress) {
    return stars(of_cold_collapse, size, seed, progress);
}
Particles cold_cube(std::uint64_t size, std::uint64_t seed, const Progress& progress) {
    return stars(of_cold_cube, size, seed, progress);
}
Particles disc(std::uint64_t size, std::uint64_t seed, const Progress& progress) {
    return stars(of_disc, size, seed, progress);
}
Particles two_clusters(std::uint64_t size, std::uint64_t seed, const Progress& progress) {
    return stars(of_two_clusters, size, seed, progress);
}

}  // namespace hedgerow
