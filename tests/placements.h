/// Transforms of every kind, for two-level scenes.
#pragma once

#include <cmath>
#include <vector>

#include <hedgerow/geometry/transform.h>
#include <hedgerow/scenes/random.h>

namespace hedgerow {

inline constexpr double pi = 3.14159265358979323846;

template <int D>
Transform<D> turned(Random& random) {
    const double angle = random.uniform(-pi, pi);
    if constexpr (D == 2)
        return Transform<2>::rotation(angle);
    else
        return Transform<3>::rotation(random.direction<3>(), angle);
}

/// Transform i of a scene: a rotation and a translation; with Scales::even also an even scale, with
/// Scales::any an uneven scale that may mirror. Every fifth is only a translation. Every seventh draws the
/// numbers of the one before, and so mostly repeats it.
enum class Scales { none, even, any };
template <int D>
Transform<D> transform_of(std::uint64_t i, Scales scales, double far) {
    Random random(5, i % 7 == 6 ? i - 1 : i);
    Vec<double, D> factors = Vec<double, D>::all(1);
    if (scales == Scales::even) factors = factors * std::exp2(random.uniform(-3, 3));
    if (scales == Scales::any)
        for (int k = 0; k < D; ++k)
            factors[k] = std::exp2(random.uniform(-3, 3)) * (random.uniform() < 0.3 ? -1 : 1);
    const auto moved = Transform<D>::translation((random.in_cube<D>() - Vec<double, D>::all(0.5)) * far);
    if (i % 5 == 4) return moved;
    const auto first = turned<D>(random), then = turned<D>(random);  // compilers order operands differently
    return moved * then * Transform<D>::scaling(factors) * first;
}

template <int D>
std::vector<Transform<D>> transforms(std::size_t n, Scales scales, double far) {
    std::vector<Transform<D>> all;
    for (std::size_t i = 0; i < n; ++i) all.push_back(transform_of<D>(i, scales, far));
    return all;
}

}  // namespace hedgerow
