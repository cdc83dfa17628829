/// The version of the library and of the tool.
#pragma once

namespace hedgerow {

/// As in "0.1.0"; CMake reads it from this line.
inline constexpr const char version[] = "0.1.0";

}  // namespace hedgerow
