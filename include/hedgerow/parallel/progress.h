/// How long work reports how far it is, and how it is asked to stop.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <stdexcept>

namespace hedgerow {

/// Thrown by long work once `Progress::cancelled()`: half a file, scene or structure is of no use to anyone.
class Cancelled : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

/// Given to long work (loading, generating, building, rendering, saving). `report(done, total)` may be called
/// from any thread and by several at once, with `total` 0 while it is unknown; `total` grows where a next
/// step begins, and the last `done` may be less. Work looks at `cancelled()` now and then. It ends early with
/// what it has, or throws Cancelled where that is of no use.
struct Progress {
    std::function<void(std::uint64_t done, std::uint64_t total)> report;
    const std::atomic<bool>* cancel = nullptr;

    void operator()(std::uint64_t done, std::uint64_t total) const {
        if (report) report(done, total);
    }
    bool cancelled() const { return cancel != nullptr && cancel->load(std::memory_order_relaxed); }
    /// Throws Cancelled if the work was asked to stop.
    void look() const {
        if (cancelled()) throw Cancelled("cancelled");
    }
};

}  // namespace hedgerow
