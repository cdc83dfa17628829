/// How long the tests run.
#pragma once

#include <cstddef>
#include <cstdlib>

namespace hedgerow {

/// `many` if HEDGEROW_LONG is set in the environment, which chooses the long suites; else `few`.
inline std::size_t in_long_runs(std::size_t many, std::size_t few) {
    return std::getenv("HEDGEROW_LONG") != nullptr ? many : few;
}

/// `few` in builds with sanitizers, which take ten times as long; else `usual`.
inline std::size_t unless_sanitized(std::size_t usual, std::size_t few) {
#ifdef HEDGEROW_SANITIZED
    return static_cast<void>(usual), few;
#else
    return static_cast<void>(few), usual;
#endif
}

}  // namespace hedgerow
