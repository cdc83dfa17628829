/// Draws a ray's walk in one structure part by part. A picture draws all steps together, a page each step in
/// a group of its own.
#pragma once

#include <optional>
#include <unordered_map>
#include <vector>

#include "labels.h"
#include "picture_parts.h"

namespace hedgerow::cli {

/// The part of a ray that is drawn, from t = `first` to `last`, and the box of the plane around it. The part
/// begins at the origin, or shortly before the scene if the origin is farther away than 0.3 of the box's
/// diagonal. It ends at the farthest hit in any of the structures, or a little beyond the scene if the ray
/// misses in one of them.
struct RayFrame {
    double first = 0, last = 0;
    Box2d shown;

    RayFrame(const FlatScene& scene, const std::vector<RayView>& views);
};

class RayDrawing {
public:
    /// The tree is drawn at the right of the cells, if the structure has one.
    RayDrawing(Svg& svg, const FlatScene& scene, const RayView& view, const RayFrame& frame,
               const Box2d& area);

    static std::string style();
    static void add_legend(Svg& svg, const Vec2d& at, bool numbers, bool tree);

    /// All cells, primitives and nodes, pale.
    void ground();
    void ray();
    void hit();

    // The parts of step i, from 0: cell, tested primitives, interval, node of the tree.
    void cell(std::size_t i);
    void tests(std::size_t i);
    /// The ray's part in the cell, with t at both ends.
    void interval(std::size_t i);
    void node(std::size_t i);

    /// The numbers of the steps. A leaf's number is at the middle of the ray's part in it. A node's number is
    /// where the ray enters it; nodes that the ray enters at nearly one place share a label.
    void numbers();

private:
    Vec2d at(double t) const;
    std::string colour(std::size_t step) const;

    Svg& svg_;
    const FlatScene& scene_;
    const FlatStructure& all_;
    const TraceTable& table_;
    const RayFrame& frame_;
    double last_;  ///< t where the ray ends in this structure
    Box2d cells_area_;
    Panel panel_;
    std::optional<TreePanel> tree_panel_;
    const TreeShape& tree_;
    std::unordered_map<PrimitiveId, const FlatPrimitive*> primitives_;
};

}  // namespace hedgerow::cli
