/// How long work reports how far it is, and how it is asked to stop.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>

namespace hedgerow {

/// Given to long work (loading, building, rendering). `report(done, total)` may be called from any thread,
/// with `total` 0 while it is unknown. Work looks at `cancelled()` now and then and ends early with what it
/// has.
struct Progress {
    std::function<void(std::uint64_t done, std::uint64_t total)> report;
    const std::atomic<bool>* cancel = nullptr;

    void operator()(std::uint64_t done, std::uint64_t total) const {
        if (report) report(done, total);
    }
    bool cancelled() const { return cancel != nullptr && cancel->load(std::memory_order_relaxed); }
};

}  // namespace hedgerow
