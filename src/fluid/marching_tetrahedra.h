/// Marching tetrahedra (Doi and Koide 1991) on a block of a lattice.
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <utility>
#include <vector>

#include "colour_field.h"

namespace hedgerow::detail {

/// Names a lattice edge at a cell of a block. Bits 0 to 11 number the edges of the block that owns it. Bits
/// 12, 13 and 14 are set if that is the next block along x, y and z. An edge goes from its lower corner in
/// one of seven directions, whose bits are the axes along which it goes. The block that owns the lower corner
/// owns the edge.
using EdgeCode = std::uint16_t;
inline constexpr int code_bits = 12;
inline constexpr std::size_t edges_of_block = 7 * block_cells * block_vertices * block_vertices;
static_assert(edges_of_block <= 1u << code_bits);

constexpr EdgeCode edge_code(int direction, int x, int y, int z) {
    const int next = (x == block_cells ? 1 : 0) | (y == block_cells ? 2 : 0) | (z == block_cells ? 4 : 0);
    x %= block_cells, y %= block_cells, z %= block_cells;
    const int code = (((direction - 1) * block_cells + z) * block_vertices + y) * block_vertices + x;
    return static_cast<EdgeCode>(next << code_bits | code);
}

/// An edge of a cell: its lower corner and its direction. Bit k of a corner's number is set if the corner is
/// the upper one along axis k.
struct CellEdge {
    std::uint8_t corner, direction;
};
/// The triangles of a cell: at most two in each of six tetrahedra.
struct CellTriangles {
    int count = 0;
    std::array<std::array<CellEdge, 3>, 12> edges = {};
};

/// Adds the triangles of a tetrahedron whose corners are those of a cell. `inside` has a bit for each corner
/// of the cell. Where `positive`, corners 1, 2 and 3 are counterclockwise seen from beyond them.
constexpr void add_tetrahedron(std::array<int, 4> corners, bool positive, unsigned inside,
                               CellTriangles& found) {
    // Put corners inside first; each exchange mirrors the tetrahedron.
    int in = 0;
    for (std::size_t i = 0; i < 4; ++i) {
        if ((inside >> corners[i] & 1) == 0) continue;
        const auto to = static_cast<std::size_t>(in++);
        if (i == to) continue;
        std::swap(corners[i], corners[to]);
        positive = !positive;
    }
    const auto edge = [&](std::size_t i, std::size_t j) {
        const int a = corners[i], b = corners[j];
        return CellEdge{static_cast<std::uint8_t>(a & b), static_cast<std::uint8_t>(a ^ b)};
    };
    const auto add = [&](CellEdge a, CellEdge b, CellEdge c) {
        if (!positive) std::swap(b, c);
        found.edges[static_cast<std::size_t>(found.count++)] = {a, b, c};
    };
    if (in == 1) add(edge(0, 1), edge(0, 2), edge(0, 3));
    if (in == 2) {
        add(edge(0, 2), edge(0, 3), edge(1, 3));
        add(edge(0, 2), edge(1, 3), edge(1, 2));
    }
    if (in == 3) add(edge(0, 3), edge(1, 3), edge(2, 3));
}

/// The triangles of a cell by the bits of its corners inside. Each of the six tetrahedra goes from corner 0
/// to corner 7 along the axes in one order, so tetrahedra meet face to face, also across cells. The surface
/// in a tetrahedron is one triangle or one quadrilateral, and each of its sides lies on a face between two
/// tetrahedra. So every edge has two triangles, and the triangles at a vertex are one ring around its lattice
/// edge.
constexpr std::array<CellTriangles, 256> make_cell_triangles() {
    constexpr std::array<std::array<int, 3>, 6> orders = {
        {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {0, 2, 1}, {2, 1, 0}, {1, 0, 2}}};
    std::array<CellTriangles, 256> all;
    for (unsigned inside = 0; inside < 256; ++inside)
        for (std::size_t k = 0; k < 6; ++k) {
            const auto& order = orders[k];
            add_tetrahedron({0, 1 << order[0], 1 << order[0] | 1 << order[1], 7}, k < 3, inside, all[inside]);
        }
    return all;
}
inline constexpr std::array<CellTriangles, 256> cell_triangles = make_cell_triangles();

/// The surface in a run of blocks, by blocks: vertices and the edges that they lie on, ascending within a
/// block, and triangles between edges.
struct SurfaceParts {
    std::vector<Vec3d> vertices;  // in cells
    std::vector<EdgeCode> edges;
    std::vector<std::array<EdgeCode, 3>> triangles;
    /// Where the vertices and triangles of each block end.
    std::vector<std::array<std::size_t, 2>> ends;
};

/// Adds the surface in a block. A lattice vertex is inside where its value is greater than the level.
inline void march(const BlockValues& values, float level, const BlockPlace& block, SurfaceParts& parts) {
    constexpr int n = block_vertices;
    // Find the corners that lie inside, 64 to a layer.
    std::array<std::uint64_t, n> inside{};
    std::uint64_t any = 0, all = ~std::uint64_t(0);
    for (std::size_t z = 0; z < n; ++z) {
        for (std::size_t i = 0; i < n * n; ++i)
            inside[z] |= std::uint64_t(values[n * n * z + i] > level) << i;
        any |= inside[z], all &= inside[z];
    }
    constexpr std::uint64_t owned = 0x007F7F7F7F7F7F7F;  // 7 of 8 corners along x and y
    // The bits of a layer's corners, moved to those that are lower by a corner's bits.
    const auto moved = [&](int z, int corner) {
        return inside[std::size_t(z) + std::size_t(corner >> 2)] >> ((corner & 1) + n * (corner >> 1 & 1));
    };
    if (any != 0 && ~all != 0) {
        // Put a vertex on each owned edge that has one end inside.
        for (int direction = 1; direction < 8; ++direction)
            for (int z = 0; z < block_cells; ++z)
                for (std::uint64_t rest = (moved(z, 0) ^ moved(z, direction)) & owned; rest != 0;
                     rest &= rest - 1) {
                    const int bit = std::countr_zero(rest), x = bit % n, y = bit / n;
                    const int step_x = direction & 1, step_y = direction >> 1 & 1, step_z = direction >> 2;
                    const int lower = n * n * z + bit, upper = lower + step_x + n * step_y + n * n * step_z;
                    const double a = static_cast<double>(values[static_cast<std::size_t>(lower)]),
                                 b = static_cast<double>(values[static_cast<std::size_t>(upper)]);
                    // A vertex keeps a 20th of the edge away from its ends, so no triangle is degenerate.
                    constexpr double least = 0.05;
                    const double t = std::clamp((static_cast<double>(level) - a) / (b - a), least, 1 - least);
                    const auto place = [&](int axis, int local, int step) {
                        return static_cast<double>(block.first(axis) + local) + t * step;
                    };
                    parts.vertices.push_back({place(0, x, step_x), place(1, y, step_y), place(2, z, step_z)});
                    parts.edges.push_back(edge_code(direction, x, y, z));
                }
        // Add the triangles of each cell that has corners on both sides.
        for (int z = 0; z < block_cells; ++z) {
            std::array<std::uint64_t, 8> corners;
            std::uint64_t some = 0, every = owned;
            for (int c = 0; c < 8; ++c) {
                const std::uint64_t bits = moved(z, c);
                corners[static_cast<std::size_t>(c)] = bits, some |= bits, every &= bits;
            }
            for (std::uint64_t rest = some & ~every & owned; rest != 0; rest &= rest - 1) {
                const int bit = std::countr_zero(rest), x = bit % n, y = bit / n;
                std::size_t mask = 0;
                for (std::size_t c = 0; c < 8; ++c) mask |= (corners[c] >> bit & 1) << c;
                const CellTriangles& found = cell_triangles[mask];
                const auto code = [&](const CellEdge& e) {
                    return edge_code(e.direction, x + (e.corner & 1), y + (e.corner >> 1 & 1),
                                     z + (e.corner >> 2));
                };
                for (std::size_t k = 0; k < static_cast<std::size_t>(found.count); ++k) {
                    const auto& [e, f, g] = found.edges[k];
                    parts.triangles.push_back({code(e), code(f), code(g)});
                }
            }
        }
    }
    parts.ends.push_back({parts.vertices.size(), parts.triangles.size()});
}

}  // namespace hedgerow::detail
