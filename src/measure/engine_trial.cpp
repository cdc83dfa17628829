#include "engine_trial.h"

#include <algorithm>
#include <cmath>

#include <hedgerow/caster.h>

namespace hedgerow::measure {

Trial::Trial(const Asked& asked, const EngineOptions& options, const RaySet& set, Question question)
    : asked_(asked),
      o_(options),
      set_(set),
      rays_(set.rays),
      question_(question),
      hits_(set.rays.size()),
      any_(new bool[set.rays.size()]()),
      use_(asked.engines.size()) {}

std::string Trial::title() const {
    return set_.name + ", " + std::string(name_of(question_));
}
bool Trial::has(Mode mode) const {
    return std::find(o_.modes.begin(), o_.modes.end(), mode) != o_.modes.end();
}
bool Trial::by_sixteen() const {
    return has(Mode::batch) && rays_.size() >= 16;
}

std::size_t Trial::one_by_one(const Engine& engine) const {
    std::size_t found = 0;
    const Caster cast(engine);
    if (question_ == Question::closest)
        for (const auto& r : rays_) found += bool(cast.closest_hit(r));
    else
        for (const auto& r : rays_) found += cast.any_hit(r);
    return found;
}
KernelUse Trial::batch(const Engine& engine, Executor& executor) {
    return question_ == Question::closest
               ? closest_hits(engine, rays_, std::span(hits_), {.threads = executor})
               : any_hits(engine, rays_, std::span(any_.get(), rays_.size()), {.threads = executor});
}

std::vector<Row> Trial::run(const GoOn& go_on) {
    Contest contest;
    add_ours(contest);
    add_theirs(contest);
    const auto times = measured_in_turn(o_.rounds, contest, Clock::thread, [&](const std::string& name) {
        return go_on(title() + ", " + name);
    });
    if (times.empty() || !go_on(title() + ", counted")) return {};
    auto rows = rows_of(times);
    count(rows);
    return rows;
}

void Trial::add_ours(Contest& contest) {
    for (const Mode mode : o_.modes)
        for (std::size_t e = 0; e < asked_.engines.size(); ++e)
            contest.add(std::string(name_of(mode)) + ", " + std::string(name_of(o_.builders[e])),
                        [this, mode, e]() -> std::size_t {
                            if (mode == Mode::one) return one_by_one(asked_.engines[e]);
                            use_[e] = batch(asked_.engines[e], serial_executor());
                            return use_[e].packets;
                        });
}

/// Adds the peers by single calls, and beside batches also by calls of sixteen.
void Trial::add_theirs(Contest& contest) {
    const bool closest = question_ == Question::closest;
    for (const Asked::Tree& tree : asked_.trees) {
        const PeerIndex& index = *tree.index;
        const std::string name = tree.peer->name() + " " + tree.how.name;
        contest.add(name,
                    [this, closest, &index] { return closest ? index.closest(rays_) : index.any(rays_); });
        if (!by_sixteen()) continue;
        packets_.push_back(index.packets(rays_, set_.coherent));
        contest.add(name + ", by 16", [closest, &index, rays = packets_.back().get()] {
            return closest ? index.closest(*rays) : index.any(*rays);
        });
    }
}

/// Makes the rows from `times`, which are in the order in which contenders were added.
std::vector<Row> Trial::rows_of(const std::vector<Times>& times) const {
    const std::size_t n = rays_.size();
    std::vector<Row> rows;
    auto t = times.begin();
    // Make a row for each mode, with the rates of our trees.
    for (const Mode mode : o_.modes) {
        Row row{set_.name, set_.coherent, question_, mode, n, 0, {}, {}};
        for (std::size_t e = 0; e < asked_.engines.size(); ++e, ++t) {
            OurRate ours;
            ours.builder = o_.builders[e];
            ours.seconds = t->median / static_cast<double>(n), ours.spread = t->spread;
            if (mode == Mode::batch) ours.use = use_[e];
            row.ours.push_back(ours);
        }
        rows.push_back(std::move(row));
    }
    // Add the rates of the peers. Single calls are compared in all modes, calls of sixteen with batches
    // alone.
    for (const Asked::Tree& tree : asked_.trees)
        for (const int calls_of : {1, 16}) {
            if (calls_of == 16 && !by_sixteen()) continue;
            const auto traced = static_cast<double>(calls_of == 16 ? n / 16 * 16 : n);
            const TheirRate rate{tree.peer->name(),
                                 tree.how.name,
                                 tree.how.robust,
                                 calls_of,
                                 t->median / traced,
                                 t->spread,
                                 0};
            ++t;
            for (Row& row : rows)
                if (calls_of == 1 || row.mode == Mode::batch) row.theirs.push_back(rate);
        }
    return rows;
}

/// Counts what a sample of the rays visits in the plain walk. Throws Disagreement where a kernel's answer
/// differs from the plain walk's, and counts where a peer's answer differs.
void Trial::count(std::vector<Row>& rows) {
    const std::size_t step = (rays_.size() + o_.sample - 1) / o_.sample;
    const std::size_t sample = (rays_.size() + step - 1) / step;
    const auto mean = [&](std::uint64_t count) {
        return static_cast<double>(count) / static_cast<double>(sample);
    };
    // Count and check each of our trees.
    for (std::size_t e = 0; e < asked_.engines.size(); ++e) {
        if (has(Mode::batch)) batch(asked_.engines[e], serial_executor());
        Visits visits;
        for (std::size_t i = 0; i < rays_.size(); i += step)
            if (!right(asked_.engines[e], i, visits))
                throw Disagreement("the kernels' answer to ray " + std::to_string(i) + " (" + title() +
                                   ") is not the plain walk's: please report this scene");
        for (Row& row : rows) {
            OurRate& r = row.ours[e];
            r.nodes = mean(visits.nodes), r.leaves = mean(visits.leaves);
            r.primitives = mean(visits.primitives), row.sample = sample;
        }
    }
    // Count the answers of each peer that differ from ours.
    for (const Asked::Tree& tree : asked_.trees) {
        std::uint64_t apart = 0;
        for (std::size_t i = 0; i < rays_.size(); i += step) apart += differs(*tree.index, i);
        for (Row& row : rows)
            for (TheirRate& t : row.theirs)
                if (t.peer == tree.peer->name() && t.build == tree.how.name) t.differs = mean(apart);
    }
}
bool Trial::right(const Engine& engine, std::size_t i, Visits& visits) const {
    const Ray3f& ray = rays_[i];
    if (question_ == Question::closest) {
        const Hit<float> plain = closest_hit(engine, ray, KeepAll{}, visits);
        return closest_hit(engine, ray) == plain && (!has(Mode::batch) || hits_[i] == plain);
    }
    const bool plain = any_hit(engine, ray, KeepAll{}, visits);
    return any_hit(engine, ray) == plain && (!has(Mode::batch) || any_[i] == plain);
}
bool Trial::differs(const PeerIndex& peer, std::size_t i) const {
    const Ray3f& ray = rays_[i];
    const Engine& engine = asked_.engines.front();
    if (question_ == Question::any) return peer.hits(ray) != any_hit(engine, ray);
    const float ours = closest_hit(engine, ray).t, theirs = peer.distance(ray);
    if (std::isinf(theirs) || std::isinf(ours)) return std::isinf(theirs) != std::isinf(ours);
    return std::fabs(theirs - ours) > 1e-4f * std::fabs(ours);
}

std::vector<Trial::Scaling> Trial::scaling(const GoOn& go_on) {
    Contest contest;
    for (const Engine& engine : asked_.engines)
        for (Executor* const executor : {static_cast<Executor*>(&serial_executor()), &default_executor()})
            contest.add("on several threads",
                        [this, &engine, executor] { return batch(engine, *executor).packets; });
    const auto times = measured_in_turn(o_.rounds, contest, Clock::wall, [&](const std::string& name) {
        return go_on(title() + ", " + name);
    });
    std::vector<Scaling> all;
    for (std::size_t c = 1; c < times.size(); c += 2)
        all.push_back(
            {times[c].median / static_cast<double>(rays_.size()), times[c - 1].median / times[c].median});
    return all;
}

}  // namespace hedgerow::measure
