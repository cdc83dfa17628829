/// Measures how good the advice of a comparison is. On each scene one sample of queries gives the advised
/// structure; then all structures are timed with other queries. Prints the advised structure's cost as a
/// multiple of the best one's, and how often the excess is at most a tenth.
///
///   advice_benchmark [SCENE ...]     default: scenes that nothing was tuned on
#include <algorithm>
#include <cstdio>

#include <hedgerow/ask.h>
#include <hedgerow/base/error.h>
#include <hedgerow/measure/advice.h>
#include <hedgerow/measure/compare.h>
#include <hedgerow/measure/lists.h>
#include <hedgerow/measure/machine.h>
#include <hedgerow/scenes/generate.h>

using namespace hedgerow;
using namespace hedgerow::measure;

namespace {

constexpr std::uint64_t first_seed = 101, other_seed = 202;
constexpr double near_enough = 1.1;

struct Score {
    int good = 0, all = 0;
};

template <class P>
void judge(const std::string& name, const P& primitives, std::vector<Score>& scores) {
    std::vector<std::string> left_out;
    const auto structures = usual_structures(P::dimension, PointSet<ViewOf<P>>, primitives.size(), left_out);
    MeasureOptions options;
    options.asks = {"closest-hit", "nearest"};
    // Take the advice from a short measurement.
    options.seconds = 0.1, options.seed = first_seed;
    const Comparison sample = compare(primitives, structures, options);
    // Take the truth from a longer measurement with other queries.
    options.seconds = 0.5, options.seed = other_seed;
    const Comparison truth = compare(primitives, structures, options);
    const Ask ask = usual_ask(sample);
    const auto advised = advise(sample, ask), measured = advise(truth, ask);
    // Compare the advised structure with the best one, need by need.
    scores.resize(advised.size());
    for (std::size_t i = 0; i < advised.size(); ++i) {
        const std::string& choice = advised[i].ranking.front().structure;
        const auto& ranking = measured[i].ranking;
        const auto at = std::find_if(ranking.begin(), ranking.end(),
                                     [&](const Ranked& r) { return r.structure == choice; });
        // The longer measurement may find the structure too slow to rank for little memory.
        const double ratio = at == ranking.end() ? INFINITY : at->figure / ranking.front().figure;
        scores[i].good += ratio <= near_enough, ++scores[i].all;
        std::printf("| %-26s | %-17s | %-24s | %-24s | %5.2f |\n", name.c_str(), advised[i].need.c_str(),
                    choice.c_str(), ranking.front().structure.c_str(), ratio);
    }
    std::fflush(stdout);
}

}  // namespace

int main(int count, char** arguments) {
    std::vector<std::string> names(arguments + 1, arguments + count);
    if (names.empty())
        names = {"gen:grass:20000",    "gen:hairball:20000",   "gen:turned-stadium:30000",
                 "gen:terrain:30000",  "gen:soup:5000",        "gen:cornell-box:3000",
                 "gen:teapot:40000",   "gen:spheres:20000",    "gen:points:30000",
                 "gen:points2d:30000", "gen:clusters2d:30000", "gen:segments2d:20000"};
    std::printf("%s, %s, one thread; x: the advised one's figure as a multiple of the best one's\n\n",
                measure::processor().c_str(), measure::compiler().c_str());
    std::printf(
        "| scene                      | for               | advised                  | best                  "
        "   | x     |\n");
    std::printf(
        "|----------------------------|-------------------|--------------------------|-----------------------"
        "---|-------|\n");
    std::vector<Score> scores;
    for (const auto& name : names)
        std::visit([&](const auto& set) { judge(name, set, scores); },
                   generate<float>(parse_scene_spec(name)));
    // Sum the scores over all needs.
    Score sum;
    for (const Score& s : scores) sum.good += s.good, sum.all += s.all;
    std::printf("\nwithin a tenth of the best:");
    for (const Score& s : scores) std::printf(" %d of %d,", s.good, s.all);
    std::printf(" in all %d of %d\n", sum.good, sum.all);
}
