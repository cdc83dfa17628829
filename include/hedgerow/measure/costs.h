/// The costs of structures on a scene: plain figures, as measured.
#pragma once

#include <cstddef>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace hedgerow::measure {

/// Thrown if two structures gave different answers, which is a fault of the library.
class Disagreement : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

/// The kind of a query: a name in the table of questions (questions.h), as "closest-hit".
using Ask = std::string_view;

/// The cost of one kind of query in one structure. Counts are means a query. They are the same on every
/// machine if all queries were measured; a slow structure may have measured a sample whose size depends on
/// the machine.
struct QueryCost {
    Ask ask;
    std::string kind;       ///< "closest hit, random rays"
    std::size_t asked = 0;  ///< number of queries that were measured
    double seconds = 0;     ///< seconds a query, the median of the rounds
    double spread = 0;      ///< slowest minus fastest round, as a share of the median
    double nodes = 0, leaves = 0, primitives = 0, skipped = 0;
};

/// The cost of updating a structure when primitives move.
struct UpdateCost {
    std::string_view how = "rebuild";  ///< update of all: "refit", "rebuild" or "one by one"
    double one = 0, all = 0;           ///< seconds to update one primitive, and all of them
    double insert = 0, erase = 0;      ///< seconds a primitive; 0 if single ones cannot change
    /// After a refit: the SAH cost as a multiple of the cost before, and the time a query as a multiple of
    /// the time in a structure that is rebuilt over the moved primitives.
    double drift = 1, slowdown = 1;
};

struct StructureCost {
    std::string structure;
    double build_seconds = 0;  ///< the median of the builds
    int builds = 0;
    std::size_t bytes = 0;  ///< without the primitives themselves
    std::size_t nodes = 0, leaves = 0, items = 0;
    int depth = 0;
    std::vector<QueryCost> queries;
    UpdateCost update;
};

/// The number of rays in a set, and how many of them hit nothing.
struct RaySetSize {
    std::string_view kind;  ///< "coherent", "incoherent" or "random"
    std::size_t rays = 0, missed = 0;
};

/// The costs of structures over one scene, all measured with the same queries.
struct Comparison {
    std::string scene, primitive;  ///< the scene's name, and the kind of its primitives: "triangles"
    std::size_t size = 0;          ///< primitives
    int dimension = 3;
    std::vector<StructureCost> structures;
    std::vector<RaySetSize> rays = {};  ///< empty for points
    /// The share of the primitives that are visible from the eye of the coherent rays, if that is outside the
    /// scene's box; 1 if it is inside, for points and in the plane. Nearly 0 means that an outer shell hides
    /// the rest.
    double seen_from_outside = 1;
    bool finished = true;  ///< false: the measurement was stopped, and some structures are missing
};

/// The mean of a figure over the sets of rays of a kind of query; 0 if the kind was not measured.
double query_mean(const StructureCost& structure, Ask ask, double QueryCost::*figure = &QueryCost::seconds);
/// The usual kind of query for the scene: closest hits if they were measured, else the nearest points.
Ask usual_ask(const Comparison& comparison);

}  // namespace hedgerow::measure
