/// The method of Barnes and Hut over every structure, in space and in the plane, against direct sums.
#include <gtest/gtest.h>

#include <hedgerow/nbody/barnes_hut.h>
#include <hedgerow/scenes/particles.h>
#include <hedgerow/scenes/sets.h>

#include "charges.h"
#include "every_structure.h"
#include "using.h"

using namespace hedgerow;

namespace {

/// The rms error of gradients at some points, relative to their rms.
template <class Kernel, class Index, class Cloud>
double error_of(const Index& index, const Cloud& cloud, const std::vector<double>& charges, double angle,
                Visits& visits) {
    const BarnesHut<Index, Kernel> method(index, charges, angle);
    double error2 = 0, size2 = 0;
    for (std::size_t i = 0; i < cloud.size(); i += 20) {
        const auto want = sum_of_pairs<Kernel>(cloud, charges, i), found = method(cloud.points[i], visits);
        error2 += length2(found.gradient - want.gradient), size2 += length2(want.gradient);
    }
    return std::sqrt(error2 / size2);
}

template <class Kernel, class Cloud>
void expect_near_direct_sums(const Cloud& cloud) {
    const auto charges = some_charges(cloud.size(), false);
    int summed = 0;
    for_each_type(cloud, [&](const char* name, const auto& index) {
        SCOPED_TRACE(name);
        if (!index.structure().exclusive()) {
            EXPECT_THROW((BarnesHut<std::decay_t<decltype(index)>, Kernel>(index, charges)), InputError);
            return;
        }
        ++summed;
        Visits exact, coarse;
        EXPECT_LT(error_of<Kernel>(index, cloud, charges, 0, exact), 1e-13);
        EXPECT_LT(error_of<Kernel>(index, cloud, charges, 0.3, coarse), 0.02);
        EXPECT_LE(coarse.primitives, exact.primitives);
    });
    EXPECT_GE(summed, 7);
}
TEST(BarnesHut, InSpace) {
    expect_near_direct_sums<InverseDistance>(points<double>(1500));
}
TEST(BarnesHut, InThePlane) {
    expect_near_direct_sums<MinusLogarithm>(points2d<double>(1500));
}

TEST(BarnesHut, NearsTheDirectSumAsTheAngleShrinks) {
    const auto cloud = points<float>(3000);
    const auto index = build<PointOrthtree>(cloud);
    for (const bool neutral : {false, true}) {
        const auto charges = some_charges(cloud.size(), neutral);
        Visits visits[3];
        const double errors[] = {error_of<InverseDistance>(index, cloud, charges, 1, visits[0]),
                                 error_of<InverseDistance>(index, cloud, charges, 0.5, visits[1]),
                                 error_of<InverseDistance>(index, cloud, charges, 0.25, visits[2])};
        EXPECT_LT(errors[0], neutral ? 0.5 : 0.05);
        EXPECT_LT(errors[1], 0.6 * errors[0]);
        EXPECT_LT(errors[2], 0.6 * errors[1]);
        EXPECT_LT(visits[0].primitives, visits[1].primitives);
        EXPECT_LT(visits[1].primitives, visits[2].primitives);
        EXPECT_LT(visits[0].primitives, 150 * cloud.size() / 5);
    }
}
TEST(BarnesHut, OfFewOrCoincidentPoints) {
    const PointCloud<double, 3> none;
    const auto empty = build<PointOrthtree>(none);
    EXPECT_EQ((BarnesHut<decltype(build<PointOrthtree>(none))>(empty, {})({1, 2, 3}).potential), 0);
    PointCloud<double, 3> cloud;
    cloud.points.assign(50, {1, 2, 3});
    const auto index = build<PointOrthtree>(cloud);
    const std::vector<double> charges(50, 2);
    const BarnesHut method(index, charges);
    EXPECT_EQ(method({1, 2, 3}).potential, 0);
    EXPECT_EQ(method({1, 2, 5}).potential, 50);
    EXPECT_EQ(method({1, 2, 5}).gradient, Vec3d(0, 0, -25));
    EXPECT_THROW((BarnesHut(index, std::span(charges).first(49))), InputError);
}

/// In vectors, from groups of targets: errors fall with the angle, and by quadrupoles.
TEST(BarnesHutByGroups, NearsTheDirectSumAsTheAngleShrinks) {
    const Particles all = plummer(5000);
    const Charges<double> charges{all.places, all.masses};
    std::vector<PotentialAt<double>> want(all.size()), found(all.size());
    direct_sum<double>(charges, all.places, want);
    const auto error = [&](const BarnesHutOptions& options) {
        barnes_hut<double>(charges, found, options);
        double error2 = 0;
        for (std::size_t i = 0; i < found.size(); ++i)
            error2 += length2(found[i].gradient - want[i].gradient) / length2(want[i].gradient) /
                      static_cast<double>(found.size());
        return std::sqrt(error2);
    };
    for (const auto set : instruction_sets()) {
        const Using use(set);
        double before = 1;
        for (const double angle : {0.9, 0.6, 0.3}) {
            const double by_quadrupoles = error({angle, true});
            EXPECT_LE(by_quadrupoles, 0.1 * angle * angle * angle) << set;
            EXPECT_LT(by_quadrupoles, before) << set;
            if (set != "plain") {
                EXPECT_LT(by_quadrupoles, 0.6 * error({angle, false})) << set;
            }
            before = by_quadrupoles;
        }
    }
}
TEST(BarnesHutByGroups, OfSoftenedAndOfCoincidentCharges) {
    const Particles all = plummer(3000);
    Charges<double> charges{all.places, all.masses, {SofteningKernel::spline, 0.1}};
    std::vector<PotentialAt<double>> want(all.size()), found(all.size());
    direct_sum<double>(charges, Targets<double>(all.places), want);
    barnes_hut<double>(charges, found, {.opening_angle = 0.4});
    for (std::size_t i = 0; i < found.size(); ++i)
        ASSERT_LE(length(found[i].gradient - want[i].gradient), 0.02 * length(want[i].gradient) + 1e-3);
    const std::vector<Vec3d> places(5000, Vec3d(1, 2, 3));
    const std::vector<double> ones(5000, 1.0);
    found.resize(5000);
    barnes_hut<double>({places, ones}, found);
    for (const auto& at : found) ASSERT_EQ(at.potential, 0);
    for (const double angle : {0.0, 1.0, -1.0, std::nan("")})
        EXPECT_THROW(barnes_hut<double>({places, ones}, found, {.opening_angle = angle}), UsageError);
}

}  // namespace
