/// The flat pictures that `draw` makes, as SVG and HTML.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <hedgerow/trace.h>

#include "flat.h"

namespace hedgerow::cli {

/// What a picture shows, beside structures. The frame is of everything that is to be seen.
struct FlatScene {
    std::string title;
    std::vector<FlatPrimitive> primitives;
    int width, height;
};
struct NamedStructure {
    std::string name;
    std::vector<std::string> facts;  // a line each
    FlatStructure flat;
};

/// Structures side by side over the same primitives: cells coloured by level, with a legend; what siblings
/// share is hatched.
std::string cells_picture(const FlatScene& scene, const std::vector<NamedStructure>& structures);

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

    /// Tested here, not skipped.
    std::size_t tested() const;
};
struct TraceTable {
    std::string structure;
    std::vector<double> origin, direction;
    std::vector<TraceRow> rows;
    std::optional<std::pair<PrimitiveId, double>> hit;
    Visits visits;
    /// In the picture's plane.
    Vec2d flat_origin, flat_direction;

    Vec2d at(double t) const { return flat_origin + flat_direction * t; }
    /// One line: what it took and what came of it.
    std::string summary() const;
};
/// For people, a line a visit.
std::string text_of(const TraceTable& table);

/// The cells that a ray visits, numbered in order, over all others; the primitives that were tested, and
/// where it hits.
std::string ray_picture(const FlatScene& scene, const FlatStructure& all, const TraceTable& table);
/// A page that steps through the same, beside the table: by buttons, arrow keys and clicks.
std::string ray_page(const FlatScene& scene, const FlatStructure& all, const TraceTable& table);

}  // namespace hedgerow::cli
