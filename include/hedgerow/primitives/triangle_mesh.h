/// Indexed triangles.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include <hedgerow/base/error.h>
#include <hedgerow/base/strided.h>
#include <hedgerow/geometry/clip.h>
#include <hedgerow/geometry/shapes.h>
#include <hedgerow/parallel/executor.h>
#include <hedgerow/primitives/concepts.h>
#include <hedgerow/primitives/packed_triangles.h>

namespace hedgerow {

/// Three positions in the list of vertices, counterclockwise seen from the front.
using TriangleIndices = std::array<std::uint32_t, 3>;

/// A view of triangles in the caller's arrays. Nothing is copied. Vertices are three T and triangles are
/// three indices, each array with its own stride. `faces` are the ids of the triangles; if it is empty, a
/// triangle's id is its position.
template <std::floating_point T>
class TriangleMeshView {
public:
    using Scalar = T;
    static constexpr int dimension = 3;

    TriangleMeshView() = default;
    TriangleMeshView(Strided<Vec<T, 3>> vertices, Strided<TriangleIndices> triangles,
                     Strided<std::uint32_t> faces = {})
        : vertices_(vertices), triangles_(triangles), faces_(faces) {}

    std::size_t size() const { return triangles_.size(); }
    std::size_t vertex_count() const { return vertices_.size(); }
    Vec<T, 3> vertex(std::size_t i) const { return vertices_[i]; }
    TriangleIndices indices(std::size_t i) const { return triangles_[i]; }
    /// Where they are, to prefetch them.
    const std::byte* vertex_at(std::size_t i) const { return vertices_.at(i); }
    const std::byte* indices_at(std::size_t i) const { return triangles_.at(i); }
    Triangle<T, 3> triangle(std::size_t i) const {
        const auto [a, b, c] = triangles_[i];
        return {vertices_[a], vertices_[b], vertices_[c]};
    }
    std::uint32_t id(std::size_t i) const {
        return faces_.empty() ? static_cast<std::uint32_t>(i) : faces_[i];
    }
    /// The ids of the triangles; empty if the ids are the positions.
    const Strided<std::uint32_t>& faces() const { return faces_; }
    Box<T, 3> bounds(std::size_t i) const { return triangle(i).bounds(); }
    /// Whether all corners are finite. The bounds do not show this, since a box drops a NaN.
    bool finite(std::size_t i) const {
        const auto t = triangle(i);
        return hedgerow::finite(t.a) && hedgerow::finite(t.b) && hedgerow::finite(t.c);
    }
    Vec<T, 3> normal(std::size_t i) const { return triangle(i).normal(); }

    Foot<T, 3> closest_point(std::size_t i, const Vec<T, 3>& p) const {
        return hedgerow::closest_point(p, triangle(i));
    }
    Foot<T, 3> farthest_point(std::size_t i, const Vec<T, 3>& p) const {
        return hedgerow::farthest_point(p, triangle(i));
    }
    template <Region R>
    bool overlaps(std::size_t i, const R& region) const {
        return overlap(triangle(i), region);
    }
    template <Region R>
    bool lies_within(std::size_t i, const R& region) const {
        return lies_in(triangle(i), region);
    }
    /// The overlap test of one triangle, prepared for many boxes.
    TriangleOverlap<T> overlap_test(std::size_t i) const { return TriangleOverlap<T>(triangle(i)); }

    static constexpr bool hits_lie_on_primitives = true;
    std::array<Vec<T, 3>, 3> corners(std::size_t i) const {
        const auto t = triangle(i);
        return {t.a, t.b, t.c};
    }
    Box<T, 3> clipped_bounds(std::size_t i, const Box<T, 3>& box) const {
        return hedgerow::clipped_bounds(triangle(i), box);
    }

    /// Throws InputError for the first triangle with a vertex index out of range, and for a list of face ids
    /// whose length is not that of the triangles. O(n).
    void validate() const {
        for (std::size_t i = 0; i < size(); ++i) validate_corners(i);
        validate_faces();
    }
    /// Checks only triangle i, and the number of face ids. Throws InputError. O(1).
    void validate(std::size_t i) const {
        validate_corners(i);
        validate_faces();
    }

    /// Tests rays by the watertight test, whose error is within the probe's slack.
    template <class Query>
    Flow test_leaf(const RayProbe<T, 3>& probe, const Leaf& leaf, Query& query) const {
        for (std::uint32_t i = 0; i < leaf.count; ++i) {
            const PrimitiveId id = leaf.ids[leaf.first + i];
            const auto m = hedgerow::meet(probe.watertight(), triangle(id));
            if (m && query.offer({m->t, m->u, m->v, id}) == Flow::stop) return Flow::stop;
        }
        return Flow::go_on;
    }

    /// Copies the triangles in the order of a structure's items, or by id, so that a test reads one place in
    /// memory.
    template <PackedOrder order>
    auto pack(std::span<const PrimitiveId> items, Executor& executor) const {
        const std::size_t count = order == PackedOrder::of_ids ? size() : items.size();
        PackedTriangles<T, order> packed(count);
        executor.for_each_piece(count, 4096, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) {
                const auto id = order == PackedOrder::of_ids ? static_cast<PrimitiveId>(i) : items[i];
                packed.set(i, triangle(id), id);
            }
        });
        return packed;
    }
    /// Copies one triangle to a place of a packed copy; the place may be beyond its end. O(1), amortized.
    template <PackedOrder order>
    void pack(PrimitiveId id, std::size_t place, PackedTriangles<T, order>& packed) const {
        packed.reach(place);
        packed.set(place, triangle(id), id);
    }

private:
    void validate_corners(std::size_t i) const {
        for (const std::uint32_t corner : triangles_[i])
            if (corner >= vertices_.size())
                throw InputError("triangle " + std::to_string(i) + " names vertex " + std::to_string(corner) +
                                 ", but there are " + std::to_string(vertices_.size()) +
                                 ": mend its indices");
    }
    void validate_faces() const {
        if (!faces_.empty() && faces_.size() != size())
            throw InputError("a mesh of " + std::to_string(size()) + " triangles has " +
                             std::to_string(faces_.size()) +
                             " face ids: give each triangle one, or none any");
    }

    Strided<Vec<T, 3>> vertices_;
    Strided<TriangleIndices> triangles_;
    Strided<std::uint32_t> faces_;
};

/// Triangles in arrays that the mesh owns.
template <std::floating_point T>
struct TriangleMesh {
    using Scalar = T;
    static constexpr int dimension = 3;

    std::vector<Vec<T, 3>> vertices;
    std::vector<TriangleIndices> triangles;
    /// The id of each triangle: the ordinal of the face that it came from, never descending. If empty, a
    /// triangle's id is its position.
    std::vector<std::uint32_t> faces;

    std::size_t size() const { return triangles.size(); }
    TriangleMeshView<T> view() const {
        return {Strided<Vec<T, 3>>(std::span(vertices)), Strided<TriangleIndices>(std::span(triangles)),
                Strided<std::uint32_t>(std::span(faces))};
    }
};

}  // namespace hedgerow
