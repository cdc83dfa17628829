#include <hedgerow/measure/growth.h>

#include <algorithm>

namespace hedgerow::measure {
namespace {

double figure_of(const StructureCost& s, std::size_t figure, Ask ask) {
    switch (figure) {
        case 0:
            return s.build_seconds;
        case 1:
            return query_mean(s, ask, &QueryCost::seconds);
        case 2:
            return query_mean(s, ask, &QueryCost::nodes);
        default:
            return query_mean(s, ask, &QueryCost::primitives);
    }
}

}  // namespace

std::vector<Growth> growth_of(std::span<const Comparison> by_size, Ask ask) {
    // Collect all structures, in the order in which they appear.
    std::vector<std::string> structures;
    for (const Comparison& c : by_size)
        for (const StructureCost& s : c.structures)
            if (std::find(structures.begin(), structures.end(), s.structure) == structures.end())
                structures.push_back(s.structure);
    // Collect each figure of each structure over the sizes, and fit the laws.
    std::vector<Growth> all;
    for (const std::string& structure : structures)
        for (std::size_t figure = 0; figure < std::size(growth_figures); ++figure) {
            Growth g{structure, growth_figures[figure], {}, {}, {}};
            for (const Comparison& c : by_size)
                for (const StructureCost& s : c.structures)
                    if (s.structure == structure) {
                        g.sizes.push_back(static_cast<double>(c.size));
                        g.values.push_back(figure_of(s, figure, ask));
                    }
            const bool positive =
                std::all_of(g.values.begin(), g.values.end(), [](double v) { return v > 0; });
            if (g.sizes.size() < 3 || !positive) continue;
            g.fits = fits(g.sizes, g.values, by_size.front().dimension);
            all.push_back(std::move(g));
        }
    return all;
}

}  // namespace hedgerow::measure
