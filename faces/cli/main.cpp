/// The tool: reads the command line and runs a verb.
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <new>
#include <string>
#include <system_error>
#include <vector>

#include <fcntl.h>

#include <fmt/format.h>

#include <hedgerow/any_index.h>
#include <hedgerow/base/error.h>
#include <hedgerow/version.h>

#include "arguments.h"
#include "memory.h"
#include "picture_notes.h"
#include "verbs.h"

namespace hedgerow::cli {

void add_common(CLI::App& verb, Common& c, bool output) {
    verb.add_option("scene", c.scene, "a mesh, point or .hedgerow file, or gen:NAME[:SIZE]")->required();
    if (output) verb.add_option("-o,--output", c.output, "the file to write")->required();
    verb.add_option("--precision", c.precision,
                    "of coordinates: float, double, or double where floats would lose what tells a file's "
                    "points apart; a .hedgerow file has its own")
        ->capture_default_str()
        ->check(CLI::IsMember({"auto", "float", "double"}));
    add_reporting(verb, c);
    add_drop_bad(verb, c);
}
void add_reporting(CLI::App& verb, Common& c) {
    verb.add_flag("--json", c.json, "results as JSON");
    verb.add_flag("--quiet", c.quiet, "no progress and no summary");
    verb.add_option("--seed", c.seed, "of random scenes and samples");
}
void add_drop_bad(CLI::App& verb, Common& c) {
    verb.add_flag("--drop-bad", c.drop_bad,
                  "leave out points that are NaN, infinite or too large, and faces with such vertices");
}

namespace {

struct Verb {
    const char *name, *help;
    Run (*add)(CLI::App&);
};
constexpr Verb verbs[] = {
    {"render",
     "Examples:\n  hedgerow render gen:teapot -o teapot.png --size 640x480\n"
     "  hedgerow render gen:teapot-in-stadium --shading steps -o steps.png\n"
     "  hedgerow render gen:teapot -o layers.exr\n\na picture, by rays",
     add_render},
    {"query",
     "Examples:\n  hedgerow query closest-point dragon.ply --from points.npy -o closest.npy\n"
     "  hedgerow query nearest scan.ply --count 8 --from places.csv -o near.csv\n"
     "  hedgerow query crossings part.stl --with case.stl -o pairs.json\n"
     "  hedgerow query signed-distance dragon.ply --from points.npy -o depth.npy\n"
     "  make-rays | hedgerow query closest-hit dragon.ply --from - --format csv -o hits.npy\n\n"
     "answer queries from a file, as many as it holds: rays, points, regions, insides, pairs",
     add_query},
    {"build",
     "Examples:\n  hedgerow build dragon.ply -o dragon.hedgerow\n"
     "  hedgerow build gen:terrain:200000 --builder high --width 8 -o terrain.hedgerow\n\n"
     "save the engine's index, for programs and for render",
     add_build},
    {"draw",
     "Examples:\n  hedgerow draw gen:clusters2d:300 --structure quadtree:leaf_size=4 -o cells.svg\n"
     "  hedgerow draw gen:teapot --slice y=0.5 --structure kdtree -o slice.svg\n"
     "  hedgerow draw gen:teapot --depth 2 -o boxes.png\n"
     "  hedgerow draw gen:segments2d:80 --ray=-0.1,0.3,1,0.3 --frames -o steps.html\n"
     "  hedgerow draw gen:segments2d:80 --structure bvh:builder=midpoint --beside bvh:builder=sweep -o "
     "two.svg\n"
     "  hedgerow draw gen:segments2d:80 --structure grid --ray=-0.1,0.5,1,0 --fan 31 -o fan.svg\n"
     "  hedgerow draw gen:cube --ray=-2.4,0,2.4,1,0,-0.58 --cone 12 -o footprint.png\n"
     "  hedgerow draw gen:teapot:2000 --hausdorff gen:teapot:200 -o far.svg\n"
     "  hedgerow draw gen:teapot-in-stadium --heat tests --scale 60 -o heat.png\n"
     "  hedgerow draw gen:boulder --field signed-distance --slice z=0.5 -o distance.png\n"
     "  hedgerow draw gen:disc:20000 --forces-at 2,1,0 -o forces.svg\n\n"
     "what a structure looks like, where rays spend their steps, how far away a surface is, what acts on a "
     "particle",
     add_draw},
    {"compare",
     "Examples:\n  hedgerow compare dragon.ply\n  hedgerow compare gen:grass:20000 --html grass.html\n"
     "  hedgerow compare house.glb --eye 2,3,1.6 --target 5,1,1\n"
     "  hedgerow compare gen:soup:50000 --sweep grid:resolution=8..256\n"
     "  hedgerow compare gen:terrain --scale --structures grid,kdtree,bvh\n\n"
     "every structure, every query: what each costs, and which to use",
     add_compare},
    {"bench",
     "Examples:\n  hedgerow bench\n  hedgerow bench dragon.ply gen:soup:200k --html bench.html -o bench.svg\n"
     "  hedgerow bench gen:hairball --quick --sets diffuse,random --instruction-set avx2\n\n"
     "the engine's rays a second, beside every peer that is present",
     add_bench},
    {"nbody",
     "Examples:\n  hedgerow nbody gen:plummer:100000 --forces --accuracy 1e-5 -o acceleration.npy\n"
     "  hedgerow nbody gen:two-clusters:20000 --until 10 -o merger\n"
     "  hedgerow nbody --resume --until 20 -o merger\n"
     "  hedgerow nbody gen:hernquist:100000 --compare\n\n"
     "forces between particles, their motion, and what each way to find them costs",
     add_nbody},
    {"particles",
     "Examples:\n  hedgerow particles gen:teapot -o run\n"
     "  hedgerow particles dragon.ply --emit rain --until 4 --every 0.1 -o rain\n"
     "  hedgerow particles --resume --until 8 -o rain\n\n"
     "particles that fall on a mesh, bounce off it and off each other: snapshots, pictures, a log",
     add_particles},
    {"flow",
     "Examples:\n  hedgerow flow gen:dam:20000 --until 2 --every 0.05 -o dam\n"
     "  hedgerow flow gen:dam --plane -o dam\n  hedgerow flow bunny.ply --surface obj -o splash\n"
     "  hedgerow flow --resume --until 4 -o dam\n\n"
     "fluids of particles that break, fall, splash and come to rest: snapshots, pictures, surfaces, a log",
     add_flow},
    {"info",
     "Examples:\n  hedgerow info dragon.ply\n  hedgerow info gen:cube --json\n"
     "  hedgerow info scan.ply --check\n\n"
     "what is in a scene, and what is wrong with it",
     add_info},
    {"generate",
     "Examples:\n  hedgerow generate gen:teapot:100k -o teapot.stl\n"
     "  hedgerow generate gen:points -o points.npy\n\nwrite a generated scene",
     add_generate},
    {"convert",
     "Examples:\n  hedgerow convert dragon.glb -o dragon.ply\n  hedgerow convert scan.xyz.gz -o scan.npy\n"
     "  hedgerow convert model.obj -o model.stl --drop-bad\n\n"
     "write what a file holds as another: meshes as .ply .stl .obj .off, points as .ply .npy .csv .xyz",
     add_convert},
    {"structures",
     "Examples:\n  hedgerow structures\n  hedgerow structures kdtree\n\n"
     "the structures that can be built, and the options of one",
     add_structures},
};

constexpr const char* where_to_look =
    "Structures and their options: hedgerow structures [NAME]. Generated scenes: hedgerow --help.";

std::string footer() {
    std::string text =
        "Structures and their options: hedgerow structures [NAME].\nGenerated scenes (gen:NAME[:SIZE]):\n";
    for (const auto& s : scene_list()) text += fmt::format("  {:20} {}\n", s.name, s.description);
    return text;
}

/// Uses the instruction set that the environment names. Throws UsageError for an unknown name, which the
/// library ignores: a user of the tool should learn of it.
void use_instruction_set_of_environment() {
    const char* const set = std::getenv("HEDGEROW_INSTRUCTION_SET");
    if (set == nullptr || *set == '\0') return;
    try {
        use_instruction_set(set);
    } catch (const UsageError& e) {
        throw UsageError(std::string("HEDGEROW_INSTRUCTION_SET: ") + e.what());
    }
}

int run(int count, char** arguments) {
    remember_command(count, arguments);
    CLI::App app(
        "Examples:\n  hedgerow render gen:teapot-in-stadium -o stadium.png\n  hedgerow render dragon.ply "
        "--shading steps -o steps.png\n"
        "  hedgerow info dragon.ply\n  hedgerow bench dragon.ply\n  hedgerow generate gen:terrain:200000 -o "
        "terrain.ply\n\n"
        "Spatial data structures for rays, geometric queries and particles.");
    app.set_version_flag("--version", std::string("hedgerow ") + version);
    app.require_subcommand(1);
    // Add the verbs with their options.
    std::vector<std::pair<CLI::App*, Run>> runs;
    for (const Verb& v : verbs) {
        auto* const verb = app.add_subcommand(v.name, v.help);
        verb->footer(where_to_look);
        runs.emplace_back(verb, v.add(*verb));
        check_arguments(*verb);
    }
    app.footer(footer());
    // Parse, with messages of our own for unknown verbs and options.
    check_verb(app, count, arguments);
    try {
        app.parse(count, arguments);
    } catch (const CLI::ExtrasError&) {
        throw UsageError(unknown_argument(app));
    } catch (const CLI::ParseError& e) {
        return app.exit(e) == 0 ? 0 : 2;
    }
    // Run the verb that was chosen.
    use_instruction_set_of_environment();
    for (const auto& [verb, run_verb] : runs)
        if (*verb) return run_verb();
    return 2;
}

/// Opens /dev/null in place of each closed standard stream. Otherwise the next file to be opened would take
/// the stream's place and receive what is printed.
void hold_standard_streams() {
    for (int stream = 0; stream < 3; ++stream)
        if (fcntl(stream, F_GETFD) == -1) static_cast<void>(open("/dev/null", O_RDONLY));
}

/// Lets a write beyond the limit on the size of files fail, as on a full disk, in place of ending the
/// process.
void survive_limits_of_files() {
    std::signal(SIGXFSZ, SIG_IGN);
}

/// Prints a message to stderr and returns the exit code.
int failed(int code, const std::string& why) {
    std::fprintf(stderr, "hedgerow: %s\n", why.c_str());
    return code;
}
int short_of_memory() {
    const std::string& work = ProgressLine::failed();
    return failed(1, "memory ran out" + (work.empty() ? std::string() : " while " + work) +
                         ": ask for less, or allow more");
}
int lost_output(int error) {
    return failed(1, "the results cannot be printed: " + std::generic_category().message(error));
}

/// Calls `run` and returns the exit code: that of `run`, 130 after an interruption, or 1, 2 or 3 after an
/// error message. Also flushes stdout, since printed results may still be in a buffer and fail to be written.
int run_safely(int count, char** arguments) {
    try {
        const int code = run(count, arguments);
        errno = 0;
        if (std::fflush(stdout) != 0 || std::ferror(stdout) != 0) return lost_output(errno);
        return code == 0 && interrupted ? 130 : code;
    } catch (const Cancelled&) {
        return failed(130, "interrupted");
    } catch (const UsageError& e) {
        return failed(2, e.what());
    } catch (const InputError& e) {
        return failed(3, e.what());
    } catch (const std::bad_alloc&) {
        return short_of_memory();
    } catch (const std::length_error&) {  // a container of more elements than there are addresses
        return short_of_memory();
    } catch (const std::filesystem::filesystem_error& e) {
        return failed(1, e.what());
    } catch (const std::system_error& e) {  // fmt could not print
        return lost_output(e.code().value());
    } catch (const std::exception& e) {
        return failed(1, e.what());
    }
}

}  // namespace
}  // namespace hedgerow::cli

int main(int count, char** arguments) {
    hedgerow::cli::hold_standard_streams();
    hedgerow::cli::survive_limits_of_files();
    hedgerow::cli::listen_to_interrupts();
    return hedgerow::cli::run_safely(count, arguments);
}
