/// What the figures were measured on.
#pragma once

#include <string>

namespace hedgerow::benchmark {

/// The processor's name, for the reader of the figures.
std::string processor();
/// "g++ 12.2", "clang++ 14.0".
std::string compiler();
/// The clock in GHz while one thread computes.
double clock_rate();

}  // namespace hedgerow::benchmark
