/// Parses JSON from files that cannot be trusted.
#pragma once

#include <string>
#include <string_view>

#include <nlohmann/json.hpp>

namespace hedgerow::detail {

/// Parses a text after checks that it is nested at most 64 deep and that its values fit in the memory that is
/// left. Throws InputError, naming `name` and the place. O(size).
nlohmann::json parse_json(std::string_view text, const std::string& name);

}  // namespace hedgerow::detail
