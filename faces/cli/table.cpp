#include "table.h"

#include <algorithm>

#include <fmt/format.h>

namespace hedgerow::cli {

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
    std::string text = t.title + " (" + t.note + ")\n" + line(t.columns);
    for (const auto& row : t.rows) text += line(row);
    return text;
}

}  // namespace hedgerow::cli
