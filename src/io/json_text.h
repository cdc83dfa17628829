/// JSON from files that nobody vouches for.
#pragma once

#include <string>
#include <string_view>

#include <nlohmann/json.hpp>

namespace hedgerow::detail {

/// Parses a text, once its nesting (at most 64 deep) and the memory that its values take are known to be
/// sane. Throws InputError, naming `name` and the byte. O(size).
nlohmann::json parse_json(std::string_view text, const std::string& name);

}  // namespace hedgerow::detail
