#include <hedgerow/measure/advice.h>

#include <algorithm>
#include <limits>

#include <hedgerow/measure/break_even.h>
#include <hedgerow/measure/quantity.h>
#include <hedgerow/measure/reason.h>

namespace hedgerow::measure {

namespace {

/// Ranks the structures by the figure that `rank` returns, least first. Equal ones keep their order; those
/// with an infinite figure are left out.
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

const StructureCost& named(const Comparison& c, const std::string& structure) {
    return *std::find_if(c.structures.begin(), c.structures.end(),
                         [&](const StructureCost& s) { return s.structure == structure; });
}
/// The time of a query as a multiple of the fastest structure's, for the set of rays where that is greatest.
double slowness(const Comparison& c, const StructureCost& s, Ask ask) {
    double most = 0;
    for (std::size_t i = 0; i < s.queries.size(); ++i) {
        if (s.queries[i].ask != ask) continue;
        double least_seconds = s.queries[i].seconds;
        for (const StructureCost& o : c.structures)
            least_seconds = std::min(least_seconds, o.queries[i].seconds);
        if (least_seconds > 0) most = std::max(most, s.queries[i].seconds / least_seconds);
    }
    return most;
}
std::string ratio(double one, double other) {
    return other > 0 ? number_text(one / other) + " times" : "more than";
}

/// Writes the reasons: sentences that compare the best structure for a need with the one whose queries take
/// least.
class Reasons {
public:
    Reasons(const Comparison& c, Ask ask, double slack)
        : c_(c), ask_(ask), slack_(slack), fastest_(c.structures.front()) {
        for (const StructureCost& s : c.structures)
            if (query(s) < query(fastest())) fastest_ = s;
    }

    std::string few(const StructureCost& s) const {
        if (s.structure == fastest().structure)
            return "Its queries take least, and its build little: " + reason(s, c_, ask_);
        return "Its build takes " + ratio(s.build_seconds, fastest().build_seconds) + " that of " +
               fastest().structure + ", and a query " + ratio(query(s), query(fastest())) + " the least";
    }
    std::string many(const StructureCost& s) const {
        // Compare with the slowest structure other than brute force, which shows what the scene demands.
        const StructureCost* slowest = nullptr;
        for (const StructureCost& o : c_.structures)
            if (o.nodes > 0 && (!slowest || query(o) > query(*slowest))) slowest = &o;
        std::string text = reason(s, c_, ask_);
        if (slowest && slowest->structure != s.structure)
            text += "; " + slowest->structure + " takes " + ratio(query(*slowest), query(s)) +
                    " as long with " + reason(*slowest, c_, ask_);
        return text;
    }
    std::string moving(const StructureCost& s) const {
        if (s.update.how == "refit")
            return "Its boxes follow in " + ratio(s.update.all, s.build_seconds) +
                   " its build, and queries then take " + number_text(s.update.slowdown) + " times as long";
        if (s.update.how == "one by one") return "Each primitive is erased and inserted in less than a build";
        return "It is built anew in less time than others take to follow and to answer";
    }
    std::string memory(const StructureCost& s) const {
        std::string text = number_text(static_cast<double>(s.bytes) / static_cast<double>(c_.size)) +
                           " bytes a primitive, and a query takes " + ratio(query(s), query(fastest())) +
                           " the least";
        std::string slow;
        for (const StructureCost& o : c_.structures)
            if (const double times = slowness(c_, o, ask_); o.bytes < s.bytes && times > slack_)
                slow += (slow.empty() ? "" : ", ") + o.structure + " (" + number_text(times) + " times)";
        return slow.empty() ? text : text + "; smaller but absurdly slow: " + slow;
    }

private:
    double query(const StructureCost& s) const { return query_mean(s, ask_); }
    const StructureCost& fastest() const { return fastest_; }

    const Comparison& c_;
    Ask ask_;
    double slack_;
    StructureCost fastest_;
};

}  // namespace

std::vector<Recommendation> advise(const Comparison& c, Ask ask, const AdviceOptions& options) {
    if (c.structures.empty()) return {};
    const auto query = [&](const StructureCost& s) { return query_mean(s, ask); };
    const double frame = static_cast<double>(c.size);
    // Each structure may be slow for another set of rays. The least slow one always counts as quick.
    double slack = slowness(c, c.structures.front(), ask);
    for (const StructureCost& s : c.structures) slack = std::min(slack, slowness(c, s, ask));
    slack = std::max(slack, options.slack);
    const std::string few = number_text(options.few);
    // Rank the structures for each need.
    std::vector<Recommendation> all = {
        least(c, {"a few queries", "a build and " + few + " queries", "s", {}, {}},
              [&](const StructureCost& s) {
                  return Ranked{
                      s.structure, Cost{s.build_seconds, query(s)}.after(options.few),
                      seconds_text(s.build_seconds) + " to build + " + times(options.few, query(s))};
              }),
        least(c, {"many queries", "a query, once it is built", "s", {}, {}},
              [&](const StructureCost& s) {
                  return Ranked{s.structure, query(s),
                                seconds_text(query(s)) + " a query, after " + seconds_text(s.build_seconds) +
                                    " to build"};
              }),
        least(c,
              {"moving primitives",
               "a frame: all primitives move, then one query is asked for each of them",
               "s",
               {},
               {}},
              [&](const StructureCost& s) {
                  const double each = query(s) * s.update.slowdown;
                  return Ranked{s.structure, Cost{s.update.all, each}.after(frame),
                                seconds_text(s.update.all) + " to follow (" + std::string(s.update.how) +
                                    ") + " + times(frame, each)};
              }),
        least(c,
              {"little memory",
               "bytes, of those that take at most " + number_text(slack) +
                   " times the fastest's time for each set of rays",
               "bytes",
               {},
               {}},
              [&](const StructureCost& s) {
                  const bool quick = slowness(c, s, ask) <= slack;
                  return Ranked{
                      s.structure,
                      quick ? static_cast<double>(s.bytes) : std::numeric_limits<double>::infinity(),
                      bytes_text(static_cast<double>(s.bytes)) + ", " + seconds_text(query(s)) + " a query"};
              })};
    // Explain the best structure of each need.
    const Reasons reasons(c, ask, slack);
    const auto first = [&](std::size_t i) -> const StructureCost& {
        return named(c, all[i].ranking[0].structure);
    };
    all[0].reason = reasons.few(first(0)), all[1].reason = reasons.many(first(1));
    all[2].reason = reasons.moving(first(2)), all[3].reason = reasons.memory(first(3));
    return all;
}

}  // namespace hedgerow::measure
