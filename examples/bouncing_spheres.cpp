/// Hard spheres in a box: they fly, bounce off the walls and off each other, and keep their energy.
#include <cmath>
#include <cstdio>
#include <vector>

#include <hedgerow/nbody/contacts.h>
#include <hedgerow/scenes/random.h>

using namespace hedgerow;

namespace {

constexpr double radius = 0.02;

double kinetic_energy(const Particles& all) {
    double sum = 0;
    for (std::size_t i = 0; i < all.size(); ++i) sum += all.masses[i] * length2(all.velocities[i]) / 2;
    return sum;
}
/// A sphere that has gone into a wall of the unit cube and still moves outward turns back.
void bounce_off_walls(Particles& all) {
    for (std::size_t i = 0; i < all.size(); ++i)
        for (int k = 0; k < 3; ++k) {
            double& v = all.velocities[i][k];
            const double x = all.places[i][k];
            if ((x < radius && v < 0) || (x > 1 - radius && v > 0)) v = -v;
        }
}

}  // namespace

int main() {
    // A lattice of a thousand spheres, the left half of them fast.
    Particles all;
    all.resize(1000);
    for (std::uint64_t i = 0; i < all.size(); ++i) {
        const std::uint64_t x = i % 10, y = i / 10 % 10, z = i / 100;
        const Vec3d cell{double(x), double(y), double(z)};
        all.places[i] = cell * 0.1 + Vec3d::all(0.05);
        all.velocities[i] = Random(1, i).direction<3>() * (all.places[i][0] < 0.5 ? 1.0 : 0.1);
        all.masses[i] = 1 + double(i % 3);
    }
    const std::vector<double> radii(all.size(), radius);
    const double before = kinetic_energy(all);
    std::size_t contacts = 0;
    constexpr double dt = 0.001;
    for (int step = 0; step < 2000; ++step) {
        for (std::size_t i = 0; i < all.size(); ++i) all.places[i] += all.velocities[i] * dt;
        bounce_off_walls(all);
        contacts += bounce(all, radii);
    }
    // Both halves have come to share their energy, of which nothing is lost.
    double left = 0, right = 0;
    for (std::size_t i = 0; i < all.size(); ++i)
        (all.places[i][0] < 0.5 ? left : right) += all.masses[i] * length2(all.velocities[i]) / 2;
    const double change = kinetic_energy(all) / before - 1;
    std::printf("%zu contacts; energy changed by %.1e of itself; %.0f%% of it is on the left\n", contacts,
                change, 100 * left / (left + right));
    return std::abs(change) < 1e-11 && contacts > 1000 && left < 0.75 * (left + right) ? 0 : 1;
}
