#include <hedgerow/measure/reason.h>

#include <hedgerow/measure/quantity.h>

namespace hedgerow::measure {

std::string reason(const StructureCost& s, const Comparison& c, Ask ask) {
    constexpr double crowded = 8, many_tests = 20, copied = 6;
    // Describe the tests of a query.
    const auto size = static_cast<double>(c.size);
    const double tests = query_mean(s, ask, &QueryCost::primitives);
    const double looked_into = query_mean(s, ask, &QueryCost::leaves);
    const std::string few = number_text(tests) + (tests == 1 ? " test" : " tests") + " a query";
    if (s.nodes == 0 && s.leaves <= 1) return few + " of all " + number_text(size) + " " + c.primitive;

    // Compare the leaves that queries visit with the mean leaf.
    const double filled = s.leaves > 0 ? static_cast<double>(s.items) / static_cast<double>(s.leaves) : 0;
    const double met = looked_into > 0 ? tests / looked_into : 0;
    if (tests > many_tests && met > crowded * filled)
        return few + ": a leaf that it looks into holds " + number_text(met) + " " + c.primitive +
               ", a leaf on the mean " + number_text(filled) + ", so the detail lies in few leaves";
    // Describe nodes and tests, and what makes them many or cheap.
    std::string steps = number_text(query_mean(s, ask, &QueryCost::nodes)) + " nodes and " + few;
    if (const double copies = static_cast<double>(s.items) / size; copies > copied)
        return steps + ": each of the " + c.primitive + " stands in " + number_text(copies) + " leaves";
    if (s.structure.starts_with("wide"))
        return steps + ", the boxes of a node and the " + c.primitive + " of a leaf by vector instructions";
    return steps;
}

}  // namespace hedgerow::measure
