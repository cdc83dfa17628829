/// What `compare` found, and the three ways to say it: tables, JSON, a page.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include <hedgerow/compare/advice.h>
#include <hedgerow/compare/growth.h>
#include <hedgerow/compare/lists.h>

#include "table.h"

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

/// Everything that is found, as tables: what the terminal and the page show.
std::vector<Table> tables_of(const CompareReport& report);
/// What to use for what, a line each.
std::vector<std::string> advice_lines(const CompareReport& report);

nlohmann::ordered_json json_of(const CompareReport& report);
/// One file, with plots, that needs no other.
std::string page_of(const CompareReport& report);

}  // namespace hedgerow::cli
