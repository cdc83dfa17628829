/// A page of its own: well-formed as XML too, and it asks for no other file.
#pragma once

#include <string>

#include "table.h"

namespace hedgerow::cli {

/// Up to its heading.
std::string page_opened(const std::string& title);
std::string page_closed();
std::string html_of(const Table& table);

}  // namespace hedgerow::cli
