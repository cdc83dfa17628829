/// What the command line is held against beyond what CLI11 does by itself.
#pragma once

#include <string>

#include <CLI/CLI.hpp>

namespace hedgerow::cli {

/// Every number must be one, finite, and fit its type; no text may be empty.
void check_arguments(CLI::App& verb);

/// Throws UsageError with the nearest verb if the first argument is none.
void check_verb(const CLI::App& app, int count, const char* const* arguments);

/// What to say about arguments that nothing takes: the first, with the nearest option of the verb.
std::string unknown_argument(const CLI::App& app);

}  // namespace hedgerow::cli
