/// What `compare` found, and the three ways to say it: tables, JSON, a page.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include <hedgerow/compare/advice.h>
#include <hedgerow/compare/growth.h>
#include <hedgerow/compare/lists.h>

namespace hedgerow::cli {

struct CompareReport {
    std::string scene;
    std::vector<std::string> notes;                ///< what a reader of the figures must know
    compare::Ask ask = compare::Ask::closest_hit;  ///< what break-even, advice and growth are about
    std::optional<compare::Comparison> comparison;
    struct Swept {
        compare::Sweep sweep;
        compare::Comparison comparison;
    };
    std::vector<Swept> sweeps;
    std::vector<compare::Comparison> by_size;
};

/// Columns of text under titles; the first is set to the left, the others to the right.
struct Table {
    std::string title, note;
    std::vector<std::string> columns;
    std::vector<std::vector<std::string>> rows;
};

/// Everything that is found, as tables: what the terminal and the page show.
std::vector<Table> tables_of(const CompareReport& report);
/// What to use for what, a line each.
std::vector<std::string> advice_lines(const CompareReport& report);

std::string text_of(const Table& table);
nlohmann::ordered_json json_of(const CompareReport& report);
/// One file, with plots, that needs no other.
std::string page_of(const CompareReport& report);

}  // namespace hedgerow::cli
