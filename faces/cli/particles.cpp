/// hedgerow particles: a particle system before a mesh, with snapshots, a log and pictures in a folder.
#include "particles.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <hedgerow/base/error.h>

#include "picture_notes.h"
#include "run_folder.h"
#include "snapshot_rows.h"
#include "verbs.h"

namespace hedgerow::cli {

namespace {

constexpr std::string_view columns_of_particles_log = "step,time,particles,emitted,mean_speed,seconds";

/// Calls f(name, number) for the columns of a particle in a snapshot.
template <class State, class F>
void each_column(State& s, std::size_t i, F&& f) {
    auto &place = s.particles.places[i], &velocity = s.particles.velocities[i];
    f("x", place.data[0]), f("y", place.data[1]), f("z", place.data[2]);
    f("vx", velocity.data[0]), f("vy", velocity.data[1]), f("vz", velocity.data[2]);
    f("mass", s.particles.masses[i]), f("age", s.ages[i]), f("life", s.lives[i]), f("radius", s.radii[i]);
    f("number", s.numbers[i]);
}
void resize(ParticleState& s, std::size_t count) {
    s.particles.resize(count);
    s.ages.resize(count), s.lives.resize(count), s.radii.resize(count), s.numbers.resize(count);
}
ColumnList snapshot_columns() {
    ColumnList list;
    ParticleState one;
    resize(one, 1);
    each_column(one, 0, list);
    return list;
}

void save_snapshot(const std::filesystem::path& path, const ParticleState& state) {
    save_snapshot_rows(path, snapshot_columns(), state.size(), [&](std::size_t i, Record& record) {
        each_column(state, i, [&](const char* name, auto number) { record(name, number); });
    });
}
ParticleState load_snapshot(const std::filesystem::path& path, double time) {
    ParticleState state;
    state.time = time;
    load_snapshot_rows(path, snapshot_columns(), [&](const double* next) {
        const std::size_t i = state.size();
        resize(state, i + 1);
        each_column(state, i, [&]<class N>(const char*, N& number) {
            // A number of 2^53 or more, or one below 0, is none that a run wrote.
            if constexpr (std::is_same_v<N, std::uint64_t>)
                if (!(*next >= 0 && *next < 0x1p53))
                    throw InputError(path.string() + ": the number of a particle is " +
                                     fmt::format("{}", *next));
            number = static_cast<N>(*next++);
        });
    });
    return state;
}

/// What run.json holds. `visit` is called with the name and the value of each option.
template <class Arguments, class Visit>
void each_option(Arguments& a, Visit visit) {
    visit("scene", a.scene), visit("seed", a.seed), visit("drop_bad", a.drop_bad), visit("emit", a.emit);
    visit("rate", a.rate), visit("life", a.life), visit("speed", a.speed), visit("spread", a.spread);
    visit("radius", a.radius), visit("gravity", a.gravity), visit("drag", a.drag), visit("wind", a.wind);
    visit("restitution", a.restitution), visit("friction", a.friction), visit("alone", a.alone);
    visit("no_floor", a.no_floor), visit("dt", a.dt), visit("every", a.every), visit("colour", a.colour);
    visit("size", a.view.size), visit("eye", a.view.eye), visit("target", a.view.target);
    visit("up", a.view.up), visit("fov", a.view.fov);
}

double mean_speed(const ParticleState& state) {
    double sum = 0;
    for (const Vec3d& v : state.particles.velocities) sum += length(v);
    return state.size() > 0 ? sum / static_cast<double>(state.size()) : 0;
}

/// The files that a run writes as it goes on.
class ParticlesRecorder {
public:
    ParticlesRecorder(const ParticlesArguments& a, const RunFolder& folder, std::uint64_t step,
                      const ParticlesScene& scene)
        : folder_(folder),
          picture_(picture_of(a, scene)),
          log_(folder, columns_of_particles_log, a.resume ? std::optional(step) : std::nullopt),
          seed_(a.seed),
          began_(now()) {}
    void line(std::uint64_t step, const ParticleSystem& system) {
        const ParticleState& state = system.state();
        log_.line(fmt::format("{},{},{},{},{},{:.3f}", step, state.time, state.size(), system.emitted(),
                              mean_speed(state), now() - began_));
    }
    void snapshot(std::uint64_t step, const ParticleState& state) {
        if (picture_) save_png(folder_.picture(step), picture_->draw(state), {}, picture_notes(seed_));
        // Last: a run goes on behind its last snapshot, and makes what comes before it again.
        save_snapshot(folder_.snapshot(step), state);
    }

private:
    static std::optional<ParticlesPicture> picture_of(const ParticlesArguments& a,
                                                      const ParticlesScene& scene) {
        std::optional<ParticlesPicture> picture;
        if (a.view.size != no_pictures) picture.emplace(a, scene);
        return picture;
    }

    const RunFolder& folder_;
    std::optional<ParticlesPicture> picture_;
    RunLog log_;
    std::uint64_t seed_;
    double began_;
};

void expect_numbers(const CLI::App& verb) {
    for (const char* name : {"--rate", "--life", "--speed", "--spread", "--radius", "--gravity", "--drag",
                             "--restitution", "--until", "--every", "--dt"}) {
        const auto* const option = verb.get_option(name);
        if (option->count() == 0) continue;
        const double number = option->as<double>();
        const bool positive = std::string_view("--life --every --dt").find(name) != std::string_view::npos;
        if (!(positive ? number > 0 : number >= 0) || !(number < 1e300))
            throw UsageError(fmt::format("{} {:g}: give a number {}", name, number,
                                         positive ? "above 0" : "of 0 or more"));
    }
}

}  // namespace

int particles_run(ParticlesArguments a) {
    RunFolder folder(a.output);
    const double began = now();
    std::uint64_t step = 0;
    if (a.resume) {
        folder.read_options([&](const nlohmann::ordered_json& options) {
            each_option(a, [&](const char* name, auto& value) { options.at(name).get_to(value); });
            if (a.wind.size() != 3)
                throw InputError(folder.options().string() + ": the wind has no three numbers");
        });
        step = folder.last_step();
    } else {
        folder.expect_none();
        if (a.view.size != no_pictures) check_picture_memory(a.view.size, false);
    }
    const ParticlesScene scene(a);
    folder.expect_lengths({a.every, a.dt});
    // Steps end at snapshots, and are of one length. The time of step i is i·dt.
    const std::uint64_t steps_between =
        static_cast<std::uint64_t>(std::max(1.0, std::ceil(std::min(a.every / a.dt, 1e15) - 1e-6)));
    a.dt = a.every / static_cast<double>(steps_between);
    const auto time_of = [&](std::uint64_t i) { return static_cast<double>(i) * a.dt; };
    const auto last = static_cast<std::uint64_t>(std::ceil(std::min(a.until / a.dt, 1e15) - 1e-6));
    ParticleSystem system(scene.options, &scene.index,
                          a.resume ? load_snapshot(folder.snapshot(step), time_of(step)) : ParticleState());
    ParticlesRecorder recorder(a, folder, step, scene);
    if (!a.resume) {
        recorder.line(0, system);
        recorder.snapshot(0, system.state());
        nlohmann::ordered_json options;
        each_option(a, [&](const char* name, const auto& value) { options[name] = value; });
        folder.save_options(options);
    }
    std::uint64_t moved = 0;
    const double from = system.state().time;
    step = go_on({.doing = "moving particles",
                  .finished = [&] { return !(system.state().time < time_of(last)); },
                  .step =
                      [&](std::uint64_t number) {
                          system.step_until(time_of(number));
                          moved += system.state().size();
                          recorder.line(number, system);
                          return number % steps_between == 0;
                      },
                  .snapshot = [&](std::uint64_t number) { recorder.snapshot(number, system.state()); },
                  .share = [&] { return (system.state().time - from) / (time_of(last) - from); }},
                 step, a.quiet);
    const ParticleState& state = system.state();
    const double seconds = now() - began;
    if (a.json)
        print_json({{"output", a.output},
                    {"time", state.time},
                    {"step", step},
                    {"dt", a.dt},
                    {"particles", state.size()},
                    {"emitted", system.emitted()},
                    {"mean_speed", mean_speed(state)},
                    {"particle_steps", moved},
                    {"seconds", seconds}});
    else if (!a.quiet)
        fmt::print(
            "{}: {} particles at time {:.4g} of {} emitted, by steps of {:.3g}; "
            "{:.3g} million particle steps in {:.1f} s\n{}",
            a.output, state.size(), state.time, system.emitted(), a.dt, static_cast<double>(moved) / 1e6,
            seconds, up_text(a.view, a, scene.upright));
    return interrupted ? 130 : 0;
}

Run add_particles(CLI::App& verb) {
    auto a = std::make_shared<ParticlesArguments>();
    verb.add_option("scene", a->scene, "a mesh of triangles: a file, or gen:NAME[:SIZE]");
    verb.add_option("-o,--output", a->output, "the folder of the run");
    verb.add_option("--emit", a->emit,
                    "fountain (from above the mesh, upward), rain (from over all of it) or sparks (from its "
                    "surface)")
        ->capture_default_str()
        ->check(CLI::IsMember({"fountain", "rain", "sparks"}));
    verb.add_option("--rate", a->rate, "particles per time");
    verb.add_option("--life", a->life, "of a particle; that of sparks varies by a half");
    verb.add_option("--speed", a->speed, "of new particles");
    verb.add_option("--spread", a->spread, "the largest angle of their directions, in degrees");
    verb.add_option("--radius", a->radius, "of particles; 0: points");
    verb.add_option("--gravity", a->gravity, "acceleration downward; else 4 times the scene's diagonal");
    verb.add_option("--drag", a->drag, "of the air, per time and speed relative to --wind");
    verb.add_option("--wind", a->wind, "x,y,z: the velocity of the air")->delimiter(',')->expected(3);
    verb.add_option("--restitution", a->restitution, "speed after a contact over speed before it, 0 to 1");
    verb.add_option("--friction", a->friction, "Coulomb's coefficient")
        ->capture_default_str()
        ->check(CLI::NonNegativeNumber);
    verb.add_flag("--alone", a->alone, "particles pass through each other, as sparks do");
    verb.add_flag("--no-floor", a->no_floor, "no floor below the mesh");
    verb.add_option(
        "--until", a->until,
        "the time at which the run ends; else 8 times that of a fall about as deep as the mesh is large");
    verb.add_option("--every", a->every, "the time between snapshots; else an eighth of the whole");
    verb.add_option("--dt", a->dt, "the longest step; else a hundredth of the time of such a fall");
    verb.add_flag("--resume", a->resume, "go on from the last snapshot in the folder of -o, to --until");
    verb.add_option("--colour", a->colour,
                    "of particles: by their speed, or by their age, which glow (as sparks)")
        ->check(CLI::IsMember({"age", "speed"}));
    verb.add_option("--size", a->view.size, "of the pictures, WIDTHxHEIGHT; 0x0: no pictures")
        ->capture_default_str();
    add_camera(verb, a->view);
    verb.add_option("--threads", a->threads, "0: all")->capture_default_str();
    add_reporting(verb, *a);
    add_drop_bad(verb, *a);
    return [a, &verb] {
        expect_numbers(verb);
        if (a->resume) expect_no_options_of_a_run(verb);
        if (a->scene.empty() && !a->resume) throw UsageError("name the mesh: gen:teapot, or a file");
        if (a->output.empty()) throw UsageError("name the folder of the run: -o run");
        if (a->resume && a->until < 0) throw UsageError("--resume: say until when, as --until 8");
        const ThreadLimit limit(a->threads);
        return particles_run(*a);
    };
}

}  // namespace hedgerow::cli
