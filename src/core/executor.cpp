#include <hedgerow/parallel/executor.h>

#include <algorithm>
#include <limits>
#include <map>
#include <mutex>
#include <thread>

#ifndef HEDGEROW_HAS_TBB
#define HEDGEROW_HAS_TBB 1
#endif

#if HEDGEROW_TSAN
extern "C" void __tsan_acquire(void*);
extern "C" void __tsan_release(void*);
#endif

#if HEDGEROW_HAS_TBB
#include <tbb/blocked_range.h>
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_invoke.h>
#include <tbb/task_arena.h>
#endif

namespace hedgerow {

namespace {

thread_local bool working = false;

}  // namespace

bool is_worker() {
    return working;
}

#if HEDGEROW_HAS_TBB
namespace {

/// Marks the calling thread as a worker as long as the object lives.
class Working {
public:
    Working() : before_(std::exchange(working, true)) {}
    ~Working() { working = before_; }
    Working(const Working&) = delete;

private:
    bool before_;
};

/// Tells ThreadSanitizer in which order work runs that is handed to other threads: the code before it happens
/// before each task, and each task before the code after it. TBB ensures that order, but TBB is built without
/// ThreadSanitizer, which cannot see it. So that ThreadSanitizer checks the tasks and not TBB, this file
/// alone is compiled without it, with HEDGEROW_TSAN.
class Handover {
public:
    Handover() { released(&before_); }
    ~Handover() { acquired(&after_); }
    Handover(const Handover&) = delete;

    template <class F>
    auto task(F f) {
        return [this, f](const auto&... arguments) {
            const Task task(*this);
            const Working here;
            f(arguments...);
        };
    }

private:
    /// A task that runs. It ends where its function throws, too.
    class Task {
    public:
        explicit Task(Handover& handover) : handover_(handover) { acquired(&handover.before_); }
        ~Task() { released(&handover_.after_); }
        Task(const Task&) = delete;

    private:
        Handover& handover_;
    };
    static void acquired([[maybe_unused]] char* what) {
#if HEDGEROW_TSAN
        __tsan_acquire(what);
#endif
    }
    static void released([[maybe_unused]] char* what) {
#if HEDGEROW_TSAN
        __tsan_release(what);
#endif
    }
    char before_ = 0, after_ = 0;
};

class TbbExecutor final : public Executor {
public:
    void for_each_piece(std::size_t count, std::size_t grain,
                        FunctionRef<void(std::size_t, std::size_t)> body) override {
        Handover handover;
        tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count, grain),
                          handover.task([&](const auto& piece) { body(piece.begin(), piece.end()); }));
    }
    void both(FunctionRef<void()> first, FunctionRef<void()> second) override {
        Handover handover;
        tbb::parallel_invoke(handover.task(first), handover.task(second));
    }
};

/// Runs work by another executor inside an arena of few threads.
class ArenaExecutor final : public Executor {
public:
    explicit ArenaExecutor(std::size_t threads) : arena_(static_cast<int>(threads)) {}

    void for_each_piece(std::size_t count, std::size_t grain,
                        FunctionRef<void(std::size_t, std::size_t)> body) override {
        arena_.execute([&] { default_executor().for_each_piece(count, grain, body); });
    }
    void both(FunctionRef<void()> first, FunctionRef<void()> second) override {
        arena_.execute([&] { default_executor().both(first, second); });
    }

private:
    tbb::task_arena arena_;
};

}  // namespace

Executor& default_executor() {
    static TbbExecutor executor;
    return executor;
}
Executor& executor_of(std::size_t threads) {
    if (threads == 0) return default_executor();
    if (threads == 1) return serial_executor();
    // An arena takes memory for each of its threads, but no more work than there are cores.
    static const auto most = std::max<std::size_t>(std::thread::hardware_concurrency(), 64);
    static std::mutex making;
    static std::map<std::size_t, ArenaExecutor> made;
    const std::lock_guard lock(making);
    threads = std::min(threads, most);
    return made.try_emplace(threads, threads).first->second;
}
ThreadLimit::ThreadLimit(unsigned threads) {
    if (threads > 0)
        control_ = new tbb::global_control(tbb::global_control::max_allowed_parallelism, threads);
}
ThreadLimit::~ThreadLimit() {
    delete static_cast<tbb::global_control*>(control_);
}
#else
Executor& default_executor() {
    return serial_executor();
}
Executor& executor_of(std::size_t) {
    return serial_executor();
}
ThreadLimit::ThreadLimit(unsigned) {}
ThreadLimit::~ThreadLimit() = default;
#endif

}  // namespace hedgerow
