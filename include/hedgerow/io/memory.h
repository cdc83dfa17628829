/// How much memory there is.
#pragma once

#include <cstdint>

namespace hedgerow {

/// Bytes that this process may still take: what the machine has free, swap included, or less where the
/// process is limited (RLIMIT_AS, RLIMIT_DATA, its control group or one around that). The largest number
/// where the system does not say. Reads a few of the system's files: less than a millisecond.
std::uint64_t memory_left();

}  // namespace hedgerow
