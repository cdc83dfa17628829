/// An executor for tests that no result depends on the order of the work.
#pragma once

#include <algorithm>

#include <hedgerow/parallel/executor.h>

namespace hedgerow {

/// Does what an executor may do but few do: it runs small pieces from the last to the first, and the second
/// task before the first.
class Backwards final : public Executor {
public:
    void for_each_piece(std::size_t count, std::size_t,
                        FunctionRef<void(std::size_t, std::size_t)> body) override {
        for (std::size_t end = count; end > 0; end -= std::min<std::size_t>(end, 7))
            body(end - std::min<std::size_t>(end, 7), end);
    }
    void both(FunctionRef<void()> first, FunctionRef<void()> second) override { second(), first(); }
};

}  // namespace hedgerow
