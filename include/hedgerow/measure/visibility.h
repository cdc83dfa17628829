/// What it costs to find what is visible in a picture: for each triangle its samples, or for each sample its
/// triangles.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <hedgerow/parallel/progress.h>
#include <hedgerow/primitives/triangle_mesh.h>
#include <hedgerow/render/camera/camera.h>

namespace hedgerow::measure {

/// The cost of one picture by one way, on one thread.
struct VisibilityCost {
    /// "raster:all", "raster:box", "raster:tiles", "cast:" and a structure, or "beams:wide"
    /// (float alone).
    std::string way;
    double build_seconds = 0;  ///< of the index; 0 for rasterising
    double seconds = 0;        ///< for the closest hit of every sample
    double spread = 0;         ///< slowest minus fastest round, as a share of the median
    double tests = 0;          ///< of a triangle at a sample, a sample; 0 for beams, which do not count them
    double nodes = 0;          ///< nodes and leaves visited by rays, beams and packets, a sample
    std::size_t bytes = 0;     ///< of memory, beside the triangles and the hits
};
/// The costs of one picture by all ways.
struct VisibilityCase {
    std::size_t triangles = 0;
    int width = 0, height = 0;
    double hit = 0;  ///< share of the samples that hit something
    std::vector<VisibilityCost> ways;
    std::vector<std::string> left_out;  ///< ways that would take too long
};

struct VisibilityOptions {
    Camera camera;
    int width = 1024, height = 1024;
    /// Timed rounds. Each runs all ways in turn.
    int rounds = 5;
    /// The structures that rays are cast at.
    std::vector<std::string> structures = {"wide", "bvh"};
    /// Ways that test every triangle at every sample are left out beyond so many tests.
    std::uint64_t most_tests = 100'000'000;
};

/// Finds the closest hit of every sample by every way, and measures time (processor time of the thread),
/// tests and memory. Throws Disagreement where two ways differ in a bit; InputError for a camera that cannot
/// be rasterised and for structures that there are not; Cancelled if the progress is cancelled. T is float or
/// double.
template <class T>
VisibilityCase compare_visibility(const TriangleMesh<T>& mesh, const VisibilityOptions& options,
                                  const Progress& progress = {});

}  // namespace hedgerow::measure
