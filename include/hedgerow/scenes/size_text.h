/// The SIZE of `gen:NAME:SIZE`.
#pragma once

#include <cstdint>
#include <string_view>

namespace hedgerow {

/// Reads a whole number, with k, M or G after it for thousands, millions or thousands of millions. Throws
/// UsageError for other text and for a size beyond `largest_scene_size`; `name` is the scene's, for the
/// message.
std::uint64_t parse_scene_size(std::string_view name, std::string_view text);

}  // namespace hedgerow
