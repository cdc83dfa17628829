/// Another executor's threads, each in IEEE mode while it works.
#pragma once

#include <hedgerow/geometry/rounding.h>
#include <hedgerow/parallel/executor.h>

namespace hedgerow {

/// Whatever mode the caller or the threads of its pool are in, what is computed is the same.
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
