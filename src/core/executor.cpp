#include <hedgerow/parallel/executor.h>

#ifndef HEDGEROW_HAS_TBB
#define HEDGEROW_HAS_TBB 1
#endif

#if HEDGEROW_HAS_TBB
#include <tbb/blocked_range.h>
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_invoke.h>
#endif

namespace hedgerow {

#if HEDGEROW_HAS_TBB
namespace {
class TbbExecutor final : public Executor {
public:
    void for_each_piece(std::size_t count, std::size_t grain,
                        FunctionRef<void(std::size_t, std::size_t)> body) override {
        tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count, grain),
                          [&](const auto& piece) { body(piece.begin(), piece.end()); });
    }
    void both(FunctionRef<void()> first, FunctionRef<void()> second) override {
        tbb::parallel_invoke(first, second);
    }
};
}  // namespace

Executor& default_executor() {
    static TbbExecutor executor;
    return executor;
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
ThreadLimit::ThreadLimit(unsigned) {}
ThreadLimit::~ThreadLimit() = default;
#endif

}  // namespace hedgerow
