/// The faults of a mesh, as `info --check` prints them.
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include <hedgerow/primitives/triangle_mesh.h>

#include "common.h"

namespace hedgerow::cli {

/// What is wrong with a mesh. Vertices with equal coordinates are one, however they are indexed.
struct MeshFaults {
    /// A kind of fault: how often it occurs, and where, as a person reads it.
    struct Line {
        std::string kind;
        std::size_t count;
        std::string where;
    };
    std::vector<Line> lines;
    nlohmann::ordered_json facts;
};

/// Looks for holes, edges along which triangles run the same way, parts turned inside out, triangles without
/// area, duplicates, vertices that are unused or not finite, and triangles that intersect. O(n) but for the
/// last, which is an index and a walk over pairs. Shows progress, and throws Cancelled when interrupted.
template <class T>
MeshFaults faults_of(const Common& c, const TriangleMesh<T>& mesh);

/// Prints a line for each kind of fault.
void print_faults(const MeshFaults& faults);

}  // namespace hedgerow::cli
