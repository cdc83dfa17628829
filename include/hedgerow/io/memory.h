/// How much memory is left.
#pragma once

#include <cstdint>

namespace hedgerow {

/// Bytes that this process may still take: the machine's free memory, swap included, or less if the process
/// is limited (RLIMIT_AS, RLIMIT_DATA, its control group or one around that). The largest number if the
/// system does not say. Reads a few of the system's files: less than a millisecond.
std::uint64_t memory_left();

}  // namespace hedgerow
