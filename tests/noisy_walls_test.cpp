/// Every structure against brute force, over walls that are flat but for the last digits of their
/// coordinates. A box that is turned and turned back has such walls.
#include "matrix.h"

#include <numbers>

#include <hedgerow/scenes/meshes.h>

#include "nasty.h"

using namespace hedgerow;
using namespace hedgerow::matrix;

namespace {

template <class T>
class NoisyWalls : public testing::Test {};
using Scalars = testing::Types<float, double>;
TYPED_TEST_SUITE(NoisyWalls, Scalars);

template <class T>
T noise(Random& random) {
    return static_cast<T>(random.bits() % 4);
}

/// Adds small triangles at two opposite corners of a unit cube whose low corner is `place`, so that the scene
/// has depth.
template <class T>
void add_far_corners(TriangleMesh<T>& mesh, T place) {
    for (const T corner : {place, place + 1}) {
        const auto at = static_cast<std::uint32_t>(mesh.vertices.size());
        for (int k = 0; k < 3; ++k) {
            auto v = Vec<T, 3>::all(corner);
            v[k] += corner > place ? T(-0.01) : T(0.01);
            mesh.vertices.push_back(v);
        }
        mesh.triangles.push_back({at, at + 1, at + 2});
    }
}

/// A wall of 8×8 squares, two triangles each, across a unit cube at three tenths of its width. The vertices
/// are 0 to 3 units in the last place out of the plane.
template <class T>
TriangleMesh<T> wall(int axis, T place) {
    constexpr std::uint32_t n = 8;
    TriangleMesh<T> mesh;
    Random random(31, static_cast<std::uint64_t>(axis));
    for (std::uint32_t i = 0; i <= n; ++i)
        for (std::uint32_t j = 0; j <= n; ++j) {
            Vec<T, 3> v;
            v[axis] = nasty::nudged(place + T(0.3), static_cast<int>(noise<T>(random)));
            v[(axis + 1) % 3] = place + T(i) / n;
            v[(axis + 2) % 3] = place + T(j) / n;
            mesh.vertices.push_back(v);
        }
    for (std::uint32_t i = 0; i < n; ++i)
        for (std::uint32_t j = 0; j < n; ++j) {
            const std::uint32_t a = i * (n + 1) + j, b = a + n + 1;
            mesh.triangles.push_back({a, b, a + 1});
            mesh.triangles.push_back({b, b + 1, a + 1});
        }
    add_far_corners(mesh, place);
    return mesh;
}

/// A box of 4×4 squares a side, turned about an axis and back. Its walls are noisy, as those of CAD files
/// are.
template <class T>
TriangleMesh<T> turned_and_turned_back(int axis, double degrees, T place) {
    TriangleMesh<T> mesh = cube<T>(192);
    const T c = static_cast<T>(std::cos(degrees * std::numbers::pi / 180)),
            s = static_cast<T>(std::sin(degrees * std::numbers::pi / 180));
    const int u = (axis + 1) % 3, w = (axis + 2) % 3;
    for (auto& v : mesh.vertices) {
        for (const T sine : {s, -s}) {
            const T x = product(c, v[u]) - product(sine, v[w]), y = product(sine, v[u]) + product(c, v[w]);
            v[u] = x, v[w] = y;
        }
        v = v + Vec<T, 3>::all(place);
    }
    return mesh;
}

TYPED_TEST(NoisyWalls, AcrossEachAxis) {
    using T = TypeParam;
    for (int axis = 0; axis < 3; ++axis) expect_equal("wall", wall<T>(axis, T(0)));
}
TYPED_TEST(NoisyWalls, AwayFromTheOrigin) {
    using T = TypeParam;
    expect_equal("beyond 1", wall<T>(0, T(7.1)));
    expect_equal("below 0", wall<T>(1, T(-1.0 / 3)));
    expect_equal("far", wall<T>(2, T(1e3 + 0.1)));
}
TYPED_TEST(NoisyWalls, OfTurnedBoxes) {
    using T = TypeParam;
    expect_equal("by 30 degrees and back", turned_and_turned_back<T>(0, 30, T(0)));
    expect_equal("by 30 degrees and back, away", turned_and_turned_back<T>(1, 30, T(0.7)));
    expect_equal("by a right angle", turned_and_turned_back<T>(2, 90, T(0.1)));
}
/// The wall is in and next to planes between the cells of grids and octrees.
TYPED_TEST(NoisyWalls, AtPlanesOfCells) {
    using T = TypeParam;
    TriangleMesh<T> mesh = wall<T>(0, T(0));
    for (auto& v : mesh.vertices)
        if (v[0] > T(0.2) && v[0] < T(0.4)) v[0] = v[0] - T(0.3) + T(0.5);
    expect_equal("in the middle", mesh);
}

TYPED_TEST(NoisyWalls, InThePlane) {
    using T = TypeParam;
    for (const T place : {T(0), T(7.1)})
        for (int axis = 0; axis < 2; ++axis) {
            SegmentSet<T> lines;
            Points<T, 2> ends;
            Random random(32, 0);
            for (int i = 0; i < 200; ++i) {
                Segment<T, 2> s;
                // The ends are 0 to 3 units in the last place beside a line across the axis.
                for (auto* end : {&s.a, &s.b}) {
                    (*end)[axis] =
                        nasty::nudged(place + T(0.1) * T(1 + i % 9), static_cast<int>(noise<T>(random)));
                    (*end)[1 - axis] = place + static_cast<T>(random.uniform());
                    ends.push_back(*end);
                }
                lines.segments.push_back(s);
            }
            // Small segments at two opposite corners give the scene depth.
            lines.segments.push_back({Vec<T, 2>::all(place), Vec<T, 2>::all(place + T(0.01))});
            lines.segments.push_back({Vec<T, 2>::all(place + 1), Vec<T, 2>::all(place + T(0.99))});
            expect_equal("segments", lines, ends);
        }
}

}  // namespace
