/// The processor, the compiler and the clock rate that figures are measured with.
#pragma once

#include <string>

namespace hedgerow::measure {

/// The processor's name, for the reader of the figures.
std::string processor();
/// The compiler and its version: "g++ 12.2", "clang++ 14.0".
std::string compiler();
/// Measures the clock rate in GHz while one thread computes.
double clock_rate();

}  // namespace hedgerow::measure
