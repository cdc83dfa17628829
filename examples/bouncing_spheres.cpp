/// Hard spheres in a box: they fly, bounce off the walls and off each other, and keep their energy.
///
///   bouncing_spheres [FILE]     a .png of the box at the beginning, after half a unit of time and at the end
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numeric>
#include <vector>

#include <hedgerow/io/image.h>
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

constexpr int panel = 240, gap = 6;  // in pixels

/// Draws the box from the front, with `left` as its first column. Fast spheres are red, slow ones blue.
void draw(const Particles& all, Image& image, int left) {
    std::vector<std::size_t> order(all.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::sort(order.begin(), order.end(),
              [&](auto i, auto k) { return all.places[i][1] > all.places[k][1]; });  // the farthest first
    for (const std::size_t i : order) {
        const Vec3d& place = all.places[i];
        const double fast = std::min(1.0, length(all.velocities[i])), near = 1 - 0.6 * place[1];
        const double size = radius * panel, x = place[0] * panel, y = (1 - place[2]) * panel;
        for (int row = std::max(0, int(y - size)); row <= std::min(panel - 1, int(y + size)); ++row)
            for (int column = std::max(0, int(x - size)); column <= std::min(panel - 1, int(x + size));
                 ++column) {
                const double across = (column + 0.5 - x) / size, down = (row + 0.5 - y) / size;
                const double height2 = 1 - across * across - down * down;
                if (height2 < 0) continue;
                const double light = near * (0.45 + 0.55 * std::sqrt(height2));
                const auto shade = [&](double c) { return static_cast<std::uint8_t>(255 * light * c); };
                image.at(left + column, row) = {shade(0.2 + 0.8 * fast), shade(0.3), shade(1 - 0.8 * fast)};
            }
    }
}

}  // namespace

int main(int count, char** arguments) {
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
    Image image(3 * panel + 2 * gap, panel, {255, 255, 255});
    for (int part = 0; part < 3; ++part)
        paste(Image(panel, panel, {20, 22, 30}), image, part * (panel + gap), 0);
    draw(all, image, 0);
    for (int step = 0; step < 2000; ++step) {
        if (step == 500) draw(all, image, panel + gap);
        for (std::size_t i = 0; i < all.size(); ++i) all.places[i] += all.velocities[i] * dt;
        bounce_off_walls(all);
        contacts += bounce(all, radii);
    }
    draw(all, image, 2 * (panel + gap));
    if (count > 1) save_png(arguments[1], image);
    // Both halves have come to share their energy, of which nothing is lost.
    double left = 0, right = 0;
    for (std::size_t i = 0; i < all.size(); ++i)
        (all.places[i][0] < 0.5 ? left : right) += all.masses[i] * length2(all.velocities[i]) / 2;
    const double change = kinetic_energy(all) / before - 1;
    std::printf("%zu contacts; energy changed by %.1e of itself; %.0f%% of it is on the left\n", contacts,
                change, 100 * left / (left + right));
    return std::abs(change) < 1e-11 && contacts > 1000 && left < 0.75 * (left + right) ? 0 : 1;
}
