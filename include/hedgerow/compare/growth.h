/// How what structures cost grows with the scene.
#pragma once

#include <span>
#include <string>
#include <vector>

#include <hedgerow/compare/costs.h>
#include <hedgerow/compare/fit.h>

namespace hedgerow::compare {

/// One figure of one structure over scenes of several sizes.
struct Growth {
    std::string structure;
    std::string_view figure;  ///< one of `growth_figures`
    std::vector<double> sizes, values;
    std::vector<Fit> fits;  ///< the best law first
};
inline constexpr std::string_view growth_figures[] = {"build seconds", "seconds a query", "nodes a query",
                                                      "primitives a query"};

/// For each structure that was measured on at least three of the scenes, its figures of queries of one kind
/// (the mean over sets of rays). A figure that is 0 somewhere has no law, and is left out.
std::vector<Growth> growth_of(std::span<const Comparison> by_size, Ask ask);

}  // namespace hedgerow::compare
