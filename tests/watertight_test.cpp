/// No ray passes through a closed mesh at an edge or a vertex, in any structure.
#include "matrix.h"
#include "structure_names.h"

#include <hedgerow/scenes/meshes.h>

using namespace hedgerow;
using namespace hedgerow::matrix;

namespace {

/// A closed mesh without symmetry: a finely cut cube whose every vertex is moved outward by its own amount.
template <class T>
TriangleMesh<T> bumpy_cube() {
    TriangleMesh<T> mesh = cube<T>(1200);
    for (auto& v : mesh.vertices) {
        Random random(23, static_cast<std::uint64_t>(std::lround(double(v[0]) * 1e3) * 4000003 +
                                                     std::lround(double(v[1]) * 1e3) * 2003 +
                                                     std::lround(double(v[2]) * 1e3)));
        v = Vec<T, 3>(Vec3d(v) * (1 + 0.2 * random.uniform()) + Vec3d(0.1, 0.2, 0.3));
    }
    return mesh;
}

/// A ray from inside to a vertex, or to a point of an edge, rounded.
template <class T>
Ray<T, 3> at_an_edge(const TriangleMesh<T>& mesh, std::uint64_t i) {
    Random random(17, i);
    const auto& t = mesh.triangles[random.bits() % mesh.size()];
    const double u = i % 3 == 0 ? 0 : random.uniform();
    const Vec3d on_edge = Vec3d(mesh.vertices[t[0]]) * (1 - u) + Vec3d(mesh.vertices[t[1]]) * u;
    const Vec<T, 3> origin(Vec3d(0.1, 0.2, 0.3) + random.direction<3>() * 0.5);
    return {origin, Vec<T, 3>(on_edge) - origin};
}

template <class T>
class Watertight : public testing::Test {};
using Scalars = testing::Types<float, double>;
TYPED_TEST_SUITE(Watertight, Scalars);

TYPED_TEST(Watertight, NoRayLeaksOutOfAClosedMesh) {
    using T = TypeParam;
    const auto mesh = bumpy_cube<T>();
    for (const std::string& spec : structures_for<TriangleMesh<T>>({"bvh:builder=midpoint"})) {
        if (spec == "brute-force") continue;  // against which others are compared elsewhere
        SCOPED_TRACE(spec);
        const std::size_t count = in_long_runs(spec == "wide" ? 100000000 : 10000000, 1000000);
        const auto index = build_any(spec, mesh);
        std::atomic<std::uint64_t> leaks{0}, first_leak{~0ull};
        constexpr std::size_t block = 4096;
        const auto ask = [&](std::size_t begin, std::size_t end) {
            std::vector<Ray<T, 3>> rays;
            for (std::size_t i = begin; i < end; ++i) rays.push_back(at_an_edge(mesh, i));
            const std::unique_ptr<bool[]> hit(new bool[rays.size()]);
            const std::span<const Ray<T, 3>> asked(rays);
            const std::size_t half = rays.size() / 2;  // the first half in a batch, the others alone
            any_hits(*index, asked.first(half), {hit.get(), half});
            for (std::size_t i = half; i < rays.size(); ++i)
                any_hits(*index, asked.subspan(i, 1), {hit.get() + i, 1});
            for (std::size_t i = 0; i < rays.size(); ++i)
                if (!hit[i] && leaks++ == 0) first_leak = begin + i;
        };
        default_executor().for_each_piece((count + block - 1) / block, 1, [&](std::size_t b, std::size_t e) {
            for (; b < e; ++b) ask(b * block, std::min(count, (b + 1) * block));
        });
        EXPECT_EQ(leaks, 0u) << "the first found is ray " << first_leak;
    }
}

}  // namespace
