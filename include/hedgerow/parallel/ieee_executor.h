/// An executor that runs another executor's threads in IEEE mode.
#pragma once

#include <hedgerow/geometry/rounding.h>
#include <hedgerow/parallel/executor.h>

namespace hedgerow {

/// Runs each piece of work in IEEE mode (in_ieee_mode), so results are the same whatever mode the caller or
/// the threads of a pool are in. Borrows `threads`.
class IeeeExecutor final : public Executor {
public:
    explicit IeeeExecutor(Executor& threads) : threads_(threads) {}
    void for_each_piece(std::size_t count, std::size_t grain,
                        FunctionRef<void(std::size_t, std::size_t)> body) override {
        threads_.for_each_piece(count, grain, [&](std::size_t begin, std::size_t end) {
            in_ieee_mode([&] { body(begin, end); });
        });
    }
    void both(FunctionRef<void()> first, FunctionRef<void()> second) override {
        threads_.both([&] { in_ieee_mode(first); }, [&] { in_ieee_mode(second); });
    }
    void expect(std::size_t work) override { threads_.expect(work); }
    void advance(std::size_t work) override { threads_.advance(work); }

private:
    Executor& threads_;
};

}  // namespace hedgerow
