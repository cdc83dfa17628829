/// What the tool writes into the files of pictures: by which version, command and seed they were made.
#pragma once

#include <cstdint>

#include <hedgerow/io/notes.h>

namespace hedgerow::cli {

/// Keeps the arguments of the program, once, as they were given.
void remember_command(int count, const char* const* arguments);

/// The version, the command as a shell takes it, and the seed.
Notes picture_notes(std::uint64_t seed);

}  // namespace hedgerow::cli
