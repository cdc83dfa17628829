/// Random spheres, points and segments.
#include <hedgerow/scenes/sets.h>

#include <utility>

#include <hedgerow/scenes/random.h>

#include "precision.h"
#include "sizing.h"
#include "steps.h"

namespace hedgerow {
namespace {

/// Calls element(random) once per element, each time with the random numbers of that element.
template <class F>
auto collected(std::uint64_t size, std::uint64_t seed, const Progress& progress, F element) {
    std::vector<decltype(element(std::declval<Random&>()))> all;
    all.reserve(size);
    for (std::uint64_t i = 0; i < size; ++i) {
        detail::step(progress, i, size);
        Random random(seed, i);
        all.push_back(element(random));
    }
    return all;
}

/// A point of the unit cube at least `margin` from its sides.
template <int D>
Vec<double, D> well_inside(Random& random, double margin) {
    return Vec<double, D>::all(margin) + random.in_cube<D>() * (1 - 2 * margin);
}

template <int D>
PointCloud<double, D> even_points(std::uint64_t size, std::uint64_t seed, const Progress& progress) {
    return {collected(size, seed, progress, [](Random& random) { return random.in_cube<D>(); })};
}

SphereSet<double, 3> build_spheres(std::uint64_t size, std::uint64_t seed, const Progress& progress) {
    const double spacing = 1 / detail::cube_root(static_cast<double>(size > 0 ? size : 1));
    return {collected(size, seed, progress, [&](Random& random) {
        const double radius = product(spacing, random.uniform(0.125, 0.5));
        return Sphere<double, 3>{well_inside<3>(random, radius), radius};
    })};
}

PointCloud<double, 2> build_clusters(std::uint64_t size, std::uint64_t seed, const Progress& progress) {
    struct Heap {
        Vec2d center;
        double spread;
    };
    std::array<Heap, 16> heaps;
    Random chosen(~seed);
    for (Heap& heap : heaps) {
        heap.center = well_inside<2>(chosen, 0.15);
        heap.spread = chosen.uniform(0.01, 0.06);
    }
    return {collected(size, seed, progress, [&](Random& random) {
        const Heap& heap = heaps[random.bits() % heaps.size()];
        Vec2d sum = Vec2d::all(-2);
        for (int i = 0; i < 4; ++i) sum = sum + random.in_cube<2>();
        return heap.center + sum * heap.spread;
    })};
}

SegmentSet<double> build_segments(std::uint64_t size, std::uint64_t seed, const Progress& progress) {
    const double spacing = 1 / std::sqrt(static_cast<double>(size > 0 ? size : 1));
    return {collected(size, seed, progress, [&](Random& random) {
        const double half = product(spacing, random.uniform(0.125, 0.5));
        const Vec2d middle = well_inside<2>(random, half), along = random.direction<2>() * half;
        return Segment<double, 2>{middle - along, middle + along};
    })};
}

}  // namespace

template <class T>
SphereSet<T, 3> spheres(std::uint64_t size, std::uint64_t seed, const Progress& progress) {
    return detail::in_precision<T>([&] { return build_spheres(size, seed, progress); });
}
template <class T>
PointCloud<T, 3> points(std::uint64_t size, std::uint64_t seed, const Progress& progress) {
    return detail::in_precision<T>([&] { return even_points<3>(size, seed, progress); });
}
template <class T>
PointCloud<T, 2> points2d(std::uint64_t size, std::uint64_t seed, const Progress& progress) {
    return detail::in_precision<T>([&] { return even_points<2>(size, seed, progress); });
}
template <class T>
PointCloud<T, 2> clusters2d(std::uint64_t size, std::uint64_t seed, const Progress& progress) {
    return detail::in_precision<T>([&] { return build_clusters(size, seed, progress); });
}
template <class T>
SegmentSet<T> segments2d(std::uint64_t size, std::uint64_t seed, const Progress& progress) {
    return detail::in_precision<T>([&] { return build_segments(size, seed, progress); });
}

template SphereSet<float, 3> spheres<float>(std::uint64_t, std::uint64_t, const Progress&);
template SphereSet<double, 3> spheres<double>(std::uint64_t, std::uint64_t, const Progress&);
template PointCloud<float, 3> points<float>(std::uint64_t, std::uint64_t, const Progress&);
template PointCloud<double, 3> points<double>(std::uint64_t, std::uint64_t, const Progress&);
template PointCloud<float, 2> points2d<float>(std::uint64_t, std::uint64_t, const Progress&);
template PointCloud<double, 2> points2d<double>(std::uint64_t, std::uint64_t, const Progress&);
template PointCloud<float, 2> clusters2d<float>(std::uint64_t, std::uint64_t, const Progress&);
template PointCloud<double, 2> clusters2d<double>(std::uint64_t, std::uint64_t, const Progress&);
template SegmentSet<float> segments2d<float>(std::uint64_t, std::uint64_t, const Progress&);
template SegmentSet<double> segments2d<double>(std::uint64_t, std::uint64_t, const Progress&);

}  // namespace hedgerow
