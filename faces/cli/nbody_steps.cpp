/// The steps of `hedgerow nbody --until`.
#include "nbody_steps.h"

#include <algorithm>
#include <cmath>

namespace hedgerow::cli {

void choose_steps(NbodyArguments& a, const MotionState& start, const MotionOptions& options) {
    if (a.every <= 0 && a.until > 0) a.every = a.until / 10;
    if (a.dt > 0) return;
    a.dt = usual_step(start, a.softening, a.eta, a.gravity) * (a.block_steps ? 8 : 1);
    // Steps end at snapshots and where the run ends.
    const double longest = std::min(a.every, a.until);
    if (longest > 0) a.dt = longest / std::max(1.0, std::ceil(longest / a.dt - 1e-6));
    const auto& masses = start.particles.masses;
    const bool attract =
        conserved(start).potential < 0 && std::ranges::none_of(masses, [](double mass) { return mass < 0; });
    if (a.softening == 0 && a.period == 0 && !a.block_steps && attract)
        a.bare = BareSteps(start, options, a.dt);
}

std::uint64_t Stepper::step(std::uint64_t number) {
    if (is_bare()) {
        const double next = a_.every * (std::floor(time() / a_.every + 1e-9) + 1);
        motion_.bare_step(a_.bare, std::min(next, a_.until));
        wants_snapshot_ = time() == next;
        return motion_.state().particles.size();
    }
    const double left = a_.until - time(), dt = left < a_.dt * (1 - 1e-6) ? left : a_.dt;
    const double steps = std::ceil(std::min(a_.every / a_.dt, 1e15) - 1e-6);
    wants_snapshot_ = number % std::max<std::uint64_t>(1, static_cast<std::uint64_t>(steps)) == 0;
    if (a_.block_steps) return motion_.block_step(dt, {.eta = a_.eta});
    motion_.step(dt);
    return motion_.state().particles.size();
}

}  // namespace hedgerow::cli
