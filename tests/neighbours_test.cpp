/// Neighbours of all points within a radius: against all pairs by the library's rule, against exact
/// fractions, and the same for any threads and instruction set.
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <random>

#include <gmpxx.h>
#include <gtest/gtest.h>

#include <hedgerow/ask/neighbours.h>
#include <hedgerow/base/error.h>
#include <hedgerow/geometry/radius.h>
#include <hedgerow/parallel/executor.h>

#include "arrangements.h"
#include "using.h"

namespace hedgerow {
namespace {

template <class T, int D>
using Points = std::vector<Vec<T, D>>;

template <class Type>
class Neighbours : public testing::Test {};
template <class Scalar, int dimension>
struct Space {
    using T = Scalar;
    static constexpr int D = dimension;
};
using Spaces = testing::Types<Space<float, 2>, Space<float, 3>, Space<double, 2>, Space<double, 3>>;
TYPED_TEST_SUITE(Neighbours, Spaces);

/// The lists of `asking` among `points` by the rule, every pair measured; of one set without the point
/// itself.
template <class T, int D>
NearLists<T> all_pairs(const Points<T, D>& points, const Points<T, D>& asking, T radius,
                       const Periods<D>& periods, bool once = false) {
    const bool one = &points == &asking;
    NearLists<T> lists;
    lists.offsets.push_back(0);
    for (std::size_t i = 0; i < asking.size(); ++i) {
        for (std::size_t j = once ? i + 1 : 0; j < points.size(); ++j) {
            const T d2 = image_distance2(asking[i], points[j], periods);
            if ((one && i == j) || !within_radius(d2, radius)) continue;
            lists.ids.push_back(static_cast<PrimitiveId>(j)), lists.distances2.push_back(d2);
        }
        lists.offsets.push_back(lists.ids.size());
    }
    return lists;
}
template <class T>
void expect_equal(const NearLists<T>& lists, const NearLists<T>& want, bool distances, const char* what) {
    EXPECT_EQ(lists.offsets, want.offsets) << what;
    EXPECT_EQ(lists.ids, want.ids) << what;
    EXPECT_EQ(lists.distances2, distances ? want.distances2 : Buffer<T>()) << what;
}
/// Compares all kinds of lists, by every instruction set, with those of all pairs.
template <class T, int D>
void expect_neighbours(const std::string& scene, const Points<T, D>& points, T radius,
                       const Periods<D>& periods = {}) {
    SCOPED_TRACE(scene + ", radius " + std::to_string(radius));
    Points<T, D> asking(points.begin(), points.begin() + static_cast<std::ptrdiff_t>(points.size() / 3));
    for (auto& p : asking) p[0] += radius < 1e9 ? radius / 3 : T(1);
    const auto both = all_pairs(points, points, radius, periods),
               once = all_pairs(points, points, radius, periods, true),
               of_asking = all_pairs(points, asking, radius, periods);
    for (const auto set : instruction_sets()) {
        SCOPED_TRACE(set);
        const Using use(set);
        NearLists<T> lists;
        for (const bool distances : {false, true}) {
            NeighbourOptions options{.periods = periods_in_space(periods), .distances = distances};
            neighbours_within(points, radius, lists, options);
            expect_equal(lists, both, distances, "both sides");
            neighbours_within(points, asking, radius, lists, options);
            expect_equal(lists, of_asking, distances, "of others");
            options.once = true;
            neighbours_within(points, radius, lists, options);
            expect_equal(lists, once, distances, "once");
            // In the order of cells: lists of the points in that order.
            std::vector<PrimitiveId> order;
            options.order = &order;
            for (const bool one_side : {false, true}) {
                options.once = one_side;
                neighbours_within(points, radius, lists, options);
                ASSERT_EQ(order.size(), points.size());
                Points<T, D> sorted;
                for (const PrimitiveId i : order) sorted.push_back(points.at(i));
                expect_equal(lists, all_pairs(sorted, sorted, radius, periods, one_side), distances,
                             "in order");
                std::sort(order.begin(), order.end());
                for (std::size_t i = 0; i < order.size(); ++i) ASSERT_EQ(order[i], i);
            }
        }
    }
}

template <class T, int D>
Points<T, D> places_of(const Arrangement& all) {
    Points<T, D> points;
    for (const Vec3d& place : all.places) {
        Vec<T, D> p;
        bool fits = true;
        for (int k = 0; k < D; ++k) {
            fits &= std::abs(place[k]) <= static_cast<double>(largest_coordinate<T>);
            p[k] = static_cast<T>(place[k]);
        }
        if (fits) points.push_back(p);
    }
    return points;
}
/// The distance, as it is rounded, of some point to the one that is near by so many others.
template <class T, int D>
T distance_to(const Points<T, D>& points, std::size_t from, std::size_t rank, const Periods<D>& periods) {
    std::vector<T> distances;
    for (const auto& p : points) distances.push_back(std::sqrt(image_distance2(points[from], p, periods)));
    std::nth_element(distances.begin(), distances.begin() + static_cast<std::ptrdiff_t>(rank),
                     distances.end());
    return distances[rank];
}

/// Calls f(name, points, period) for the hunter's arrangements of about n charges, open and periodic.
template <class T, int D, class F>
void for_each_arrangement(std::size_t n, std::uint64_t seed, F f) {
    for (const bool periodic : {false, true})
        for (const auto& one : periodic ? periodic_arrangements() : open_arrangements()) {
            const Arrangement all = one.make(n, seed);
            const auto points = places_of<T, D>(all);
            if (points.size() >= 20) f(one.name, points, all.period);
        }
}

/// The hunter's arrangements; radii are distances that some pair has exactly, and others.
TYPED_TEST(Neighbours, OfTheHuntersArrangements) {
    using T = typename TypeParam::T;
    constexpr int D = TypeParam::D;
    for_each_arrangement<T, D>(150, 1, [](const auto& name, const auto& points, double period) {
        const auto periods = Periods<D>::all(period);
        for (const std::size_t rank : {std::size_t(1), std::size_t(9), points.size() / 2})
            expect_neighbours(name, points, distance_to(points, points.size() / 3, rank, periods), periods);
    });
}

/// Boxes that repeat along some axes, also narrow ones, with points outside of them.
TYPED_TEST(Neighbours, InPeriodicBoxes) {
    using T = typename TypeParam::T;
    constexpr int D = TypeParam::D;
    Points<T, D> points;
    for (std::uint64_t i = 0; i < 260; ++i) {
        Random random(7, i);
        Vec<T, D> p;
        for (int k = 0; k < D; ++k) p[k] = static_cast<T>(random.uniform());
        points.push_back(p);
    }
    for (int k = 0; k < D; ++k)
        points[0][k] = 0, points[1][k] = T(1), points[2][k] = T(0.5), points[3][k] = -T(0);
    for (const T radius : {T(0), T(0.06), T(0.24), T(0.32), T(0.4), T(0.5), T(0.7), T(2)})
        for (const double period : {1.0, 0.9, 0.13, 1e-3, 7.0})
            for (unsigned axes = 1; axes < 1u << D; ++axes) {
                if (period != 1.0 && axes + 1 != 1u << D) continue;
                Periods<D> periods = {};
                for (int k = 0; k < D; ++k) periods[k] = (axes >> k & 1) != 0 ? period : 0;
                expect_neighbours("period " + std::to_string(period), points, radius, periods);
            }
}

TYPED_TEST(Neighbours, OfFewAndOfPointsInOnePlace) {
    using T = typename TypeParam::T;
    constexpr int D = TypeParam::D;
    for (const std::size_t n : {0u, 1u, 2u, 40u}) {
        const Points<T, D> points(n, Vec<T, D>::all(T(0.3)));
        for (const T radius :
             {T(-1), T(0), std::numeric_limits<T>::denorm_min(), T(1), std::numeric_limits<T>::max(),
              std::numeric_limits<T>::infinity(), std::numeric_limits<T>::quiet_NaN()}) {
            expect_neighbours("one place", points, radius);
            expect_neighbours("one place", points, radius, Periods<D>::all(0.25));
        }
    }
}

/// Lattices, whose neighbours are at exactly the radius; lines, far-off points, and the least distances.
TYPED_TEST(Neighbours, OfLatticesLinesAndExtremes) {
    using T = typename TypeParam::T;
    constexpr int D = TypeParam::D;
    Points<T, D> lattice, line, far, tiny, small;
    const T root = std::sqrt(std::numeric_limits<T>::denorm_min());  // of the least square
    for (std::uint64_t i = 0; i < 343; ++i) {
        Random random(9, i);
        Vec<T, D> p, q = Vec<T, D>::all(T(1e5)), r, s, t;
        for (std::uint64_t k = 0, rest = i; k < D; ++k, rest /= 7) {
            const auto axis = static_cast<int>(k);
            p[axis] = T(rest % 7) * T(0.1);
            r[axis] = static_cast<T>((random.uniform() - 0.5) * std::pow(10.0, 17 * random.uniform()));
            s[axis] = static_cast<T>(random.uniform() * 8) * std::numeric_limits<T>::denorm_min() * T(0x1p10);
        }
        q[0] = static_cast<T>(i) * T(0.01);
        for (int k = 0; k < D; ++k) t[k] = static_cast<T>(random.uniform()) * root * 8;
        lattice.push_back(p), line.push_back(q), far.push_back(r), tiny.push_back(s), small.push_back(t);
    }
    for (const T radius : {T(0.1), T(0.2), std::sqrt(T(0.02)), T(0.3)}) {
        expect_neighbours("lattice", lattice, radius);
        expect_neighbours("lattice", lattice, radius, Periods<D>::all(0.7));
    }
    for (const T radius : {T(0.01), T(0.055), T(2)}) expect_neighbours("line", line, radius);
    for (const T radius : {T(1e-3), T(1), T(1e6), T(1e15)}) expect_neighbours("far", far, radius);
    for (const T radius : {T(-1), T(0), root, root * T(1.5), root * 4})
        expect_neighbours("small", small, radius);
    expect_neighbours("tiny", tiny, T(0));
    expect_neighbours("tiny", tiny, std::numeric_limits<T>::denorm_min() * T(0x1p12));
    const T most = largest_coordinate<T>;
    Points<T, D> corners = tiny;
    corners.push_back(Vec<T, D>::all(most)), corners.push_back(Vec<T, D>::all(-most));
    corners.push_back(corners.back()), corners.back()[0] = std::nextafter(-most, T(0));
    for (const T radius : {T(1e-9), T(1e12), most, most * 4}) expect_neighbours("corners", corners, radius);
}

/// Against exact fractions: pairs that are nearer than the radius by more than the roundings of the rule are
/// listed, and pairs that are farther by as much are not.
TYPED_TEST(Neighbours, AgreeWithExactFractions) {
    using T = typename TypeParam::T;
    constexpr int D = TypeParam::D;
    for_each_arrangement<T, D>(70, 2, [](const auto& name, const auto& points, double of_period) {
        const T radius = distance_to(points, 3, 6, Periods<D>::all(of_period));
        NearLists<T> lists;
        neighbours_within(points, radius, lists, {.periods = periods_in_space(Periods<D>::all(of_period))});
        const mpq_class r2 = mpq_class(static_cast<double>(radius)) * mpq_class(static_cast<double>(radius)),
                        slack = r2 * mpq_class(4 * static_cast<double>(std::numeric_limits<T>::epsilon())) +
                                mpq_class(2 * static_cast<double>(std::numeric_limits<T>::denorm_min()));
        for (std::size_t i = 0; i < points.size(); ++i)
            for (std::size_t j = 0; j < points.size(); ++j) {
                mpq_class d2 = 0;
                for (int k = 0; k < D; ++k) {
                    mpq_class away = mpq_class(static_cast<double>(points[i][k])) -
                                     mpq_class(static_cast<double>(points[j][k]));
                    if (of_period > 0) {
                        const mpq_class period = of_period, turns = away / period + mpq_class(1, 2);
                        mpz_class whole;
                        mpz_fdiv_q(whole.get_mpz_t(), turns.get_num_mpz_t(), turns.get_den_mpz_t());
                        away -= whole * period;
                    }
                    d2 += away * away;
                }
                const auto begin = lists.ids.begin() + static_cast<std::ptrdiff_t>(lists.offsets[i]),
                           end = lists.ids.begin() + static_cast<std::ptrdiff_t>(lists.offsets[i + 1]);
                const bool listed = std::binary_search(begin, end, static_cast<PrimitiveId>(j));
                if (i == j || d2 > r2 + slack) {
                    EXPECT_FALSE(listed) << name << ": " << i << ", " << j;
                } else if (d2 < r2 - slack) {
                    EXPECT_TRUE(listed) << name << ": " << i << ", " << j;
                }
            }
    });
}

/// Many points: the same lists for any executor, instruction set and order of the array.
TYPED_TEST(Neighbours, TheSameForAnyThreadsAndOrder) {
    using T = typename TypeParam::T;
    constexpr int D = TypeParam::D;
    Points<T, D> points;
    for (std::uint64_t i = 0; i < 30000; ++i) {
        Random random(11, i);
        Vec<T, D> p;
        for (int k = 0; k < D; ++k) p[k] = static_cast<T>(random.uniform());
        points.push_back(i % 10 == 0 ? p * T(0.01) : p);
    }
    const T radius = D == 2 ? T(0.006) : T(0.03);
    NearLists<T> want, in_order;
    neighbours_within(points, radius, want, {.distances = true, .threads = serial_executor()});
    std::vector<PrimitiveId> order;
    neighbours_within(points, radius, in_order,
                      {.distances = true, .order = &order, .threads = serial_executor()});
    EXPECT_GT(want.ids.size(), 10 * points.size());
    Points<T, D> sorted;
    for (const PrimitiveId i : order) sorted.push_back(points[i]);
    for (const auto set : instruction_sets()) {
        const Using use(set);
        NearLists<T> lists;
        neighbours_within(points, radius, lists, {.distances = true, .threads = default_executor()});
        expect_equal(lists, want, true, "as they are");
        neighbours_within(sorted, radius, lists, {.distances = true, .threads = default_executor()});
        expect_equal(lists, in_order, true, "sorted");
        neighbours_within(sorted, radius, lists, {.distances = true, .threads = serial_executor()});
        expect_equal(lists, in_order, true, "sorted, one thread");
    }
    // The renumbered lists are those of the order of cells.
    std::size_t of_order = 0;
    for (std::size_t i = 0; i < order.size(); ++i)
        of_order += want.offsets[order[i] + 1] - want.offsets[order[i]];
    EXPECT_EQ(of_order, in_order.ids.size());
}

TYPED_TEST(Neighbours, RefuseWhatHasNoAnswer) {
    using T = typename TypeParam::T;
    constexpr int D = TypeParam::D;
    Points<T, D> points(9000, Vec<T, D>::all(T(1)));
    NearLists<T> lists;
    for (const T bad : {std::numeric_limits<T>::quiet_NaN(), std::numeric_limits<T>::infinity(),
                        std::nextafter(largest_coordinate<T>, std::numeric_limits<T>::max())}) {
        points[8123][D - 1] = bad;
        try {
            neighbours_within(points, T(0.1), lists);
            ADD_FAILURE() << bad;
        } catch (const InputError& error) {
            EXPECT_NE(std::string(error.what()).find("point 8123 has"), std::string::npos) << error.what();
        }
    }
    points.resize(10);
    for (const double bad : {-1.0, std::numeric_limits<double>::infinity(), std::nan("")}) {
        Periods<D> periods = {};
        periods[1] = bad;
        EXPECT_THROW(neighbours_within(points, T(0.1), lists, {.periods = periods_in_space(periods)}),
                     UsageError);
    }
    std::vector<PrimitiveId> order;
    EXPECT_THROW(neighbours_within(points, points, T(0.1), lists, {.once = true}), UsageError);
    EXPECT_THROW(neighbours_within(points, points, T(0.1), lists, {.order = &order}), UsageError);
}

/// Cells are sorted for many questions that are near points, not for few, nor for those beside a clump, whose
/// points would all be measured for each.
TEST(NeighboursOfQuestions, AreListedByCellsWhereThatIsFast) {
    Points<float, 3> points, near, beside;
    for (std::uint64_t i = 0; i < 8000; ++i) {
        Random random(17, i);
        points.push_back(Vec3f(random.direction<3>() * 1e-3));
        near.push_back(Vec3f(random.direction<3>()));
        beside.push_back(Vec3f(random.direction<3>() * 1e-3) + Vec3f(0.6f, 0, 0));
    }
    using Cells = detail::CellNeighbours<float, 3>;
    NearLists<float> lists;
    const auto listed = [&](const Points<float, 3>& asking) {
        return Cells::within(points, asking, 0.25f, lists, {});
    };
    EXPECT_TRUE(listed(near));
    EXPECT_EQ(lists.size(), 8000u);
    EXPECT_EQ(lists.count(), 0u);
    EXPECT_FALSE(listed(beside));
    near.resize(400);
    EXPECT_FALSE(listed(near));
}

/// A clump of points in one cell takes memory for its pairs alone.
TEST(NeighboursOfClumps, AreListedInParts) {
    Points<float, 3> points;
    for (std::uint64_t i = 0; i < 4000; ++i) {
        Random random(13, i);
        points.push_back(Vec3f(random.direction<3>() * 1e-3));
    }
    points.push_back({1, 1, 1}), points.push_back({1.5f, 1, 1});
    NearLists<float> lists;
    neighbours_within(points, 0.5f, lists);
    EXPECT_EQ(lists.count(), 4000u * 3999 + 2);
    EXPECT_EQ(lists.ids.back(), 4000u);
}

/// More cells along each axis than keys have room for, because of one point that is far away.
TEST(NeighboursOfManyPoints, AreFoundBesideAFarOne) {
    Points<double, 3> points;
    for (std::uint64_t i = 0; i < 1300000; ++i) {
        Random random(19, i);
        points.push_back({random.uniform(), random.uniform(), random.uniform()});
    }
    points[7] = points[1299999] + Vec3d(0, 0x1p-40, 0);
    points.push_back({1e9, 1e9, 1e9});
    NearLists<double> lists;
    neighbours_within(points, 1e-11, lists);
    ASSERT_EQ(lists.count(), 2u);
    EXPECT_EQ(lists[7].ids[0], 1299999u);
    EXPECT_EQ(neighbours_within(points, Points<double, 3>{{1e9, 1e9, 1e9}}, 1).count(), 1u);
}
/// Places so many periods away that differences are rounded: by the rule, whatever the instruction set.
TEST(NeighboursInPeriods, AreThoseOfTheRuleFarFromZero) {
    const Points<double, 3> points = {{1e15 + 0.25, 0, 0}, {0.1, 0, 0}};
    const Periods<3> periods{1, 0, 0};
    const bool near = image_distance2(points[0], points[1], periods) <= 0.13 * 0.13;
    for (const auto set : instruction_sets()) {
        const Using use(set);
        EXPECT_EQ(neighbours_within(points, 0.13, {.periods = periods}).count(), near ? 2u : 0u) << set;
    }
}

}  // namespace
}  // namespace hedgerow
