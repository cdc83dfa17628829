#include <hedgerow/compare/advice.h>

#include <algorithm>
#include <limits>

#include <hedgerow/compare/break_even.h>
#include <hedgerow/compare/quantity.h>

namespace hedgerow::compare {

namespace {

/// The structures by what `rank` makes of them, least first; of equals the first. Infinity: not among them.
template <class F>
Recommendation least(const Comparison& comparison, Recommendation r, F rank) {
    for (const StructureCost& s : comparison.structures) {
        Ranked ranked = rank(s);
        if (ranked.figure < std::numeric_limits<double>::infinity()) r.ranking.push_back(std::move(ranked));
    }
    std::stable_sort(r.ranking.begin(), r.ranking.end(),
                     [](const Ranked& a, const Ranked& b) { return a.figure < b.figure; });
    return r;
}

std::string times(double count, double seconds) {
    return number_text(count) + " x " + seconds_text(seconds);
}

}  // namespace

std::vector<Recommendation> advise(const Comparison& c, Ask ask, const AdviceOptions& options) {
    if (c.structures.empty()) return {};
    const auto query = [&](const StructureCost& s) { return query_mean(s, ask); };
    double fastest = std::numeric_limits<double>::infinity();
    for (const StructureCost& s : c.structures) fastest = std::min(fastest, query(s));
    const double frame = static_cast<double>(c.size);
    const std::string few = number_text(options.few), slack = number_text(options.slack);
    return {
        least(c, {"a few queries", "a build and " + few + " queries", "s", {}},
              [&](const StructureCost& s) {
                  return Ranked{
                      s.structure, Cost{s.build_seconds, query(s)}.after(options.few),
                      seconds_text(s.build_seconds) + " to build + " + times(options.few, query(s))};
              }),
        least(c, {"many queries", "a query, once it is built", "s", {}},
              [&](const StructureCost& s) {
                  return Ranked{s.structure, query(s),
                                seconds_text(query(s)) + " a query, after " + seconds_text(s.build_seconds) +
                                    " to build"};
              }),
        least(c,
              {"moving primitives",
               "a frame: all primitives move, then one query is asked for each of them",
               "s",
               {}},
              [&](const StructureCost& s) {
                  const double each = query(s) * s.update.slowdown;
                  return Ranked{s.structure, Cost{s.update.all, each}.after(frame),
                                seconds_text(s.update.all) + " to follow (" + std::string(s.update.how) +
                                    ") + " + times(frame, each)};
              }),
        least(c,
              {"little memory",
               "bytes, of those that take at most " + slack + " times the fastest's time a query",
               "bytes",
               {}},
              [&](const StructureCost& s) {
                  const bool quick = query(s) <= options.slack * fastest;
                  return Ranked{
                      s.structure,
                      quick ? static_cast<double>(s.bytes) : std::numeric_limits<double>::infinity(),
                      bytes_text(static_cast<double>(s.bytes)) + ", " + seconds_text(query(s)) + " a query"};
              })};
}

}  // namespace hedgerow::compare
