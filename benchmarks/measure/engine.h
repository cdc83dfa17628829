/// The engine on one scene beside its peers: builds, and ray sets × questions × modes.
#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <hedgerow/structures/bvh/wide/kernels.h>

#include "peers/peer.h"
#include "ray_sets.h"

namespace hedgerow::benchmark {

enum class Question { closest, any };
inline constexpr std::string_view questions[] = {"closest", "any"};
constexpr std::string_view name_of(Question q) {
    return questions[static_cast<std::size_t>(q)];
}
/// A call a ray, or one for all.
enum class Mode { one, batch };
inline constexpr std::string_view modes[] = {"one", "batch"};
constexpr std::string_view name_of(Mode m) {
    return modes[static_cast<std::size_t>(m)];
}
inline constexpr std::string_view builders[] = {"fast", "medium", "high"};
constexpr std::string_view name_of(WideBuilder b) {
    return builders[static_cast<std::size_t>(b)];
}

/// Least cycles that one visit takes a ray that is alone: what depends on each other from a node's address to
/// the next one's. Its planes come from the nearest cache (7 cycles into a wide register), a fused product
/// (4), two steps of maximum and minimum (4), a comparison into a mask (5), the mask in a plain register (4),
/// its lowest bit (1) and the child's word there (3).
inline constexpr double latency_floor = 28;
/// Least cycles that one visit takes where other rays hide that: the 12 to 15 instructions on vectors
/// that test a node (six products, up to six maxima and minima, a comparison, and two to keep what is
/// entered): 15 of them, two a cycle.
inline constexpr double throughput_floor = 15.0 / 2;
constexpr double floor_of(Mode m) {
    return m == Mode::one ? latency_floor : throughput_floor;
}

struct EngineOptions {
    std::vector<RayKind> sets = {RayKind::primary, RayKind::diffuse, RayKind::random, RayKind::shadow};
    std::vector<Question> questions = {Question::closest, Question::any};
    std::vector<Mode> modes = {Mode::one, Mode::batch};
    /// Whose trees are traced. All are built and timed.
    std::vector<WideBuilder> builders = {WideBuilder::medium, WideBuilder::high};
    int width = 0;         ///< as WideOptions has it
    unsigned threads = 1;  ///< more: batches and builds on so many too
    int rounds = 5, build_rounds = 3;
    int picture = 1024;            ///< primary rays a side; the other sets leave their hits
    std::size_t random = 1 << 19;  ///< random rays
    std::size_t sample = 20'000;   ///< at most so many of a set are counted and checked
    std::uint64_t seed = 0;
    const std::atomic<bool>* cancel = nullptr;  ///< looked at during our builds, besides what GoOn says
};

/// What one of our trees did in a row. Counts are means a ray, by the plain walk of the same tree.
struct OurRate {
    WideBuilder builder = WideBuilder::medium;
    double seconds = 0;  ///< a ray, the median of the rounds
    double spread = 0;   ///< between the slowest and the fastest round, as a share of the median
    double nodes = 0, leaves = 0, primitives = 0;
    KernelUse use;          ///< of batches
    double on_threads = 0;  ///< seconds a ray on several threads, by the clock on the wall; 0: not measured
    double scaling = 0;     ///< how many times as fast that is as one thread by the same clock

    double visits() const { return nodes + leaves; }
    double cycles_a_visit(double gigahertz) const {
        return visits() > 0 ? seconds * 1e9 * gigahertz / visits() : 0;
    }
};
struct TheirRate {
    std::string peer, build;
    bool robust = false;
    int calls_of = 1;  ///< rays a call
    double seconds = 0, spread = 0;
    /// The share of the sample where it hits and we do not, or the reverse, or at a t that is further than
    /// 1e-4 of ours away.
    double differs = 0;
};
struct Row {
    RayKind set = RayKind::primary;
    Question question = Question::closest;
    Mode mode = Mode::one;
    std::size_t rays = 0, sample = 0;
    std::vector<OurRate> ours;
    std::vector<TheirRate> theirs;

    /// The fastest of our trees.
    const OurRate& best() const;
    /// The fastest of the peers that are not robust: for batches of coherent rays by its calls of sixteen,
    /// else by its single ones. nullptr without peers.
    const TheirRate* against() const;
    /// Our rate as a multiple of theirs; 0 without peers.
    double ratio() const;
};

struct OurBuild {
    WideBuilder builder = WideBuilder::medium;
    double seconds = 0, spread = 0;
    std::size_t bytes = 0;               ///< beyond the primitives
    double on_threads = 0, scaling = 0;  ///< as of OurRate
};
struct TheirBuild {
    std::string peer;
    PeerBuild how;
    double seconds = 0, spread = 0;
    std::size_t bytes = 0, most_bytes = 0;  ///< at the end, and at most during the build
};

struct SceneCosts {
    std::string name;
    std::size_t triangles = 0;
    int width = 0;
    std::vector<OurBuild> builds;
    std::vector<TheirBuild> their_builds;
    std::vector<Row> rows;
    bool finished = true;  ///< false: it was stopped, and holds what was done

    /// What a build of ours is held against, the fastest of the peers'; nullptr without peers.
    const TheirBuild* against(const OurBuild& build) const;
    /// Our time as a multiple of theirs; 0 without peers.
    double ratio(const OurBuild& build) const;
};

/// Is told what is measured next; once it says no, what was finished is returned.
using GoOn = std::function<bool(const std::string& next)>;

/// Measures. Rounds go through all contenders in turn. Times on one thread are what was worked, so that what
/// else the machine does counts little. Every answer of the sample is held against our own plain walk's:
/// throws compare::Disagreement where one differs. Throws InputError for a mesh without triangles, and as
/// `build` does. Peers are asked on one thread, with the instruction set that is in use.
SceneCosts measure_engine(const std::string& name, const TriangleMesh<float>& mesh,
                          const std::vector<std::unique_ptr<Peer>>& peers, const EngineOptions& options,
                          const GoOn& go_on);

/// Of ratios over scenes and ray sets: of rates ours to theirs, of builds our time to theirs.
struct Mean {
    std::string what;
    bool of_times = false;  ///< less is better
    double ratio = 0;       ///< the geometric mean
    double worst = 0;       ///< the one of all that is worst for us, and where
    std::string scene, set;
    std::size_t count = 0;
};
std::vector<Mean> means_of(const std::vector<SceneCosts>& scenes);

}  // namespace hedgerow::benchmark
