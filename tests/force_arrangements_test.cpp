/// Forces keep their accuracy in arrangements that are hard on sums, against sums in long double and after
/// Ewald.
#include <gtest/gtest.h>

#include <hedgerow/base/error.h>
#include <hedgerow/nbody/barnes_hut.h>
#include <hedgerow/nbody/force_check.h>
#include <hedgerow/nbody/forces.h>

#include "arrangements.h"
#include "force_oracle.h"
#include "force_questions.h"
#include "long_runs.h"
#include "using.h"

using namespace hedgerow;

namespace {

using Found = std::vector<PotentialAt<double>>;

Found forces_of(const Arrangement& all, double accuracy) {
    Found found(all.size());
    forces<double>(all.view(), found, {.accuracy = accuracy});
    return found;
}
void expect_accuracies(const NamedArrangement& one, std::size_t n, std::size_t targets,
                       std::initializer_list<double> accuracies) {
    const Arrangement all = one.make(n, 1);
    const ForceOracle oracle(all, targets);
    for (const double accuracy : accuracies) {
        const FoundErrors errors = errors_at_some_or_many(oracle, all, forces_of(all, accuracy), accuracy);
        EXPECT_LE(errors.rms, accuracy) << one.name << " of " << n << ", worst at " << errors.worst;
        EXPECT_LE(errors.most, 10 * accuracy) << one.name << " of " << n << ", " << accuracy;
    }
}
/// Numbers of charges, from so many on.
std::vector<std::size_t> sizes(std::initializer_list<std::size_t> usual) {
    std::vector<std::size_t> all = usual;
    if (in_long_runs(1, 0) == 1) all.insert(all.end(), {9000, 20000, 60000});
    return all;
}

TEST(ForceArrangements, InOpenSpaceKeepTheirAccuracy) {
    for (const auto& one : open_arrangements())
        for (const std::size_t n : sizes({2, 3, 9, unless_sanitized(3000, 1500)}))
            expect_accuracies(one, n, 150, {1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9});
}
/// So many that expansions are in double, too.
TEST(ForceArrangements, OfManyChargesKeepTheirAccuracy) {
    for (const auto& one : open_arrangements())
        expect_accuracies(one, unless_sanitized(13000, 6500), 100, {1e-5, 1e-6, 1e-7, 1e-9});
}
TEST(ForceArrangements, InPeriodicCubesKeepTheirAccuracy) {
    for (const auto& one : periodic_arrangements()) {
        expect_accuracies(one, 217, 217, {1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9});
        for (const std::size_t n : sizes({unless_sanitized(2000, 700)}))
            expect_accuracies(one, n, 60, {1e-2, 1e-3, 1e-5, 1e-6, 1e-7, 1e-9});
    }
}
/// What `hunter --particles` draws, by the number of the arrangement.
TEST(ForceArrangements, QuestionsOfTheHunter) {
    const ForceQuestion questions[] = {
        {24, 3000, 1, 1e-5, 0x1p20, 3, 0, false},
        {24, 3000, 2, 1e-3, 1, 0, 0, true},
        {11, 3000, 3, 1e-5, 1, -700, 0, false},
        {47, 300, 4, 1e-6, 0x1p-30, 0, 0, false},
        {28, 2000, 5, 1e-4, 0x1p-20, 0, 0, false},
        {0, 2000, 6, 1e-3, 1, 0, 1e-3, true},
        {37, 1500, 7, 1e-2, 1, 0, 0, true},
        {40, 2, 472196, 2.9060502195581402e-07, 1, 0, 0,
         true},  // by the hunter: a charge 1e-112 of the extent away
        {50, 3, 104664, 4.4859360146554471e-05, 1, 0, 0, true},
        {48, 290, 973958, 2.23950114233688e-09, 1, 0, 0, true},
        {49, 556, 842833, 0.00096230929798330703, 1, 0, 0.0048541129512421153, true},
        {53, 487, 793589, 0.0006404527000742617, 1, 0, 4.2815587486191575e-09, false},
        {3, 2148, 902401, 0.0024171990432974313, 0x1p-17, 0, 0, true},
        {61, 1110, 4927, 1.1524807812153112e-09, 1, 0, 0, true},
        {59, 783, 663409, 2.7944062314069562e-08, 4096, 0, 0, false},
        {13, 1294, 216433, 0.019507605051330847, 1, 0, 0, true},
        {13, 9729, 825442, 3.58632419780797e-07, 1, 0, 0.017700372601234405, false},
        {5, 4028, 82464, 0.0069485837712977231, 1, 0, 0, false},
        {56, 221, 612869, 0.014886447716832391, 1, 0, 0, true},
        {62, 3, 595168, 5.4094992956684184e-09, 1, 385.09860782713145, 0, false},
        {50, 672, 673874, 0.00016945004464358996, 1, 189.65221991256863, 0, true},
        {56, 349, 592702, 9.1036056460376766e-05, 1.9073486328125e-06, 0, 2.8108775168730566e-06, true},
        {55, 225, 446109, 0.006950602924265659, 1, 0, 0, true},
        {49, 225, 691068, 9.2106851309306498e-05, 2048, 0, 0, true},
        {35, 12626, 952904, 3.3858737452134015e-09, 1, 0, 0, false},
        {58, 243, 772927, 0.00030701952510414469, 1, 0, 0, true},
        {39, 1983, 935578, 0.02249049447202978, 1, 0, 0, true},
        {5, 5722, 50085, 0.0032567775444535371, 1, 708.12933909073126, 0, true},
        {30, 6851, 884954, 6.9776127202580362e-06, 1, 0, 8.1730427372468546e-09,
         true},  // thousands of charges within one softening length
    };
    for (const ForceQuestion& question : questions) {
        std::uint64_t asked = 0;
        EXPECT_LE(excess(question, asked), 1) << kinds_of_arrangements()[question.kind].name;
        EXPECT_GT(asked, 0u);
    }
}
/// By every instruction set.
TEST(ForceArrangements, OfClosePairsByEveryInstructionSet) {
    for (const auto& one : open_arrangements()) {
        if (one.name.find("pair") == one.name.npos && one.name.find("1e100") == one.name.npos &&
            one.name.find("pile") == one.name.npos)
            continue;
        const Arrangement all = one.make(2600, 1);
        const ForceOracle oracle(all, 100);
        for (const auto set : instruction_sets()) {
            const Using use(set);
            for (const double accuracy : {1e-3, 1e-5}) {
                const FoundErrors errors = oracle.errors_of(forces_of(all, accuracy));
                EXPECT_LE(errors.rms, accuracy) << one.name << " " << set;
                EXPECT_LE(errors.potential, accuracy) << one.name << " " << set;
            }
        }
    }
}
/// Two close bodies among 3,000 pull each other however near they are.
TEST(ForceArrangements, TwoCloseBodiesAmongManyActOnEachOther) {
    for (const double apart : {1e-6, 1e-7, 1e-8, 1e-9, 1e-12}) {
        Arrangement all = arranging::cube(2998, 5);
        all.add({0.7, 0.6, 0.5}, 1), all.add({0.7 + apart, 0.6, 0.5}, 1);
        const double distance = all.places[2999][0] - all.places[2998][0], pull = 1 / (distance * distance);
        for (const double accuracy : {1e-1, 1e-3, 1e-5}) {
            const Found found = forces_of(all, accuracy);
            EXPECT_NEAR(found[2998].gradient[0] / pull, 1, accuracy) << apart;
            EXPECT_NEAR(found[2999].gradient[0] / pull, -1, accuracy) << apart;
        }
    }
}
/// Targets that are no charges, beside heavy ones.
TEST(ForceArrangements, TargetsBesideCharges) {
    Arrangement all = arranging::cube(4000, 6);
    std::vector<Vec3d> targets;
    for (std::uint64_t i = 0; i < 400; ++i) {
        Random random(7, i);
        targets.push_back(all.places[i] + random.direction<3>() * 1e-6);
    }
    Arrangement both = all;  // with targets as charges of nothing
    for (const Vec3d& target : targets) both.add(target, 0);
    for (const double accuracy : {1e-1, 1e-3, 1e-5, 1e-7}) {
        std::vector<PotentialAt<double>> found(targets.size()), want(targets.size());
        forces<double>(all.view(), Targets<double>(targets), found, {.accuracy = accuracy});
        for (std::size_t i = 0; i < targets.size(); ++i) {
            const Vec3d apart = all.places[i] - targets[i];
            const double distance = length(apart);
            const Vec3d pull = apart * (all.charges[i] / (distance * distance * distance));
            EXPECT_LE(length(found[i].gradient - pull), 3 * accuracy * length(pull) + 1e-6 * length(pull));
        }
    }
}

/// The corner of a periodic cube: 216 charges of 1 and one of 0.01, whose gradient is that of Ewald's sums.
TEST(ForceArrangements, AClumpAroundACornerOfAPeriodicCube) {
    Arrangement all;
    all.period = 1;
    for (int i = 0; i < 216; ++i) {
        Vec3d p((i / 36 - 2.5) * 1e-3, (i / 6 % 6 - 2.5) * 1e-3, (i % 6 - 2.5) * 1e-3);
        for (int k = 0; k < 3; ++k) p[k] -= std::floor(p[k]);
        all.add(p, 1);
    }
    all.add({0.49, 0.1, 0.51}, 0.01);
    for (const double accuracy : {1e-3, 1e-5, 1e-6, 1e-7}) {
        const Vec3d want(-17.42652, -90.10657, 17.42652), found = forces_of(all, accuracy)[216].gradient;
        EXPECT_LE(length(found - want), 10 * accuracy * length(want) + 1e-5) << accuracy;
    }
}
/// Of softened charges in one place each has the others' potential.
TEST(ForceArrangements, SoftenedChargesInOnePlaceActOnEachOther) {
    Arrangement all;
    all.add({0, 0, 0}, 1), all.add({0, 0, 0}, 2), all.add({1, 0, 0}, 1);
    all.softening = {SofteningKernel::wendland, 0.1};
    const auto expect = [](const Found& found, const std::string& how) {
        EXPECT_NEAR(found[0].potential, 21, 1e-4) << how;
        EXPECT_NEAR(found[1].potential, 11, 1e-4) << how;
        EXPECT_NEAR(found[2].potential, 3, 1e-4) << how;
    };
    for (const auto set : instruction_sets()) {
        const Using use(set);
        Found found(3);
        direct_sum<double>(all.view(), found);
        expect(found, "direct " + std::string(set));
        direct_sum<double>(all.view(), Targets<double>(all.places, {}, all.charges), found);
        expect(found, "at targets " + std::string(set));
        expect(forces_of(all, 1e-3), "forces " + std::string(set));
        std::vector<Vec3f> places;
        for (const Vec3d& p : all.places) places.emplace_back(p);
        const std::vector<float> charges{1, 2, 1};
        std::vector<PotentialAt<float>> in_float(3);
        direct_sum<float>({places, charges, all.softening}, in_float);
        for (int i = 0; i < 3; ++i)
            found[std::size_t(i)].potential = double(in_float[std::size_t(i)].potential);
        expect(found, "in float " + std::string(set));
    }
    // Many in one place, softened each its own way.
    Arrangement pile;
    for (std::uint64_t i = 0; i < 4000; ++i) {
        Random random(8, i);
        pile.add(i < 3000 ? Vec3d(0.5, 0.5, 0.5) : random.in_cube<3>(), 0.5 + random.uniform());
        pile.lengths.push_back(0.01 * (0.5 + random.uniform()));
    }
    const ForceOracle oracle(pile, 100);
    for (const double accuracy : {1e-3, 1e-7}) {
        const FoundErrors errors = oracle.errors_of(forces_of(pile, accuracy));
        EXPECT_LE(errors.rms, accuracy);
        EXPECT_LE(errors.potential, accuracy);
    }
}
/// A body far out switches off nothing, in sums over all pairs and in the method of Barnes and Hut.
TEST(ForceArrangements, ABodyFarOutLeavesTheOthersTheirForces) {
    for (const auto set : instruction_sets()) {
        const Using use(set);
        const std::vector<Vec3f> places{{0, 0, 0}, {1, 0, 0}, {2e12F, 0, 0}};
        const std::vector<float> charges{1, 1, 1};
        std::vector<PotentialAt<float>> found(3);
        direct_sum<float>({places, charges}, found);
        EXPECT_NEAR(found[0].gradient[0], 1, 1e-5) << set;
        EXPECT_NEAR(found[1].gradient[0], -1, 1e-5) << set;
        forces<float>({places, charges}, found);
        EXPECT_NEAR(found[0].gradient[0], 1, 1e-3) << set;
        for (const double far : {1e15, 1e97, 1e140}) {
            Arrangement all;
            all.add({0, 0, 0}, 1), all.add({1, 0, 0}, 1), all.add({far, 0, 0}, 1);
            Found in_double(3);
            direct_sum<double>(all.view(), in_double);
            EXPECT_NEAR(in_double[0].gradient[0], 1, 1e-12) << set << far;
            EXPECT_NEAR(forces_of(all, 1e-3)[1].gradient[0], -1, 1e-3) << set << far;
        }
        for (const double far : {1e6, 1e23, 1e60, 1e140}) {
            const Arrangement all = arranging::with(arranging::cube(600, 9), {far, far, 0}, 1);
            const ForceOracle oracle(all, 600);
            Found by_groups(all.size());
            barnes_hut<double>(all.view(), by_groups, {.opening_angle = 0.2});
            // Without kernels cells act as single charges, and cubes of distances are numbers of double.
            if (set == "plain" && far > 1e100) continue;
            EXPECT_LE(oracle.errors_of(by_groups).rms, set == "plain" ? 4e-3 : 1e-3) << set << far;
        }
    }
}
TEST(ForceArrangements, AnAccuracyBeyondFloatIsRefused) {
    const std::vector<Vec3f> places{{0, 0, 0}, {1, 0, 0}};
    const std::vector<float> charges{1, 1};
    std::vector<PotentialAt<float>> found(2);
    EXPECT_THROW(forces<float>({places, charges}, found, {.accuracy = 1e-8}), UsageError);
    forces<float>({places, charges}, found, {.accuracy = 1e-7});
    EXPECT_NEAR(found[0].gradient[0], 1, 1e-6);
}
/// The check tells errors of softened pairs by what they do, not by what bare ones would.
TEST(ForceArrangements, ChecksOfSoftenedPairs) {
    const Arrangement all = arranging::softened(arranging::pairs(2000, 10, 1e-9), 1e-2);
    const ForceCheck check(all.view(), 2000);
    Found found = forces_of(all, 1e-3);
    EXPECT_LE(check.errors_of<double>(found).rms, 1e-3);
    for (auto& at : found) at.gradient = at.gradient * 1.5;
    EXPECT_NEAR(check.errors_of<double>(found).rms, 0.5, 0.1);
}

}  // namespace
