/// Smoothing of closed meshes (Taubin 1995) that keeps the volume of each connected part.
#pragma once

#include <cmath>
#include <cstdint>
#include <numeric>
#include <utility>
#include <vector>

#include <hedgerow/geometry/vec.h>
#include <hedgerow/parallel/executor.h>
#include <hedgerow/primitives/triangle_mesh.h>

namespace hedgerow::detail {

/// A closed manifold mesh that is smoothed in place. Every sum has one order, whatever the threads.
class Fairing {
public:
    /// Borrows the arrays.
    Fairing(std::vector<Vec3d>& vertices, const std::vector<TriangleIndices>& triangles, Executor& executor)
        : vertices_(vertices),
          executor_(executor),
          offsets_(vertices.size() + 1),
          corners_(3 * triangles.size()),
          areas_(vertices.size()) {
        // Sort the corners of triangles by their vertex.
        for (const auto& t : triangles)
            for (const std::uint32_t v : t) ++offsets_[v + 1];
        std::partial_sum(offsets_.begin(), offsets_.end(), offsets_.begin());
        std::vector<std::size_t> to(offsets_.begin(), offsets_.end() - 1);
        for (const auto& [a, b, c] : triangles)
            corners_[to[a]++] = {b, c}, corners_[to[b]++] = {c, a}, corners_[to[c]++] = {a, b};
        find_parts();
    }

    /// Smooths `passes` times, and gives each connected part the volume that it had before.
    void smooth(int passes) {
        // The filter passes shapes that are longer than about ten edges: 1 / shrink + 1 / swell = 0.1 is
        // Taubin's pass band.
        constexpr double shrink = 0.6307, swell = -0.6732;
        if (passes == 0) return;
        const std::vector<double> wanted = volumes();
        for (int pass = 0; pass < passes; ++pass) {
            executor_.look();
            move_to_neighbours(shrink);
            move_to_neighbours(swell);
            restore(wanted);
        }
    }

    /// The normals of the vertices, of length 1.
    std::vector<Vec3f> normals() {
        find_areas();
        std::vector<Vec3f> all(vertices_.size());
        for_each_vertex([&](std::size_t v) {
            const Vec3d n = normalized(areas_[v]);
            all[v] = n == Vec3d() ? Vec3f(0, 0, 1) : Vec3f(n);
        });
        return all;
    }

private:
    /// The other two corners of a triangle, in its order.
    struct Corner {
        std::uint32_t next, last;
    };

    template <class F>
    void for_each_vertex(F f) {
        executor_.for_each_piece(vertices_.size(), 4096, [&](std::size_t begin, std::size_t end) {
            for (std::size_t v = begin; v < end; ++v) f(v);
        });
    }

    /// Numbers the connected parts, in the order of their first vertices.
    void find_parts() {
        constexpr std::uint32_t none = 0xFFFFFFFFu;
        part_.assign(vertices_.size(), none);
        std::vector<std::uint32_t> open;
        for (std::size_t first = 0; first < part_.size(); ++first) {
            if (part_[first] != none) continue;
            const auto part = static_cast<std::uint32_t>(anchors_.size());
            anchors_.push_back(vertices_[first]);
            part_[first] = part;
            open.push_back(static_cast<std::uint32_t>(first));
            while (!open.empty()) {
                const std::uint32_t v = open.back();
                open.pop_back();
                for (std::size_t c = offsets_[v]; c < offsets_[v + 1]; ++c)
                    if (const std::uint32_t w = corners_[c].next; part_[w] == none) {
                        part_[w] = part;
                        open.push_back(w);
                    }
            }
        }
    }

    /// Moves each vertex a share of the way to the mean of its neighbours.
    void move_to_neighbours(double share) {
        moved_.resize(vertices_.size());
        for_each_vertex([&](std::size_t v) {
            // In a closed mesh every neighbour is the next corner of one triangle.
            Vec3d sum;
            for (std::size_t c = offsets_[v]; c < offsets_[v + 1]; ++c)
                sum += vertices_[corners_[c].next] - vertices_[v];
            moved_[v] = vertices_[v] + sum * (share / static_cast<double>(offsets_[v + 1] - offsets_[v]));
        });
        vertices_.swap(moved_);
    }

    /// The area vector of each vertex: the sum over its triangles of area times normal. A third of it is the
    /// change of volume as the vertex moves.
    void find_areas() {
        for_each_vertex([&](std::size_t v) {
            Vec3d sum;
            for (std::size_t c = offsets_[v]; c < offsets_[v + 1]; ++c)
                sum += cross(vertices_[corners_[c].next] - vertices_[v],
                             vertices_[corners_[c].last] - vertices_[v]);
            areas_[v] = sum / 2.0;
        });
    }

    /// The volume of each part, less than 0 for a hollow inside another part.
    std::vector<double> volumes() {
        find_areas();
        std::vector<double> sums(anchors_.size());
        for (std::size_t v = 0; v < vertices_.size(); ++v)
            sums[part_[v]] += product(dot(vertices_[v] - anchors_[part_[v]], areas_[v]), 1.0 / 9);
        return sums;
    }

    /// Moves each part along its normals until it has the wanted volume, to first order.
    void restore(const std::vector<double>& wanted) {
        std::vector<double> step = volumes(), growth(anchors_.size());
        for (std::size_t v = 0; v < vertices_.size(); ++v) growth[part_[v]] += length(areas_[v]) / 3;
        for (std::size_t p = 0; p < step.size(); ++p)
            step[p] = growth[p] > 0 ? (wanted[p] - step[p]) / growth[p] : 0;
        for_each_vertex([&](std::size_t v) { vertices_[v] += normalized(areas_[v]) * step[part_[v]]; });
    }

    std::vector<Vec3d>& vertices_;
    Executor& executor_;
    std::vector<std::size_t> offsets_;  // of each vertex's corners
    std::vector<Corner> corners_;
    std::vector<Vec3d> areas_, moved_;
    std::vector<std::uint32_t> part_;  // of each vertex
    std::vector<Vec3d> anchors_;       // a place at each part, from which its volume is measured
};

}  // namespace hedgerow::detail
