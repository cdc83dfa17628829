/// `compare --visibility`: what finding the visible costs by rasterising and by casting rays, over numbers of
/// triangles and of pixels.
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include <hedgerow/measure/visibility.h>

#include "report/table.h"

namespace hedgerow::cli {

struct VisibilityReport {
    std::string scene;
    std::vector<measure::VisibilityCase> cases;
};

/// A table for each case.
std::vector<Table> tables_of(const VisibilityReport& report);
/// For each case, from how many pictures on the fastest casting takes less time than the fastest rasterising.
std::vector<std::string> break_even_lines(const VisibilityReport& report);
nlohmann::ordered_json json_of(const VisibilityReport& report);
/// An HTML page with plots, which needs no other file.
std::string page_of(const VisibilityReport& report);

}  // namespace hedgerow::cli
