/// The walk of a ray as rows of numbers.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <hedgerow/trace.h>

#include "flat.h"

namespace hedgerow::cli {

/// A step of the walk: a visited cell, and the primitives that were tested there.
struct TraceRow {
    NodeId node, parent;
    int level;
    bool leaf;
    std::vector<double> low, high;
    Interval<double> inside;
    double limit;
    std::vector<TraceTest<double>> tests;
    Corners corners;
};
struct TraceTable {
    std::string structure;
    std::vector<double> origin, direction;
    std::vector<TraceRow> rows;
    std::optional<std::pair<PrimitiveId, double>> hit;
    /// The nearest hit, if the walk was stopped at its first one.
    std::optional<std::pair<PrimitiveId, double>> nearest;
    Visits visits;
    /// The ray in the picture's plane.
    Vec2d flat_origin, flat_direction;

    /// Whether the walk was stopped at a hit beyond the nearest one.
    bool wrong() const { return nearest && hit->second != nearest->second; }
    Vec2d at(double t) const { return flat_origin + flat_direction * t; }
    /// One line: counts and hit of the walk; for a stopped walk its steps, its hit and the nearest one.
    std::string summary() const;
    /// Ends the walk at the first leaf with a hit, in its cell or beyond, and moves the true hit to
    /// `nearest`. Shows the error of a walk that neither requires a hit to be in the cell nor continues.
    void stop_at_first_hit();
};

/// The headings of the columns, and the texts of a row. Steps are numbered from 1.
std::span<const std::string_view> table_columns();
std::vector<std::string> texts_of(const TraceRow& row, std::size_t step);
/// The table as text: a line for each visit, and the summary.
std::string text_of(const TraceTable& table);

/// An interval as text: "[0.1, 0.25]".
std::string interval_text(const Interval<double>& in);

}  // namespace hedgerow::cli
