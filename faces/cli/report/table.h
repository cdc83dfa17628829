/// A table of texts, for the terminal and for a page.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace hedgerow::cli {

/// Columns of text under headings. The first column is aligned left, the others right.
struct Table {
    std::string title, note;
    std::vector<std::string> columns;
    std::vector<std::vector<std::string>> rows;
};

/// Removes `count` columns, beginning with the first one that is named `first`, which must exist.
void drop(Table& table, std::string_view first, std::size_t count);

std::string text_of(const Table& table);

}  // namespace hedgerow::cli
