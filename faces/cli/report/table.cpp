#include "table.h"

#include <algorithm>

#include <fmt/format.h>

namespace hedgerow::cli {

void drop(Table& table, std::string_view first, std::size_t count) {
    const auto begin = std::find(table.columns.begin(), table.columns.end(), first) - table.columns.begin();
    const auto cut = [&](std::vector<std::string>& cells) {
        cells.erase(cells.begin() + begin, cells.begin() + begin + static_cast<std::ptrdiff_t>(count));
    };
    cut(table.columns);
    for (auto& row : table.rows) cut(row);
}

std::string text_of(const Table& t) {
    std::vector<std::size_t> width;
    for (std::size_t k = 0; k < t.columns.size(); ++k) {
        width.push_back(t.columns[k].size());
        for (const auto& row : t.rows) width[k] = std::max(width[k], row[k].size());
    }
    const auto line = [&](const std::vector<std::string>& cells) {
        std::string text = fmt::format("{:<{}}", cells[0], width[0]);
        for (std::size_t k = 1; k < cells.size(); ++k) text += fmt::format("  {:>{}}", cells[k], width[k]);
        return text.substr(0, text.find_last_not_of(' ') + 1) + "\n";
    };
    std::string text = t.title + (t.note.empty() ? "" : " (" + t.note + ")") + "\n" + line(t.columns);
    for (const auto& row : t.rows) text += line(row);
    return text;
}

}  // namespace hedgerow::cli
