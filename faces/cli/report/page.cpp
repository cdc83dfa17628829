#include "page.h"

#include <fmt/format.h>

#include "xml.h"

namespace hedgerow::cli {

namespace {

constexpr const char* style_sheet =
    R"(body { font: 15px/1.45 sans-serif; color: #222; max-width: 1000px; margin: 2em auto; padding: 0 1em }
h1 { font-size: 1.5em } h2 { font-size: 1.2em; margin-top: 2em }
table { border-collapse: collapse; font-size: 13px } div.wide { overflow-x: auto; margin: 1em 0 }
th, td { padding: 2px 9px; text-align: right; white-space: nowrap; border-bottom: 1px solid #e4e4e4 }
th:first-child, td:first-child { text-align: left } caption { text-align: left; padding: 4px 0; color: #555 }
caption b { color: #222 } svg { max-width: 100%; height: auto; margin: 1em 0; display: block }
li { margin: 0.5em 0 } p.note { color: #555; margin: 0.2em 0 })";

}  // namespace

std::string page_opened(const std::string& title) {
    return fmt::format(
        "<!DOCTYPE html>\n<html xmlns=\"http://www.w3.org/1999/xhtml\" lang=\"en\">\n<head><meta "
        "charset=\"utf-8\"/>\n"
        "<title>{0}</title>\n<style>{1}</style></head>\n<body>\n<h1>{0}</h1>\n",
        escaped(title), style_sheet);
}
std::string page_closed() {
    return "</body>\n</html>\n";
}

std::string html_of(const Table& t) {
    const auto cells = [](const std::vector<std::string>& all, const char* tag) {
        std::string row = "<tr>";
        for (const auto& c : all) row += fmt::format("<{0}>{1}</{0}>", tag, escaped(c));
        return row + "</tr>\n";
    };
    std::string html = fmt::format(
        "<div class=\"wide\"><table>\n<caption><b>{}</b>{}{}</caption>\n<thead>{}</thead>\n<tbody>\n",
        escaped(t.title), t.note.empty() ? "" : ": ", escaped(t.note), cells(t.columns, "th"));
    for (const auto& row : t.rows) html += cells(row, "td");
    return html + "</tbody></table></div>\n";
}

}  // namespace hedgerow::cli
