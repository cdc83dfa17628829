/// Parts that are computed at the same time and appended in turn.
#pragma once

#include <atomic>
#include <cstddef>
#include <memory>
#include <mutex>
#include <shared_mutex>
#include <vector>

#include <hedgerow/parallel/ieee_executor.h>

namespace hedgerow::detail {

/// Calls compute(i, part) for each i below `count`, several at a time, and copy(i, part) when the place of
/// part i is known: `grow(i, part)` has been called for it and all before it, in turn. Nothing is copied
/// while anything grows. Parts are used again, and few are in memory at a time where parts take about as long
/// as each other.
template <class Part, class Compute, class Grow, class Copy>
void in_turn(std::size_t count, Executor& executor, Compute compute, Grow grow, Copy copy) {
    std::vector<std::unique_ptr<Part>> done(count), spare;
    std::size_t next_to_grow = 0;
    std::atomic<std::size_t> next = 0;
    std::mutex turns;
    std::shared_mutex growing;
    IeeeExecutor(executor).for_each_piece(count, 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t k = begin; k < end; ++k) {
            // Take parts in their order, whichever pieces the executor hands out.
            const std::size_t i = next++;
            std::unique_ptr<Part> part;
            {
                const std::lock_guard lock(turns);
                if (!spare.empty()) part = std::move(spare.back()), spare.pop_back();
            }
            if (part == nullptr) part = std::make_unique<Part>();
            compute(i, *part);
            std::vector<std::pair<std::size_t, std::unique_ptr<Part>>> placed;
            {
                const std::lock_guard lock(turns);
                done[i] = std::move(part);
                for (; next_to_grow < count && done[next_to_grow] != nullptr; ++next_to_grow) {
                    const std::unique_lock alone(growing);
                    grow(next_to_grow, *done[next_to_grow]);
                    placed.emplace_back(next_to_grow, std::move(done[next_to_grow]));
                }
            }
            for (auto& [number, of_turn] : placed) {
                {
                    const std::shared_lock others(growing);
                    copy(number, *of_turn);
                }
                const std::lock_guard lock(turns);
                spare.push_back(std::move(of_turn));
            }
        }
    });
}

}  // namespace hedgerow::detail
