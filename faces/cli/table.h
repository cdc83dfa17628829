/// Tables, as text and for a page.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace hedgerow::cli {

/// Columns of text under titles; the first is set to the left, the others to the right.
struct Table {
    std::string title, note;
    std::vector<std::string> columns;
    std::vector<std::vector<std::string>> rows;
};

/// Removes some columns, from the first one of that name on.
void drop(Table& table, std::string_view first, std::size_t count);

std::string text_of(const Table& table);

}  // namespace hedgerow::cli
