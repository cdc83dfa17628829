/// The premise of the SAH: a share S_child/S_node of the uniformly random lines that meet a node meets its
/// child.
#include <cmath>

#include <gtest/gtest.h>

#include <hedgerow/hedgerow.h>
#include <hedgerow/scenes/meshes.h>
#include <hedgerow/scenes/random.h>

using namespace hedgerow;

namespace {

Ray3d random_line(const Box3d& box, std::uint64_t i) {
    Random random(5, i);
    const double radius = 0.5 * length(box.extent());
    const Vec3d a = box.center() + random.direction<3>() * radius,
                b = box.center() + random.direction<3>() * radius;
    return {a, b - a};
}

TEST(SahPremise, LinesThatMeetANodeMeetItsChildByTheRatioOfAreas) {
    const auto mesh = teapot<double>(6000);
    const auto index = build(mesh);
    const auto& tree = index.structure();
    constexpr int lines = 200000;
    // Checks the root's children and grandchildren: six ratios, each within three sigma.
    const auto check = [&](const Box3d& node, const Box3d& child) {
        double met = 0, both = 0;
        for (int i = 0; i < lines; ++i) {
            const Ray3d line = random_line(index.bounds(), static_cast<std::uint64_t>(i));
            if (!meet(line, node)) continue;
            ++met;
            both += meet(line, child).has_value();
        }
        const double p = child.half_area() / node.half_area();
        const double sigma = std::sqrt(met * p * (1 - p));
        EXPECT_GT(met, 1000);
        EXPECT_NEAR(both, met * p, 3 * sigma + 1e-9) << "of " << met << " lines";
    };
    for (int i = 0; i < 2; ++i) {
        check(index.bounds(), tree.volumes(tree.root())[i]);
        const NodeRef child = tree.child(tree.root(), i);
        ASSERT_FALSE(child.leaf());
        for (int k = 0; k < 2; ++k) check(tree.volumes(tree.root())[i], tree.volumes(child)[k]);
    }
}

TEST(SahPremise, PredictedCostIsWhatRandomLinesCostWithoutOcclusion) {
    const auto mesh = teapot<double>(6000);
    const auto index = build(mesh);
    Visits visits;
    std::vector<Hit<double>> hits;
    double met = 0;
    for (std::uint64_t i = 0; i < 50000; ++i) {
        const Ray3d line = random_line(index.bounds(), i);
        if (!meet(line, index.bounds())) continue;
        ++met;
        all_hits(index, line, hits, KeepAll{}, visits);
    }
    const auto& options = index.structure().options();
    const double counted = (options.traversal_cost * static_cast<double>(visits.nodes) +
                            options.intersection_cost * static_cast<double>(visits.primitives)) /
                           met;
    EXPECT_NEAR(counted / index.structure().sah_cost(), 1.0, 0.02);
}

}  // namespace
