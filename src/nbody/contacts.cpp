/// Hard spheres that bounce.
#include <hedgerow/nbody/contacts.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <hedgerow/ask/neighbours.h>
#include <hedgerow/base/error.h>

namespace hedgerow {
namespace {

void expect_sound(const Particles& spheres, std::span<const double> radii) {
    const std::size_t n = spheres.size();
    if (radii.size() != n || spheres.velocities.size() != n || spheres.masses.size() != n)
        throw InputError(std::to_string(n) + " places, " + std::to_string(spheres.velocities.size()) +
                         " velocities, " + std::to_string(spheres.masses.size()) + " masses and " +
                         std::to_string(radii.size()) + " radii: give one of each a sphere");
    for (std::size_t i = 0; i < n; ++i) {
        if (!(radii[i] >= 0 && radii[i] <= 0x1p480))
            throw InputError("the radius of sphere " + std::to_string(i) + " is " + std::to_string(radii[i]));
        if (!(spheres.masses[i] > 0 && spheres.masses[i] <= 0x1p480))
            throw InputError("the mass of sphere " + std::to_string(i) + " is " +
                             std::to_string(spheres.masses[i]) + ": give one above 0");
    }
}

}  // namespace

std::size_t bounce(Particles& spheres, std::span<const double> radii, double restitution, Threads threads) {
    if (!(restitution >= 0 && restitution <= 1))
        throw UsageError("a restitution of " + std::to_string(restitution) + " is not from 0 to 1");
    expect_sound(spheres, radii);
    if (spheres.size() < 2) return 0;
    NearLists<double> near;
    neighbours_within(spheres.places, 2 * *std::max_element(radii.begin(), radii.end()), near,
                      {.once = true, .distances = true, .threads = threads});
    std::size_t contacts = 0;
    const auto meet = [&](std::size_t a, std::size_t b, double distance2) {
        const double reach = radii[a] + radii[b];
        if (!(distance2 <= reach * reach && distance2 > 0)) return;
        const Vec3d along = (spheres.places[b] - spheres.places[a]) / std::sqrt(distance2);
        const double approach = dot(spheres.velocities[a] - spheres.velocities[b], along);
        if (!(approach > 0)) return;
        const double impulse = (1 + restitution) * approach / (1 / spheres.masses[a] + 1 / spheres.masses[b]);
        spheres.velocities[a] -= along * (impulse / spheres.masses[a]);
        spheres.velocities[b] += along * (impulse / spheres.masses[b]);
        ++contacts;
    };
    for (std::size_t a = 0; a < spheres.size(); ++a)
        for (std::size_t k = near.offsets[a]; k < near.offsets[a + 1]; ++k)
            meet(a, near.ids[k], near.distances2[k]);
    return contacts;
}

}  // namespace hedgerow
