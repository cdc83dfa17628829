/// Fans of rays in flat pictures: as single rays over the cells of structures, and as one beam.
#pragma once

#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

#include "pictures.h"
#include "report/svg.h"

namespace hedgerow::cli {

/// The rays of a fan in the plane of the picture, and where each ends: at its hit, or where it leaves what
/// the picture shows.
struct FlatFan {
    Vec2d origin;
    std::vector<Vec2d> directions;
    /// The t of each ray's hit.
    std::vector<std::optional<double>> hits;

    /// The box of a picture of this fan: `scene`, and the rays up to their hits, with a margin.
    Box2d shown(const Box2d& scene) const;
    Vec2d end(std::size_t ray, const Box2d& shown) const;
};

/// A structure, and what the walks of a fan's rays did there: how many rays looked into each leaf, and how
/// many found their hit there.
struct FanView {
    NamedStructure structure;
    std::unordered_map<NodeId, int> looked_into, ended;
};

/// An SVG of a fan over the cells of each structure: those in which a ray's hit was found, those that rays
/// only passed through, and those that none visited.
std::string fan_picture(const FlatScene& scene, const FlatFan& fan, const std::vector<FanView>& views);

/// Rays `first` to `last` of a fan, after a beam was halved `level` times. A part that sees one thing ends
/// there. A part of two rays may be left undecided: an edge is between them, or near.
struct BeamPart {
    enum class Sees { nothing, one, undecided };
    std::size_t first, last;
    int level;
    Sees sees;
};

/// An SVG of the parts into which a beam divides, coloured by how often they were halved. `fact` is a line
/// below.
std::string beam_picture(const FlatScene& scene, const FlatFan& fan, const std::vector<BeamPart>& parts,
                         const std::string& fact);

}  // namespace hedgerow::cli
