/// What an index will take in memory, predicted from the number of primitives before anything is built.
#pragma once

#include <cstdint>
#include <string_view>

namespace hedgerow {

/// In bytes, without the primitives themselves.
struct PredictedMemory {
    double index = 0;       ///< of the index once it is built, packed copies included
    double build_peak = 0;  ///< at the build's worst moment, the index included
};

/// Predicts the memory of a structure over `count` primitives: `structure` as for build_any, `kind` one of
/// "triangles", "points", "spheres" and "segments". The figures are those a primitive that were measured over
/// the generated scenes, with default options; of the options only `builder` of `wide` counts. From 3,000
/// primitives up the index takes at most twice as much as predicted and at least half, and the peak 2.5 times
/// (predicted_memory_test); for the engine 1.3 times. O(1). Throws UsageError for an unknown structure, or
/// one that does not hold the kind.
PredictedMemory predicted_memory(std::string_view structure, std::string_view kind, std::uint64_t count,
                                 bool in_double);

}  // namespace hedgerow
