/// Builds structures over one scene, asks all the same, and measures.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>

#include <hedgerow/compare/costs.h>
#include <hedgerow/parallel/executor.h>
#include <hedgerow/parallel/progress.h>
#include <hedgerow/primitives/concepts.h>
#include <hedgerow/render/camera.h>

namespace hedgerow::compare {

struct MeasureOptions {
    /// Of each kind; a structure that is too slow for its time is asked every second, third, ... of them.
    std::size_t queries = 10'000;
    /// Time for each structure and kind of query, over all rounds. At least one query is asked a round.
    double seconds = 0.1;
    /// 0: counts alone. Everything is built once, asked everything once, and not timed: seconds are 0.
    int rounds = 5;
    /// A structure is built `rounds` times, or as often as begins within this time.
    double build_seconds = 1;
    /// Only what is asked here; empty: all.
    std::vector<Ask> asks;
    /// Whether to change and move primitives too. Costs two builds more of what can be refitted.
    bool updates = true;
    std::uint64_t seed = 0;
    /// Where coherent rays come from; none: from outside, as a picture is taken of what nobody knows.
    std::optional<Camera> camera;
};

/// Whether primitives can be asked this: rays pass between points.
template <class P>
constexpr bool can_be_asked(Ask ask) {
    return ask >= Ask::closest_point || !PointSet<ViewOf<P>>;
}

/// Two structures answered differently, which none may: a fault of the library.
class Disagreement : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

/// Structures by their names and options. Rounds go through all structures in turn, so that whatever else
/// the machine does meets them alike; all are held at once. Every answer is compared with that of the
/// default structure: throws Disagreement where one differs, naming structure and query. Builds run on
/// `executor`, queries on one thread. When the progress is cancelled, those that were measured in full are
/// returned. Throws InputError for unknown names and options, and for a set without primitives.
///
/// Times are the thread's own, where the system tells it: what else runs does not count. Only builds on
/// several threads are measured by the clock on the wall.
///
/// Coherent rays are a picture's. Incoherent ones leave random places on all surfaces, spread evenly by area,
/// from the front of triangles and about the normal by the cosine. Random ones join two random points of the
/// scene's box. Points are random in that box; boxes, 1/100 of its
/// diagonal wide, stand around random primitives. What moves is bent by a tenth of the scene.
///
/// Defined for TriangleMesh<T>, SphereSet<T, 3>, PointCloud<T, 2 or 3> and SegmentSet<T>, T float or double.
template <class P>
Comparison measure(const P& primitives, std::span<const std::string> structures,
                   const MeasureOptions& options = {}, Executor& executor = serial_executor(),
                   const Progress& progress = {});

/// The middle one; of an even number, the mean of both. Not of none.
double median(std::vector<double> all);

}  // namespace hedgerow::compare
