/// A dam breaks: a column of water falls and runs along the floor, by smoothed particle hydrodynamics.
///
/// Each particle is a bit of water. Its density is a sum over its neighbours, its pressure grows with the
/// density, and neighbours push each other apart by their pressures (Müller, Charypar and Gross,
/// Particle-based fluid simulation for interactive applications, 2003). All pairs of neighbours come from one
/// query, each once.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <vector>

#include <hedgerow/ask/pairs.h>
#include <hedgerow/index.h>
#include <hedgerow/primitives/point_cloud.h>
#include <hedgerow/structures/kdtree/point_kdtree.h>

using namespace hedgerow;

namespace {

constexpr double spacing = 0.02, reach = 2 * spacing;  // of particles, and of their influence
constexpr double column = 0.5, tank = 2, rest_density = 1000, gravity = 9.81;
constexpr double stiffness = 50, viscosity = 2, dt = 0.0004;
constexpr double mass = rest_density * spacing * spacing;  // per unit of depth

/// The kernels of Müller et al. in the plane: of densities, and the slopes for pressure and viscosity.
double density_share(double r2) {
    const double rest = reach * reach - r2;
    return 4 / (std::numbers::pi * std::pow(reach, 8)) * rest * rest * rest;
}
double pressure_slope(double r) {
    return 30 / (std::numbers::pi * std::pow(reach, 5)) * (reach - r) * (reach - r);
}
double viscosity_slope(double r) {
    return 20 / (3 * std::numbers::pi * std::pow(reach, 5)) * (reach - r);
}

struct Water {
    std::vector<Vec2d> places, velocities;

    double front() const {
        double most = 0;
        for (const Vec2d& p : places) most = std::max(most, p[0]);
        return most;
    }
    double mean_height() const {
        double sum = 0;
        for (const Vec2d& p : places) sum += p[1];
        return sum / double(places.size());
    }
    void step() {
        const std::size_t n = places.size();
        const auto index = build<PointKdTree>(PointCloudView<double, 2>(places));
        std::vector<PairWithin<double>> pairs;
        pairs_within(index, {.radius = reach}, pairs);
        // Densities, then pressures, then forces.
        std::vector<double> density(n, mass * density_share(0)), pressure(n);
        for (const auto& [a, b, r2] : pairs) {
            const double share = mass * density_share(r2);
            density[a] += share, density[b] += share;
        }
        for (std::size_t i = 0; i < n; ++i)
            pressure[i] = std::max(0.0, stiffness * (density[i] - rest_density));
        std::vector<Vec2d> force(n);
        for (const auto& [a, b, r2] : pairs) {
            const double r = std::sqrt(r2);
            if (r == 0) continue;
            const Vec2d along = (places[b] - places[a]) / r;
            const double push = mass * mass * (pressure[a] + pressure[b]) / (2 * density[a] * density[b]) *
                                pressure_slope(r),
                         drag = viscosity * mass * mass / (density[a] * density[b]) * viscosity_slope(r);
            const Vec2d pull = (velocities[b] - velocities[a]) * drag - along * push;
            force[a] += pull, force[b] -= pull;
        }
        // Move, and keep the water in the tank.
        for (std::size_t i = 0; i < n; ++i) {
            velocities[i] += (force[i] / mass - Vec2d(0, gravity)) * dt;
            places[i] += velocities[i] * dt;
            for (int k = 0; k < 2; ++k) {
                const double most = k == 0 ? tank : 4;
                if (places[i][k] < 0 || places[i][k] > most) {
                    places[i][k] = std::clamp(places[i][k], 0.0, most);
                    velocities[i][k] *= -0.3;
                }
            }
        }
    }
};

}  // namespace

int main() {
    Water water;
    const int side = static_cast<int>(column / spacing);
    for (int y = 0; y < 2 * side; ++y)
        for (int x = 0; x < side; ++x) water.places.emplace_back((x + 0.5) * spacing, (y + 0.5) * spacing);
    water.velocities.resize(water.places.size());
    const double height = water.mean_height();
    double arrived = 0;
    for (int step = 1; step <= 2000; ++step) {
        water.step();
        const double time = step * dt;
        if (arrived == 0 && water.front() > 0.98 * tank) arrived = time;
        if (step % 250 == 0)
            std::printf("t = %.1f s: the front is at %.2f m, the water's middle at %.2f m\n", time,
                        water.front(), water.mean_height());
    }
    // The front runs at up to twice the speed of a shallow wave, √(g·height) (Ritter 1892).
    std::printf("the front reached the wall, %.1f m away, after %.2f s\n", tank - column, arrived);
    const bool sound = water.mean_height() < 0.6 * height &&
                       arrived > (tank - column) / 2 / std::sqrt(gravity * 1.0) && arrived < 0.8;
    return sound ? 0 : 1;
}
