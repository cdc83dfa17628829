/// Text for SVG and HTML.
#pragma once

#include <string>
#include <string_view>

namespace hedgerow::cli {

/// The text with &, <, > and double quotes as entities. Control characters other than tab and newline become
/// blanks, since XML does not allow most of them.
std::string escaped(std::string_view text);

}  // namespace hedgerow::cli
