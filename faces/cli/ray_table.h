/// What a ray visits, as rows of numbers.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <hedgerow/trace.h>

#include "flat.h"

namespace hedgerow::cli {

/// A row of a trace's table: a visited cell, and what was tested there.
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
    /// Of a walk that was stopped at its first hit: the nearest one.
    std::optional<std::pair<PrimitiveId, double>> nearest;
    Visits visits;
    /// In the picture's plane.
    Vec2d flat_origin, flat_direction;

    /// Whether the walk was stopped at a hit beyond the nearest one.
    bool wrong() const { return nearest && hit->second != nearest->second; }
    Vec2d at(double t) const { return flat_origin + flat_direction * t; }
    /// One line: what it took and what came of it.
    std::string summary() const;
    /// Ends the walk in the first leaf where anything is met, in the cell or beyond: what comes of it where a
    /// hit need not lie in its cell, and the walk does not go on either.
    void stop_at_first_hit();
};

/// The heads of the columns, and a row's texts for them; steps count from 1.
std::span<const std::string_view> table_columns();
std::vector<std::string> texts_of(const TraceRow& row, std::size_t step);
/// For people, a line a visit.
std::string text_of(const TraceTable& table);

/// "[0.1, 0.25]"
std::string interval_text(const Interval<double>& in);

}  // namespace hedgerow::cli
