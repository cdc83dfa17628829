/// Builds structures over one scene, and measures the same queries on all of them.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>

#include <hedgerow/measure/costs.h>
#include <hedgerow/parallel/by.h>
#include <hedgerow/parallel/progress.h>
#include <hedgerow/primitives/concepts.h>
#include <hedgerow/render/camera/camera.h>

namespace hedgerow::measure {

struct MeasureOptions {
    /// Queries of each kind. A structure that is too slow for `seconds` gets only every second, third, ... of
    /// them.
    std::size_t queries = 10'000;
    /// Seconds for each structure and kind of query, over all rounds. Each round makes at least one query.
    double seconds = 0.1;
    /// Timed rounds. With 0 only counts are measured: everything is built once, each query is made once, and
    /// seconds are 0.
    int rounds = 5;
    /// Seconds for builds: a structure is built `rounds` times, or as often as builds begin within this time.
    double build_seconds = 1;
    /// The kinds of query to measure; empty: all.
    std::vector<Ask> asks;
    /// Whether to measure updates too. For structures that can be refitted this takes two more builds.
    bool updates = true;
    std::uint64_t seed = 0;
    /// Camera of the coherent rays; without one they come from an automatic camera outside the scene.
    std::optional<Camera> camera;
    /// By which threads structures are built. Queries are asked on one.
    Threads threads = serial_executor();
};

/// Builds structures, given by names and options, and measures builds, queries and updates. Each round runs
/// all structures in turn, so that other load on the machine affects them alike; all structures are in memory
/// at once. Answers are compared with those of the default
/// structure.
///
/// Throws Disagreement, which names structure and query, where an answer differs. Throws InputError for
/// unknown names and options, and for a set without primitives. If the progress is cancelled, returns the
/// structures that were timed in at least one round (with `rounds` 0: that were counted), perhaps without
/// updates; throws Cancelled if that happens before the first structure is begun.
///
/// Times are processor time of the thread, where the system has such a clock: other load does not count. Only
/// builds on several threads are measured on the wall clock.
///
/// Coherent rays are those of a picture. Incoherent rays start at random places on all surfaces, spread
/// evenly by area, and leave the front of triangles, cosine-distributed about the normal. Random rays go from
/// one random point of the scene's box through another. Points are random in that box. Boxes and
/// balls are centred at random primitives and 1/100 of its diagonal wide. Moving primitives are bent by up to
/// a tenth of the scene.
///
/// Defined for TriangleMesh<T>, SphereSet<T, 3>, PointCloud<T, 2 or 3> and SegmentSet<T>, T float or double.
template <class P>
Comparison compare(const P& primitives, std::span<const std::string> structures,
                   const MeasureOptions& options = {}, const Progress& progress = {});

}  // namespace hedgerow::measure
