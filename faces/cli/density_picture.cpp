#include "density_picture.h"

#include <algorithm>
#include <cmath>

#include <hedgerow/geometry/elementary.h>
#include <hedgerow/render/film/colour.h>
#include <hedgerow/render/lettering.h>

namespace hedgerow::cli {

namespace {

/// The mass in each pixel.
std::vector<double> projected(const Particles& all, const DensityFrame& frame, int width, int height) {
    std::vector<double> mass(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
    const double pixels = height / (2 * frame.half_height);
    // Spots reach to about the next particle, and at most four pixels.
    const double spacing = std::sqrt(static_cast<double>(mass.size()) /
                                     static_cast<double>(std::max<std::size_t>(1, all.size())));
    const int reach = static_cast<int>(std::clamp(spacing / 3, 0.0, 4.0));
    const auto weight = [reach](int dx, int dy) {
        return std::max(0.0, 1 - std::sqrt(static_cast<double>(dx * dx + dy * dy)) / (reach + 1));
    };
    double whole = 0, heaviest = 0;
    for (int dy = -reach; dy <= reach; ++dy)
        for (int dx = -reach; dx <= reach; ++dx) whole += weight(dx, dy);
    // In fixed point, so that the order of the particles does not change a bit.
    for (const double one : all.masses) heaviest = FixedPoint::larger(heaviest, one);
    const FixedPoint point(heaviest);
    std::vector<FixedPoint::Sum> sums(mass.size());
    for (std::size_t i = 0; i < all.size(); ++i) {
        const double x = width / 2.0 + (all.places[i][0] - frame.middle[0]) * pixels,
                     y = height / 2.0 - (all.places[i][1] - frame.middle[1]) * pixels;
        if (!(x > -8 && x < width + 8 && y > -8 && y < height + 8)) continue;
        const int px = static_cast<int>(std::floor(x)), py = static_cast<int>(std::floor(y));
        for (int dy = std::max(-reach, -py); dy <= std::min(reach, height - 1 - py); ++dy)
            for (int dx = std::max(-reach, -px); dx <= std::min(reach, width - 1 - px); ++dx)
                sums[static_cast<std::size_t>(py + dy) * static_cast<std::size_t>(width) +
                     static_cast<std::size_t>(px + dx)] +=
                    point.integer(all.masses[i] * weight(dx, dy) / whole);
    }
    for (std::size_t i = 0; i < mass.size(); ++i) mass[i] = point.value(sums[i]);
    return mass;
}
double median(std::vector<double> all, double share) {
    if (all.empty()) return 0;
    const auto at = all.begin() + static_cast<std::ptrdiff_t>(static_cast<double>(all.size() - 1) * share);
    std::nth_element(all.begin(), at, all.end());
    return *at;
}

}  // namespace

DensityFrame DensityFrame::around(const Particles& all, int width, int height, double period) {
    DensityFrame frame;
    std::vector<double> across[2], distances;
    for (const Vec3d& p : all.places)
        for (int k = 0; k < 2; ++k) across[k].push_back(p[k]);
    frame.middle = {median(across[0], 0.5), median(across[1], 0.5)};
    // The wider side of the picture shows as much more.
    const double wide = std::max(1.0, static_cast<double>(width) / height);
    for (const Vec3d& p : all.places)
        distances.push_back(
            std::max(std::abs(p[0] - frame.middle[0]) / wide, std::abs(p[1] - frame.middle[1])));
    frame.half_height = 1.4 * median(distances, 0.9);
    if (!(frame.half_height > 0)) frame.half_height = 1;
    if (period > 0) {
        frame.middle = {period / 2, period / 2};
        frame.half_height = period / 2 * std::max(1.0, static_cast<double>(height) / width);
    }
    const auto mass = projected(all, frame, width, height);
    frame.most = mass.empty() ? 0 : 4 * *std::max_element(mass.begin(), mass.end());
    if (!(frame.most > 0)) frame.most = 1;
    return frame;
}

Image density_picture(const Particles& all, const DensityFrame& frame, int width, int height,
                      const std::vector<std::string>& note) {
    Image image(width, height, {0, 0, 0});
    const auto mass = projected(all, frame, width, height);
    constexpr double range = 2000;  // from the last colour to the first
    for (std::size_t i = 0; i < mass.size(); ++i) {
        if (!(mass[i] > 0)) continue;
        const double x = logarithm(1 + product(mass[i] / frame.most, range)) / logarithm(1 + range);
        const Image::Pixel colour = heat(static_cast<float>(x));
        // Fades into the dark where there is next to nothing.
        for (std::size_t k = 0; k < 3; ++k)
            image.pixels[i][k] = static_cast<std::uint8_t>(colour[k] * std::min(1.0, 0.3 + 3 * x));
    }
    draw_note(image, 0, 0, note, width >= 1000 ? 2 : 1);
    return image;
}

}  // namespace hedgerow::cli
