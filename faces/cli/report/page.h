/// Parts of an HTML page that is well-formed as XML too, and needs no other file.
#pragma once

#include <string>

#include "table.h"

namespace hedgerow::cli {

/// The beginning of a page, up to and with its heading.
std::string page_opened(const std::string& title);
std::string page_closed();
std::string html_of(const Table& table);

}  // namespace hedgerow::cli
