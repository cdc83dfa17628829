/// An executor that adds progress reports and cancellation to another executor.
#pragma once

#include <algorithm>
#include <atomic>
#include <utility>

#include <hedgerow/parallel/executor.h>
#include <hedgerow/parallel/progress.h>

namespace hedgerow {

/// Makes a build report progress, and stop on request:
///
///   std::atomic<bool> stop = false;  // set it from any thread or signal handler
///   WatchedExecutor watched(default_executor(), {show, &stop});
///   auto index = build(mesh, watched);
///
/// The token is checked wherever work is split, about once in 4096 primitives. What is built is the same as
/// without a token. Once the token is raised, the next check throws Cancelled, which leaves `build` when all
/// threads have ended.
class WatchedExecutor final : public Executor {
public:
    /// Borrows `threads`.
    WatchedExecutor(Executor& threads, Progress progress)
        : threads_(threads), progress_(std::move(progress)) {}

    void for_each_piece(std::size_t count, std::size_t grain,
                        FunctionRef<void(std::size_t, std::size_t)> body) override {
        const std::size_t step = std::max<std::size_t>(grain, 1);
        threads_.for_each_piece(count, grain, [&](std::size_t begin, std::size_t end) {
            for (std::size_t next; begin < end; begin = next) {
                check();
                next = begin + std::min(step, end - begin);
                body(begin, next);
            }
        });
    }
    void both(FunctionRef<void()> first, FunctionRef<void()> second) override {
        const auto watched = [this](FunctionRef<void()> f) {
            check();
            f();
        };
        threads_.both([&] { watched(first); }, [&] { watched(second); });
    }
    void expect(std::size_t work) override {
        check();
        progress_(done_, total_ += work);
    }
    void advance(std::size_t work) override {
        check();
        const std::uint64_t total = total_;
        progress_(std::min<std::uint64_t>(done_ += work, total), total);
    }

    /// The number of times that the token was checked.
    std::uint64_t looks() const { return looks_; }

private:
    void check() {
        looks_.fetch_add(1, std::memory_order_relaxed);
        progress_.look();
    }

    Executor& threads_;
    Progress progress_;
    std::atomic<std::uint64_t> done_{0}, total_{0}, looks_{0};
};

}  // namespace hedgerow
