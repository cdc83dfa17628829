/// Which structure is right for what, with the figures that say so.
#pragma once

#include <hedgerow/compare/costs.h>

namespace hedgerow::compare {

struct AdviceOptions {
    double few = 1000;
    /// How many times the fastest's time a query may take where memory counts, for each set of rays: beyond
    /// that a structure is absurdly slow. Where every structure is, for one set or another, the least slow
    /// ones count. The engine's kernels alone are several times as fast as any other structure.
    double slack = 10;
};

struct Ranked {
    std::string structure;
    double figure;      ///< what it is ranked by
    std::string terms;  ///< what that is made of: "12.1 ms build + 1000 x 0.8 us"
};
struct Recommendation {
    std::string need;    ///< "many queries"
    std::string rule;    ///< what the figure is, and what was left out
    std::string unit;    ///< of the figure: "s" or "bytes"
    std::string reason;  ///< a sentence: why the first is the first, by its counts and the figures of others
    /// Best first, never empty.
    std::vector<Ranked> ranking;
};

/// For a few queries, many queries, moving primitives and little memory. Queries are those of one kind, the
/// mean over its sets of rays. Empty for no structures.
std::vector<Recommendation> advise(const Comparison& comparison, Ask ask, const AdviceOptions& options = {});

}  // namespace hedgerow::compare
