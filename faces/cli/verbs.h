/// The verbs. Each function adds the options of a verb to the tool, and returns the function that runs the
/// verb after they are read. That function returns the exit code.
#pragma once

#include <functional>

#include <CLI/CLI.hpp>

#include "common.h"

namespace hedgerow::cli {

using Run = std::function<int()>;

Run add_render(CLI::App& verb);
Run add_query(CLI::App& verb);
Run add_build(CLI::App& verb);
Run add_draw(CLI::App& verb);
Run add_compare(CLI::App& verb);
Run add_bench(CLI::App& verb);
Run add_nbody(CLI::App& verb);
Run add_particles(CLI::App& verb);
Run add_flow(CLI::App& verb);
Run add_info(CLI::App& verb);
Run add_generate(CLI::App& verb);
Run add_convert(CLI::App& verb);
Run add_structures(CLI::App& verb);

/// Adds the options of a verb about one scene: the scene, --output if `output` is set, --precision, and those
/// of add_reporting and add_drop_bad.
void add_common(CLI::App& verb, Common& c, bool output);
/// Adds the options that do not depend on one scene: --json, --quiet and --seed.
void add_reporting(CLI::App& verb, Common& c);
/// Adds --drop-bad.
void add_drop_bad(CLI::App& verb, Common& c);

}  // namespace hedgerow::cli
