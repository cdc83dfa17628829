#include <hedgerow/measure/engine.h>

#include <algorithm>

#include <hedgerow/base/error.h>
#include <hedgerow/parallel/watched_executor.h>

#include "engine_trial.h"

namespace hedgerow::measure {

namespace {

using Mesh = TriangleMesh<float>;

std::string_view instruction_set() {
    return name_of(hedgerow::instruction_set());
}

class Measuring {
public:
    Measuring(const std::string& name, const Mesh& mesh, const std::vector<std::unique_ptr<Peer>>& peers,
              const EngineOptions& options, const GoOn& go_on)
        : mesh_(mesh),
          peers_(peers),
          o_(options),
          go_on_([&name, &go_on](const std::string& next) { return go_on(name + ": " + next); }) {
        costs_.name = name, costs_.triangles = mesh.size();
        if (mesh.size() == 0)
            throw InputError(name + ": there are no triangles, so there is nothing to measure");
    }

    SceneCosts run() {
        try {
            costs_.finished = builds() && builds_on_threads() && plant() && traces();
        } catch (const Cancelled&) {  // thrown by a build
            costs_.finished = false;
        }
        return std::move(costs_);
    }

private:
    Engine built(WideBuilder builder, Executor& executor = serial_executor()) const {
        WideOptions options;
        options.builder = builder, options.width = o_.width;
        WatchedExecutor watched(executor, {{}, o_.cancel});
        return build<WideBvh>(mesh_, options, watched);
    }
    /// Calls f with each peer and each of its builds, until f returns false.
    template <class F>
    bool each_peer_build(F f) const {
        for (const auto& peer : peers_)
            for (const PeerBuild& how : peer->builds())
                if (!f(*peer, how)) return false;
        return true;
    }

    /// Times all builds, ours and the peers', in turn. False if `go_on_` stopped it.
    bool builds() {
        Contest contest;
        std::vector<OurBuild> ours;
        std::vector<TheirBuild> theirs;
        std::vector<std::vector<double>> seconds;  // times of the build alone, as each peer reports them
        // Add all builds as contenders.
        ours.resize(std::size(wide_builders));
        for (const WideBuilder b : wide_builders) add_ours(contest, b, ours[static_cast<std::size_t>(b)]);
        each_peer_build([&](const Peer& peer, const PeerBuild& how) {
            theirs.push_back({peer.name(), how, 0, 0, 0, 0});
            return true;
        });
        seconds.resize(theirs.size());
        std::size_t i = 0;
        each_peer_build([&](const Peer& peer, const PeerBuild& how) {
            add_theirs(contest, peer, how, theirs[i], seconds[i]);
            return ++i > 0;
        });
        const auto times = measured_in_turn(o_.build_rounds, contest, Clock::process, go_on_);
        // Store the times: ours from the contest, those of the peers as they report them.
        if (times.empty()) return false;
        for (std::size_t b = 0; b < ours.size(); ++b)
            ours[b].seconds = times[b].median, ours[b].spread = times[b].spread;
        for (i = 0; i < theirs.size(); ++i) {
            const Times all = times_of(seconds[i]);
            theirs[i].seconds = all.median, theirs[i].spread = all.spread;
        }
        costs_.builds = std::move(ours), costs_.their_builds = std::move(theirs);
        return true;
    }
    void add_ours(Contest& contest, WideBuilder builder, OurBuild& cost) {
        cost.builder = builder;
        contest.add("build " + std::string(name_of(builder)), [this, builder, &cost] {
            const Engine engine = built(builder);
            costs_.width = engine.structure().options().width;
            return cost.bytes = engine.bytes();
        });
    }
    void add_theirs(Contest& contest, const Peer& peer, const PeerBuild& how, TheirBuild& cost,
                    std::vector<double>& seconds) const {
        contest.add(peer.name() + ", build " + how.name, [this, &peer, how, &cost, &seconds] {
            const auto index = peer.build(mesh_, how, instruction_set());
            seconds.push_back(index->build_seconds);
            cost.most_bytes = index->most_bytes;
            return cost.bytes = index->bytes;
        });
    }
    bool builds_on_threads() {
        if (o_.threads == 1) return true;
        const ThreadLimit limit(o_.threads);
        Contest contest;
        for (const WideBuilder b : wide_builders)
            for (Executor* const executor : {static_cast<Executor*>(&serial_executor()), &default_executor()})
                contest.add("builds on several threads",
                            [this, b, executor] { return built(b, *executor).size(); });
        const auto times = measured_in_turn(o_.build_rounds, contest, Clock::wall, go_on_);
        if (times.empty()) return false;
        for (std::size_t b = 0; b < costs_.builds.size(); ++b) {
            costs_.builds[b].on_threads = times[2 * b + 1].median;
            costs_.builds[b].scaling = times[2 * b].median / times[2 * b + 1].median;
        }
        return true;
    }

    /// Builds the trees of ours that are traced, and makes the rays.
    bool plant() {
        for (const WideBuilder b : o_.builders) {
            if (!go_on_("build " + std::string(name_of(b)) + ", to be traced")) return false;
            asked_.engines.push_back(built(b));
        }
        const Engine& engine = asked_.engines.front();
        const Box3f& box = engine.bounds();
        const auto primary = primary_rays(o_.camera.value_or(side_camera(box)), o_.picture);
        std::vector<Hit<float>> hits(primary.size());
        closest_hits(engine, std::span<const Ray3f>(primary), std::span(hits));
        for (const RayKind kind : o_.sets)
            sets_.push_back({std::string(name_of(kind)), rays_of(kind, box, primary, hits), coherent(kind),
                             only_any_hit(kind)});
        return true;
    }

    std::vector<Ray3f> rays_of(RayKind kind, const Box3f& box, const std::vector<Ray3f>& primary,
                               const std::vector<Hit<float>>& hits) const {
        switch (kind) {
            case RayKind::primary:
                return primary;
            case RayKind::diffuse:
                return diffuse_rays(mesh_, primary, hits, o_.seed);
            case RayKind::ambient:
                return ambient_rays(diffuse_rays(mesh_, primary, hits, o_.seed), box);
            case RayKind::shadow:
                return shadow_rays(mesh_, light(box), primary, hits);
            default:
                return random_rays(box, o_.random, o_.seed);
        }
    }
    Vec3f light(const Box3f& box) const {
        if (!o_.camera) return side_light(box);
        return o_.camera->eye + o_.camera->up * (0.2f * length(o_.camera->target - o_.camera->eye));
    }

    bool traces() {
        // A peer may limit the threads of the whole process while its tree exists, so the scaling on threads
        // is measured before the peers build.
        std::vector<std::vector<Trial::Scaling>> scaling;
        if (!each_trial([&](Trial& trial) {
                scaling.emplace_back();
                if (!scales()) return true;
                const ThreadLimit limit(o_.threads);
                scaling.back() = trial.scaling(go_on_);
                return !scaling.back().empty();
            }))
            return false;
        // Build the peers' trees.
        if (!each_peer_build([&](const Peer& peer, const PeerBuild& how) {
                if (!go_on_(peer.name() + ", build " + how.name + ", to be traced")) return false;
                asked_.trees.push_back({&peer, how, peer.build(mesh_, how, instruction_set())});
                return true;
            }))
            return false;
        // Trace each set with each question, and add the scaling to its rows.
        auto scaled = scaling.begin();
        return each_trial([&](Trial& trial) {
            auto rows = trial.run(go_on_);
            for (Row& row : rows) add_scaling(*scaled, row);
            ++scaled;
            const bool finished = !rows.empty();
            std::move(rows.begin(), rows.end(), std::back_inserter(costs_.rows));
            return finished;
        });
    }
    bool scales() const {
        return o_.threads != 1 && std::find(o_.modes.begin(), o_.modes.end(), Mode::batch) != o_.modes.end();
    }
    static void add_scaling(const std::vector<Trial::Scaling>& scaling, Row& row) {
        if (row.mode != Mode::batch) return;
        for (std::size_t e = 0; e < scaling.size(); ++e)
            row.ours[e].on_threads = scaling[e].seconds, row.ours[e].scaling = scaling[e].times;
    }
    /// Calls f with the trial of each question of each set, until f returns false. Some sets are for any hit
    /// only. A set is empty where no primary ray hits.
    template <class F>
    bool each_trial(F f) const {
        for (const std::span<const RaySet> sets : {std::span<const RaySet>(sets_), o_.more_sets})
            for (const RaySet& set : sets)
                for (const Question question : o_.questions) {
                    if (set.rays.empty() || (set.only_any_hit && question == Question::closest)) continue;
                    Trial trial(asked_, o_, set, question);
                    if (!f(trial)) return false;
                }
        return true;
    }

    const Mesh& mesh_;
    const std::vector<std::unique_ptr<Peer>>& peers_;
    const EngineOptions& o_;
    GoOn go_on_;
    SceneCosts costs_;
    Asked asked_;
    std::vector<RaySet> sets_;  // of o_.sets
};

}  // namespace

SceneCosts measure_engine(const std::string& name, const Mesh& mesh,
                          const std::vector<std::unique_ptr<Peer>>& peers, const EngineOptions& options,
                          const GoOn& go_on) {
    return Measuring(name, mesh, peers, options, go_on).run();
}

}  // namespace hedgerow::measure
