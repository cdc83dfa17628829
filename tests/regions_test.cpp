/// Boxes and balls as regions: every structure against brute force, and brute force against rational
/// arithmetic.
#include <hedgerow/scenes/meshes.h>
#include <hedgerow/scenes/sets.h>

#include "nasty.h"
#include "placements.h"
#include "region_answers.h"
#include "region_sets.h"

using namespace hedgerow;

namespace {

template <class P>
class Regions : public testing::Test {};
using Sets =
    testing::Types<TriangleMesh<float>, TriangleMesh<double>, PointCloud<float, 3>, PointCloud<double, 2>,
                   SphereSet<double, 3>, SphereSet<float, 2>, SegmentSet<float>, SegmentSet<double>>;
TYPED_TEST_SUITE(Regions, Sets);

// ---- Oracles in rational numbers

/// Triangles, segments and points as rational triangles, for distances.
rational::Number distance2_to(const rational::Point& x, const std::vector<rational::Point>& c) {
    using namespace rational;
    Number least = distance2(x, c[0], c.back());
    if (c.size() < 3) return least;
    for (std::size_t i = 0; i < 2; ++i) {
        const Number d = distance2(x, c[i], c[i + 1]);
        if (d < least) least = d;
    }
    const Point n = cross(c[1] - c[0], c[2] - c[0]);
    if (zero(n)) return least;
    for (std::size_t i = 0; i < 3; ++i)
        if (dot(cross(n, c[(i + 1) % 3] - c[i]), x - c[i]) < 0) return least;
    const Number height = dot(n, x - c[0]);
    return height * height / dot(n, n);
}

template <class P, class T, int D>
Said judge_ball(const P& set, std::size_t i, const Sphere<T, D>& ball, Finds finds) {
    using rational::Number;
    Number own;
    const auto c = corners_of(set, i, own);
    const rational::Point center = rational::point(ball.center);
    const Number radius = double(ball.radius);
    if (finds == Finds::contained) {
        const Number error = own > 0 ? Number(0)
                                     : radius * radius * (std::is_same_v<T, float> ? 0x1p-22 : 0x1p-50) +
                                           Number(double(std::numeric_limits<T>::denorm_min()));
        bool near = false;  // a corner is about as far away as the radius
        for (const auto& p : c) {
            const Number reach = radius - own, r2 = reach * reach, d = distance2_to(center, {p});
            if (reach < 0 || d > r2 + error) return Said::no;
            near = near || (own == 0 && d > r2 - error);
        }
        return near ? Said::either : Said::yes;
    }
    const Number d = distance2_to(center, c), reach = radius + own, r2 = reach * reach;
    // Solid balls that overlap exactly are found. Else distances decide, which are rounded to T; those to
    // triangles err by roundings of their edges in double.
    if (own > 0 && d <= r2) return Said::yes;
    Number size = r2;
    for (const auto& p : c) size += distance2_to(center, {p});
    const Number error = r2 * (std::is_same_v<T, float> ? 0x1p-22 : 0x1p-50) + size * 0x1p-46 +
                         Number(double(std::numeric_limits<T>::denorm_min()));
    if (d <= r2 - error) return Said::yes;
    return d > r2 + error ? Said::no : Said::either;
}
template <class P, class T, int D>
Said judge_box(const P& set, std::size_t i, const Box<T, D>& box, Finds finds) {
    using rational::Number;
    Number own;
    const auto c = corners_of(set, i, own);
    if (finds == Finds::contained) {
        for (const auto& p : c)
            for (int k = 0; k < D; ++k) {
                const auto a = static_cast<std::size_t>(k);
                if (p[a] - own < double(box.low[k]) || p[a] + own > double(box.high[k])) return Said::no;
            }
        return Said::yes;
    }
    if constexpr (requires { set.sphere(i); })
        return exactly(rational::overlap(set.sphere(i), box));
    else
        return exactly(!rational::clipped(c, box).empty());
}

/// Returns how many answers there are, of both kinds.
template <class P>
std::array<std::size_t, 2> expect_balls_and_boxes(const P& set, const auto& draw, std::size_t count) {
    using T = typename P::Scalar;
    constexpr int D = P::dimension;
    std::vector<Sphere<T, D>> balls;
    std::vector<Box<T, D>> boxes;
    for (std::size_t i = 0; i < count; ++i) {
        const Vec<T, D> center = draw();
        balls.push_back({center, std::abs(draw()[0])});
        const Vec<T, D> corner = draw();
        boxes.push_back(exact::box_of(corner, draw()));
    }
    const auto view = set.view();
    for (const auto& ball : balls)
        expect_right(set, ball, [&](std::size_t i, Finds f) { return judge_ball(view, i, ball, f); });
    for (const auto& box : boxes)
        expect_right(set, box, [&](std::size_t i, Finds f) { return judge_box(view, i, box, f); });
    const auto in_balls = expect_answers(set, balls), in_boxes = expect_answers(set, boxes);
    return {in_balls[0] + in_boxes[0], in_balls[1] + in_boxes[1]};
}

TYPED_TEST(Regions, OnSmallIntegers) {
    using T = typename TypeParam::Scalar;
    for (const int reach : {2, 5}) {
        Random random(31, static_cast<std::uint64_t>(reach));
        const auto [overlapping, contained] = expect_balls_and_boxes(
            on_integers<TypeParam>(120, 2, 30),
            [&] { return exact::integers<T, TypeParam::dimension>(random, reach); }, 25);
        EXPECT_GT(overlapping, 500u);
        EXPECT_GT(contained, 20u);
    }
}
TYPED_TEST(Regions, OfTheLargestAndLeastShapes) {
    using T = typename TypeParam::Scalar;
    constexpr int most = std::is_same_v<T, float> ? 56 : 476;
    for (const int exponent : {most, -most}) {
        Random random(32, exponent > 0);
        const auto found = expect_balls_and_boxes(
            on_integers<TypeParam>(60, 3, 33, exponent),
            [&] { return exact::integers<T, TypeParam::dimension>(random, 3, exponent); }, 12);
        EXPECT_GT(found[0], 50u);
    }
}
TYPED_TEST(Regions, OnNastyNumbers) {
    using T = typename TypeParam::Scalar;
    std::size_t found = 0;
    for (std::uint64_t seed = 0; seed < 6; ++seed) {
        Random random(34, seed);
        auto numbers = nasty::Numbers<T>(static_cast<typename nasty::Numbers<T>::Kind>(seed), random);
        const auto draw = [&] { return numbers.template vec<TypeParam::dimension>(); };
        found += expect_balls_and_boxes(set_of<TypeParam>(60, draw), draw, 12)[0];
    }
    EXPECT_GT(found, 100u);
}
TYPED_TEST(Regions, TakeSubtreesOfLargeSetsWhole) {
    using T = typename TypeParam::Scalar;
    constexpr int D = TypeParam::dimension;
    const auto set = small_things<TypeParam>(3000, 0.02, 35);
    const Sphere<T, D> ball{Vec<T, D>::all(T(0.5)), T(0.4)};
    const Box<T, D> box{Vec<T, D>::all(T(0.1)), Vec<T, D>::all(T(0.8))};
    expect_answers(set, std::vector{ball, Sphere<T, D>{Vec<T, D>::all(T(0.3)), T(0.05)}});
    expect_answers(set, std::vector{box});
    const auto many = small_things<TypeParam>(20000, 0.01, 35);
    // A tree that holds each primitive once tests few of those that it counts.
    const auto expect_few_tests = [&](const auto& index, const auto& region) {
        Visits counted, listed;
        std::vector<PrimitiveId> found;
        const std::size_t count = overlap_count(index, region, {}, counted);
        EXPECT_EQ(overlapping(index, region, found, {}, listed), count);
        EXPECT_GT(count, 2000u);
        EXPECT_LT(counted.primitives, count * 3 / 4);
        EXPECT_EQ(counted, listed);
    };
    expect_few_tests(build<WideBvh>(many), ball);
    expect_few_tests(build<WideBvh>(many), box);
    expect_few_tests(build<Bvh>(many), ball);
    expect_few_tests(build<Bvh>(many), box);
}
TYPED_TEST(Regions, ThatAreEmptyFlatOrEverything) {
    using T = typename TypeParam::Scalar;
    constexpr int D = TypeParam::dimension;
    using V = Vec<T, D>;
    const T nan = std::numeric_limits<T>::quiet_NaN(), infinite = std::numeric_limits<T>::infinity();
    const auto set = on_integers<TypeParam>(100, 3, 36);
    const V zero, one = V::all(1);
    V broken = one;
    broken[D - 1] = nan;
    const std::vector<Sphere<T, D>> no_balls = {
        {zero, -1},        {zero, nan},           {broken, 1},
        {zero, -infinite}, {V::all(infinite), 1}, {V::all(-infinite), infinite}};
    const std::vector<Box<T, D>> no_boxes = {{}, {one, zero}, {broken, one}, {zero, broken}};
    EXPECT_EQ(expect_answers(set, no_balls)[0], 0u);
    EXPECT_EQ(expect_answers(set, no_boxes)[0], 0u);
    // Points, as balls without a radius and as flat boxes, find what they lie on.
    expect_answers(set, std::vector<Sphere<T, D>>{{zero, 0}, {one, 0}, {one * T(2), 0}});
    V flat = one * T(3);
    flat[0] = 1;
    expect_answers(set, std::vector<Box<T, D>>{{zero, zero}, {{V::all(-3) + V{}}, flat}});
    // All of space.
    const std::size_t all = 2 * set.size();
    EXPECT_EQ(expect_answers(set, std::vector<Sphere<T, D>>{{one, infinite}, {one, T(1000)}})[1], all);
    EXPECT_EQ(expect_answers(set, std::vector<Box<T, D>>{{V::all(-infinite), V::all(infinite)},
                                                         {V::all(-1000), V::all(1000)}})[1],
              all);
    // Nothing is in nothing.
    TypeParam none;
    expect_answers(none, std::vector<Sphere<T, D>>{{one, infinite}});
    expect_answers(on_integers<TypeParam>(1, 1, 37), std::vector<Sphere<T, D>>{{one, 1}, {zero, 0}});
}

TEST(RegionsOf, OfBallsAreWhatIsWithinTheRadius) {
    const auto mesh = soup<float>(500);
    const auto index = build(mesh);
    std::vector<Near<float, 3>> near;
    std::vector<PrimitiveId> found, ids;
    for (std::uint64_t i = 0; i < 200; ++i) {
        const Vec3f p(Random(38, i).in_cube<3>());
        const float radius = std::exp2(-float(i % 8));  // its square is exact
        within(index, p, radius, near);
        ids.clear();
        for (const auto& n : near) ids.push_back(n.element);
        std::sort(ids.begin(), ids.end());
        overlapping(index, Sphere<float, 3>{p, radius}, found);
        EXPECT_EQ(found, ids);
    }
}

/// Instances: any structure over instances of any structure, as brute force over brute force.
template <class P>
void expect_instances(const P& set, Scales scales) {
    using T = typename P::Scalar;
    constexpr int D = P::dimension;
    std::vector<Sphere<T, D>> balls;
    std::vector<Box<T, D>> boxes;
    for (std::uint64_t i = 0; i < 20; ++i) {
        Random random(39, i);
        const Vec<T, D> p((random.in_cube<D>() - Vec<double, D>::all(0.5)) * 8.0);
        balls.push_back({p, static_cast<T>(random.uniform() * 3)});
        boxes.push_back(exact::box_of(p, Vec<T, D>((random.in_cube<D>() - Vec<double, D>::all(0.5)) * 8.0)));
    }
    balls.push_back({{}, -1}), balls.push_back({{}, std::numeric_limits<T>::infinity()});
    const auto inner_of = [&]<class I>(const I& inner, const auto& use) {
        std::vector<Instance<I>> instances;
        for (const auto& t : transforms<D>(12, scales, 6)) instances.emplace_back(inner, t);
        const InstanceSet<I> all(instances);
        use(all);
    };
    const auto answers = [&](const auto& index) {
        std::vector<std::vector<PlacedId>> lists;
        const auto ask = [&](const auto& region) {
            overlapping(index, region, lists.emplace_back());
            EXPECT_EQ(overlap_count(index, region), lists.back().size());
            EXPECT_EQ(any_overlap(index, region), !lists.back().empty());
            contained(index, region, lists.emplace_back());
        };
        for (const auto& ball : balls) ask(ball);
        for (const auto& box : boxes) ask(box);
        return lists;
    };
    std::vector<std::vector<PlacedId>> want;
    inner_of(build<BruteForce>(set), [&](const auto& all) { want = answers(build<BruteForce>(all)); });
    std::size_t found = 0;
    for (const auto& list : want) found += list.size();
    EXPECT_GT(found, 100u);
    const auto compare = [&](const auto& all) {
        EXPECT_EQ(answers(build<WideBvh>(all)), want);
        EXPECT_EQ(answers(build<Bvh>(all)), want);
        EXPECT_EQ(answers(build<Grid>(all)), want);
    };
    inner_of(build<WideBvh>(set), compare);
    inner_of(build<KdTree>(set), compare);
}
TEST(RegionsOf, OfInstances) {
    expect_instances(soup<float>(60), Scales::any);
    expect_instances(spheres<double>(60), Scales::even);
    expect_instances(points2d<float>(60), Scales::any);
}
TEST(RegionsOf, OfBatchesNeedRoom) {
    const auto index = build(soup<float>(50));
    const std::vector<Sphere<float, 3>> balls(3, {{0.5f, 0.5f, 0.5f}, 1});
    std::vector<std::size_t> counts(2);
    EXPECT_THROW(overlap_counts(index, balls, counts), InputError);
    EXPECT_THROW(any_overlaps(index, balls, std::span<bool>()), InputError);
}

}  // namespace
