/// Cancellation of builds, generators and writers. The tests raise the token at chosen moments, and count how
/// often it is checked.
#include <hedgerow/any_index.h>
#include <hedgerow/io/mesh_file.h>
#include <hedgerow/io/point_file.h>
#include <hedgerow/parallel/watched_executor.h>
#include <hedgerow/scenes/generate.h>

#include "io_support.h"
#include "structure_names.h"

namespace hedgerow {
namespace {

using testing_io::contents;
using testing_io::TempFolder;

/// Raises a token when work is split for the k-th time.
class RaisingExecutor final : public Executor {
public:
    RaisingExecutor(Executor& threads, std::uint64_t k, std::atomic<bool>& token)
        : threads_(threads), k_(k), token_(token) {}
    void for_each_piece(std::size_t count, std::size_t grain,
                        FunctionRef<void(std::size_t, std::size_t)> body) override {
        split();
        threads_.for_each_piece(count, grain, body);
    }
    void both(FunctionRef<void()> first, FunctionRef<void()> second) override {
        split();
        threads_.both(first, second);
    }
    std::uint64_t splits() const { return splits_; }

private:
    void split() {
        if (++splits_ == k_) token_ = true;
    }
    Executor& threads_;
    std::uint64_t k_;
    std::atomic<bool>& token_;
    std::atomic<std::uint64_t> splits_{0};
};

/// Every structure that is built (brute force is not) by every builder, and what a build may add to that.
const std::vector<std::string>& structures() {
    static const auto names = [] {
        auto all = builders_for<TriangleMesh<float>>();
        std::erase(all, "brute-force");
        all.insert(all.end(), {"bvh:reinsertion=3", "bvh:volume=sphere"});
        return all;
    }();
    return names;
}
// Primitives of the indexes that are built, and of the scenes and files that are written.
constexpr std::size_t count = 12'000, written = 20'000;

const TriangleMesh<float>& mesh() {
    static const auto made = soup<float>(count);
    return made;
}

TEST(Interruption, TheTokenIsLookedAtOftenAndTheWorkIsReported) {
    for (Executor* const threads : {static_cast<Executor*>(&serial_executor()), &default_executor()})
        for (const std::string& structure : structures()) {
            std::atomic<std::uint64_t> most{0}, total{0}, reports{0};
            const Progress progress{[&](std::uint64_t done, std::uint64_t all) {
                                        EXPECT_LE(done, all) << structure;
                                        most = std::max<std::uint64_t>(most, done);
                                        total = all;
                                        ++reports;
                                    },
                                    nullptr};
            WatchedExecutor watched(*threads, progress);
            const auto index = build_any(structure, mesh(), watched);
            EXPECT_GE(watched.looks(), count / worth_a_task) << structure;
            EXPECT_GE(reports, count / worth_a_task / 2) << structure;
            EXPECT_GE(total, count) << structure;
            if (threads == &serial_executor()) {
                EXPECT_GE(double(most), 0.7 * double(total)) << structure;
            }
            EXPECT_EQ(index->validate(), "") << structure;
        }
}

TEST(Interruption, WatchedBuildsAreTheSame) {
    for (const std::string& structure : structures()) {
        WatchedExecutor watched(serial_executor(), {});
        const auto one = build_any(structure, mesh(), watched), other = build_any(structure, mesh());
        EXPECT_EQ(one->node_count(), other->node_count()) << structure;
        EXPECT_EQ(one->item_count(), other->item_count()) << structure;
        EXPECT_EQ(one->depth(), other->depth()) << structure;
    }
}

TEST(Interruption, ATokenRaisedAtAnySplitEndsTheBuild) {
    for (Executor* const threads : {static_cast<Executor*>(&serial_executor()), &default_executor()})
        for (const std::string& structure : structures()) {
            std::atomic<bool> token{false};
            // Count the splits of a whole build.
            RaisingExecutor never(*threads, 0, token);
            WatchedExecutor whole(never, {{}, &token});
            const std::uint64_t nodes = build_any(structure, mesh(), whole)->node_count();
            const std::uint64_t splits = never.splits();
            // Raise the token at some of the splits, ever farther apart.
            const std::uint64_t growth = threads == &serial_executor() ? 3 : 30;
            for (std::uint64_t k = 1; k <= splits; k += 1 + growth * k) {
                token = false;
                RaisingExecutor raising(*threads, k, token);
                WatchedExecutor watched(raising, {{}, &token});
                EXPECT_THROW(build_any(structure, mesh(), watched), Cancelled)
                    << structure << ", split " << k << " of " << splits;
                EXPECT_LE(raising.splits(), splits);
            }
            // A build after the cancelled ones is whole again.
            token = false;
            EXPECT_EQ(build_any(structure, mesh(), whole)->node_count(), nodes) << structure;
        }
}

TEST(Interruption, GeneratorsStopWhereverTheyAreAsked) {
    for (const SceneInfo& info : scene_list()) {
        const SceneSpec spec{std::string(info.name), written, 0};
        std::uint64_t reports = 0, stop_at = 0;
        std::atomic<bool> token{false};
        const Progress progress{[&](std::uint64_t done, std::uint64_t total) {
                                    if (done > total + total / 4)
                                        ADD_FAILURE() << info.name << ": " << done << " of " << total;
                                    if (++reports == stop_at) token = true;
                                },
                                &token};
        generate<float>(spec, progress);
        const std::uint64_t all = reports;
        EXPECT_GE(all, 2u) << info.name;
        for (stop_at = 1; stop_at < all; ++stop_at) {
            reports = 0, token = false;
            EXPECT_THROW(generate<float>(spec, progress), Cancelled) << info.name << " at " << stop_at;
            EXPECT_EQ(reports, stop_at) << info.name;
        }
    }
}

TEST(Interruption, WritersLeaveWhatWasThere) {
    const TempFolder folder;
    std::uint64_t reports = 0;
    std::atomic<bool> token{false};
    const Progress progress{[&](std::uint64_t done, std::uint64_t total) {
                                EXPECT_LE(done, total);
                                if (++reports == 3) token = true;
                            },
                            &token};
    const auto cloud = points<float>(written);
    const auto triangles = soup<float>(written);
    for (const char* const name : {"a.ply", "a.stl", "a.obj", "a.off", "a.npy", "a.csv"}) {
        folder.file(name, "of before");
        reports = 0, token = false;
        const bool of_points = std::string(name) == "a.npy" || std::string(name) == "a.csv";
        const auto save = [&] {
            of_points ? save_points(folder / name, cloud, progress)
                      : save_mesh(folder / name, triangles, progress);
        };
        EXPECT_THROW(save(), Cancelled) << name;
        EXPECT_EQ(contents(folder / name), "of before");
        EXPECT_EQ(folder.file_count(), 1u) << "nothing is left beside " << name;
        std::filesystem::remove(folder / name);
    }
}

}  // namespace
}  // namespace hedgerow
