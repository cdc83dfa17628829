/// The results of `compare`, and their output as tables, JSON and a page.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include <hedgerow/measure/advice.h>
#include <hedgerow/measure/growth.h>
#include <hedgerow/measure/lists.h>

#include "report/table.h"

namespace hedgerow::cli {

struct CompareReport {
    std::string scene;
    std::vector<std::string> notes;    ///< facts that a reader of the figures must know
    measure::Ask ask = "closest-hit";  ///< the query of break-even, advice and growth
    bool timed = true;                 ///< false: counts alone
    std::optional<measure::Comparison> comparison;
    struct Swept {
        measure::Sweep sweep;
        measure::Comparison comparison;
    };
    std::vector<Swept> sweeps;
    std::vector<measure::Comparison> by_size;
};

/// All results as tables, for the terminal and for the page.
std::vector<Table> tables_of(const CompareReport& report);
/// A line for each need: the structure to use, and why. Empty without times or without a comparison.
std::vector<std::string> advice_lines(const CompareReport& report);
/// One table with a row for each structure. Nothing if only sweeps or growth were measured.
std::optional<Table> summary_of(const CompareReport& report);
/// Notes about the rays that a reader of the figures must know.
std::vector<std::string> ray_notes(const measure::Comparison& comparison);

nlohmann::ordered_json json_of(const CompareReport& report);
/// An HTML page with plots, which needs no other file.
std::string page_of(const CompareReport& report);

}  // namespace hedgerow::cli
