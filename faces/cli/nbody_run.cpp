/// hedgerow nbody --until: moves particles, with snapshots, a log and pictures in a folder.
#include <algorithm>
#include <cmath>
#include <memory>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <hedgerow/base/error.h>
#include <hedgerow/io/particle_file.h>

#include "density_picture.h"
#include "nbody.h"
#include "nbody_steps.h"
#include "picture_notes.h"
#include "run_folder.h"
#include "view.h"

namespace hedgerow::cli {

namespace {

using nlohmann::ordered_json;

constexpr std::string_view log_columns =
    "step,time,kinetic,potential,energy,virial_ratio,momentum,angular_momentum,forces,seconds";

/// What run.json holds: all that a run goes on with, beside its snapshots.
ordered_json options_of(const NbodyArguments& a, const DensityFrame& frame) {
    return {{"scene", a.scene},
            {"seed", a.seed},
            {"accuracy", a.accuracy},
            {"softening", a.softening},
            {"kernel", a.kernel},
            {"gravity", a.gravity},
            {"period", a.period},
            {"dt", a.dt},
            {"bare", {{"size", a.bare.size}, {"binding", a.bare.binding}}},
            {"block_steps", a.block_steps},
            {"eta", a.eta},
            {"every", a.every},
            {"snapshots", a.snapshots},
            {"size", a.size},
            {"frame",
             {{"x", frame.middle[0]},
              {"y", frame.middle[1]},
              {"half_height", frame.half_height},
              {"most", frame.most}}}};
}
void read_options(const RunFolder& folder, NbodyArguments& a, DensityFrame& frame) {
    folder.read_options([&](const ordered_json& options) {
        a.scene = options.at("scene"), a.seed = options.at("seed"), a.accuracy = options.at("accuracy");
        a.softening = options.at("softening"), a.kernel = options.at("kernel"),
        a.gravity = options.at("gravity");
        a.period = options.value("period", 0.0);
        a.dt = options.at("dt"), a.block_steps = options.at("block_steps"), a.eta = options.at("eta");
        if (const auto bare = options.find("bare"); bare != options.end())
            a.bare.size = bare->at("size"), a.bare.binding = bare->at("binding");
        a.every = options.at("every"), a.size = options.at("size");
        a.snapshots = options.value("snapshots", "npy");
        const auto& of_frame = options.at("frame");
        frame = {{of_frame.at("x"), of_frame.at("y")}, of_frame.at("half_height"), of_frame.at("most")};
    });
    folder.expect_lengths({a.every, a.dt});
}

class Recorder {
public:
    Recorder(const NbodyArguments& a, const RunFolder& folder, std::uint64_t step, const DensityFrame& frame)
        : folder_(folder),
          frame_(frame),
          log_(folder, log_columns, a.resume ? std::optional(step) : std::nullopt),
          period_(a.period),
          seed_(a.seed),
          began_(now()) {
        if (a.size != no_pictures) std::tie(width_, height_) = parse_size(a.size);
    }

    void line(std::uint64_t step, const MotionState& state, std::uint64_t found) {
        const Conserved sums = conserved(state);
        log_.line(fmt::format("{},{},{},{},{},{},{},{},{},{:.3f}", step, state.time, sums.kinetic,
                              sums.potential, sums.energy(), sums.virial_ratio(), length(sums.momentum),
                              length(sums.angular_momentum), found, now() - began_));
    }
    void snapshot(std::uint64_t step, const MotionState& state) {
        if (width_ > 0)
            save_png(folder_.picture(step),
                     density_picture(state.particles, frame_, width_, height_,
                                     {fmt::format("t = {:.4g}", state.time),
                                      fmt::format("{} particles", state.particles.size())}),
                     {}, picture_notes(seed_));
        // Last: a run goes on behind its last snapshot, and makes what comes before it again.
        save_state(folder_.snapshot(step), state, period_);
    }

private:
    const RunFolder& folder_;
    const DensityFrame& frame_;
    RunLog log_;
    double period_;
    std::uint64_t seed_;
    double began_;
    int width_ = 0, height_ = 0;
};

/// Warns of a change of the energy that no motion has.
void warn_of_energy(const Conserved& first, const Conserved& last) {
    const double share = std::abs(last.energy() - first.energy()) /
                         std::max(std::abs(first.energy()), std::abs(first.potential));
    if (share > 0.1)
        fmt::print(
            stderr,
            "hedgerow: warning: the energy changed much: particles came too close for the steps. Give a "
            "shorter --dt, or a length of --softening\n");
}

int print_summary(const NbodyArguments& a, const Conserved& first, const MotionState& state,
                  std::uint64_t step, std::uint64_t found, double seconds) {
    const Conserved last = conserved(state);
    // The potential's mean in a periodic cube is 0, and the energy may be anything.
    const double unit = a.period > 0 ? last.kinetic : std::abs(first.energy());
    const double error = unit > 0 ? std::abs(last.energy() - first.energy()) / unit : 0;
    if (a.period == 0) warn_of_energy(first, last);
    if (a.json)
        print_json({{"output", a.output},
                    {"particles", state.particles.size()},
                    {"time", state.time},
                    {"step", step},
                    {"dt", a.dt},
                    {"softening", a.softening},
                    {"energy", last.energy()},
                    {"energy_error", error},
                    {"virial_ratio", last.virial_ratio()},
                    {"forces", found},
                    {"seconds", seconds}});
    else if (!a.quiet)
        fmt::print(
            "{}: {} particles to time {:g} by {}{:g} (softening {:.3g}, accuracy {:g})\n"
            "energy {:.6g}, changed by {:.1e} of {}; virial ratio {:.3f}; "
            "{:.3g} million forces in {:.1f} s\n",
            a.output, state.particles.size(), state.time,
            a.block_steps     ? "steps of at most "
            : a.bare.size > 0 ? "steps that follow the potential energy, the first of "
                              : "steps of ",
            a.dt, a.softening, a.accuracy, last.energy(), error, a.period > 0 ? "the kinetic one" : "itself",
            last.virial_ratio(), static_cast<double>(found) / 1e6, seconds);
    return interrupted ? 130 : 0;
}

}  // namespace

int nbody_run(NbodyArguments a) {
    RunFolder folder(a.output);
    const double began = now();
    DensityFrame frame;
    MotionState start;
    std::uint64_t step = 0;
    if (a.resume) {
        read_options(folder, a, frame);
        folder.hold(a.snapshots);
        step = folder.last_step();
        start = load_state(folder.snapshot(step));
    } else {
        folder.expect_none();
        folder.hold(a.snapshots);
        if (a.size != no_pictures) check_memory_of_pixels(a.size, memory_of_density_pixel);
        start = load_particles(a);
        // Those of a snapshot are of its own gravity, softening and period.
        start.accelerations.clear(), start.potentials.clear();
        folder.make();
        a.softening = softening_of(a, start.particles).length;
    }
    // Find the first accelerations, and what follows from them.
    const bool first = !a.resume;
    const MotionOptions options{a.accuracy, softening_of(a, start.particles), a.gravity, a.period};
    Motion motion(std::move(start), options);
    const Conserved before = conserved(motion.state());
    if (first) {
        choose_steps(a, motion.state(), options);
        if (a.every <= 0) a.every = 10 * a.dt;  // of a run that ends at 0, which may go on
        if (a.size != no_pictures) {
            const auto [width, height] = parse_size(a.size);
            frame = DensityFrame::around(motion.state().particles, width, height, a.period);
        }
    }
    Recorder recorder(a, folder, step, frame);
    if (first) {
        recorder.line(0, motion.state(), motion.state().particles.size());
        recorder.snapshot(0, motion.state());
        folder.save_options(options_of(a, frame));
    }
    Stepper stepper(a, motion);
    std::uint64_t found = 0;
    const double from = motion.state().time;
    step = go_on({.doing = "moving particles",
                  .finished = [&] { return stepper.finished(); },
                  .step =
                      [&](std::uint64_t number) {
                          const std::uint64_t of_step = stepper.step(number);
                          found += of_step;
                          recorder.line(number, motion.state(), of_step);
                          return stepper.wants_snapshot();
                      },
                  .snapshot = [&](std::uint64_t number) { recorder.snapshot(number, motion.state()); },
                  .share = [&] { return (motion.state().time - from) / (a.until - from); }},
                 step, a.quiet);
    return print_summary(a, before, motion.state(), step, found, now() - began);
}

}  // namespace hedgerow::cli
