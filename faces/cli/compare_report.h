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
    bool timed = true;                             ///< false: counts alone
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
/// What to use for what and why, a line each. None without times.
std::vector<std::string> advice_lines(const CompareReport& report);
/// All structures, a row each; none where only an option or growth was looked at.
std::optional<Table> summary_of(const CompareReport& report);
/// What must be known of the rays to read the figures.
std::vector<std::string> ray_notes(const compare::Comparison& comparison);

nlohmann::ordered_json json_of(const CompareReport& report);
/// One file, with plots, that needs no other.
std::string page_of(const CompareReport& report);

}  // namespace hedgerow::cli
