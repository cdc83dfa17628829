/// One question for one set of rays: all trees are queried, timed, counted and checked.
#pragma once

#include <span>

#include <hedgerow/measure/contest.h>
#include <hedgerow/measure/costs.h>
#include <hedgerow/measure/engine.h>
#include <hedgerow/mesh_index.h>

namespace hedgerow::measure {

using Engine = MeshIndex<float>;

/// The trees that are traced: ours in the order of EngineOptions::builders, and the peers'.
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
    /// Borrows all.
    Trial(const Asked& asked, const EngineOptions& options, const RaySet& set, Question question);

    /// Returns a row for each mode, or none if `go_on` returned false. Throws Disagreement where an
    /// answer of the kernels differs from the plain walk's.
    std::vector<Row> run(const GoOn& go_on);

    /// How batches on all threads in use compare with one thread on the same clock.
    struct Scaling {
        double seconds, times;  ///< OurRate::on_threads and OurRate::scaling
    };
    /// Returns the scaling of each of our trees, or nothing if `go_on` returned false.
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
    const RaySet& set_;
    std::span<const Ray3f> rays_;  // of the set
    Question question_;
    std::vector<Hit<float>> hits_;  // the last batch's closest hits
    std::unique_ptr<bool[]> any_;
    std::vector<KernelUse> use_;                                // of the last batch, by engine
    std::vector<std::unique_ptr<PeerIndex::Packets>> packets_;  // by peer's tree; empty unless by_sixteen()
};

}  // namespace hedgerow::measure
