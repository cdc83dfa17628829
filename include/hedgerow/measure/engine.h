/// Measures the engine and its peers on one scene: builds, and queries for each ray set, question and mode.
#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <hedgerow/engine/kernels.h>
#include <hedgerow/measure/peer.h>
#include <hedgerow/measure/ray_sets.h>

namespace hedgerow::measure {

enum class Question { closest, any };
inline constexpr std::string_view questions[] = {"closest", "any"};
constexpr std::string_view name_of(Question q) {
    return questions[static_cast<std::size_t>(q)];
}
/// One call for each ray, or one call for all rays.
enum class Mode { one, batch };
inline constexpr std::string_view modes[] = {"one", "batch"};
constexpr std::string_view name_of(Mode m) {
    return modes[static_cast<std::size_t>(m)];
}

/// Least cycles that one visit takes for a single ray: the dependent steps from a node's address to the next
/// node's. They are a load of the planes from the nearest cache into a wide register (7 cycles), a fused
/// product (4), two steps of maximum and minimum (4), a comparison into a mask (5), a move of the mask to a
/// plain register (4), its lowest bit (1) and a load of the child's word (3).
inline constexpr double latency_floor = 28;
/// Least cycles that one visit takes where other rays hide that latency. Testing a node takes 12 to 15 vector
/// instructions: six products, up to six maxima and minima, a comparison, and two to store the children that
/// were hit. The figure is for 15 of them, two a cycle.
inline constexpr double throughput_floor = 15.0 / 2;
constexpr double floor_of(Mode m) {
    return m == Mode::one ? latency_floor : throughput_floor;
}

struct EngineOptions {
    std::vector<RayKind> sets = {RayKind::primary, RayKind::diffuse, RayKind::random, RayKind::shadow,
                                 RayKind::ambient};
    /// Sets that are traced after those. Borrowed.
    std::span<const RaySet> more_sets;
    std::vector<Question> questions = {Question::closest, Question::any};
    std::vector<Mode> modes = {Mode::one, Mode::batch};
    /// Builders whose trees are traced. The builds of all builders are timed.
    std::vector<WideBuilder> builders = {WideBuilder::medium, WideBuilder::high};
    int width = 0;         ///< see WideOptions::width
    unsigned threads = 1;  ///< if not 1, batches and builds are timed on so many too
    int rounds = 5, build_rounds = 3;
    int picture = 1024;  ///< primary rays a side; diffuse, shadow and ambient rays start at their hits
    /// The camera of the primary rays, with the light of the shadow rays a little above it; without one both
    /// are outside the scene.
    std::optional<Camera> camera;
    std::size_t random = 1 << 19;  ///< random rays
    std::size_t sample = 20'000;   ///< most rays of a set that are counted and checked
    std::uint64_t seed = 0;
    const std::atomic<bool>* cancel = nullptr;  ///< checked during our builds, besides GoOn
};

/// The results of one of our trees in a row. Counts are means a ray, from the plain walk of the same tree.
struct OurRate {
    WideBuilder builder = WideBuilder::medium;
    double seconds = 0;  ///< seconds a ray, the median of the rounds
    double spread = 0;   ///< slowest minus fastest round, as a share of the median
    double nodes = 0, leaves = 0, primitives = 0;
    KernelUse use;          ///< kernels that batches used
    double on_threads = 0;  ///< seconds a ray on several threads, on the wall clock; 0: not measured
    double scaling = 0;     ///< speed-up over one thread on the same clock

    double visits() const { return nodes + leaves; }
    double cycles_a_visit(double gigahertz) const {
        return visits() > 0 ? seconds * 1e9 * gigahertz / visits() : 0;
    }
};
struct TheirRate {
    std::string peer, build;
    bool robust = false;
    int calls_of = 1;  ///< rays in a call: 1 or 16
    double seconds = 0, spread = 0;
    /// The share of the sample whose answers differ: only one of both hits, or the t differ by more than 1e-4
    /// of ours.
    double differs = 0;
};
struct Row {
    std::string set;        ///< the name of the rays: that of a RayKind, or of a RaySet
    bool coherent = false;  ///< whether neighbouring rays take nearly the same path
    Question question = Question::closest;
    Mode mode = Mode::one;
    std::size_t rays = 0, sample = 0;
    std::vector<OurRate> ours;
    std::vector<TheirRate> theirs;

    /// The result of our fastest tree.
    const OurRate& best() const;
    /// The result of the fastest peer that is not robust: by single calls, and by calls of any kind. nullptr
    /// without peers.
    const TheirRate* by_single_calls() const;
    const TheirRate* by_any_calls() const;
    /// What ours is compared with: for batches the fastest call of any kind, else single calls.
    const TheirRate* against() const { return mode == Mode::batch ? by_any_calls() : by_single_calls(); }
    /// Our rate as a multiple of theirs; 0 without one.
    double ratio_to(const TheirRate* theirs) const;
    double ratio() const { return ratio_to(against()); }
};

struct OurBuild {
    WideBuilder builder = WideBuilder::medium;
    double seconds = 0, spread = 0;
    std::size_t bytes = 0;               ///< beyond the primitives
    double on_threads = 0, scaling = 0;  ///< see OurRate
};
struct TheirBuild {
    std::string peer;
    PeerBuild how;
    double seconds = 0, spread = 0;
    std::size_t bytes = 0, most_bytes = 0;  ///< after the build, and the peak during it
};

struct SceneCosts {
    std::string name;
    std::size_t triangles = 0;
    int width = 0;
    std::vector<OurBuild> builds;
    std::vector<TheirBuild> their_builds;
    std::vector<Row> rows;
    bool finished = true;  ///< false: the measurement was stopped, and this has what was finished

    /// The peers' build that one of ours is compared with, the fastest of its kind; nullptr without peers.
    const TheirBuild* against(const OurBuild& build) const;
    /// Our time as a multiple of the time of against(); 0 without peers.
    double ratio(const OurBuild& build) const;
};

/// Is called with a name of the next measurement. Once it returns false, the finished results are returned.
using GoOn = std::function<bool(const std::string& next)>;

/// Measures our trees and the peers on one scene. Each round runs all contenders in turn. Times on one thread
/// are processor time, so that other load on the machine counts little. Peers run on one thread, with the
/// instruction set that is in use.
///
/// The kernels' answers to the sample are compared with those of our plain walk: throws Disagreement
/// where one differs. Throws InputError for a mesh without triangles, and the errors of `build`.
SceneCosts measure_engine(const std::string& name, const TriangleMesh<float>& mesh,
                          const std::vector<std::unique_ptr<Peer>>& peers, const EngineOptions& options,
                          const GoOn& go_on);

/// The mean of ratios over scenes and ray sets. The ratio of rates is ours to theirs; that of builds is our
/// time to theirs.
struct Mean {
    std::string what;
    bool of_times = false;  ///< the ratios are of times: less is better
    double ratio = 0;       ///< the geometric mean
    double worst = 0;       ///< the ratio that is worst for us; its scene and ray set follow
    std::string scene, set;
    std::size_t count = 0;
};
std::vector<Mean> means_of(const std::vector<SceneCosts>& scenes);

}  // namespace hedgerow::measure
