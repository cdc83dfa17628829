/// Tables, as text and for a page.
#pragma once

#include <string>
#include <vector>

namespace hedgerow::cli {

/// Columns of text under titles; the first is set to the left, the others to the right.
struct Table {
    std::string title, note;
    std::vector<std::string> columns;
    std::vector<std::vector<std::string>> rows;
};

std::string text_of(const Table& table);

}  // namespace hedgerow::cli
