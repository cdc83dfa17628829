/// Any executor builds the same index and lets exceptions through, and any number of threads may query at
/// once.
#include <atomic>
#include <condition_variable>
#include <deque>
#include <functional>
#include <mutex>
#include <stdexcept>
#include <thread>

#include <hedgerow/scenes/meshes.h>
#include <hedgerow/scenes/sets.h>

#include "backwards.h"
#include "contract.h"

using namespace hedgerow;
using namespace hedgerow::contract;

namespace {

/// A thread pool of the caller's: a list of tasks, threads that run them, and callers that run tasks while
/// they wait.
class Pool final : public Executor {
public:
    explicit Pool(int threads) {
        for (int i = 0; i < threads; ++i)
            threads_.emplace_back([this] { help([this] { return closing_; }); });
    }
    ~Pool() override {
        {
            const std::lock_guard lock(mutex_);
            closing_ = true;
        }
        changed_.notify_all();
        for (auto& t : threads_) t.join();
    }
    void for_each_piece(std::size_t count, std::size_t grain,
                        FunctionRef<void(std::size_t, std::size_t)> body) override {
        std::vector<std::function<void()>> pieces;
        for (std::size_t at = 0; at < count; at += grain)
            pieces.push_back([=] { body(at, std::min(count, at + grain)); });
        run(pieces);
    }
    void both(FunctionRef<void()> first, FunctionRef<void()> second) override { run({first, second}); }

private:
    struct Task {
        std::function<void()> work;
        std::size_t* left;
        std::exception_ptr* error;
    };
    void run(const std::vector<std::function<void()>>& works) {
        std::size_t left = works.size();
        std::exception_ptr error;
        {
            const std::lock_guard lock(mutex_);
            for (const auto& w : works) tasks_.push_back({w, &left, &error});
        }
        changed_.notify_all();
        help([&] { return left == 0; });
        if (error) std::rethrow_exception(error);
    }
    template <class Done>
    void help(Done done) {
        std::unique_lock lock(mutex_);
        while (true) {
            changed_.wait(lock, [&] { return done() || !tasks_.empty(); });
            if (done()) return;
            const Task task = std::move(tasks_.back());
            tasks_.pop_back();
            lock.unlock();
            std::exception_ptr error;
            try {
                task.work();
            } catch (...) {
                error = std::current_exception();
            }
            lock.lock();
            if (error && !*task.error) *task.error = error;
            if (--*task.left == 0) changed_.notify_all();
        }
    }

    std::mutex mutex_;
    std::condition_variable changed_;
    std::deque<Task> tasks_;
    bool closing_ = false;
    std::vector<std::thread> threads_;
};

/// Under ThreadSanitizer the serial executor replaces oneTBB: the sanitizer does not see how oneTBB hands
/// work over, and reports races that are none.
#if defined(__SANITIZE_THREAD__)
Executor& threads_of_the_library() {
    return serial_executor();
}
#else
Executor& threads_of_the_library() {
    return default_executor();
}
#endif

template <class T>
class Executors : public testing::Test {};
using Scalars = testing::Types<float, double>;
TYPED_TEST_SUITE(Executors, Scalars);

template <template <class, int> class S, class P>
void expect_same_structure(const P& set, const typename S<typename P::Scalar, 3>::Options& options = {}) {
    const auto serial = build<S>(set, options);
    const Questions questions(serial, 200);
    const auto expected = answers(serial, questions);
    Pool pool(3);
    Backwards backwards;
    for (Executor* executor :
         std::initializer_list<Executor*>{&pool, &backwards, &threads_of_the_library()}) {
        const auto index = build<S>(set, options, *executor);
        EXPECT_TRUE(std::ranges::equal(index.structure().items(), serial.structure().items()));
        EXPECT_EQ(index.structure().node_count(), serial.structure().node_count());
        EXPECT_EQ(index.structure().depth(), serial.structure().depth());
        EXPECT_EQ(answers(index, questions), expected);
        std::vector<HitOf<decltype(index)>> hits(questions.rays.size());
        closest_hits(index, questions.rays, hits, {.threads = *executor});
        for (std::size_t i = 0; i < hits.size(); ++i) EXPECT_EQ(hits[i], expected.closest[i]);
    }
}

TYPED_TEST(Executors, EveryExecutorBuildsTheSame) {
    const auto mesh = soup<TypeParam>(20000);
    for (const auto builder : bvh_builders) {
        typename Bvh<TypeParam, 3>::Options options;
        options.builder = builder;
        expect_same_structure<Bvh>(mesh, options);
        options.reinsertion = 1;
        expect_same_structure<Bvh>(mesh, options);
    }
    for (const auto builder : wide_builders) {
        WideOptions options;
        options.builder = builder, options.reinsertion = 1;
        expect_same_structure<WideBvh>(mesh, options);
    }
    expect_same_structure<KdTree>(mesh);
    expect_same_structure<Grid>(mesh);
    expect_same_structure<Orthtree>(mesh);
}

struct Refusal : std::runtime_error {
    using runtime_error::runtime_error;
};

/// Spheres, one of which throws when its bounds are computed, and one when a ray is intersected with it.
struct Touchy {
    using Scalar = float;
    static constexpr int dimension = 3;
    SphereSetView<float, 3> balls;
    std::size_t unseen = Hit<float>::none, unasked = Hit<float>::none;

    std::size_t size() const { return balls.size(); }
    Box3f bounds(std::size_t i) const {
        if (i == unseen) throw Refusal("bounds");
        return balls.bounds(i);
    }
    std::optional<Meeting<float>> meet(std::size_t i, const Ray3f& ray) const {
        if (i == unasked) throw Refusal("meet");
        return balls.meet(i, ray);
    }
};

TEST(Exceptions, PassThroughEveryExecutor) {
    const auto balls = spheres<float>(50000);
    const Box3f box = build(balls).bounds();
    const Questions<float, 3> questions(box, {balls.spheres[7].center}, 5000);
    std::vector<Hit<float>> hits(questions.rays.size());
    Pool pool(3);
    Backwards backwards;
    for (Executor* executor :
         std::initializer_list<Executor*>{&pool, &backwards, &threads_of_the_library(), &serial_executor()}) {
        // Exceptions of pieces and tasks.
        const auto fail = [] { throw Refusal("asked to"); };
        const auto fine = [] {};
        EXPECT_THROW(executor->for_each_piece(100, 10, [&](std::size_t, std::size_t) { fail(); }), Refusal);
        EXPECT_THROW(executor->both(fail, fine), Refusal);
        EXPECT_THROW(executor->both(fine, fail), Refusal);

        // Exceptions of primitives, in a build and in a batch.
        EXPECT_THROW(build<Bvh>(Touchy{balls.view(), 40000}, {}, *executor), Refusal);
        const auto index = build<Bvh>(Touchy{balls.view(), Hit<float>::none, 7}, {}, *executor);
        EXPECT_THROW(closest_hits(index, questions.rays, hits, {.threads = *executor}), Refusal);
        // The exception leaves nothing behind.
        const auto good = build<Bvh>(Touchy{balls.view()}, {}, *executor);
        EXPECT_NO_THROW(closest_hits(good, questions.rays, hits, {.threads = *executor}));

        // An error message names the first bad primitive, whichever piece found one first.
        auto bad = balls;
        bad.spheres[30001].radius = bad.spheres[9001].radius = bad.spheres[9002].radius =
            std::numeric_limits<float>::quiet_NaN();
        try {
            build<Bvh>(bad, {}, *executor);
            ADD_FAILURE() << "a NaN was let in";
        } catch (const InputError& e) {
            EXPECT_NE(std::string(e.what()).find("primitive 9001 "), std::string::npos) << e.what();
        }
    }
}

TYPED_TEST(Executors, ManyThreadsMayAskAtOnce) {
    const auto mesh = teapot<TypeParam>(1000);
    const Questions questions(build(mesh), 800);
    with_each_structure(mesh, [&](const auto& index) {
        const auto expected = answers(index, questions);
        std::vector<decltype(answers(index, questions))> said(4);
        std::vector<std::thread> threads;
        threads.reserve(said.size());
        for (auto& s : said) threads.emplace_back([&] { s = answers(index, questions); });
        for (auto& t : threads) t.join();
        for (const auto& s : said) EXPECT_EQ(s, expected);
    });
}

TEST(Threads, AreAllCoresForLargeWorkAndTheCallersForSmall) {
    EXPECT_EQ(&Threads().over(worth_a_task), &default_executor());
    EXPECT_EQ(&Threads().over(worth_a_task - 1), &serial_executor());
    EXPECT_EQ(&Threads(serial_executor()).over(worth_a_task), &serial_executor());
    EXPECT_EQ(&Threads(default_executor()).over(1), &default_executor());
}

TEST(Threads, AreNotStartedInsideOfAWorker) {
    if (&default_executor() == &serial_executor()) GTEST_SKIP() << "built without threads";
    EXPECT_FALSE(is_worker());
    std::atomic<int> pieces{0}, others{0};
    default_executor().for_each_piece(8, 1, [&](std::size_t begin, std::size_t end) {
        pieces += static_cast<int>(end - begin);
        others += &Threads().over(worth_a_task) != &serial_executor();
        default_executor().both([&] { others += !is_worker(); }, [&] { others += !is_worker(); });
        others += !is_worker();
    });
    EXPECT_EQ(pieces, 8);
    EXPECT_EQ(others, 0);
    EXPECT_FALSE(is_worker());
    EXPECT_THROW(default_executor().for_each_piece(
                     1, 1, [](std::size_t, std::size_t) { throw std::runtime_error(""); }),
                 std::runtime_error);
    EXPECT_FALSE(is_worker());
}

TEST(Threads, AFilterOfABatchIsCalledInTheCallersThreadUnlessItIsGivenOthers) {
    const auto mesh = soup<float>(300);
    const auto index = build(mesh);
    const std::vector<Ray3f> rays(4 * worth_a_task, Ray3f{{0.5f, 0.5f, -2}, {0.01f, 0.02f, 1}});
    std::vector<Hit<float>> hits(rays.size());
    const auto caller = std::this_thread::get_id();
    std::atomic<int> calls{0}, elsewhere{0};
    const auto filter = [&](const Hit<float>&) {
        ++calls, elsewhere += std::this_thread::get_id() != caller;
        return true;
    };
    closest_hits(index, rays, hits, filter);
    all_hits(index, rays, filter);
    EXPECT_GT(calls, 0);
    EXPECT_EQ(elsewhere, 0);
}

}  // namespace
