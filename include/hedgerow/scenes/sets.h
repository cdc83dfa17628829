/// Generated sets of spheres, points and segments.
///
/// A set has exactly `size` elements and the same bits on every machine; the float set is the double set
/// rounded. Element i depends only on (size, seed, i). Each generator takes O(size) time and memory, and
/// throws Cancelled if `progress` is cancelled. T is float or double.
#pragma once

#include <cstdint>

#include <hedgerow/parallel/progress.h>
#include <hedgerow/primitives/point_cloud.h>
#include <hedgerow/primitives/segment_set.h>
#include <hedgerow/primitives/sphere_set.h>

namespace hedgerow {

/// Spheres inside the unit cube, with radii uniform in [1/8, 1/2]·size^(-1/3). Some overlap.
template <class T>
SphereSet<T, 3> spheres(std::uint64_t size, std::uint64_t seed = 0, const Progress& progress = {});

/// Points uniform in the unit cube.
template <class T>
PointCloud<T, 3> points(std::uint64_t size, std::uint64_t seed = 0, const Progress& progress = {});

/// Points uniform in the unit square.
template <class T>
PointCloud<T, 2> points2d(std::uint64_t size, std::uint64_t seed = 0, const Progress& progress = {});

/// Points of the unit square in 16 clusters, all equally likely. Their standard deviations are between 0.006
/// and 0.035. Coordinates are sums of four uniform numbers, so clusters are bounded.
template <class T>
PointCloud<T, 2> clusters2d(std::uint64_t size, std::uint64_t seed = 0, const Progress& progress = {});

/// Short segments in the unit square, with uniform places and directions. Lengths are uniform in [1/4,
/// 1]·size^(-1/2).
template <class T>
SegmentSet<T> segments2d(std::uint64_t size, std::uint64_t seed = 0, const Progress& progress = {});

}  // namespace hedgerow
