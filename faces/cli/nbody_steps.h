/// The steps of `hedgerow nbody --until`.
#pragma once

#include <cstdint>

#include "nbody.h"

namespace hedgerow::cli {

/// Chooses steps that are not given, and the time between snapshots.
void choose_steps(NbodyArguments& a, const MotionState& start, const MotionOptions& options);

/// The steps of a run. The last one ends at --until.
class Stepper {
public:
    Stepper(const NbodyArguments& a, Motion& motion) : a_(a), motion_(motion) {}

    bool finished() const { return !(a_.until - time() > (is_bare() ? 0 : 1e-6 * a_.dt)); }
    /// Makes a step, whose number is given. Returns how many forces were found.
    std::uint64_t step(std::uint64_t number);
    /// Whether --every asks for a snapshot after the last step.
    bool wants_snapshot() const { return wants_snapshot_; }

private:
    bool is_bare() const { return a_.bare.size > 0; }
    double time() const { return motion_.state().time; }

    const NbodyArguments& a_;
    Motion& motion_;
    bool wants_snapshot_ = false;
};

}  // namespace hedgerow::cli
