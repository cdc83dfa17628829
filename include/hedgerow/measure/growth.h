/// Growth of the costs of structures with the size of the scene.
#pragma once

#include <span>
#include <string>
#include <vector>

#include <hedgerow/measure/costs.h>
#include <hedgerow/measure/fit.h>

namespace hedgerow::measure {

/// One figure of one structure, over scenes of several sizes.
struct Growth {
    std::string structure;
    std::string_view figure;  ///< one of `growth_figures`
    std::vector<double> sizes, values;
    std::vector<Fit> fits;  ///< the best law first
};
inline constexpr std::string_view growth_figures[] = {"build seconds", "seconds a query", "nodes a query",
                                                      "primitives a query"};

/// Fits the figures of each structure that was measured on at least three of the scenes. Figures of queries
/// are those of the kind `ask`, as the mean over its sets of rays. A figure that is 0 on some scene is left
/// out, since no law fits.
std::vector<Growth> growth_of(std::span<const Comparison> by_size, Ask ask);

}  // namespace hedgerow::measure
