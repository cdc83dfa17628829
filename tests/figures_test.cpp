/// Checks that the counts in documents are those that the commands beside them print.
///
/// A comment before a table or a paragraph describes its figures:
///
///   <!-- figures: column 2: nodes / leaves / primitives; column 3: memory; except row 2 -->
///   <!-- figures: row 1: coherent nodes of 2; "tests {} triangles" = coherent primitives @grid -->
///
/// - `column N`, `row N` and `cell ROW COLUMN` are those of the next table, counted from 1 without its head.
///   The structure of a figure is at the other end: for a column in the first cell of the row, for a row or a
///   cell in the table's head. `except row N` and `except column N` leave figures out.
/// - A template in quotes is searched in the text that follows.
/// - A figure is `[ask] [set] name [@structure]`. Its name is nodes, leaves, primitives, skipped, items or
///   bytes (both per primitive), memory or depth. A figure of a command with --scale is `name[size]`, at the
///   size of its column. A figure of `render` is a name in its JSON.
/// - `of N` chooses command N of the next block of commands instead of the first, and `of hedgerow ...`
///   another command.
///
/// HEDGEROW_REWRITE=1 corrects the documents instead (scripts/figures).
///
/// The columns and options of queries in docs/queries.md are those that the questions tell of themselves.
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <map>
#include <optional>
#include <regex>
#include <sstream>

#include <nlohmann/json.hpp>

#include <hedgerow/any_question.h>
#include <hedgerow/measure/quantity.h>

#include "tool.h"

namespace {

using namespace hedgerow;
using nlohmann::json;
using Strings = std::vector<std::string>;

std::string trimmed(const std::string& text) {
    const auto from = text.find_first_not_of(" \n\t"), to = text.find_last_not_of(" \n\t");
    return from == text.npos ? "" : text.substr(from, to - from + 1);
}
Strings split(const std::string& text, const std::string& separator) {
    Strings parts;
    std::size_t from = 0;
    for (std::size_t at; (at = text.find(separator, from)) != text.npos; from = at + separator.size())
        parts.push_back(trimmed(text.substr(from, at - from)));
    parts.push_back(trimmed(text.substr(from)));
    return parts;
}

/// The source of a figure, as a document describes it.
struct Figure {
    std::string ask = "closest-hit", set, name, structure;
};
Figure figure_of(const std::string& text) {
    Figure f;
    for (const std::string& word : split(text, " ")) {
        if (word == "coherent" || word == "incoherent" || word == "random")
            f.set = word;
        else if (word == "nearest" || word == "overlap" || word == "all-hits" || word == "any-hit" ||
                 word == "closest-point")
            f.ask = word;
        else if (word.starts_with("@"))
            f.structure = word.substr(1);
        else if (f.name.empty())
            f.name = word;
        else
            ADD_FAILURE() << "'" << text << "' names two figures";
    }
    return f;
}

/// The JSON that a command of the tool prints. Each command runs once.
const json& result_of(std::string command, const std::string& ask) {
    static std::map<std::string, json> known;
    // Ask for counts alone, and write pictures to a temporary file.
    command = std::regex_replace(command, std::regex("(^hedgerow |\\s+#.*$| --time [0-9.]+| --json)"), "");
    const auto picture =
        std::filesystem::temp_directory_path() / ("figures." + std::to_string(getpid()) + ".png");
    if (command.starts_with("compare ")) {
        if (command.find(" --for ") == command.npos) command += " --for " + ask;
        command += " --counts";
    } else {
        command = std::regex_replace(command, std::regex(" -o [^ ]+"), "") + " -o " + picture.string();
    }
    const auto found = known.find(command);
    if (found != known.end()) return found->second;
    const auto result = run_shell(HEDGEROW_TOOL_PATH " " + command + " --json");
    std::filesystem::remove(picture);
    EXPECT_EQ(result.code, 0) << command;
    return known[command] = result.code == 0 ? json::parse(result.output) : json();
}

/// The structure in a result that has a name, a value of the option that a sweep changes, or "grid,
/// density=1" for grid:density=1. Null if there is none.
const json* structure_of(const json& result, std::string name) {
    if (std::smatch m; std::regex_search(name, m, std::regex("`([^`]*)`"))) name = m[1];
    name = name.substr(0, name.find(" ("));
    if (const auto comma = name.find(", "); comma != name.npos) name.replace(comma, 2, ":");
    name = std::regex_replace(name, std::regex(", "), ",");
    const auto among = [&](const json& all) -> const json* {
        for (const json& s : all)
            if (const std::string full = s["structure"];
                full == name || full.ends_with("=" + name) || full.ends_with(":" + name))
                return &s;
        return nullptr;
    };
    if (result.contains("structures"))
        if (const json* s = among(result["structures"])) return s;
    if (result.contains("sweeps"))
        for (const json& sweep : result["sweeps"])
            if (const json* s = among(sweep["structures"])) return s;
    return nullptr;
}

std::optional<double> grown(const json& result, const Figure& f, const std::string& structure) {
    const std::string name = f.name.substr(0, f.name.find('[')) + " a query";
    for (const json& g : result["scale"]["growth"])
        if (g["structure"] == structure && g["figure"] == name)
            return g["values"].at(std::stoul(f.name.substr(f.name.find('[') + 1)));
    return std::nullopt;
}

std::optional<double> value_of(const json& result, const Figure& f, const std::string& otherwise) {
    std::string name = f.structure.empty() ? otherwise : f.structure;
    if (result.contains("scale")) return grown(result, f, name);
    if (!result.contains("structures") && !result.contains("sweeps"))
        return result.contains(f.name) ? std::optional<double>(result[f.name]) : std::nullopt;
    const json* s = structure_of(result, name);
    if (!s) return std::nullopt;
    const double size =
        result.contains("size") ? double(result["size"]) : double(result["sweeps"][0]["size"]);
    if (f.name == "items") return double((*s)["items"]) / size;
    if (f.name == "bytes") return double((*s)["bytes"]) / size;
    if (f.name == "memory") return (*s)["bytes"];
    if (f.name == "depth") return (*s)["depth"];
    // Take the mean over the kinds of queries that fit.
    double sum = 0, kinds = 0;
    for (const json& q : (*s)["queries"])
        if (q["ask"] == f.ask && q.contains(f.name) &&
            (f.set.empty() || q["kind"].get<std::string>().ends_with(", " + f.set + " rays")))
            sum += double(q[f.name]), ++kinds;
    return kinds > 0 ? std::optional(sum / kinds) : std::nullopt;
}

const std::string number_pattern = "[0-9][0-9,]*(?:\\.[0-9]+)?";

/// The value in the format of the document's sample: as many decimals, and commas if the sample has them.
std::string written_as(const std::string& sample, double value) {
    const auto point = sample.find('.');
    char text[64];
    std::snprintf(text, sizeof text, "%.*f",
                  point == sample.npos ? 0 : static_cast<int>(sample.size() - point - 1), value);
    std::string digits = text;
    const auto whole = std::min(digits.find('.'), digits.size());
    if (sample.find(',') != sample.npos)
        for (auto at = static_cast<std::ptrdiff_t>(whole) - 3; at > 0; at -= 3)
            digits.insert(static_cast<std::size_t>(at), ",");
    return digits;
}

class Document {
public:
    explicit Document(const std::string& name)
        : name_("docs/" + name),
          path_(std::string(HEDGEROW_SOURCE "/docs/") + name),
          lines_(split_lines(bytes_of(path_))) {}

    void check() {
        for (std::size_t i = 0; i < lines_.size(); ++i) {
            if (!lines_[i].starts_with("<!-- figures: ")) continue;
            // Join the lines of the comment.
            std::string mark;
            for (;; ++i) {
                mark += lines_.at(i) + " ";
                if (lines_[i].find("-->") != std::string::npos) break;
            }
            mark = mark.substr(14, mark.find("-->") - 14);
            marked(mark, i + 1);
        }
        EXPECT_GT(figures_, 50u) << "the marks are no longer found";
        if (std::getenv("HEDGEROW_REWRITE")) {
            std::string text;
            for (const std::string& l : lines_) text += l + "\n";
            std::ofstream(path_, std::ios::binary) << text;
        }
    }

private:
    static Strings split_lines(const std::string& text) {
        Strings lines;
        std::istringstream in(text);
        for (std::string line; std::getline(in, line);) lines.push_back(line);
        return lines;
    }

    /// The commands of the first block of commands after a line.
    Strings commands_after(std::size_t line) const {
        Strings commands;
        while (line < lines_.size() && lines_[line] != "```sh") ++line;
        for (++line; line < lines_.size() && lines_[line] != "```"; ++line)
            if (lines_[line].starts_with("hedgerow ")) commands.push_back(lines_[line]);
        return commands;
    }

    struct Source {
        std::vector<Figure> figures;
        std::string command;
    };
    Source source_of(std::string text, const Strings& commands) const {
        Source s;
        std::string which = "1";
        if (const auto of = text.find(" of "); of != text.npos)
            which = trimmed(text.substr(of + 4)), text.resize(of);
        if (which.starts_with("hedgerow "))
            s.command = which;
        else
            s.command = commands.at(std::stoul(which) - 1);
        for (const std::string& f : split(text, text.find(", ") != text.npos ? ", " : " / "))
            s.figures.push_back(figure_of(f));
        // If several figures share a structure, it is given once, after the last of them.
        for (Figure& f : s.figures)
            if (f.structure.empty()) f.structure = s.figures.back().structure;
        return s;
    }

    void marked(const std::string& mark, std::size_t line) {
        const Strings commands = commands_after(line);
        const Strings items = split(mark, ";");
        // Collect the exceptions.
        std::vector<std::pair<std::string, std::size_t>> except;
        std::smatch m;
        for (const std::string& item : items)
            if (std::regex_match(item, m, std::regex("except (row|column) ([0-9]+)")))
                except.emplace_back(m[1], std::stoul(m[2]));
        // Check the figures of each item.
        for (const std::string& item : items) {
            if (item.empty() || item.starts_with("except ")) continue;
            if (std::regex_match(item, m, std::regex("(row|column) ([0-9]+): (.*)"))) {
                table(m[1] == "row", std::stoul(m[2]), source_of(m[3], commands), line, except);
            } else if (std::regex_match(item, m, std::regex("cell ([0-9]+) ([0-9]+): (.*)"))) {
                table(true, std::stoul(m[1]), source_of(m[3], commands), line, {}, std::stoul(m[2]));
            } else if (std::regex_match(item, m, std::regex("\"(.*)\" = (.*)"))) {
                prose(m[1], source_of(m[2], commands), line);
            } else {
                ADD_FAILURE() << name_ << ":" << line << ": '" << item << "' is no mark of figures";
            }
        }
    }

    /// Checks one row, column or cell of the next table.
    void table(bool is_row, std::size_t number, const Source& source, std::size_t line,
               const std::vector<std::pair<std::string, std::size_t>>& except, std::size_t only_column = 0) {
        while (line < lines_.size() && !lines_[line].starts_with("|")) ++line;
        const Strings head = cells_of(lines_.at(line));
        for (std::size_t row = 1; line + 1 + row < lines_.size() && lines_[line + 1 + row].starts_with("|");
             ++row) {
            Strings cells = cells_of(lines_[line + 1 + row]);
            for (std::size_t column = 2; column <= cells.size(); ++column) {
                if ((is_row ? row : column) != number || (only_column && column != only_column)) continue;
                if (std::find(except.begin(), except.end(), std::pair(std::string("row"), row)) !=
                        except.end() ||
                    std::find(except.begin(), except.end(), std::pair(std::string("column"), column)) !=
                        except.end())
                    continue;
                std::string& cell = cells[column - 1];
                Source here = source;
                for (Figure& f : here.figures)
                    f.name = std::regex_replace(f.name, std::regex("\\[size\\]"),
                                                "[" + std::to_string(column - 2) + "]");
                cell = compared(cell, here, is_row ? head[column - 1] : cells[0], line + 2 + row);
            }
            lines_[line + 1 + row] = "|";
            for (const std::string& c : cells) lines_[line + 1 + row] += " " + c + " |";
        }
    }
    static Strings cells_of(const std::string& line) {
        Strings cells = split(line, "|");
        return {cells.begin() + 1, cells.end() - 1};
    }

    void prose(const std::string& pattern, const Source& source, std::size_t line) {
        Strings parts = split_raw(pattern);
        std::string expression;
        // Make an expression that finds the text with a number in place of each {}.
        for (std::size_t i = 0; i < parts.size(); ++i)
            expression += (i > 0 ? "(" + number_pattern + "(?: [kM]?B)?)" : "") +
                          std::regex_replace(parts[i], std::regex("[\\^$.|?*+()\\[\\]{}\\\\]"), "\\$&");
        const std::regex wanted(expression);
        // Check the numbers of the first line that matches.
        for (std::size_t i = line; i < lines_.size(); ++i) {
            std::smatch m;
            if (!std::regex_search(lines_[i], m, wanted)) continue;
            ASSERT_EQ(m.size() - 1, source.figures.size()) << name_ << ": " << pattern;
            std::string text = parts[0];
            for (std::size_t k = 1; k < m.size(); ++k)
                text += compared(m[k], {{source.figures[k - 1]}, source.command}, "", i + 1) + parts[k];
            lines_[i].replace(static_cast<std::size_t>(m.position(0)), static_cast<std::size_t>(m.length(0)),
                              text);
            return;
        }
        ADD_FAILURE() << name_ << ": no text is like '" << pattern << "' after line " << line;
    }
    static Strings split_raw(const std::string& pattern) {
        Strings parts;
        std::size_t from = 0;
        for (std::size_t at; (at = pattern.find("{}", from)) != pattern.npos; from = at + 2)
            parts.push_back(pattern.substr(from, at - from));
        parts.push_back(pattern.substr(from));
        return parts;
    }

    /// Returns a cell with its figures corrected. Fails the test if they differ, unless documents are
    /// rewritten.
    std::string compared(const std::string& cell, const Source& source, const std::string& structure,
                         std::size_t line) {
        Strings parts = split(cell, " / ");
        if (parts.size() != source.figures.size()) {
            ADD_FAILURE() << name_ << ":" << line << ": '" << cell << "' should have "
                          << source.figures.size() << " figures";
            return cell;
        }
        std::string right;
        for (std::size_t i = 0; i < parts.size(); ++i) {
            const Figure& f = source.figures[i];
            const auto value = value_of(result_of(source.command, f.ask), f, structure);
            std::smatch m;
            const bool number = std::regex_search(parts[i], m, std::regex(number_pattern));
            if (!value || !number) {
                ADD_FAILURE() << name_ << ":" << line << ": '" << cell << "': no " << f.name << " of '"
                              << (f.structure.empty() ? structure : f.structure) << "' by " << source.command;
                return cell;
            }
            ++figures_;
            const std::string is = f.name == "memory" ? parts[i] : m.str();
            const std::string should =
                f.name == "memory" ? measure::bytes_text(*value) : written_as(is, *value);
            EXPECT_TRUE(is == should || std::getenv("HEDGEROW_REWRITE"))
                << name_ << ":" << line << ": " << f.set << " " << f.name << " of "
                << (f.structure.empty() ? structure : f.structure) << " is " << is << " and should be "
                << should << ", by " << source.command << "; scripts/figures corrects the documents";
            if (i > 0) right += " / ";
            right += f.name == "memory"
                         ? should
                         : parts[i].replace(static_cast<std::size_t>(m.position(0)), is.size(), should);
        }
        return right;
    }

    std::string name_, path_;
    Strings lines_;
    std::size_t figures_ = 0;
};

TEST(Figures, OfStructuresAreWhatTheCommandsPrint) {
    Document("structures.md").check();
}
TEST(Figures, OfClaimsAreWhatTheCommandsPrint) {
    Document("claims.md").check();
}

std::string joined(const std::vector<std::string>& words) {
    std::string all;
    for (const auto& word : words) all += (all.empty() ? "" : " ") + word;
    return all;
}
std::string columns_of(const QuestionInfo& info) {
    std::vector<std::string> names;
    for (const Column& c : info.answered) names.push_back(c.name);
    return joined(names);
}

// The table of docs/queries.md is what the questions say.
TEST(Figures, ColumnsOfQueriesAreThoseOfTheQuestions) {
    std::ifstream file(std::string(HEDGEROW_SOURCE) + "/docs/queries.md");
    std::vector<std::vector<std::string>> table;  // the three cells of each row
    for (std::string line; std::getline(file, line);) {
        if (!line.starts_with("| `")) continue;
        std::vector<std::string> cells;
        std::istringstream in(line.substr(2));
        for (std::string cell; std::getline(in, cell, '|');) cells.push_back(cell);
        if (cells[1] == " the same ") cells[1] = table.back()[1];
        table.push_back(cells);
    }
    for (const auto* const question : any_questions<float, 3>()) {
        const QuestionInfo& info = question->info();
        const std::string name = "`" + std::string(info.name) + "`";
        const auto row = std::find_if(table.begin(), table.end(),
                                      [&](const auto& cells) { return cells[0].starts_with(name); });
        ASSERT_NE(row, table.end()) << name << " is not in docs/queries.md";
        std::vector<std::string> asked = info.asked.names;
        if (!info.asked.defaults.empty()) asked[info.asked.required()].insert(0, "["), asked.back() += "]";
        EXPECT_NE((*row)[1].find(joined(asked)), std::string::npos) << name << " reads " << joined(asked);
        // What a feature tells comes after what a closest point does.
        std::string columns = columns_of(info);
        if (info.variant == "feature") columns = columns.substr(columns.find("feature"));
        EXPECT_NE((*row)[2].find(columns), std::string::npos) << name << " answers " << columns;
        for (const auto& option : info.options) {
            if (option.name == "error") continue;  // of `--by expansion`, below the table
            const std::string said = (*row)[0] + (*row)[1];
            EXPECT_NE(said.find("--" + std::string(option.name)), std::string::npos)
                << name << " takes --" << option.name;
        }
    }
}

}  // namespace
