/// hedgerow nbody: forces between particles and their motion.
#include "nbody.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <hedgerow/base/error.h>
#include <hedgerow/io/particle_file.h>
#include <hedgerow/io/rows.h>
#include <hedgerow/nbody/force_check.h>
#include <hedgerow/nbody/forces.h>

#include "run_folder.h"
#include "verbs.h"

namespace hedgerow::cli {

MotionState load_particles(const NbodyArguments& a) {
    if (a.scene.starts_with("gen:")) {
        SceneSpec spec = parse_scene_spec(a.scene);
        spec.seed = a.seed;
        check_memory(spec);
        ProgressLine line("generating gen:" + spec.name, a.quiet, "particles");
        return {0, generate_particles(spec, line.progress()), {}, {}};
    }
    ProgressLine line("loading " + a.scene, a.quiet, "bytes");
    return load_state(a.scene, line.progress());
}

Softening softening_of(const NbodyArguments& a, const Particles& particles) {
    const SofteningKernel kernel = a.kernel == "spline" ? SofteningKernel::spline : SofteningKernel::wendland;
    return {kernel, a.softening < 0 ? usual_softening(particles) : a.softening};
}

int nbody_forces(const NbodyArguments& a) {
    const RowFormat format = row_format(a.output, a.format);
    const MotionState state = load_particles(a);
    const Particles& all = state.particles;
    NbodyArguments given = a;
    given.softening = std::max(0.0, a.softening);  // as points, unless a length is given
    const Charges<double> charges{all.places, all.masses, softening_of(given, all), {}, a.period};
    std::vector<Vec3d> targets;
    if (!a.from.empty()) {
        ProgressLine line("loading " + a.from, a.quiet, "bytes");
        targets = load_state(a.from, line.progress()).particles.places;
    }
    const std::size_t count = a.from.empty() ? all.size() : targets.size();
    std::vector<PotentialAt<double>> found(count);
    // A row a target.
    const auto list = [&](auto& f, const PotentialAt<double>& at) {
        f("potential", -a.gravity * at.potential);
        f("ax", a.gravity * at.gradient[0]), f("ay", a.gravity * at.gradient[1]);
        f("az", a.gravity * at.gradient[2]);
    };
    ColumnList columns;
    list(columns, {});
    RowWriter out(a.output, format, columns.all, count);  // fails before the work is done
    const double began = now();
    {
        ProgressLine line("finding forces", a.quiet, "particles");
        WatchedExecutor watched(default_executor(), line.progress());
        if (a.from.empty())
            forces<double>(charges, found, {.accuracy = a.accuracy, .threads = watched});
        else
            forces<double>(charges, Targets<double>(targets), found,
                           {.accuracy = a.accuracy, .threads = watched});
    }
    const double seconds = now() - began;
    std::string records;
    append_records(records, count, 4 * sizeof(double),
                   [&](std::size_t i, Record& record) { list(record, found[i]); });
    out.write(out.encode(std::move(records)), count);
    out.finish();
    std::optional<ForceErrors> errors;
    if (a.check) {
        ProgressLine line("checking forces", a.quiet, "particles");
        WatchedExecutor watched(default_executor(), line.progress());
        errors = ForceCheck(charges, 1000, watched).errors_of<double>(found);
    }
    const bool kept = !errors || (errors->rms <= a.accuracy && errors->most <= 10 * a.accuracy);
    const bool to_pipe = a.output == "-";
    if (a.json && !to_pipe) {
        nlohmann::ordered_json report = {{"output", a.output},
                                         {"particles", all.size()},
                                         {"targets", count},
                                         {"accuracy", a.accuracy},
                                         {"seconds", seconds}};
        if (errors)
            report["errors"] = {{"targets", errors->targets},           {"rms", errors->rms},
                                {"all_but_a_thousandth", errors->most}, {"largest", errors->largest},
                                {"imbalance", errors->imbalance},       {"kept", kept}};
        print_json(report);
    } else if (!a.quiet) {
        std::FILE* const to = to_pipe ? stderr : stdout;
        fmt::print(to,
                   "{}: {} rows of potential and acceleration, within {:g}, in {:.3f} s ({:.3g} million/s)\n",
                   a.output, count, a.accuracy, seconds, static_cast<double>(count) / seconds / 1e6);
        if (errors)
            fmt::print(
                to,
                "errors at {} of them: rms {:.1e}, all but a thousandth below {:.1e}, the largest {:.1e}; "
                "all forces add up to {:.1e} of the sum of their sizes\n",
                errors->targets, errors->rms, errors->most, errors->largest, errors->imbalance);
    }
    if (!kept)
        fmt::print(stderr,
                   "hedgerow: the accuracy of {:g} is not kept: rms errors are {:.1e} at {} of the "
                   "particles, all but "
                   "a thousandth of them below {:.1e}; ask for a smaller one\n",
                   a.accuracy, errors->rms, errors->targets, errors->most);
    return kept ? 0 : 1;
}

Run add_nbody(CLI::App& verb) {
    auto a = std::make_shared<NbodyArguments>();
    verb.add_option("scene", a->scene,
                    "particles: gen:plummer[:SIZE] and other stars, or a file of rows with columns x y z, "
                    "x y z mass, x y z vx vy vz mass, or a snapshot");
    verb.add_option("-o,--output", a->output,
                    "the file of forces, the folder of the run, or the plot of the comparison (.svg)");
    verb.add_flag("--forces", a->forces, "write potential and acceleration of every particle");
    verb.add_option("--from", a->from, "with --forces: at the places of this file instead");
    verb.add_flag("--check", a->check,
                  "with --forces: measure their errors at a thousand of the particles, by sums over all "
                  "pairs; exit code 1 if the "
                  "accuracy is not kept");
    verb.add_option("--format", a->format, "of the forces: npy, csv or json; else by the file's name");
    CLI::Option* const until = verb.add_option("--until", a->until, "move the particles until this time");
    CLI::Option* const dt =
        verb.add_option("--dt", a->dt,
                        "the step; else it follows from the softening and the accelerations, "
                        "and without softening from the pairs and the potential energy");
    verb.add_flag("--block-steps", a->block_steps,
                  "steps of each particle's own, of which --dt is the longest");
    verb.add_option("--eta", a->eta,
                    "of steps that are not given: they are sqrt(2 eta softening/|a|), and without softening "
                    "begin with eta sqrt(r^3/(G m)) of the fastest pair")
        ->capture_default_str();
    CLI::Option* const every =
        verb.add_option("--every", a->every, "the time between snapshots; else a tenth of the whole");
    verb.add_option("--snapshots", a->snapshots, "their format: npy, or hdf5 as GADGET lays it out")
        ->capture_default_str()
        ->check(CLI::IsMember({"npy", "hdf5"}));
    verb.add_flag("--resume", a->resume, "go on from the last snapshot in the folder of -o");
    verb.add_option("--size", a->size, "of the pictures, WIDTHxHEIGHT; 0x0: no pictures")
        ->capture_default_str();
    verb.add_flag("--compare", a->compare,
                  "time and error of direct sums, Barnes-Hut and fast multipoles, over numbers of particles");
    verb.add_option("--accuracy", a->accuracy, "rms error of the accelerations, from 1e-9 to 0.1")
        ->capture_default_str();
    CLI::Option* const softening = verb.add_option(
        "--softening", a->softening,
        "length of softening (as Plummer's); else that of moving particles is 0.28 times the distance to "
        "the eighth nearest other one, for a particle in the middle");
    verb.add_option("--kernel", a->kernel, "of the softening")
        ->capture_default_str()
        ->check(CLI::IsMember({"wendland", "spline"}));
    CLI::Option* const period = verb.add_option(
        "--period", a->period, "the side of a cube in which all repeats along each axis; else nothing does");
    verb.add_option("--gravity", a->gravity, "the constant of gravity")->capture_default_str();
    verb.add_option("--threads", a->threads, "0: all")->capture_default_str();
    add_reporting(verb, *a);
    return [a, &verb, until, dt, every, softening, period] {
        if (a->resume) expect_no_options_of_a_run(verb);
        const auto expect = [](const CLI::Option* option, double number, bool good, const char* what) {
            if (option->count() > 0 && !good)
                throw UsageError(fmt::format("{} {:g}: give {}", option->get_name(), number, what));
        };
        expect(until, a->until, a->until >= 0, "a time of 0 or more");
        expect(softening, a->softening, a->softening >= 0, "a length of 0 or more");
        expect(period, a->period, a->period > 0, "a length above 0");
        expect(dt, a->dt, a->dt > 0, "a time above 0");
        expect(every, a->every, a->every > 0, "a time above 0");
        if (!(a->eta > 0)) throw UsageError(fmt::format("--eta {:g}: give a number above 0", a->eta));
        const int tasks = int(a->forces) + int(a->compare) + int(a->until >= 0);
        if (tasks != 1) throw UsageError("say what to do: one of --forces, --until TIME and --compare");
        if (a->check && (!a->forces || !a->from.empty()))
            throw UsageError("--check measures what --forces finds at the particles themselves");
        if (a->compare && a->period > 0)
            throw UsageError("--compare knows no periodic cubes: Barnes-Hut does not; leave --period out");
        if (a->scene.empty() && !a->resume)
            throw UsageError("name the particles: gen:plummer:10000, or a file");
        if (a->output.empty() && !a->compare)
            throw UsageError(a->forces ? "name the file of forces: -o acc.npy"
                                       : "name the folder of the run: -o run");
        const ThreadLimit limit(a->threads);
        return a->forces ? nbody_forces(*a) : a->compare ? nbody_compare(*a) : nbody_run(*a);
    };
}

}  // namespace hedgerow::cli
