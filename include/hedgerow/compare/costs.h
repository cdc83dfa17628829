/// What structures cost on a scene: plain figures, as they were measured.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace hedgerow::compare {

/// What an index can be asked.
enum class Ask { closest_hit, any_hit, all_hits, closest_point, nearest, overlap };
inline constexpr std::string_view ask_names[] = {"closest-hit",   "any-hit", "all-hits",
                                                 "closest-point", "nearest", "overlap"};
constexpr std::string_view name_of(Ask ask) {
    return ask_names[static_cast<std::size_t>(ask)];
}

/// One kind of query of one structure. Counts are means a query, and the same on every machine.
struct QueryCost {
    Ask ask = Ask::closest_hit;
    std::string kind;       ///< "closest hit, random rays"
    std::size_t asked = 0;  ///< how many queries the figures are from
    double seconds = 0;     ///< a query: the median of the rounds
    double spread = 0;      ///< between the slowest and the fastest round, as a share of the median
    double nodes = 0, leaves = 0, primitives = 0, skipped = 0;
};

/// How a structure follows primitives that move.
struct UpdateCost {
    std::string_view how = "rebuild";  ///< all are followed: by a "refit", a "rebuild" or "one by one"
    double one = 0, all = 0;           ///< seconds to follow one primitive, and all of them
    double insert = 0, erase = 0;      ///< seconds a primitive, where single ones can change; else 0
    /// After a refit: its SAH cost as a multiple of what it was, and its time a query as a multiple of what
    /// one takes that is built anew over the moved primitives.
    double drift = 1, slowdown = 1;
};

struct StructureCost {
    std::string structure;
    double build_seconds = 0;  ///< the median of the builds
    int builds = 0;
    std::size_t bytes = 0;  ///< beyond the primitives themselves
    std::size_t nodes = 0, leaves = 0, items = 0;
    int depth = 0;
    std::vector<QueryCost> queries;
    UpdateCost update;
};

/// How many rays of a set meet nothing.
struct RaySet {
    std::string_view kind;  ///< "coherent", "incoherent" or "random"
    std::size_t rays = 0, missed = 0;
};

/// Structures over one scene, all asked the same.
struct Comparison {
    std::string scene, primitive;  ///< what, and of what: "triangles"
    std::size_t size = 0;          ///< primitives
    int dimension = 3;
    std::vector<StructureCost> structures;
    std::vector<RaySet> rays = {};  ///< none for points
    /// The share of the primitives that the eye of the coherent rays sees from outside of the scene's box; 1
    /// for an eye in the box. Nearly 0: an outer shell hides the rest.
    double seen_from_outside = 1;
    bool finished = true;  ///< false: it was stopped, and holds the structures that were done
};

/// A figure of a kind of query, the mean over its sets of rays; 0 where it was not asked.
double query_mean(const StructureCost& structure, Ask ask, double QueryCost::*figure = &QueryCost::seconds);
/// What is asked of most scenes of a kind: the closest hit, or the nearest points where rays meet nothing.
Ask usual_ask(const Comparison& comparison);

}  // namespace hedgerow::compare
