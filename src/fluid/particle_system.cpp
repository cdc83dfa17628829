/// Births, steps and contacts of a particle system.
#include <hedgerow/fluid/particle_system.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <utility>

#include <hedgerow/ask/neighbours.h>
#include <hedgerow/base/error.h>
#include <hedgerow/geometry/elementary.h>
#include <hedgerow/nbody/contacts.h>
#include <hedgerow/parallel/ieee_executor.h>
#include <hedgerow/scenes/random.h>

#include "obstacle.h"

namespace hedgerow {
namespace {

void expect(bool good, const char* name, double given, const char* what) {
    if (!good)
        throw UsageError("particle system: " + std::string(name) + " is " + std::to_string(given) +
                         ": give " + what);
}
void expect_finite(const Vec3d& v, const char* name) {
    if (!finite(v))
        throw UsageError("particle system: " + std::string(name) +
                         " has a number that is not finite: give three finite ones");
}
bool sound(double x, double least = 0) {
    return x >= least && x <= largest_coordinate<double>;
}

void expect_sound(const ParticleEmitter& e) {
    expect(e.rate >= 0 && e.rate <= 0x1p40, "the rate of an emitter", e.rate,
           "a number of particles per time from 0 to 2^40");
    expect(std::abs(e.begin) <= largest_coordinate<double>, "the begin of an emitter", e.begin, "a time");
    expect(!(e.end != e.end), "the end of an emitter", e.end, "a time");
    expect_finite(e.direction, "the direction of an emitter");
    expect(max_component(abs(e.direction)) > 0, "the length of an emitter's direction", 0, "more than 0");
    expect(e.spread >= 0 && e.spread <= std::numbers::pi, "the spread of an emitter", e.spread,
           "an angle from 0 to pi");
    expect(sound(e.speed), "the speed of an emitter", e.speed, "0 or more");
    expect(e.speed_spread >= 0 && e.speed_spread <= e.speed, "the spread of speeds", e.speed_spread,
           "a number from 0 to the speed");
    expect(e.life > 0 && sound(e.life), "the life of an emitter's particles", e.life, "a time above 0");
    expect(e.life_spread >= 0 && e.life_spread < e.life, "the spread of lives", e.life_spread,
           "a number from 0 to below the life");
    expect(sound(e.radius), "the radius of an emitter's particles", e.radius, "0 or more");
    if (const auto* point = std::get_if<FromPoint>(&e.source))
        expect_finite(point->place, "a place of birth");
    if (const auto* disc = std::get_if<FromDisc>(&e.source)) {
        expect_finite(disc->middle, "a place of birth");
        expect(sound(disc->radius), "the radius of an emitter's disc", disc->radius, "0 or more");
    }
    if (const auto* from = std::get_if<FromBox>(&e.source)) {
        expect_finite(from->box.low, "an emitter's box"), expect_finite(from->box.high, "an emitter's box");
        expect(!from->box.empty(), "the size of an emitter's box", -1, "corners in order");
    }
}
void expect_sound(const ParticleSystemOptions& o) {
    for (const ParticleEmitter& emitter : o.emitters) {
        expect_sound(emitter);
        expect(!o.contacts.each_other || emitter.radius > 0, "the radius of particles that touch each other",
               emitter.radius, "a length above 0");
    }
    expect_finite(o.forces.gravity, "gravity"), expect_finite(o.forces.wind, "the wind");
    expect(sound(o.forces.linear_drag), "the linear drag", o.forces.linear_drag, "0 or more");
    expect(sound(o.forces.quadratic_drag), "the quadratic drag", o.forces.quadratic_drag, "0 or more");
    expect(o.contacts.restitution >= 0 && o.contacts.restitution <= 1, "the restitution",
           o.contacts.restitution, "a number from 0 to 1");
    expect(sound(o.contacts.friction), "the friction", o.contacts.friction, "0 or more");
}
void expect_sound(const ParticleState& s) {
    const std::size_t n = s.size();
    for (const std::size_t other : {s.particles.velocities.size(), s.particles.masses.size(), s.ages.size(),
                                    s.lives.size(), s.radii.size(), s.numbers.size()})
        if (other != n)
            throw InputError("particle system: a state of " + std::to_string(n) + " places has an array of " +
                             std::to_string(other) + ": give one of each a particle");
    for (std::size_t i = 0; i < n; ++i) {
        const bool good = max_component(abs(s.particles.places[i])) <= largest_coordinate<double> &&
                          max_component(abs(s.particles.velocities[i])) <= largest_coordinate<double> &&
                          finite(s.particles.places[i]) && finite(s.particles.velocities[i]) &&
                          s.particles.masses[i] > 0 && sound(s.particles.masses[i]) && sound(s.ages[i]) &&
                          sound(s.lives[i]) && sound(s.radii[i]);
        if (!good)
            throw InputError("particle system: particle " + std::to_string(i) +
                             " has a number that is not finite or out of its range: masses are above 0, "
                             "ages, lives and radii 0 or more");
    }
    if (!(std::abs(s.time) <= largest_coordinate<double>))
        throw InputError("particle system: the time of the state is " + std::to_string(s.time));
}

/// The sums of the triangles' areas, up to each of them. Throws InputError if there is no area.
std::vector<double> summed_areas(const TriangleMeshView<double>& mesh) {
    std::vector<double> sums;
    double sum = 0;
    for (std::size_t i = 0; i < mesh.size(); ++i) {
        const auto t = mesh.triangle(i);
        sums.push_back(sum += length(cross(t.b - t.a, t.c - t.a)) / 2);
    }
    if (!(sum > 0 && sum <= largest_coordinate<double>))
        throw InputError("particle system: the surface of an emitter has an area of " + std::to_string(sum) +
                         ": give triangles with an area");
    return sums;
}

double birth(const ParticleEmitter& e, std::uint64_t k) {
    return e.begin + static_cast<double>(k) / e.rate;
}
/// How many particles are born before a time: by bisection over the very numbers that births have.
std::uint64_t births_before(const ParticleEmitter& e, double time) {
    const double until = std::min(time, e.end);
    if (!(e.rate > 0 && birth(e, 0) < until)) return 0;
    constexpr std::uint64_t most = std::uint64_t(1) << 53;
    if (birth(e, most) < until)
        throw InputError(
            "particle system: an emitter would have given birth to more than 2^53 particles before "
            "the time " +
            std::to_string(time) + ": give a lower rate, or an earlier time");
    std::uint64_t before = 0, after = 1;
    while (birth(e, after) < until) before = after, after *= 2;
    while (after - before > 1) {
        const std::uint64_t middle = before + (after - before) / 2;
        (birth(e, middle) < until ? before : after) = middle;
    }
    return after;
}

/// Two directions across a direction of length 1, and across each other.
std::pair<Vec3d, Vec3d> across(const Vec3d& z) {
    const Vec3d other = std::abs(z[0]) < 0.5 ? Vec3d(1, 0, 0) : Vec3d(0, 1, 0);
    const Vec3d x = normalized(cross(other, z));
    return {x, cross(z, x)};
}
/// A direction within an angle of another, evenly by solid angle.
Vec3d direction_near(const Vec3d& z, double angle, Random& random) {
    const double turn = 2 * std::numbers::pi * random.uniform(),
                 height = 1 - product(random.uniform(), 1 - cosine(angle)),
                 width = std::sqrt(std::max(0.0, 1 - product(height, height)));
    const auto [x, y] = across(z);
    return x * product(width, cosine(turn)) + y * product(width, sine(turn)) + z * height;
}

/// A place of birth and the direction in which the emitter points there.
struct Start {
    Vec3d place, direction;
};
Start start_of(const ParticleEmitter& e, const std::vector<double>& areas, Random& random) {
    Start start{{}, detail::unit(e.direction)};
    if (const auto* point = std::get_if<FromPoint>(&e.source)) {
        start.place = point->place;
    } else if (const auto* disc = std::get_if<FromDisc>(&e.source)) {
        const auto [x, y] = across(start.direction);
        const double r = product(disc->radius, std::sqrt(random.uniform())),
                     turn = 2 * std::numbers::pi * random.uniform();
        start.place = disc->middle + x * product(r, cosine(turn)) + y * product(r, sine(turn));
    } else if (const auto* from = std::get_if<FromBox>(&e.source)) {
        for (int k = 0; k < 3; ++k) start.place[k] = random.uniform(from->box.low[k], from->box.high[k]);
    } else {
        const auto& mesh = std::get<FromSurface>(e.source).mesh;
        const auto at = std::upper_bound(areas.begin(), areas.end(), product(random.uniform(), areas.back()));
        const auto t = mesh.triangle(static_cast<std::size_t>(std::min(at, areas.end() - 1) - areas.begin()));
        // Even over the triangle: the square is folded along its diagonal.
        double u = random.uniform(), v = random.uniform();
        if (u + v > 1) u = 1 - u, v = 1 - v;
        start.place = t.a + (t.b - t.a) * u + (t.c - t.a) * v;
        start.direction = detail::unit_normal(t);
    }
    return start;
}

/// The velocity after a time. Drag slows the velocity u relative to the wind by du/dt = −(a + b·u)·u, so that
/// u(t) = u₀/(eᵃᵗ + b·u₀·(eᵃᵗ − 1)/a).
Vec3d accelerated(const Vec3d& velocity, double time, const ParticleForces& forces) {
    const double a = forces.linear_drag, b = forces.quadratic_drag;
    if (a == 0 && b == 0) return velocity + forces.gravity * time;
    const Vec3d kick = forces.gravity * (time / 2), u = velocity + kick - forces.wind;
    // (eˣ − 1)/x without a loss of digits (Kahan): the error of eˣ is in its logarithm too.
    const double grown = exponential(product(a, time));
    if (!(grown < std::numeric_limits<double>::infinity()))
        return forces.wind + kick;  // the air takes it along
    const double mean = grown == 1 ? 1 : (grown - 1) / logarithm(grown);
    const double slowed = grown + product(product(b, length(u)), product(mean, time));
    return forces.wind + u / slowed + kick;
}

/// Takes the velocity of a particle through a contact. Returns whether it bounces: slower ones than `slow`
/// come to rest on the surface.
bool respond(Vec3d& velocity, const Vec3d& normal, const ParticleContacts& contacts, double slow) {
    const double approach = -dot(velocity, normal);
    if (!(approach > 0)) return false;
    const double restitution = approach > slow ? contacts.restitution : 0;
    const Vec3d along = velocity + normal * approach;
    const double speed = length(along), rubbed = product(contacts.friction, (1 + restitution) * approach);
    velocity = (speed > rubbed ? along * (1 - rubbed / speed) : Vec3d()) + normal * (restitution * approach);
    return restitution > 0;
}

/// The flight of one particle through a step.
struct Flight {
    const detail::Obstacle& obstacle;
    const ParticleSystemOptions& options;
    double radius, slow;
    Vec3d place, velocity;

    void fly(double time) {
        // Legs are a sixteenth of the time or longer, but for contacts, which end them.
        constexpr int most_legs = 64;
        double left = time;
        for (int legs = 0; left > 0 && legs < most_legs; ++legs) left -= leg(left, time / 16);
    }

private:
    /// Flies for a time or a part of it, up to the first contact. Returns how long.
    double leg(double left, double shortest) {
        Vec3d after = accelerated(velocity, left, options.forces), way = (velocity + after) * (left / 2);
        const double far = length(way);
        double time = left;
        if (obstacle) {
            // Fly freely where the mesh is farther away than the particle comes.
            const double reach = std::max(radius, 2 * obstacle.margin(place, way));
            const auto near = obstacle.touch(place, far + reach);
            if (near) {
                // Near the mesh, a ball looks for contacts every half of its radius.
                const double clear = std::max(near->distance - reach, radius / 2);
                if (radius > 0 && clear < far)
                    time = std::min(left, std::max(left * (clear / far), shortest));
                if (time < left) {
                    after = accelerated(velocity, time, options.forces);
                    way = (velocity + after) * (time / 2);
                }
                return by_mesh(near->distance, way, after, time);
            }
        }
        place += way, velocity = after;
        return time;
    }
    /// Flies along a way from a place at a distance from the mesh.
    double by_mesh(double before, const Vec3d& way, const Vec3d& after, double time) {
        const Vec3d start = place;
        const double least = obstacle.margin(place, way);
        auto moved = obstacle.move(place, way, radius, before);
        auto touch = touched(least);
        if (touch && touch->distance < radius - least && before > radius + least) {
            // Go back to where the ball reached the mesh, as if its distance had shrunk evenly.
            const double share = moved.share * (before - radius) / (before - touch->distance);
            place = start;
            moved = obstacle.move(place, way * share, radius, before);
            moved.share *= share;
            touch = touched(least);
        }
        velocity += (after - velocity) * moved.share;
        double flown = time * moved.share;
        if (moved.ended && !respond(velocity, moved.normal, options.contacts, slow) && moved.share == 0) {
            // Slide along a surface on which the particle lies.
            velocity = after;
            respond(velocity, moved.normal, options.contacts, slow);
            obstacle.move(place, way - moved.normal * dot(way, moved.normal), radius);
            flown = time;
            touch = touched(least);
        }
        if (touch) {
            respond(velocity, touch->normal, options.contacts, slow);
            obstacle.push_out(place, radius);
        }
        return flown;
    }
    /// What the surface of the ball touches.
    std::optional<detail::Touch> touched(double least) const {
        return radius > 0 ? obstacle.touch(place, radius + least) : std::nullopt;
    }
};

}  // namespace

ParticleSystem::ParticleSystem(ParticleSystemOptions options, const MeshIndex<double>* mesh,
                               ParticleState start)
    : options_(std::move(options)), mesh_(mesh), state_(std::move(start)) {
    expect_sound(options_), expect_sound(state_);
    if (const detail::Obstacle obstacle(mesh_); obstacle)
        for (std::size_t i = 0; i < state_.size(); ++i)
            obstacle.release(state_.particles.places[i], state_.radii[i]);
    for (const ParticleEmitter& e : options_.emitters) {
        const auto* surface = std::get_if<FromSurface>(&e.source);
        areas_.push_back(surface != nullptr ? summed_areas(surface->mesh) : std::vector<double>());
    }
}

std::uint64_t ParticleSystem::emitted() const {
    std::uint64_t all = 0;
    for (const ParticleEmitter& e : options_.emitters) all += births_before(e, state_.time);
    return all;
}

void ParticleSystem::step(double dt, Threads threads) {
    expect(dt > 0 && sound(dt), "the length of a step", dt, "a time above 0");
    step_until(state_.time + dt, threads);
}
void ParticleSystem::step_until(double time, Threads threads) {
    const double dt = time - state_.time;
    expect(dt > 0 && sound(dt), "the length of a step", dt, "a time above 0");
    in_ieee_mode([&] {
        flights_.assign(state_.size(), dt);
        emit(time);
        IeeeExecutor executor(threads.over(state_.size()));
        executor.for_each_piece(state_.size(), 256, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) move(i, dt, flights_[i]);
        });
        state_.time = time;
        remove_dead();
        if (options_.contacts.each_other && state_.size() > 1) {
            bounce(state_.particles, state_.radii, options_.contacts.restitution, threads);
            separate(threads);
        }
    });
}

void ParticleSystem::emit(double until) {
    std::uint64_t number = emitted();
    const detail::Obstacle obstacle(mesh_);
    for (std::size_t e = 0; e < options_.emitters.size(); ++e) {
        const ParticleEmitter& emitter = options_.emitters[e];
        const std::uint64_t end = births_before(emitter, until);
        for (std::uint64_t k = births_before(emitter, state_.time); k < end; ++k) {
            // The numbers of a particle depend on its emitter and k alone.
            Random random(scattered(options_.seed + e), k);
            Start start = start_of(emitter, areas_[e], random);
            const Vec3d direction = direction_near(start.direction, emitter.spread, random);
            const double speed = random.uniform(emitter.speed - emitter.speed_spread,
                                                emitter.speed + emitter.speed_spread),
                         life = random.uniform(emitter.life - emitter.life_spread,
                                               emitter.life + emitter.life_spread);
            if (obstacle) obstacle.release(start.place, emitter.radius);
            state_.particles.places.push_back(start.place);
            state_.particles.velocities.push_back(direction * speed);
            const double r = emitter.radius;
            state_.particles.masses.push_back(r > 0 ? product(product(r, r), r) : 1);
            state_.ages.push_back(0), state_.lives.push_back(life), state_.radii.push_back(r);
            state_.numbers.push_back(number++);
            flights_.push_back(std::min(until - state_.time, until - birth(emitter, k)));
        }
    }
}

void ParticleSystem::move(std::size_t i, double dt, double flight) {
    const detail::Obstacle obstacle(mesh_);
    Particles& all = state_.particles;
    Flight one{obstacle,      options_,         state_.radii[i], 2 * length(options_.forces.gravity) * dt,
               all.places[i], all.velocities[i]};
    one.fly(flight);
    all.places[i] = one.place, all.velocities[i] = one.velocity;
    state_.ages[i] += flight;
}

void ParticleSystem::separate(Threads threads) {
    Particles& all = state_.particles;
    const auto& radii = state_.radii;
    NearLists<double> near;
    neighbours_within(all.places, 2 * *std::max_element(radii.begin(), radii.end()), near,
                      {.distances = true, .threads = threads});
    // Add up all pushes before any ball moves, so that the order of the balls does not matter.
    std::vector<Vec3d> pushes(all.size());
    const detail::Obstacle obstacle(mesh_);
    IeeeExecutor executor(threads.over(all.size()));
    executor.for_each_piece(all.size(), 256, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i)
            for (std::size_t k = near.offsets[i]; k < near.offsets[i + 1]; ++k) {
                const std::size_t other = near.ids[k];
                const double distance = std::sqrt(near.distances2[k]),
                             overlap = radii[i] + radii[other] - distance;
                if (!(overlap > 0 && distance > 0)) continue;
                const double share = all.masses[other] / (all.masses[i] + all.masses[other]);
                pushes[i] += (all.places[i] - all.places[other]) * (share * overlap / (2 * distance));
            }
    });
    executor.for_each_piece(all.size(), 256, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            if (pushes[i] == Vec3d()) continue;
            if (!obstacle) {
                all.places[i] += pushes[i];
                continue;
            }
            obstacle.move(all.places[i], pushes[i], radii[i]);
            obstacle.push_out(all.places[i], radii[i]);
        }
    });
}

void ParticleSystem::remove_dead() {
    Particles& all = state_.particles;
    std::size_t alive = 0;
    for (std::size_t i = 0; i < all.size(); ++i) {
        // Particles beyond all coordinates are dead too. NaN compares false.
        const bool lives = state_.ages[i] < state_.lives[i] && finite(all.places[i]) &&
                           finite(all.velocities[i]) &&
                           max_component(abs(all.places[i])) <= largest_coordinate<double> &&
                           max_component(abs(all.velocities[i])) <= largest_coordinate<double>;
        if (!lives) continue;
        const auto keep = [&](auto& array) { array[alive] = array[i]; };
        keep(all.places), keep(all.velocities), keep(all.masses);
        keep(state_.ages), keep(state_.lives), keep(state_.radii), keep(state_.numbers);
        ++alive;
    }
    all.resize(alive);
    state_.ages.resize(alive), state_.lives.resize(alive), state_.radii.resize(alive);
    state_.numbers.resize(alive);
}

}  // namespace hedgerow
