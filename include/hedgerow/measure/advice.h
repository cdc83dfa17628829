/// Recommends a structure for each need, with the figures behind the advice.
#pragma once

#include <hedgerow/measure/costs.h>

namespace hedgerow::measure {

struct AdviceOptions {
    /// Number of queries in the need "a few queries".
    double few = 1000;
    /// For the need "little memory": the most that a query may take in each set of rays, as a multiple of the
    /// fastest structure's time. Slower structures are absurdly slow, and are left out. If every structure is
    /// slow for some set, the least slow ones stay in. The engine's kernels alone are several times as fast
    /// as any other structure.
    double slack = 10;
};

struct Ranked {
    std::string structure;
    double figure;      ///< the figure to rank by, in Recommendation::unit
    std::string terms;  ///< parts of the figure: "12.1 ms to build + 1,000 x 812 ns"
};
struct Recommendation {
    std::string need;    ///< "many queries"
    std::string rule;    ///< the definition of the figure, and which structures are left out
    std::string unit;    ///< unit of the figure: "s" or "bytes"
    std::string reason;  ///< why the first is the best, by its counts and the others' figures
    /// The structures, best first. Never empty.
    std::vector<Ranked> ranking;
};

/// Recommends structures for a few queries, many queries, moving primitives and little memory. Queries are
/// those of the kind `ask`, as the mean over its sets of rays. Returns nothing for a comparison without
/// structures.
std::vector<Recommendation> advise(const Comparison& comparison, Ask ask, const AdviceOptions& options = {});

}  // namespace hedgerow::measure
