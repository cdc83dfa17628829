/// Evaluates the figures: which peer each of ours is compared with, and means.
#include <algorithm>
#include <cmath>

#include <hedgerow/measure/engine.h>

namespace hedgerow::measure {

namespace {

/// The fastest of the rates that are not robust and that `counts`, or nullptr.
template <class F>
const TheirRate* fastest(const std::vector<TheirRate>& all, F counts) {
    const TheirRate* best = nullptr;
    for (const TheirRate& t : all)
        if (!t.robust && counts(t) && (best == nullptr || t.seconds < best->seconds)) best = &t;
    return best;
}

}  // namespace

const OurRate& Row::best() const {
    return *std::min_element(ours.begin(), ours.end(),
                             [](const OurRate& a, const OurRate& b) { return a.seconds < b.seconds; });
}
const TheirRate* Row::by_single_calls() const {
    return fastest(theirs, [](const TheirRate& t) { return t.calls_of == 1; });
}
const TheirRate* Row::by_any_calls() const {
    return fastest(theirs, [](const TheirRate&) { return true; });
}
double Row::ratio_to(const TheirRate* their_rate) const {
    return their_rate != nullptr ? their_rate->seconds / best().seconds : 0;
}

const TheirBuild* SceneCosts::against(const OurBuild& build) const {
    // Compare with the peers' medium builds where no peer has a build like ours.
    const auto fastest = [&](WideBuilder like) {
        const TheirBuild* best = nullptr;
        for (const TheirBuild& t : their_builds)
            if (!t.how.robust && t.how.like == like && (best == nullptr || t.seconds < best->seconds))
                best = &t;
        return best;
    };
    const TheirBuild* const like = fastest(build.builder);
    return like != nullptr ? like : fastest(WideBuilder::medium);
}
double SceneCosts::ratio(const OurBuild& build) const {
    const TheirBuild* const them = against(build);
    return them != nullptr ? build.seconds / them->seconds : 0;
}

namespace {

std::string group_of(const Row& row) {
    const std::string question(name_of(row.question));
    if (row.mode == Mode::one) return "one, " + question;
    return "batch, " + std::string(row.coherent ? "coherent, " : "incoherent, ") + question;
}

class Means {
public:
    void add(const std::string& what, bool of_times, double ratio, const SceneCosts& scene,
             std::string_view set) {
        if (!(ratio > 0)) return;
        auto m =
            std::find_if(all_.begin(), all_.end(), [&](const Mean& known) { return known.what == what; });
        if (m == all_.end()) m = all_.insert(m, {what, of_times, 0, ratio, scene.name, std::string(set), 0});
        m->ratio += std::log(ratio), ++m->count;
        if (of_times ? ratio > m->worst : ratio < m->worst)
            m->worst = ratio, m->scene = scene.name, m->set = set;
    }
    std::vector<Mean> done() && {
        for (Mean& m : all_) m.ratio = std::exp(m.ratio / static_cast<double>(m.count));
        std::stable_sort(all_.begin(), all_.end(),
                         [](const Mean& a, const Mean& b) { return b.of_times && !a.of_times; });
        return std::move(all_);
    }

private:
    std::vector<Mean> all_;
};

}  // namespace

std::vector<Mean> means_of(const std::vector<SceneCosts>& scenes) {
    Means means;
    for (const Mode mode : {Mode::one, Mode::batch})  // in this order, whatever was measured first
        for (const bool together : {false, true})
            for (const Question question : {Question::closest, Question::any})
                for (const SceneCosts& s : scenes)
                    for (const Row& row : s.rows)
                        if (row.mode == mode && row.question == question &&
                            (mode == Mode::one ? !together : row.coherent == together)) {
                            means.add(group_of(row), false, row.ratio(), s, row.set);
                            if (mode == Mode::batch)
                                means.add(group_of(row) + ", to single calls", false,
                                          row.ratio_to(row.by_single_calls()), s, row.set);
                        }
    for (const SceneCosts& s : scenes)
        for (const OurBuild& b : s.builds)
            means.add("build, " + std::string(name_of(b.builder)), true, s.ratio(b), s, "");
    return std::move(means).done();
}

}  // namespace hedgerow::measure
