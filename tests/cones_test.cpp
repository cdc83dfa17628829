/// What cones see by the kernels, against the walk by brute force, bit for bit.
#include <gtest/gtest.h>

#include <hedgerow/ask/families.h>
#include <hedgerow/hedgerow.h>
#include <hedgerow/scenes/meshes.h>
#include <hedgerow/scenes/random.h>

#include "engine.h"

using namespace hedgerow;

namespace {

using Mesh = TriangleMesh<float>;
using Cone = ConeRays<float, 3>;

/// Compares what cones see in trees of every width by every instruction set. Returns how many fragments there
/// are.
std::size_t expect_equal(const Mesh& mesh, const std::vector<Cone>& cones) {
    const auto oracle = build<BruteForce>(mesh);
    std::vector<std::vector<ConeFragment<float>>> want(cones.size());
    std::size_t all = 0;
    for (std::size_t i = 0; i < cones.size(); ++i) all += cone_fragments(oracle, cones[i], want[i]);
    std::vector<ConeFragment<float>> found;
    for_each_kernel(mesh, [&](const auto& index, std::string_view) {
        for (std::size_t i = 0; i < cones.size(); ++i) {
            found.assign(3, {1, 2, 3});
            ASSERT_EQ(cone_fragments(index, cones[i], found), want[i].size()) << "cone " << i;
            ASSERT_EQ(found, want[i]) << "cone " << i;
            Visits visits;  // no kernel counts
            if (i % 16 != 0) continue;
            cone_fragments(index, cones[i], found, visits);
            ASSERT_EQ(found, want[i]) << "by the walk, cone " << i;
        }
    });
    return all;
}

/// Cones of all widths, from all sides and from within, that begin and end anywhere.
std::vector<Cone> some_cones(const Box3f& box, std::size_t count) {
    std::vector<Cone> cones;
    for (std::uint64_t i = 0; i < count; ++i) {
        Random random(81, i);
        const Vec3f size = box.extent();
        const auto inside = [&] {
            Vec3f p = box.low;
            for (int k = 0; k < 3; ++k) p[k] += size[k] * static_cast<float>(random.uniform());
            return p;
        };
        const Vec3f from =
            i % 4 == 0 ? inside() : inside() + Vec3f(random.direction<3>()) * (2 * length(size));
        Ray3f axis{from, inside() - from};
        if (i % 7 == 0) axis.direction = Vec3f(random.direction<3>());
        if (i % 9 == 0) {  // along an axis, and through the corners of boxes
            const int k = static_cast<int>(i / 9 % 3);
            axis.direction = Vec3f();
            axis.direction[k] = i % 2 == 0 ? 1.0f : -1.0f;
            if (i % 27 == 0) axis.origin = box.low;
        }
        if (i % 5 == 0) axis.t_min = 0.4f, axis.t_max = 1.1f;
        const float slopes[] = {0.3f, 0.05f, 1e-3f, 0, 1.5f};
        const float radius = i % 3 == 0 ? 0.02f * length(size) : 0;
        if (length2(axis.direction) > 0)
            cones.emplace_back(axis, radius, slopes[i % 5 == 3 && i % 3 != 0 ? 1 : i % 5]);
    }
    return cones;
}
Box3f box_of(const Mesh& mesh) {
    Box3f box;
    for (const auto& v : mesh.vertices) box.expand(v);
    return box;
}

TEST(Cones, OfGeneratedMeshes) {
    const std::size_t count = in_long_runs(20000, 400);
    const auto expect = [&](const char* name, const Mesh& mesh) {
        SCOPED_TRACE(name);
        EXPECT_GT(expect_equal(mesh, some_cones(box_of(mesh), count)), count / 2);
    };
    expect("soup", soup<float>(400));
    expect("terrain", terrain<float>(1500));
    expect("stadium", teapot_in_stadium<float>(1500));
    expect("hairball", hairball<float>(800));
    expect("cornell box", cornell_box<float>(0));
}

/// Coordinates that are huge, tiny, far away or in planes through 0, and triangles that are points or lines.
TEST(Cones, OfScenesAtTheEndsOfTheNumbers) {
    const auto changed = [&](const char* name, auto change) {
        SCOPED_TRACE(name);
        Mesh mesh = soup<float>(200);
        for (auto& v : mesh.vertices) v = change(v);
        expect_equal(mesh, some_cones(box_of(mesh), in_long_runs(3000, 120)));
    };
    changed("huge", [](const Vec3f& v) { return v * 0x1p50f; });
    changed("tiny", [](const Vec3f& v) { return v * 0x1p-90f; });
    changed("subnormal", [](const Vec3f& v) { return v * 0x1p-140f; });
    changed("far away", [](const Vec3f& v) { return v + Vec3f(1e5f, -2e5f, 3e4f); });
    changed("flat", [](const Vec3f& v) { return Vec3f(v[0], v[1], -0.0f); });
    changed("in a lattice", [](const Vec3f& v) {
        Vec3f p;
        for (int k = 0; k < 3; ++k) p[k] = std::round(v[k] * 4) * 0.25f;
        return p;
    });
    changed("a line", [](const Vec3f& v) { return Vec3f(v[0], v[0], v[0]); });
}

TEST(Cones, OfFewTriangles) {
    const Mesh none;
    const auto empty = build<WideBvh>(none);
    std::vector<ConeFragment<float>> found(2);
    EXPECT_EQ(cone_fragments(empty, Cone(Ray3f{{}, {0, 0, 1}}, 0, 0.1f), found), 0u);
    EXPECT_TRUE(found.empty());
    // Two that coincide: the lower number is seen.
    const Mesh twice{{{-9, -9, 1}, {9, -9, 1}, {0, 30, 1}}, {{0, 1, 2}, {0, 1, 2}}, {}};
    const std::vector<Cone> one{Cone(Ray3f{{}, {0, 0, 1}}, 0, 0.1f)};
    EXPECT_EQ(expect_equal(twice, one), 1u);
    cone_fragments(build<WideBvh>(twice), one[0], found);
    ASSERT_EQ(found.size(), 1u);
    EXPECT_EQ(found[0].element, 0u);
    EXPECT_EQ(found[0].samples, ~std::uint64_t(0));
}

}  // namespace
