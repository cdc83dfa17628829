/// One question of one set of rays: everyone is asked, timed, counted and checked.
#pragma once

#include <span>

#include <hedgerow/ask.h>

#include "contest.h"
#include "engine.h"

namespace hedgerow::benchmark {

using Engine = decltype(build<WideBvh>(std::declval<const TriangleMesh<float>&>()));

/// What is asked: our trees, in the order of the builders that options name, and the peers'.
struct Asked {
    std::vector<Engine> engines;
    struct Tree {
        const Peer* peer;
        PeerBuild how;
        std::unique_ptr<PeerIndex> index;
    };
    std::vector<Tree> trees;
};

class Trial {
public:
    Trial(const Asked& asked, const EngineOptions& options, RayKind kind, const std::vector<Ray3f>& rays,
          Question question);

    /// A row for each mode; none if `go_on` said no. Throws compare::Disagreement.
    std::vector<Row> run(const GoOn& go_on);

    /// Batches on all threads that there are now, beside one by the same clock.
    struct Scaling {
        double seconds, times;  ///< of OurRate
    };
    /// Of each of our trees; none if `go_on` said no.
    std::vector<Scaling> scaling(const GoOn& go_on);

    std::string title() const;

private:
    bool has(Mode mode) const;
    bool by_sixteen() const;
    std::size_t one_by_one(const Engine& engine) const;
    KernelUse batch(const Engine& engine, Executor& executor);
    void add_ours(Contest& contest);
    void add_theirs(Contest& contest);
    std::vector<Row> rows_of(const std::vector<Times>& times) const;
    void count(std::vector<Row>& rows);
    bool right(const Engine& engine, std::size_t i, Visits& visits) const;
    bool differs(const PeerIndex& peer, std::size_t i) const;

    const Asked& asked_;
    const EngineOptions& o_;
    RayKind kind_;
    std::span<const Ray3f> rays_;
    Question question_;
    std::vector<Hit<float>> hits_;  // what the last batch answered
    std::unique_ptr<bool[]> any_;
    std::vector<KernelUse> use_;                                // of batches, by engine
    std::vector<std::unique_ptr<PeerIndex::Packets>> packets_;  // by peer's tree
};

}  // namespace hedgerow::benchmark
