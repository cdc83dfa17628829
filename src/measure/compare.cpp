#include <hedgerow/measure/compare.h>

#include <algorithm>

#include <hedgerow/base/error.h>
#include <hedgerow/measure/contest.h>
#include <hedgerow/parallel/watched_executor.h>

#include "scene_questions.h"

namespace hedgerow::measure {

namespace {

template <std::floating_point T, int D>
class Measuring {
public:
    using Any = AnyIndex<T, D>;
    using Set = QuerySet<T, D>;

    Measuring(const Scene<T, D>& scene, const MeasureOptions& options, Executor& executor,
              const Progress& progress)
        : scene_(scene),
          o_(options),
          building_(&executor == &serial_executor() ? Clock::thread : Clock::wall),
          progress_(progress),
          executor_(executor, {{}, progress.cancel}) {
        if (scene.size() == 0) throw InputError("there are no primitives, so there is nothing to compare");
        // Build the default structure, whose answers are the reference for all others.
        oracle_ = scene.build("bvh", executor_);
        const SceneQuestions questions(scene, *oracle_, options);
        auto all = questions.all();
        questions_ = std::move(all.questions);
        ray_sets_ = std::move(all.ray_sets);
        seen_from_outside_ = questions.seen_from_outside();
        Visits ignored;
        for (const auto& q : questions_) answers_.push_back(q->answers(*oracle_, ignored, progress_));
    }

    Comparison run(std::span<const std::string> structures) {
        Comparison c{{}, scene_.noun(), scene_.size(), D, {}, ray_sets_, seen_from_outside_, true};
        // Build all structures and count what their queries visit.
        steps_ = structures.size() * (static_cast<std::size_t>(o_.rounds) * questions_.size() + 2);
        try {
            for (const std::string& s : structures) {
                built_.push_back(built(s));
                step();
            }
        } catch (const Cancelled&) {  // the structures before this one are counted in full
        }
        time_queries();
        // Measure updates, and return the structures that were measured.
        for (Built& built : built_) {
            // Leave out a structure that was to be timed but has no complete round.
            if (o_.rounds > 0 && built.rounds == 0) continue;
            finish(built);
            c.structures.push_back(std::move(built.cost));
            step();
        }
        c.finished = c.structures.size() == structures.size() && !progress_.cancelled();
        return c;
    }

private:
    struct Trial {
        std::shared_ptr<Set> questions;
        QueryCost cost;
        std::vector<double> seconds;  // by round
    };
    struct Built {
        std::unique_ptr<Any> index;
        StructureCost cost;
        std::vector<Trial> trials;
        std::size_t rounds = 0;  // number of timed rounds
    };

    void step() { progress_(++done_, steps_); }

    /// Builds a structure and counts what its queries visit. Throws Cancelled.
    Built built(const std::string& structure) {
        progress_.look();
        Built c;
        // Build as often as there are rounds, or until the time for builds is spent.
        std::vector<double> seconds;
        double spent = 0;
        do {
            c.index.reset();
            seconds.push_back(seconds_of([&] { c.index = scene_.build(structure, executor_); }, building_));
            spent += seconds.back();
        } while (static_cast<int>(seconds.size()) < o_.rounds && spent < o_.build_seconds);
        const Any& index = *c.index;
        // Record the costs of the structure, and make a trial for each kind of query.
        c.cost = {structure,
                  o_.rounds > 0 ? median(seconds) : 0,
                  static_cast<int>(seconds.size()),
                  index.bytes(),
                  index.node_count(),
                  index.leaf_count(),
                  index.item_count(),
                  index.depth(),
                  {},
                  {}};
        for (std::size_t i = 0; i < questions_.size(); ++i) c.trials.push_back(trial(index, i));
        return c;
    }
    /// Times all trials of all structures in turn. Where the progress is cancelled in a round, nothing of it
    /// is kept for a structure that is not through.
    void time_queries() {
        Contest contest;
        for (Built& b : built_)
            for (const Trial& t : b.trials)
                contest.add(b.cost.structure, [&questions = *t.questions, &index = *b.index] {
                    questions.put_to(index);
                    return questions.size();
                });
        const auto seconds = seconds_in_turn(o_.rounds, contest, Clock::thread, [&](const std::string&) {
            step();
            return !progress_.cancelled();
        });
        auto next = seconds.begin();
        for (Built& b : built_) {
            b.rounds = progress_.cancelled() && b.trials.empty() ? 0 : static_cast<std::size_t>(o_.rounds);
            for (Trial& t : b.trials) {
                t.seconds = *next++;
                b.rounds = std::min(b.rounds, t.seconds.size());
            }
            for (Trial& t : b.trials) t.seconds.resize(b.rounds);
        }
    }

    /// Makes as many of the queries as there is time for, once, to check their answers and count their
    /// visits. Throws Disagreement where an answer differs from the default structure's, and Cancelled.
    Trial trial(const Any& index, std::size_t i) {
        const Set& all = *questions_[i];
        // The first query of a solid makes it.
        if (all.size() > 0) all.thinned(all.size())->put_to(index);
        const std::size_t step = o_.rounds > 0 ? step_for(index, all) : 1;
        Trial t;
        // Trials with time for all queries share one set of them.
        t.questions = step == 1 ? questions_[i] : all.thinned(step);
        Visits visits;
        // Check the answers and count the visits.
        const auto answers = t.questions->answers(index, visits, progress_);
        for (std::size_t k = 0; k < answers.size(); ++k)
            if (answers[k] != answers_[i][k * step])
                throw Disagreement("answers differ: " + std::string(index.structure()) + " and " +
                                   std::string(oracle_->structure()) + " to query " +
                                   std::to_string(k * step) + " of '" + all.kind() + "' (seed " +
                                   std::to_string(o_.seed) + "): please report this scene");
        // Record the means.
        const auto n = static_cast<double>(answers.size());
        t.cost = {all.ask(),
                  all.kind(),
                  answers.size(),
                  0,
                  0,
                  static_cast<double>(visits.nodes) / n,
                  static_cast<double>(visits.leaves) / n,
                  static_cast<double>(visits.primitives) / n,
                  static_cast<double>(visits.skipped) / n};
        return t;
    }
    /// Returns the step for which a round of every step-th query takes its share of the time. The estimate
    /// comes from a few queries. They are timed twice, since the data that they touch is in the cache the
    /// second time.
    std::size_t step_for(const Any& index, const Set& all) const {
        const double share = o_.seconds / o_.rounds;
        std::size_t asked = 1;
        for (;;) {
            progress_.look();
            const auto some = all.thinned((all.size() + asked - 1) / asked);
            const double first = seconds_of([&] { some->put_to(index); });
            const double again =
                first > share ? first : std::min(first, seconds_of([&] { some->put_to(index); }));
            // Take four times as many queries while they need less than 1/16 of the share.
            if (again < share / 16 && asked * 4 <= all.size()) {
                asked *= 4;
                continue;
            }
            // Extrapolate to all queries.
            const double whole = again / static_cast<double>(some->size()) * static_cast<double>(all.size());
            const auto step = static_cast<std::size_t>(std::ceil(whole / share));
            return std::clamp<std::size_t>(step, 1, all.size());
        }
    }

    void finish(Built& c) {
        // Record the medians of the rounds.
        for (Trial& t : c.trials) {
            if (t.seconds.empty()) {
                c.cost.queries.push_back(t.cost);
                continue;
            }
            const Times times = times_of(t.seconds);
            t.cost.seconds = times.median / static_cast<double>(t.cost.asked);
            t.cost.spread = times.spread;
            c.cost.queries.push_back(t.cost);
        }
        // Measure updates; a rebuild is always possible.
        c.cost.update.one = c.cost.update.all = c.cost.build_seconds;
        if (!o_.updates || o_.rounds == 0 || progress_.cancelled()) return;
        try {
            if (c.index->changes_one_by_one()) change(c);
            if (c.index->refittable()) refit(c);
        } catch (const Cancelled&) {  // the figures of the queries are still valid
        }
    }

    /// Times erasing up to 1000 primitives and inserting them again.
    void change(Built& c) {
        const std::size_t n = scene_.size(), some = std::min<std::size_t>(n, 1000);
        const std::uint64_t first = scattered(o_.seed) % n;
        std::vector<double> out, in;
        for (int round = 0; round < o_.rounds; ++round) {
            progress_.look();
            // The ids are n / some apart, hence all different.
            const auto each = [&](auto f) {
                for (std::size_t i = 0; i < some; ++i)
                    f(static_cast<PrimitiveId>((first + i * (n / some)) % n));
            };
            bool held = true;
            out.push_back(seconds_of([&] { each([&](PrimitiveId id) { held &= c.index->erase(id); }); }));
            in.push_back(seconds_of([&] { each([&](PrimitiveId id) { held &= c.index->insert(id); }); }));
            if (!held) throw Disagreement(c.cost.structure + ": lost a primitive, or had one twice");
        }
        // Check the answers, and use single updates for all primitives where a rebuild takes longer.
        expect_same(c, *c.index, *oracle_, "after changes");
        UpdateCost& u = c.cost.update;
        u.erase = median(out) / static_cast<double>(some), u.insert = median(in) / static_cast<double>(some);
        u.one = u.erase + u.insert;
        if (u.one * static_cast<double>(n) < u.all)
            u.all = u.one * static_cast<double>(n), u.how = "one by one";
    }

    /// Times a refit over a copy of the primitives that is moved, and compares its queries with those of an
    /// index that is built after the motion.
    void refit(Built& c) {
        // Build an index over the copy, and refit it.
        const auto moving = scene_.copy();
        const auto fitted = moving->build(c.cost.structure, executor_);
        moving->move(Bend<T, D>(oracle_->bounds()));
        std::vector<double> seconds, slowdown;
        double drift = 1;
        for (int round = 0; round < o_.rounds; ++round)
            seconds.push_back(seconds_of([&] { drift = fitted->refit(executor_); }, building_));
        // Build another index, check that both give the same answers, and compare their times.
        const auto anew = moving->build(c.cost.structure, executor_);
        expect_same(c, *fitted, *anew, "after a refit");
        for (int round = 0; round < o_.rounds; ++round) {
            double refitted = 0, rebuilt = 0;
            for (const Trial& t : c.trials) {
                if (t.cost.ask != c.trials.front().cost.ask) continue;
                progress_.look();
                refitted += seconds_of([&] { t.questions->put_to(*fitted); });
                rebuilt += seconds_of([&] { t.questions->put_to(*anew); });
            }
            slowdown.push_back(rebuilt > 0 ? refitted / rebuilt : 1);
        }
        // Record the costs of the refit.
        UpdateCost& u = c.cost.update;
        u.drift = drift;
        u.how = "refit";
        u.all = median(seconds);
        if (!c.index->changes_one_by_one()) u.one = u.all;
        u.slowdown = median(slowdown);
    }

    void expect_same(const Built& c, const Any& one, const Any& other, const char* when) const {
        Visits ignored;
        for (const Trial& t : c.trials)
            if (t.questions->answers(one, ignored, progress_) !=
                t.questions->answers(other, ignored, progress_))
                throw Disagreement(c.cost.structure + ": answers differ " + when + " to '" + t.cost.kind +
                                   "' (seed " + std::to_string(o_.seed) + "): please report this scene");
    }

    const Scene<T, D>& scene_;
    const MeasureOptions& o_;
    Clock building_;  // wall for several threads: no thread's clock shows all their work
    const Progress& progress_;
    WatchedExecutor executor_;  // throws Cancelled
    std::unique_ptr<Any> oracle_;
    std::vector<std::shared_ptr<Set>> questions_;
    std::vector<RaySetSize> ray_sets_;
    double seen_from_outside_ = 1;
    std::vector<std::vector<std::uint64_t>> answers_;
    std::vector<Built> built_;
    std::uint64_t done_ = 0, steps_ = 0;
};

}  // namespace

template <class P>
Comparison compare(const P& primitives, std::span<const std::string> structures,
                   const MeasureOptions& options, const Progress& progress) {
    const SceneOf<P> scene(primitives);
    return Measuring(scene, options, options.threads.over(primitives.size()), progress).run(structures);
}

#define HEDGEROW_COMPARE(P)                                                                    \
    template Comparison compare(const P&, std::span<const std::string>, const MeasureOptions&, \
                                const Progress&);
#define HEDGEROW_COMPARE_ALL(T)       \
    HEDGEROW_COMPARE(TriangleMesh<T>) \
    HEDGEROW_COMPARE(SegmentSet<T>)
HEDGEROW_COMPARE_ALL(float)
HEDGEROW_COMPARE_ALL(double)
using Spheres3f = SphereSet<float, 3>;
using Spheres3d = SphereSet<double, 3>;
using Points2f = PointCloud<float, 2>;
using Points2d = PointCloud<double, 2>;
using Points3f = PointCloud<float, 3>;
using Points3d = PointCloud<double, 3>;
HEDGEROW_COMPARE(Spheres3f)
HEDGEROW_COMPARE(Spheres3d)
HEDGEROW_COMPARE(Points2f)
HEDGEROW_COMPARE(Points2d)
HEDGEROW_COMPARE(Points3f)
HEDGEROW_COMPARE(Points3d)

}  // namespace hedgerow::measure
