/// Text as it may stand in SVG and HTML.
#pragma once

#include <string>
#include <string_view>

namespace hedgerow::cli {

/// With &, <, > and quotes as entities. Control characters that XML does not allow become blanks.
std::string escaped(std::string_view text);

}  // namespace hedgerow::cli
