/// A ray's walk in one structure, part by part: pictures draw the steps together, pages in groups of their
/// own.
#pragma once

#include <optional>
#include <unordered_map>
#include <vector>

#include "labels.h"
#include "picture_parts.h"

namespace hedgerow::cli {

/// What is seen of a ray, in t, and of the plane with it: from its origin, if that is near, to its farthest
/// hit in any of the structures, or to a little beyond the scene.
struct RayFrame {
    double first = 0, last = 0;
    Box2d shown;

    RayFrame(const FlatScene& scene, const std::vector<RayView>& views);
};

class RayDrawing {
public:
    /// The tree stands at the right of the cells, if the structure has one.
    RayDrawing(Svg& svg, const FlatScene& scene, const RayView& view, const RayFrame& frame,
               const Box2d& area);

    static std::string style();
    static void add_legend(Svg& svg, const Vec2d& at, bool numbers, bool tree);

    /// All cells, primitives and nodes, pale.
    void ground();
    void ray();
    void hit();

    // Of step i, from 0.
    void cell(std::size_t i);
    void tests(std::size_t i);
    /// The ray's part in the cell, with t where it begins and ends.
    void interval(std::size_t i);
    void node(std::size_t i);

    /// A leaf's number stands where the ray is in it; nodes are numbered where the ray enters them, those
    /// that it enters at one place together.
    void numbers();

private:
    Vec2d at(double t) const;
    std::string colour(std::size_t step) const;

    Svg& svg_;
    const FlatScene& scene_;
    const FlatStructure& all_;
    const TraceTable& table_;
    const RayFrame& frame_;
    double last_;  ///< t where this structure's ray ends
    Box2d cells_area_;
    Panel panel_;
    std::optional<TreePanel> tree_panel_;
    const TreeShape& tree_;
    std::unordered_map<PrimitiveId, const FlatPrimitive*> primitives_;
};

}  // namespace hedgerow::cli
