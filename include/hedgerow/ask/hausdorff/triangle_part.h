/// Parts of triangles, and what bounds their distance by corners alone.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <limits>

#include <hedgerow/geometry/rounding.h>
#include <hedgerow/geometry/vec.h>
#include <hedgerow/primitives/concepts.h>

namespace hedgerow::detail {

/// A triangle of A, or a part of one.
struct TrianglePart {
    Vec3d corner[3];
    double distance[3];      // at least those of the corners to B
    PrimitiveId nearest[3];  // the elements of B closest to the corners
    PrimitiveId others[5];   // and to points that were asked for before, the latest first
    PrimitiveId element;     // of A
    double bound = std::numeric_limits<double>::infinity();  // at least the distance of any point to B
    double at = 0.5;        // where to divide the edge from corner `edge` to the next, from 0 to 1
    std::uint8_t edge = 0;  // the longest, unless another is to be divided
    std::uint8_t age = 0;   // how many cuts ago the longest edge was halved
    bool asked_middle = false;

    explicit TrianglePart(PrimitiveId of) : element(of) { std::fill(others, std::end(others), no_primitive); }
    Vec3d centroid() const { return (corner[0] + corner[1] + corner[2]) / 3.0; }
    Vec3d cut() const { return corner[edge] + (corner[(edge + 1) % 3] - corner[edge]) * at; }
    void remember(PrimitiveId element_of_b) {
        if (std::find(others, std::end(others), element_of_b) != std::end(others)) return;
        std::copy_backward(others, std::end(others) - 1, std::end(others));
        others[0] = element_of_b;
    }
    void move_corner(int k, const Vec3d& to, double above, PrimitiveId element_of_b) {
        remember(nearest[k]);
        corner[k] = to, distance[k] = above, nearest[k] = element_of_b;
    }
    /// Lowers the bound by the distances of the corners, if that may bring it down to `wanted`. Finds the
    /// longest edge.
    void bound_by_corners(double wanted);
};

/// No point of a part is farther from a corner than the corner's longer edge, nor from the nearest corner
/// than the part's circumradius, or half the longest edge of an obtuse part.
inline void TrianglePart::bound_by_corners(double wanted) {
    double edge2[3];
    for (int k = 0; k < 3; ++k) edge2[k] = length2(corner[(k + 1) % 3] - corner[k]);
    const int longest = static_cast<int>(std::max_element(edge2, edge2 + 3) - edge2);
    edge = static_cast<std::uint8_t>(longest);
    const double x2 = edge2[(longest + 1) % 3], y2 = edge2[(longest + 2) % 3], z2 = edge2[longest];
    // A corner's longer edge and the circumradius are at least half the longest edge.
    const double room = 2 * (std::min(wanted, bound) - std::min({distance[0], distance[1], distance[2]}));
    if (room < 0 || product(room, room) < product(z2, 1 - 0x1p-40)) return;
    const double turned = x2 + y2 - z2 + product(z2, 0x1p-48);  // |x|·|y|·cos, doubled and rounded up
    const double sine = product(x2, y2) - product(turned, turned) / 4;  // (|x|·|y|·sin)²
    double radius2 = z2 / 4;
    if (turned > 0)
        radius2 = sine > 0x1p-900 ? std::min(z2 / 3, product(radius2, product(x2, y2) / sine)) : z2 / 3;
    double least = std::max({distance[0], distance[1], distance[2]}) + std::sqrt(radius2);
    for (int k = 0; k < 3; ++k)
        least = std::min(least, distance[k] + std::sqrt(std::max(edge2[k], edge2[(k + 2) % 3])));
    bound = std::min(bound, product(least, 1 + 0x1p-40));
}

}  // namespace hedgerow::detail
