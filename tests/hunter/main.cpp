/// The hunter draws scenes and queries of numbers that provoke rounding errors, and queries every structure,
/// builder, scalar and instruction set. It compares the answers with those of brute force, and these with
/// exact arithmetic. It shrinks what differs to a few primitives and prints it as a test.
///
/// With --files it draws meshes and points instead, and writes each as text of every format in a style that
/// means the same: other ends of lines, comments, joined lines, orders, words. What gives another geometry,
/// or is refused, is printed as an entry of the corpus of files (tests/corpus/).
///
/// With --particles it draws arrangements of charges and holds forces against sums in long double and after
/// Ewald.
///
///   hunter [--files | --particles] [--seconds 60 | --rounds N | --round N] [--seed 1] [--most 10]
///
/// It hunts for some time, for some rounds, or repeats one round that has found something. It uses one
/// thread; processes with other seeds search other scenes. The exit code is 1 if something was found.
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>

#include <hedgerow/engine/kernels.h>

#include "hunt.h"

using namespace hedgerow;
using namespace hedgerow::hunter;

namespace {

/// Rounds alternate between kinds of shapes and, every 16 rounds, between instruction sets. Only triangles of
/// float use an instruction set.
Report run(std::uint64_t seed, std::uint64_t round) {
    const auto sets = instruction_sets();
    use_instruction_set(sets[round / 16 % sets.size()]);
    switch (round % 16) {
        case 0:
            return Hunt<Sphere<float, 3>>(seed, round).run();
        case 1:
            return Hunt<Sphere<double, 3>>(seed, round).run();
        case 2:
            return Hunt<Segment<float, 2>>(seed, round).run();
        case 3:
            return Hunt<Segment<double, 2>>(seed, round).run();
        case 4:
            return round % 32 == 4 ? Hunt<Vec<float, 3>>(seed, round).run()
                                   : Hunt<Vec<double, 3>>(seed, round).run();
        case 5:
            return round % 32 == 5 ? Hunt<Vec<float, 2>>(seed, round).run()
                                   : Hunt<Vec<double, 2>>(seed, round).run();
        case 6:
            return hunt_instances(seed, round);
        case 7:
            return hunt_pairs(seed, round);
        default:
            return round % 2 == 0 ? Hunt<Triangle<float, 3>>(seed, round).run()
                                  : Hunt<Triangle<double, 3>>(seed, round).run();
    }
}

struct Options {
    double seconds = 60;
    std::uint64_t seed = 1, most = 10;
    std::optional<std::uint64_t> rounds, round;
    /// What a round hunts among.
    Report (*hunt)(std::uint64_t seed, std::uint64_t round) = run;
};

std::optional<Options> parsed(int argc, char** argv) {
    Options options;
    for (int i = 1; i < argc; i += 2) {
        if (std::strcmp(argv[i], "--files") == 0) {
            options.hunt = hunt_files, --i;
            continue;
        }
        if (std::strcmp(argv[i], "--particles") == 0) {
            options.hunt = hunt_particles, --i;
            continue;
        }
        if (i + 1 == argc) return std::nullopt;
        char* end = nullptr;
        const auto number = [&] { return std::strtoull(argv[i + 1], &end, 10); };
        if (std::strcmp(argv[i], "--seconds") == 0)
            options.seconds = std::strtod(argv[i + 1], &end);
        else if (std::strcmp(argv[i], "--seed") == 0)
            options.seed = number();
        else if (std::strcmp(argv[i], "--rounds") == 0)
            options.rounds = number();
        else if (std::strcmp(argv[i], "--round") == 0)
            options.round = number();
        else if (std::strcmp(argv[i], "--most") == 0)
            options.most = number();
        if (end == nullptr || end == argv[i + 1] || *end != '\0') return std::nullopt;
    }
    return options;
}

}  // namespace

int main(int argc, char** argv) {
    const auto options = parsed(argc, argv);
    if (!options) {
        std::fprintf(stderr,
                     "usage: hunter [--files | --particles] [--seconds 60 | --rounds N | --round N] [--seed "
                     "1] [--most 10]\n");
        return 2;
    }
    using Clock = std::chrono::steady_clock;
    const auto began = Clock::now();
    const auto seconds = [&] { return std::chrono::duration<double>(Clock::now() - began).count(); };
    std::uint64_t rounds = 0, questions = 0, exact = 0, found = 0;
    double told = 0;
    // Run rounds, and print what each has found.
    for (std::uint64_t round = options->round.value_or(0); found < options->most; ++round) {
        const Report report = options->hunt(options->seed, round);
        ++rounds, questions += report.questions, exact += report.checked_exactly,
            found += report.found.size();
        for (const auto& test : report.found) std::printf("%s\n", test.c_str()), std::fflush(stdout);
        if (options->round || (options->rounds ? rounds >= *options->rounds : seconds() > options->seconds))
            break;
        // Report the progress every ten seconds.
        if (seconds() - told > 10) {
            told = seconds();
            std::fprintf(stderr, "hunter: %.0f of %.0f s, %llu rounds, %.3g questions\n", told,
                         options->seconds, static_cast<unsigned long long>(rounds),
                         static_cast<double>(questions));
        }
    }
    std::fprintf(
        stderr,
        "hunter: seed %llu, %llu rounds, %llu questions (%.3g a second), %llu answers of brute force held "
        "against exact arithmetic, %llu found\n",
        static_cast<unsigned long long>(options->seed), static_cast<unsigned long long>(rounds),
        static_cast<unsigned long long>(questions), static_cast<double>(questions) / seconds(),
        static_cast<unsigned long long>(exact), static_cast<unsigned long long>(found));
    return found > 0 ? 1 : 0;
}
