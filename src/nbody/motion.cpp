/// Leapfrog, in steps of one length or in block steps.
#include <hedgerow/nbody/motion.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include <hedgerow/ask/points.h>
#include <hedgerow/base/error.h>
#include <hedgerow/index.h>
#include <hedgerow/parallel/fixed_sums.h>
#include <hedgerow/primitives/point_cloud.h>
#include <hedgerow/structures/kdtree/point_kdtree.h>

#include "rows.h"

namespace hedgerow {

namespace {

/// What a particle adds to the conserved sums: kinetic and potential energy, momentum, angular momentum.
std::array<double, 8> share_of(const MotionState& state, std::size_t i) {
    const Particles& all = state.particles;
    const Vec3d momentum = all.velocities[i] * all.masses[i], angular = cross(all.places[i], momentum);
    return {dot(momentum, all.velocities[i]) / 2,
            all.masses[i] * state.potentials[i] / 2,
            momentum[0],
            momentum[1],
            momentum[2],
            angular[0],
            angular[1],
            angular[2]};
}

}  // namespace

Conserved conserved(const MotionState& state, Threads threads) {
    const std::size_t n = state.particles.size();
    const auto sums =
        fixed_sums<8>(n, threads.over(n / 4), [&](std::size_t i) { return share_of(state, i); });
    return {sums[0], sums[1], {sums[2], sums[3], sums[4]}, {sums[5], sums[6], sums[7]}};
}

double usual_softening(const Particles& all) {
    constexpr std::size_t others = 8;
    if (all.size() <= others) return 0;
    const PointCloudView<double, 3> cloud(all.places);
    const auto index = build<PointKdTree>(cloud);
    std::vector<double> distances;
    std::vector<Near<double, 3>> near;
    for (std::size_t i = 0; i < all.size(); i += std::max<std::size_t>(1, all.size() / 1000)) {
        nearest(index, all.places[i], others + 1, near);
        distances.push_back(std::sqrt(near.back().distance2));
    }
    const auto middle = distances.begin() + static_cast<std::ptrdiff_t>(distances.size() / 2);
    std::nth_element(distances.begin(), middle, distances.end());
    return 0.28 * *middle;
}

namespace {

/// The acceleration that all but a thousandth of the particles stay below.
double usual_acceleration(const MotionState& state) {
    std::vector<double> sizes;
    for (const Vec3d& a : state.accelerations) sizes.push_back(length(a));
    if (sizes.empty()) return 0;
    const auto most =
        sizes.begin() + static_cast<std::ptrdiff_t>(static_cast<double>(sizes.size() - 1) * 0.999);
    std::nth_element(sizes.begin(), most, sizes.end());
    return *most;
}
/// The least time in which a particle and one of its eight nearest turn around or pass each other. Particles
/// in one place do not act on each other.
double least_pair_time(const Particles& all, double gravity) {
    const PointCloudView<double, 3> cloud(all.places);
    const auto index = build<PointKdTree>(cloud);
    std::vector<Near<double, 3>> near;
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < all.size(); ++i) {
        nearest(index, all.places[i], std::min<std::size_t>(9, all.size()), near);
        for (const auto& other : near) {
            const double r = std::sqrt(other.distance2);
            if (!(r > 0)) continue;
            const double mass = std::abs(all.masses[i]) + std::abs(all.masses[other.primitive]),
                         speed = length(all.velocities[i] - all.velocities[other.primitive]);
            least = std::min({least, r * std::sqrt(r / (gravity * mass)), r / speed});
        }
    }
    return least;
}

}  // namespace

double usual_step(const MotionState& state, double softening, double eta, double gravity) {
    const double step = softening > 0 ? std::sqrt(2 * eta * softening / usual_acceleration(state))
                                      : eta * least_pair_time(state.particles, gravity);
    return step > 0 && step < 0x1p60 ? std::ldexp(1.0, std::ilogb(step)) : 1;
}

BareSteps::BareSteps(const MotionState& start, const MotionOptions& options, double dt) {
    const Conserved sums = conserved(start);
    const auto& masses = start.particles.masses;
    if (options.softening.length > 0 || options.period > 0 || !(sums.potential < 0) ||
        std::ranges::any_of(masses, [](double mass) { return mass < 0; }))
        throw UsageError("bare steps need masses that attract each other, without softening and period");
    size = -sums.potential * dt, binding = -sums.energy();
}

Motion::Motion(Particles start, const MotionOptions& options, Threads threads)
    : Motion(MotionState{0, std::move(start), {}, {}}, options, threads) {}

Motion::Motion(MotionState saved, const MotionOptions& options, Threads threads)
    : state_(std::move(saved)), options_(options), threads_(threads) {
    const std::size_t n = state_.particles.size();
    if (state_.particles.velocities.size() != n || state_.particles.masses.size() != n)
        throw InputError(std::to_string(n) + " places, " +
                         std::to_string(state_.particles.velocities.size()) + " velocities and " +
                         std::to_string(state_.particles.masses.size()) +
                         " masses: give one of each a particle");
    known_ = state_.accelerations.size() == n && state_.potentials.size() == n;
    if (known_) return;
    state_.accelerations.assign(n, Vec3d()), state_.potentials.assign(n, 0);
    accelerate();
}

void Motion::step(double dt) {
    kick(dt / 2);
    drift(dt);
    state_.time += dt;
    accelerate();
    kick(dt / 2);
}

// A leapfrog of the Hamiltonian log(T + binding) − log U, whose own time is `size` a step: kicks last size/2
// over U, drifts size over (T + binding), which is U but for errors. Both sides depend on what they leave
// unchanged.
void Motion::bare_step(const BareSteps& steps, double until) {
    const Conserved before = conserved(state_, threads_);
    const double depth = -before.potential, sum = before.kinetic + steps.binding,
                 rest = sum > 0 ? sum : depth;
    // After a kick of length k the drift lasts size/(rest + k·slope + k²·bend).
    double slope = 0, bend = 0, size = steps.size;
    for (std::size_t i = 0; i < state_.particles.size(); ++i) {
        const Vec3d pull = state_.accelerations[i] * state_.particles.masses[i];
        slope += dot(pull, state_.particles.velocities[i]), bend += dot(pull, state_.accelerations[i]) / 2;
    }
    const auto drift_of = [&](double s) {
        const double k = s / (2 * depth);
        return s / (rest + k * (slope + k * bend));
    };
    while (drift_of(size) <= 0) size /= 2;  // errors of the energy may be larger than U
    // Shorten a step that would end beyond the time: the drift of the lesser root lasts until then.
    const double left = until - state_.time;
    const bool last = !(drift_of(size) < left);
    if (last) {
        const double a = left * bend / (4 * depth * depth), b = 1 - left * slope / (2 * depth);
        size = 2 * left * rest / (b + std::sqrt(std::max(0.0, b * b - 4 * a * left * rest)));
    }
    const double dt = last ? left : drift_of(size);
    kick(size / (2 * depth));
    drift(dt);
    state_.time = last ? until : state_.time + dt;
    accelerate();
    kick(size / (-2 * conserved(state_, threads_).potential));
}

std::uint64_t Motion::block_step(double dt, const BlockSteps& steps) {
    if (!(options_.softening.length > 0))
        throw UsageError("block steps need a length of softening: their lengths are √(2·eta·length/|a|)");
    const std::size_t n = state_.particles.size();
    const std::uint64_t whole = std::uint64_t{1} << steps.deepest;  // ticks of the shortest step in dt
    const double start = state_.time, tick = dt / static_cast<double>(whole);
    std::vector<int> depth(n);
    Ids active(n);
    for (std::size_t i = 0; i < n; ++i) {
        active[i] = static_cast<std::uint32_t>(i);
        depth[i] = depth_of(i, dt, steps);
    }
    std::uint64_t found = 0;
    for (std::uint64_t now = 0; now < whole;) {
        kick(active, depth, dt / 2);
        // Drift to where the shortest of all steps ends: their ends are multiples of their lengths.
        const int deepest = n > 0 ? *std::max_element(depth.begin(), depth.end()) : 0;
        const std::uint64_t shortest = whole >> deepest;
        now += shortest;
        drift(tick * static_cast<double>(shortest));
        state_.time = start + tick * static_cast<double>(now);
        active.clear();
        for (std::size_t i = 0; i < n; ++i)
            if (now % (whole >> depth[i]) == 0) active.push_back(static_cast<std::uint32_t>(i));
        accelerate(active);
        kick(active, depth, dt / 2);
        found += active.size();
        // A step may grow shorter at any of its ends, and longer where the longer one begins.
        for (const std::uint32_t i : active) {
            int next = depth_of(i, dt, steps);
            while (next < depth[i] && now % (whole >> next) != 0) ++next;
            depth[i] = next;
        }
    }
    state_.time = start + dt;
    return found;
}

int Motion::depth_of(std::size_t i, double dt, const BlockSteps& steps) const {
    const double size = length(state_.accelerations[i]);
    const double most = std::sqrt(2 * steps.eta * options_.softening.length / size);
    int depth = 0;
    while (depth < steps.deepest && std::ldexp(dt, -depth) > most) ++depth;
    return depth;
}

void Motion::accelerate() {
    Ids all(state_.particles.size());
    for (std::size_t i = 0; i < all.size(); ++i) all[i] = static_cast<std::uint32_t>(i);
    accelerate(all);
}
void Motion::accelerate(const Ids& active) {
    const Particles& all = state_.particles;
    const Charges<double> charges{all.places, all.masses, options_.softening, {}, options_.period};
    ForceOptions options{.accuracy = options_.accuracy, .threads = threads_};
    std::vector<double> sizes;
    if (known_)
        for (const std::uint32_t i : active)
            sizes.push_back(length(state_.accelerations[i]) / options_.gravity);
    known_ = true;
    options.sizes = sizes;
    std::vector<PotentialAt<double>> found(active.size());
    if (active.size() == all.size()) {
        forces(charges, std::span(found), options);
    } else {
        std::vector<Vec3d> places;
        std::vector<double> lengths(active.size(), options_.softening.length), masses;
        for (const std::uint32_t i : active) places.push_back(all.places[i]), masses.push_back(all.masses[i]);
        forces(charges, Targets<double>(places, lengths, masses), std::span(found), options);
    }
    for (std::size_t k = 0; k < active.size(); ++k) {
        state_.accelerations[active[k]] = found[k].gradient * options_.gravity;
        state_.potentials[active[k]] = -found[k].potential * options_.gravity;
    }
}

void Motion::kick(double dt) {
    Particles& all = state_.particles;
    for (std::size_t i = 0; i < all.size(); ++i) all.velocities[i] += state_.accelerations[i] * dt;
}
void Motion::kick(const Ids& active, const std::vector<int>& depth, double half_dt) {
    for (const std::uint32_t i : active)
        state_.particles.velocities[i] += state_.accelerations[i] * std::ldexp(half_dt, -depth[i]);
}
void Motion::drift(double dt) {
    Particles& all = state_.particles;
    for (std::size_t i = 0; i < all.size(); ++i) {
        Vec3d& place = all.places[i];
        place += all.velocities[i] * dt;
        if (options_.period > 0)
            for (int k = 0; k < 3; ++k) place[k] = detail::in_period(place[k], options_.period);
    }
}

}  // namespace hedgerow
