/// Progress reports and cancellation of long work.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <stdexcept>

namespace hedgerow {

/// Thrown by long work once `Progress::cancelled()` is true, since half a file, scene or structure is of no
/// use.
class Cancelled : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

/// What a caller gives to long work (loading, generating, building, rendering, saving) to follow and to
/// cancel it. `report(done, total)` may be called from any thread, and by several threads at once. `total` is
/// 0 while it is unknown, and grows when a next step begins; the last `done` may be less than `total`. Work
/// checks `cancelled()` now and then. It then ends early with what it has, or throws Cancelled if that is of
/// no use.
struct Progress {
    std::function<void(std::uint64_t done, std::uint64_t total)> report;
    const std::atomic<bool>* cancel = nullptr;

    void operator()(std::uint64_t done, std::uint64_t total) const {
        if (report) report(done, total);
    }
    bool cancelled() const { return cancel != nullptr && cancel->load(std::memory_order_relaxed); }
    /// Throws Cancelled if the work is cancelled.
    void look() const {
        if (cancelled()) throw Cancelled("cancelled");
    }
};

}  // namespace hedgerow
