/// The fast multipole method over every structure, against sums over all pairs; passes over hierarchies.
#include <gtest/gtest.h>

#include <hedgerow/nbody/plain_fmm.h>
#include <hedgerow/scenes/sets.h>

#include "charges.h"
#include "every_structure.h"

using namespace hedgerow;

namespace {

template <class Cloud>
std::vector<PotentialAt<double>> direct_sum(const Cloud& cloud, const std::vector<double>& charges) {
    std::vector<PotentialAt<double>> found;
    for (std::size_t i = 0; i < cloud.size(); ++i)
        found.push_back(sum_of_pairs<InverseDistance>(cloud, charges, i));
    return found;
}
/// The rms of the errors of the gradients, relative to the rms of these.
double error_of(const std::vector<PotentialAt<double>>& found, const std::vector<PotentialAt<double>>& want) {
    double error2 = 0, size2 = 0;
    for (std::size_t i = 0; i < want.size(); ++i)
        error2 += length2(found[i].gradient - want[i].gradient), size2 += length2(want[i].gradient);
    return std::sqrt(error2 / size2);
}
TEST(PlainFmm, NearsTheDirectSumAsTheAngleShrinks) {
    const auto cloud = points<double>(1200);
    for (const bool neutral : {false, true}) {
        const auto charges = some_charges(cloud.size(), neutral);
        const auto want = direct_sum(cloud, charges);
        const auto index = build<PointOrthtree>(cloud, {.leaf_size = 24});
        const double errors[] = {error_of(PlainFmm<4>(0.8)(index, charges), want),
                                 error_of(PlainFmm<4>(0.5)(index, charges), want),
                                 error_of(PlainFmm<6>(0.5)(index, charges), want),
                                 error_of(PlainFmm<4>(0)(index, charges), want)};
        EXPECT_LT(errors[0], 1e-2);
        EXPECT_LT(errors[1], 0.3 * errors[0]);
        EXPECT_LT(errors[2], 0.3 * errors[1]);
        EXPECT_LT(errors[3], 1e-13);
        const auto found = PlainFmm<6>(0.5)(index, charges);
        for (std::size_t i = 0; i < cloud.size(); i += 100)
            EXPECT_NEAR(found[i].potential, want[i].potential, 1e-3 * std::abs(want[0].potential));
    }
}

template <class Index>
void expect_forces(const Index& index, const std::vector<double>& charges,
                   const std::vector<PotentialAt<double>>& want) {
    const auto found = PlainFmm<5>(0.6)(index, charges);
    EXPECT_LT(error_of(found, want), 6e-3);
    // Forces add up to nothing.
    Vec3d force;
    double all = 0;
    for (std::size_t i = 0; i < charges.size(); ++i) {
        force = force + found[i].gradient * charges[i];
        all += length(found[i].gradient) * std::abs(charges[i]);
    }
    EXPECT_LT(length(force), 1e-13 * all);
}
TEST(PlainFmm, IsOverEveryStructureThatHoldsPointsOnce) {
    const auto cloud = points<double>(800);
    const auto charges = some_charges(cloud.size(), false);
    const auto want = direct_sum(cloud, charges);
    int summed = 0;
    for_each_index(cloud, [&](const char* name, const auto& index) {
        SCOPED_TRACE(name);
        try {
            expect_forces(index, charges, want);
            ++summed;
        } catch (const InputError&) {
            EXPECT_FALSE(index.structure().exclusive());
        }
    });
    EXPECT_GE(summed, 10);
}
TEST(PlainFmm, OfPointsInFloat) {
    const auto cloud = points<float>(800);
    const auto charges = some_charges(cloud.size(), true);
    expect_forces(build<PointOrthtree>(cloud), charges, direct_sum(cloud, charges));
    expect_forces(build<WideBvh>(cloud), charges, direct_sum(cloud, charges));
}
/// A lattice whose points lie on the corners of an octree's cells.
TEST(PlainFmm, RefusesPointsInSeveralCells) {
    PointCloud<double, 3> lattice{{{0.5, 0.5, 0.5}}};
    for (int i = 0; i < 4096; ++i) {
        const int x = i % 16, y = i / 16 % 16, z = i / 256;
        lattice.points.emplace_back(x * 0x1p-12, y * 0x1p-12, z * 0x1p-12);
    }
    const auto charges = some_charges(lattice.size(), false);
    EXPECT_THROW(PlainFmm<2>()(build<Orthtree>(lattice, {.leaf_size = 1}), charges), InputError);
    EXPECT_EQ(PlainFmm<2>()(build<PointOrthtree>(lattice), charges).size(), lattice.size());
}
TEST(PlainFmm, OfFewOrCoincidentPoints) {
    EXPECT_TRUE(PlainFmm<3>()(build<PointOrthtree>(PointCloud<double, 3>()), {}).empty());
    EXPECT_THROW(PlainFmm<3>()(build<PointOrthtree>(points<double>(20)), some_charges(19, false)),
                 InputError);
    PointCloud<double, 3> cloud{{{1, 2, 3}}};
    EXPECT_EQ(PlainFmm<3>()(build<PointOrthtree>(cloud), std::vector{2.0})[0].potential, 0);
    cloud.points.assign(50, {1, 2, 3});
    cloud.points.emplace_back(1, 2, 4);
    const auto found = PlainFmm<3>()(build<PointOrthtree>(cloud), std::vector<double>(51, 1));
    EXPECT_EQ(found[0].potential, 1);
    EXPECT_EQ(found[50].potential, 50);
    EXPECT_EQ(found[50].gradient, Vec3d(0, 0, -50));
}

/// Both passes meet every node once, in their order.
TEST(Passes, MeetEachNodeOnceInTheirOrder) {
    const auto cloud = points<float>(500);
    for_each_index(cloud, [&](const char* name, const auto& index) {
        SCOPED_TRACE(name);
        const auto hierarchy = hierarchy_of(index.structure(), index.primitives());
        std::vector<std::size_t> up(hierarchy.node_count()), down(hierarchy.node_count());
        std::size_t items = 0, at_leaves = 0;
        upward_pass(
            hierarchy,
            [&](const auto& node, const Leaf& leaf) { up[node.id] += leaf.count, items += leaf.count; },
            [&](const auto& node, const auto& child) { up[node.id] += up[child.id]; });
        EXPECT_EQ(up[hierarchy.root().id], items);
        EXPECT_GE(items, cloud.size());
        down[hierarchy.root().id] = 1;
        downward_pass(
            hierarchy, [&](const auto& node, const auto& child) { down[child.id] += down[node.id]; },
            [&](const auto& node, const Leaf& leaf) { at_leaves += down[node.id] * leaf.count; });
        EXPECT_EQ(at_leaves, items);
    });
}

}  // namespace
