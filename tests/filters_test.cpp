/// Filters of single rays and of batches: a hit that is refused changes nothing else, whichever kernel calls
/// the filter.
#include "engine.h"
#include "filtered.h"

#include <hedgerow/scenes/meshes.h>
#include <hedgerow/structures/brute_force.h>
#include <hedgerow/structures/bvh/bvh.h>
#include <hedgerow/structures/grid/grid.h>

using namespace hedgerow;
using namespace hedgerow::matrix;

namespace {

template <class Index, class T>
void expect_all_filters(const Index& index, const Expected<T>& expected) {
    using H = Hit<T>;
    std::vector<PrimitiveId> first;  // what each ray hits first
    for (const auto& all : expected.all) first.push_back(all.empty() ? no_primitive : all[0].element);
    std::vector<std::uint32_t> masks(index.size());
    for (std::size_t i = 0; i < masks.size(); ++i) masks[i] = 1u << i % 3;
    expect_filtered("all", index, expected, [](const H&) { return true; });
    expect_filtered("none", index, expected, [](const H&) { return false; });
    expect_filtered("masks", index, expected, [&](const H& h) { return (masks[h.element] & 5) != 0; });
    expect_filtered("by t", index, expected, [](const H& h) { return h.t > T(0.7); });
    expect_filtered("by u and v", index, expected, [](const H& h) { return h.u < h.v; });
    expect_filtered("by ray", index, expected, [](std::size_t i, const H&) { return i % 3 != 0; });
    expect_filtered("but the first", index, expected,
                    [&](std::size_t i, const H& h) { return h.element != first[i]; });
    expect_filtered("the last", index, expected,
                    [&](std::size_t i, const H& h) { return h.element == expected.all[i].back().element; });
}

void expect_by_every_kernel(const TriangleMesh<float>& mesh) {
    const auto brute = build<BruteForce>(mesh);
    const Box3f box = brute.bounds();
    const Expected<float> separate(brute, apart(box, targets_of(mesh), 700)),
        coherent(brute, together(box, 700));
    for_each_kernel(mesh, [&](const auto& index, std::string_view set) {
        expect_all_filters(index, separate);
        expect_all_filters(index, coherent);
        std::vector<Hit<float>> hits(coherent.rays.size());
        const auto use = closest_hits(index, coherent.rays, hits, {.threads = serial_executor()},
                                      [](const Hit<float>&) { return false; });
        EXPECT_EQ(use.packets > 0, set != "plain");
    });
}

TEST(Filters, GiveTheBitsOfBruteForceByEveryKernel) {
    expect_by_every_kernel(soup<float>(300));
    expect_by_every_kernel(teapot_in_stadium<float>(500));
}

TEST(Filters, LeaveTheNextOfCoincidentTriangles) {
    TriangleMesh<float> mesh = teapot<float>(50);
    for (int copy = 0; copy < 2; ++copy) {
        const std::vector<TriangleIndices> again(mesh.triangles.begin(), mesh.triangles.begin() + 50);
        mesh.triangles.insert(mesh.triangles.end(), again.begin(), again.end());
    }
    for (std::uint32_t i = 0; i < mesh.size(); ++i) mesh.faces.push_back(i / 2);
    expect_by_every_kernel(mesh);
}

TEST(Filters, OfBatchesInOtherStructuresAndInDouble) {
    const auto mesh = soup<float>(200);
    const auto brute = build<BruteForce>(mesh);
    const Expected<float> expected(brute, apart(brute.bounds(), targets_of(mesh), 300));
    expect_all_filters(build<Bvh>(mesh), expected);
    expect_all_filters(build<Grid>(mesh), expected);
    const auto of_double = soup<double>(200);
    const auto wide = build<WideBvh>(of_double);
    std::vector<Ray3d> rays;
    for (std::size_t i = 0; i < 300; ++i) rays.push_back(ray_of(wide.bounds(), targets_of(of_double), i));
    expect_all_filters(wide, Expected<double>(build<BruteForce>(of_double), rays));
}

/// The filter gets a ray's number in the whole batch, also from the pieces that threads work on.
TEST(Filters, AreAskedByAllThreads) {
    const auto mesh = teapot_in_stadium<float>(1000);
    const auto index = build<WideBvh>(mesh);
    for (const auto& rays :
         {apart(index.bounds(), targets_of(mesh), 20000), together(index.bounds(), 20000)}) {
        std::vector<Hit<float>> plain(rays.size()), hits(rays.size());
        const std::unique_ptr<bool[]> any(new bool[rays.size()]);
        closest_hits(index, rays, plain);
        const auto even = [](std::size_t i, const Hit<float>&) { return i % 2 == 0; };
        for (const auto set : instruction_sets()) {
            const Using use(set);
            const KernelUse by = closest_hits(index, rays, hits, {.threads = default_executor()}, even);
            EXPECT_EQ(by.single, set == "plain" ? rays.size() : 0u);
            any_hits(index, rays, {any.get(), rays.size()}, {.threads = default_executor()}, even);
            for (std::size_t i = 0; i < rays.size(); ++i) {
                ASSERT_EQ(i % 2 == 0 ? plain[i] : Hit<float>(), hits[i]) << set << ", ray " << i;
                ASSERT_EQ(i % 2 == 0 && plain[i], any[i]) << set << ", ray " << i;
            }
        }
    }
}

/// An exception of a filter reaches the caller, and the next query is answered as usual.
TEST(Filters, MayThrow) {
    struct Refusal {};
    const auto mesh = soup<float>(1000);
    const auto index = build<WideBvh>(mesh);
    for (const auto& rays : {apart(index.bounds(), targets_of(mesh), 640), together(index.bounds(), 640)}) {
        std::vector<Hit<float>> want(rays.size()), hits(rays.size());
        const std::unique_ptr<bool[]> any(new bool[rays.size()]);
        closest_hits(index, rays, want);
        // Find the last ray that hits.
        std::size_t last = rays.size() - 1;
        while (!want[last]) --last;
        const auto throws_once = [&](std::size_t i, const Hit<float>&) {
            if (i == last) throw Refusal();
            return true;
        };
        const auto throws = [](const Hit<float>&) -> bool { throw Refusal(); };
        for (const auto set : instruction_sets()) {
            SCOPED_TRACE(set);
            const Using use(set);
            EXPECT_THROW(closest_hits(index, rays, hits, {.threads = serial_executor()}, throws_once),
                         Refusal);
            EXPECT_THROW(
                any_hits(index, rays, {any.get(), rays.size()}, {.threads = default_executor()}, throws_once),
                Refusal);
            EXPECT_THROW(closest_hit(index, rays[last], throws), Refusal);
            EXPECT_THROW(any_hit(index, rays[last], throws), Refusal);
            closest_hits(index, rays, hits);
            EXPECT_EQ(hits, want);
        }
    }
}

}  // namespace
