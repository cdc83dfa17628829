/// The processor, the compiler and the clock rate that figures are measured with.
#pragma once

#include <string>

namespace hedgerow::measure {

/// The processor's name, for the reader of the figures.
std::string processor();
/// How fast this processor is with vectors of 512 bits: "AVX-512 at full rate" where it multiplies more
/// floats a cycle by them than by vectors of 256 bits, "AVX-512 at half rate" where it does not, and "no
/// AVX-512". Measured, in a few milliseconds.
std::string avx512_rate();
/// The compiler and its version: "g++ 12.2", "clang++ 14.0".
std::string compiler();
/// Measures the clock rate in GHz while one thread computes.
double clock_rate();

}  // namespace hedgerow::measure
