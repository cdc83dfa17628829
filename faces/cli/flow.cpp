/// hedgerow flow: fluids of particles.
#include "flow.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <hedgerow/base/error.h>
#include <hedgerow/fluid/fluid_scenes.h>

#include "run_folder.h"
#include "verbs.h"

namespace hedgerow::cli {

Run add_flow(CLI::App& verb) {
    auto a = std::make_shared<FlowArguments>();
    std::string scenes = "the fluid: a closed mesh that is full of it (a file, in space), or one of";
    for (const FluidSceneInfo& info : fluid_scenes())
        scenes += fmt::format("\n  gen:{}[:PARTICLES]  {}", info.name, info.description);
    verb.add_option("scene", a->scene, scenes);
    verb.add_option("-o,--output", a->output, "the folder of the run");
    verb.add_flag("--plane", a->plane, "in the plane; else in space");
    CLI::Option* const until =
        verb.add_option("--until", a->until, "the time at which the run ends; else by the scene");
    CLI::Option* const every =
        verb.add_option("--every", a->every, "the time between snapshots; else a twentieth of the whole");
    verb.add_option("--walls", a->walls,
                    "a closed mesh: the tank, if the fluid begins inside of it, or what stands in its way");
    verb.add_option("--inflow", a->inflow, "a closed mesh that is kept full, from which more fluid flows");
    verb.add_option("--inflow-velocity", a->inflow_velocity, "x,y,z: of what flows from --inflow")
        ->delimiter(',')
        ->expected(3);
    CLI::Option* const spacing =
        verb.add_option("--spacing", a->spacing,
                        "of the particles that fill a mesh; else such that about 20,000 fill its box");
    CLI::Option* const viscosity = verb.add_option(
        "--viscosity", a->viscosity,
        "the kinematic one, as 1e-6 for water; the fluid then clings to walls, which are slippery else");
    CLI::Option* const sound = verb.add_option(
        "--sound", a->sound, "speed of sound; else ten times that of a fall from the top to the bottom");
    CLI::Option* const gravity =
        verb.add_option("--gravity", a->gravity, "acceleration downward")->capture_default_str();
    verb.add_option("--up", a->up, "the upward axis of a mesh: x, y, z or auto")
        ->capture_default_str()
        ->check(CLI::IsMember({"auto", "x", "y", "z"}));
    verb.add_flag("--resume", a->resume, "go on from the last snapshot in the folder of -o");
    verb.add_flag(
        "--check", a->check,
        "tell whether density, energy and, at rest, pressures are what they should be, and whether any "
        "particle is behind a wall; exit code 1 if not");
    verb.add_option("--colour", a->colour, "of particles in pictures: by their pressure or speed")
        ->capture_default_str()
        ->check(CLI::IsMember({"pressure", "speed"}));
    verb.add_option("--size", a->size, "of the pictures, WIDTHxHEIGHT; 0x0: no pictures; auto: by the tank")
        ->capture_default_str();
    verb.add_option(
            "--surface", a->surface,
            "also write the surface of the fluid at each snapshot, as a closed mesh with normals: obj (of "
            "clear water), ply or stl")
        ->check(CLI::IsMember({"obj", "ply", "stl"}));
    verb.add_flag("--floor", a->floor, "surfaces of obj have a floor below the tank, for pictures");
    verb.add_option("--threads", a->threads, "0: all")->capture_default_str();
    add_reporting(verb, *a);
    add_drop_bad(verb, *a);
    return [a, &verb, until, every, spacing, viscosity, sound, gravity] {
        if (a->resume) expect_no_options_of_a_run(verb);
        const auto expect = [](const CLI::Option* option, double number, bool good, const char* what) {
            if (option->count() > 0 && !(good && number < 1e100))
                throw UsageError(fmt::format("{} {:g}: give {}", option->get_name(), number, what));
        };
        expect(until, a->until, a->until >= 0, "a time of 0 or more");
        expect(every, a->every, a->every > 0, "a time above 0");
        expect(spacing, a->spacing, a->spacing > 0, "a length above 0");
        expect(viscosity, a->viscosity, a->viscosity >= 0, "a number of 0 or more");
        expect(sound, a->sound, a->sound > 0, "a speed above 0");
        expect(gravity, a->gravity, a->gravity >= 0, "a number of 0 or more");
        if (a->scene.empty() && !a->resume)
            throw UsageError("name the fluid: gen:dam:20000, or a closed mesh");
        if (a->output.empty()) throw UsageError("name the folder of the run: -o run");
        if (a->resume)
            RunFolder(a->output).read_options(
                [&](const nlohmann::ordered_json& options) { options.at("plane").get_to(a->plane); });
        if (a->plane && !a->surface.empty())
            throw UsageError("--surface is for fluids in space: leave --plane out");
        if (a->floor && a->surface != "obj" && !a->resume)
            throw UsageError("--floor is for --surface obj, which holds two materials");
        const ThreadLimit limit(a->threads);
        return a->plane ? flow_run<2>(*a) : flow_run<3>(*a);
    };
}

}  // namespace hedgerow::cli
