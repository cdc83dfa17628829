/// Half-spaces, frusta, oriented boxes, any planes and cones as regions: every structure against brute force,
/// and brute force against rational and long double arithmetic.
#include <optional>

#include <hedgerow/scenes/meshes.h>
#include <hedgerow/scenes/sets.h>

#include "placements.h"
#include "region_answers.h"
#include "region_sets.h"

using namespace hedgerow;

namespace {

template <class P>
class ShapedRegions : public testing::Test {};
using Sets =
    testing::Types<TriangleMesh<float>, SphereSet<double, 3>, SegmentSet<double>, PointCloud<float, 3>>;
TYPED_TEST_SUITE(ShapedRegions, Sets);

// ---- Oracles

/// The half-spaces of a region in rational numbers, each moved outward by `by` of its size near the
/// primitive.
template <class V>
std::vector<rational::HalfSpace> half_spaces(const V& region, const std::vector<rational::Point>& corners,
                                             double by) {
    std::vector<rational::HalfSpace> all;
    detail::for_each_face(region, [&](const auto& normal, double offset) {
        rational::HalfSpace h{rational::point(normal), offset};
        rational::Number size = abs(h.offset);
        for (const auto& c : corners)
            for (std::size_t k = 0; k < 3; ++k) size += abs(h.normal[k] * c[k]);
        h.offset += size * by + 0x1p-990;
        all.push_back(h);
        return true;
    });
    return all;
}
bool clips_to_something(const std::vector<rational::Point>& polygon,
                        const std::vector<rational::HalfSpace>& planes) {
    return !rational::clipped(polygon, planes).empty();
}
/// The distance of a point from what half-spaces have in common, in rational numbers but for the last root:
/// the least to a feasible foot on one, two or three planes. Nothing if there is no such foot.
std::optional<double> distance_to(const std::vector<rational::HalfSpace>& planes, const rational::Point& x) {
    using namespace rational;
    std::optional<Number> least;
    // Orthogonalises the planes' normals one after the other, moving the foot into each plane.
    const auto visit = [&](auto& self, std::size_t first, const Point& foot,
                           const std::vector<Point>& normals) -> void {
        for (std::size_t i = first; i < planes.size(); ++i) {
            Point n = planes[i].normal;
            for (const Point& m : normals) {
                const Number share = dot(n, m) / dot(m, m);
                for (std::size_t k = 0; k < 3; ++k) n[k] -= share * m[k];
            }
            if (zero(n)) continue;
            const Number step = (planes[i].offset - dot(planes[i].normal, foot)) / dot(n, n);
            Point there = foot;
            for (std::size_t k = 0; k < 3; ++k) there[k] += step * n[k];
            bool feasible = true;
            for (const auto& h : planes) feasible = feasible && dot(h.normal, there) <= h.offset;
            const Number d = dot(there - x, there - x);
            if (feasible && (!least || d < *least)) least = d;
            if (normals.size() < 2) {
                auto more = normals;
                more.push_back(n);
                self(self, i + 1, there, more);
            }
        }
    };
    visit(visit, 0, x, {});
    if (!least) return std::nullopt;
    return std::sqrt(least->get_d());
}
template <class P, SlabVolume V>
Said judge(const P& set, std::size_t i, const V& region, Finds finds) {
    rational::Number radius;
    const auto corners = corners_of(set, i, radius);
    const auto exact = half_spaces(region, corners, 0), wide = half_spaces(region, corners, 0x1p-40);
    if (radius > 0) {
        // A ball lies in the region if it is clear of every plane, and apart if it is beyond one.
        bool inside = true, apart = false, center = true;
        for (const auto& h : exact) {
            const double height = rational::Number(rational::dot(h.normal, corners[0]) - h.offset).get_d();
            const double reach =
                radius.get_d() * std::sqrt(rational::Number(rational::dot(h.normal, h.normal)).get_d());
            const double error = 1e-12 * (std::abs(height) + reach) + 1e-13 * std::abs(h.offset.get_d());
            if (finds == Finds::contained && std::abs(height + reach) <= error) return Said::either;
            if (finds == Finds::overlapping && std::abs(height - reach) <= error) return Said::either;
            inside = inside && height + reach <= 0, apart = apart || height - reach > 0;
            center = center && height <= 0;
        }
        if (finds == Finds::contained) return exactly(inside);
        if (apart || center) return exactly(center);
        const auto away = distance_to(exact, corners[0]);
        const double error = 1e-9 * (1 + radius.get_d());
        if (!away || std::abs(*away - radius.get_d()) <= error) return Said::either;
        return exactly(*away < radius.get_d());
    }
    if (finds == Finds::contained || corners.size() == 1) {
        bool all = true;
        for (const auto& c : corners)
            for (const auto& h : exact) all = all && rational::dot(h.normal, c) <= h.offset;
        return exactly(all);
    }
    if (clips_to_something(corners, exact)) return Said::yes;
    return clips_to_something(corners, wide) ? Said::either : Said::no;
}

/// The least of a convex function on [low, high], by golden sections.
template <class F>
exact::Real least_on(exact::Real low, exact::Real high, F f) {
    constexpr exact::Real share = 0.6180339887498948482L;
    exact::Real a = high - share * (high - low), b = low + share * (high - low), fa = f(a), fb = f(b);
    for (int i = 0; i < 70; ++i) {
        if (fa < fb)
            high = b, b = a, fb = fa, a = high - share * (high - low), fa = f(a);
        else
            low = a, a = b, fa = fb, b = low + share * (high - low), fb = f(b);
    }
    return std::min(fa, fb);
}
/// Cones in long double. How far a place is outside of the side and the ends is a convex function, whose
/// least on a primitive is searched for.
template <class P, class T, int D>
Said judge(const P& set, std::size_t i, const Cone<T, D>& cone, Finds finds) {
    using namespace exact;
    rational::Number radius;
    const auto corners = corners_of(set, i, radius);
    const Real3 axis = real(cone.axis());
    const Real slope = cone.slope(), height = cone.height(), reach = static_cast<Real>(radius.get_d());
    const auto beyond = [&](Real3 x) {
        const Real3 v = x - real(cone.apex());
        const Real h = dot(axis, v), across = size(v - axis * h);
        return std::max({(across - slope * h) / std::sqrt(1 + slope * slope), -h, h - height});
    };
    std::vector<Real3> p;
    Real error = 1e-11L;
    for (const auto& c : corners) {
        p.push_back({c[0].get_d(), c[1].get_d(), c[2].get_d()});
        error = std::max(error, 1e-11L * size(p.back() - real(cone.apex())));
    }
    const auto judged = [&](Real most) { return std::abs(most) <= error ? Said::either : exactly(most < 0); };
    if (finds == Finds::contained) {
        Real most = beyond(p[0]);
        for (const Real3& x : p) most = std::max(most, beyond(x));
        return judged(most + reach);
    }
    if (p.size() == 1 && reach > 0) {
        // The distance from the cone, over the heights of its places.
        const Real3 v = p[0] - real(cone.apex());
        const Real h = dot(axis, v), across = size(v - axis * h);
        return judged(least_on(0, std::min(height, std::abs(h) + across + 1),
                               [&](Real at) {
                                   const Real away = std::max(Real(0), across - slope * at);
                                   return std::sqrt((at - h) * (at - h) + away * away);
                               }) -
                      reach);
    }
    const Real3 along = p[p.size() / 2] - p[0], aside = p.back() - p[0];
    return judged(least_on(0, 1, [&](Real u) {
        const auto on_line = [&](Real v) { return beyond(p[0] + along * u + aside * v); };
        return p.size() < 3 ? on_line(0) : least_on(0, 1 - u, on_line);
    }));
}

// ---- Regions

template <class T, int D>
struct Shapes {
    std::vector<HalfSpace<T, D>> half_spaces;
    std::vector<Frustum<T, D>> frusta;
    std::vector<Obb<T, D>> boxes;
    std::vector<Cone<T, D>> cones;
    std::vector<std::vector<HalfSpace<T, D>>> planes;
    std::vector<Hull<T, D>> hulls;

    /// Regions of about the size of the cube from −reach to reach.
    Shapes(std::size_t count, double reach, std::uint64_t seed, bool integers) {
        for (std::uint64_t i = 0; i < count; ++i) {
            Random random(seed, i);
            const auto vector = [&] {
                if (integers) return exact::integers<T, D>(random, 3);
                return Vec<T, D>(random.direction<D>());
            };
            const auto place = [&] {
                return Vec<T, D>((random.in_cube<D>() - Vec<double, D>::all(0.5)) * (2 * reach));
            };
            const auto number = [&](double most) {
                const double x = random.uniform() * most;
                return static_cast<T>(integers ? std::round(x) : x);
            };
            half_spaces.push_back({vector(), number(2 * reach) - static_cast<T>(reach)});
            // An oriented box.
            Obb<T, D> box;
            const auto turn = turned<D>(random).there().linear;
            for (int k = 0; k < D; ++k) {
                if (integers)
                    box.axis[k][(k + 1) % D] = T(1);
                else
                    box.axis[k] = Vec<T, D>(turn[static_cast<std::size_t>(k)]);
                box.low[k] = number(reach) - static_cast<T>(reach),
                box.high[k] = box.low[k] + number(1.5 * reach);
            }
            boxes.push_back(box);
            // A cut-off pyramid around a place: opposite faces lean towards each other.
            typename Frustum<T, D>::Faces faces;
            const Vec<double, D> at(place());
            for (int face = 0; face < 2 * D; ++face) {
                const int k = face / 2, side = face % 2;
                Vec<double, D> n;
                n[k] = side == 0 ? -1 : 1;
                if (k > 0) n[0] = integers ? 1 : 0.3;
                const Vec<T, D> normal(integers ? n : Vec<double, D>(turned<D>(random).there().vector(n)));
                faces[static_cast<std::size_t>(face)] = {
                    normal,
                    static_cast<T>(
                        std::round(4 * (dot(Vec<double, D>(normal), at) + random.uniform() * reach)) / 4)};
            }
            frusta.emplace_back(faces);
            cones.push_back(
                {place(), vector(), number(1.5),
                 integers && i % 2 == 0 ? std::numeric_limits<T>::infinity() : number(2 * reach)});
            auto& some = planes.emplace_back();
            for (std::uint64_t k = 0; k <= i % 9; ++k) some.push_back({vector(), number(reach)});
        }
        for (const auto& some : planes) hulls.push_back({some});
    }
    template <class F>
    void for_each_kind(F f) const {
        f("half-spaces", half_spaces);
        f("frusta", frusta);
        f("oriented boxes", boxes);
        f("cones", cones);
        f("planes", hulls);
    }
};

template <class P>
void expect_shapes(const P& set, const Shapes<typename P::Scalar, P::dimension>& shapes, std::size_t least) {
    const auto view = set.view();
    shapes.for_each_kind([&](const char* kind, const auto& regions) {
        SCOPED_TRACE(kind);
        for (const auto& region : regions)
            if (!is_empty(region))
                expect_right(set, region, [&](std::size_t i, Finds f) { return judge(view, i, region, f); });
        const auto found = expect_answers(set, regions);
        EXPECT_GT(found[0], least);
    });
}

TYPED_TEST(ShapedRegions, OfAnyShape) {
    using T = typename TypeParam::Scalar;
    constexpr int D = TypeParam::dimension;
    expect_shapes(small_things<TypeParam>(150, 0.3, 50), Shapes<T, D>(16, 1, 51, false), 60);
}
TYPED_TEST(ShapedRegions, OnSmallIntegers) {
    using T = typename TypeParam::Scalar;
    constexpr int D = TypeParam::dimension;
    expect_shapes(on_integers<TypeParam>(80, 3, 52), Shapes<T, D>(16, 3, 53, true), 20);
}
TYPED_TEST(ShapedRegions, OfManySmallThings) {
    using T = typename TypeParam::Scalar;
    constexpr int D = TypeParam::dimension;
    const auto set = small_things<TypeParam>(3000, 0.02, 54);
    Shapes<T, D>(4, 1, 55, false).for_each_kind([&](const char* kind, const auto& regions) {
        SCOPED_TRACE(kind);
        expect_answers(set, regions);
    });
}

/// Every primitive overlaps a half-space or the one beyond its plane; those that lie in one overlap the other
/// only if they touch the plane.
TYPED_TEST(ShapedRegions, OfAPlaneCoverAll) {
    using T = typename TypeParam::Scalar;
    constexpr int D = TypeParam::dimension;
    const auto set = on_integers<TypeParam>(200, 3, 56);
    const auto index = build(set);
    for (std::uint64_t i = 0; i < 50; ++i) {
        Random random(57, i);
        HalfSpace<T, D> low{exact::integers<T, D>(random, 2), T(exact::integer(random, 4))};
        const HalfSpace<T, D> high{-low.normal, -low.offset};
        const HalfSpace<T, D> both[] = {low, high};
        std::vector<PrimitiveId> in_low, in_high, in_both;
        overlapping(index, low, in_low), overlapping(index, high, in_high);
        overlapping(index, Hull<T, D>{both}, in_both);
        std::vector<PrimitiveId> all, common, inside, apart;
        std::ranges::set_union(in_low, in_high, std::back_inserter(all));
        EXPECT_EQ(all.size(), set.size());
        std::ranges::set_intersection(in_low, in_high, std::back_inserter(common));
        EXPECT_EQ(in_both, common);
        contained(index, low, inside);
        std::ranges::set_difference(all, in_high, std::back_inserter(apart));
        EXPECT_TRUE(std::ranges::includes(inside, apart));
    }
}
TYPED_TEST(ShapedRegions, ThatAreEmptyFlatOrEverything) {
    using T = typename TypeParam::Scalar;
    constexpr int D = TypeParam::dimension;
    using V = Vec<T, D>;
    const T nan = std::numeric_limits<T>::quiet_NaN(), infinite = std::numeric_limits<T>::infinity();
    const auto set = on_integers<TypeParam>(300, 3, 58);
    const V zero, one = V::all(1);
    V broken = one;
    broken[0] = nan;
    const auto expect_found = [&](const auto& regions, std::size_t count) {
        EXPECT_EQ(expect_answers(set, regions)[1], count);
    };
    // Nothing.
    using Half = HalfSpace<T, D>;
    expect_found(
        std::vector<Half>{{broken, 1}, {one, nan}, {one, -infinite}, {zero, -1}, {one * infinite, 1}}, 0);
    expect_found(std::vector<Cone<T, D>>{{broken, one, 1, 1},
                                         {zero, broken, 1, 1},
                                         {zero, one, nan, 1},
                                         {zero, one, 1, nan},
                                         {zero, zero, 1, 1},
                                         {zero, one, -1, 1},
                                         {zero, one, 1, -1},
                                         {zero, one, infinite, 1}},
                 0);
    Obb<T, D> box;
    for (int k = 0; k < D; ++k) box.axis[k][k] = 1;
    box.low = one, box.high = zero;
    expect_found(std::vector{box}, 0);
    const Half beyond[] = {{one, -1}, {-one, -1}};
    expect_found(std::vector{Hull<T, D>{beyond}}, 0);
    // All.
    const std::size_t all = set.size();
    expect_found(std::vector<Half>{{one, infinite}, {zero, 0}, {one, 1000}}, 3 * all);
    expect_found(std::vector{Hull<T, D>{}}, all);
    V axis;
    axis[0] = 1;
    expect_found(std::vector<Cone<T, D>>{{axis * T(-100), axis, 1}, {axis * T(-100), axis, 1, 1000}},
                 2 * all);
    // A plane, a line, a point: what touches them.
    const Half plane[] = {{axis, 1}, {-axis, -1}};
    EXPECT_GT(expect_answers(set, std::vector{Hull<T, D>{plane}})[0], 0u);
    box.low = box.high = zero;
    box.low[D - 1] = -3, box.high[D - 1] = 3;
    EXPECT_GT(expect_answers(set, std::vector{box})[0], 0u);
    expect_answers(set, std::vector<Cone<T, D>>{{zero, one, 0, 5}, {zero, axis, 0}, {zero, axis, 1, 0}});
}
TEST(Frusta, SeeWhatIsBetweenTheirPlanes) {
    const auto view = Frustum<double, 3>::perspective({1, 2, 3}, {0, 0, -2}, {0, 5, 1}, 0.5, 0.25, 1, 9);
    const PointCloud<double, 3> cloud{{{1, 2, 2.5},
                                       {1, 2, 2},
                                       {1, 2, -6},
                                       {1, 2, -6.01},
                                       {2.9, 2, -1},
                                       {3.1, 2, -1},
                                       {1, 2.9, -1},
                                       {1, 3.1, -1},
                                       {-0.9, 1.1, -1},
                                       {1, 2, 4}}};
    std::vector<PrimitiveId> found;
    overlapping(build(cloud), view, found);
    EXPECT_EQ(found, (std::vector<PrimitiveId>{1, 2, 4, 6, 8}));
    const Extent e = extent(view, Vec3d(0, 1, 0));
    EXPECT_NEAR(e.low, 2 - 2.25, 1e-4);
    EXPECT_NEAR(e.high, 2 + 2.25, 1e-4);
    const Vec3d eye, z(0, 0, 1), y(0, 1, 0);
    using F = Frustum<double, 3>;
    EXPECT_THROW(F::perspective(eye, eye, y, 1, 1, 1, 2), InputError);
    EXPECT_THROW(F::perspective(eye, z, z, 1, 1, 1, 2), InputError);
    EXPECT_THROW(F::perspective(eye, z, y, 0, 1, 1, 2), InputError);
    EXPECT_THROW(F::perspective(eye, z, y, 1, 1, 2, 1), InputError);
    EXPECT_THROW(F::perspective(eye, z, y, 1, 1, 1, std::numeric_limits<double>::quiet_NaN()), InputError);
}
TEST(ShapedRegionsOf, Instances) {
    const auto set = soup<float>(60);
    const auto inner = build<WideBvh>(set);
    const auto plain = build<BruteForce>(set);
    std::vector<Instance<decltype(build<WideBvh>(set))>> instances;
    std::vector<Instance<decltype(build<BruteForce>(set))>> as_well;
    for (const auto& t : transforms<3>(12, Scales::any, 6))
        instances.emplace_back(inner, t), as_well.emplace_back(plain, t);
    const auto index = build<Bvh>(InstanceSet(instances));
    const auto oracle = build<BruteForce>(InstanceSet(as_well));
    std::size_t some = 0;
    Shapes<float, 3>(12, 6, 59, false).for_each_kind([&](const char* kind, const auto& regions) {
        for (const auto& region : regions) {
            std::vector<PlacedId> found, want;
            EXPECT_EQ(overlapping(index, region, found), overlapping(oracle, region, want));
            EXPECT_EQ(found, want) << kind;
            EXPECT_EQ(overlap_count(index, region), want.size()) << kind;
            contained(index, region, found), contained(oracle, region, want);
            EXPECT_EQ(found, want) << kind;
            some += want.size();
        }
    });
    EXPECT_GT(some, 50u);
}

}  // namespace
