/// The verbs. Each adds its options to the tool and returns what runs it once they are read: the exit code.
#pragma once

#include <functional>

#include <CLI/CLI.hpp>

#include "common.h"

namespace hedgerow::cli {

using Run = std::function<int()>;

Run add_render(CLI::App& verb);
Run add_build(CLI::App& verb);
Run add_draw(CLI::App& verb);
Run add_compare(CLI::App& verb);
Run add_bench(CLI::App& verb);
Run add_info(CLI::App& verb);
Run add_generate(CLI::App& verb);
Run add_convert(CLI::App& verb);
Run add_structures(CLI::App& verb);

/// The options that every verb has.
void add_common(CLI::App& verb, Common& c, bool output);
/// Those of them that are not about one scene.
void add_reporting(CLI::App& verb, Common& c);

}  // namespace hedgerow::cli
