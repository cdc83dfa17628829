/// Checks of the command line beyond those of CLI11.
#pragma once

#include <string>

#include <CLI/CLI.hpp>

namespace hedgerow::cli {

/// Makes the options of a verb reject values that are not numbers, not finite or too large for their type,
/// and empty texts.
void check_arguments(CLI::App& verb);

/// Throws UsageError if the first argument is neither an option nor a verb. The message suggests the nearest
/// verb.
void check_verb(const CLI::App& app, int count, const char* const* arguments);

/// A message about the arguments that CLI11 left over. It names the first unknown option, with the nearest
/// option of the verb, or else the first argument.
std::string unknown_argument(const CLI::App& app);

}  // namespace hedgerow::cli
