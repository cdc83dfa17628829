#include <hedgerow/measure/costs.h>

namespace hedgerow::measure {

double query_mean(const StructureCost& structure, Ask ask, double QueryCost::*figure) {
    double sum = 0, kinds = 0;
    for (const QueryCost& q : structure.queries)
        if (q.ask == ask) sum += q.*figure, ++kinds;
    return kinds > 0 ? sum / kinds : 0;
}

Ask usual_ask(const Comparison& comparison) {
    for (const StructureCost& s : comparison.structures)
        for (const QueryCost& q : s.queries)
            if (q.ask == "closest-hit") return q.ask;
    return "nearest";
}

}  // namespace hedgerow::measure
