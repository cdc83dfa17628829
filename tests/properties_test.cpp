/// Properties of every scene and every query, tested on generated cases, which shrink when they fail.
#include <numeric>

#include "generated.h"

using namespace hedgerow;
using namespace hedgerow::generated;
using namespace hedgerow::matrix;
namespace gen = rc::gen;

namespace {

// ---- Structures

/// An index of each structure over the set, some with several options. Brute force is the first.
template <class P>
auto every_index(const P& set) {
    std::vector<std::string> specs = structures_for<P>();
    specs.insert(specs.begin(), "brute-force");
    for (const char* more :
         {"bvh:builder=sweep", "bvh:builder=midpoint", "bvh:builder=equal-counts", "bvh:builder=lbvh",
          "bvh:builder=ploc", "bvh:builder=agglomerative", "bvh:reinsertion=2", "bvh:max_leaf_size=1",
          "wide:width=4,builder=high,reinsertion=2", "wide:width=16,builder=fast,max_leaf_size=1",
          "kdtree:leaf_size=1", "grid:resolution=3", "octree:leaf_size=1", "octree:leaf_size=2,mailbox=off"})
        specs.push_back(named_for<P>(more));
    Indexes<typename P::Scalar, P::dimension> indexes;
    for (const auto& spec : specs) {
        indexes.push_back(build_any(spec, set, serial_executor()));
        if (const auto wrong = indexes.back()->validate(); !wrong.empty()) RC_FAIL(spec + ": " + wrong);
    }
    return indexes;
}

template <class T, int D>
struct Answers {
    Hit<T> closest;
    bool any = false;
    std::vector<Hit<T>> all;
    Near<T, D> near;
    std::vector<Near<T, D>> nearest;
    std::vector<PrimitiveId> overlapping;

    Answers(const AnyIndex<T, D>& index, const Ray<T, D>& ray) {
        closest_hits(index, {&ray, 1}, {&closest, 1});
        any_hits(index, {&ray, 1}, {&any, 1});
        all_hits(index, ray, all);
    }
    Answers(const AnyIndex<T, D>& index, const Vec<T, D>& point, std::size_t k, const Box<T, D>& box) {
        closest_points(index, {&point, 1}, {&near, 1});
        hedgerow::nearest(index, point, k, nearest);
        hedgerow::overlapping(index, box, overlapping);
    }
    friend bool operator==(const Answers&, const Answers&) = default;
};

template <class P>
class OfEverySet : public testing::Test {};
using Sets =
    testing::Types<TriangleMesh<float>, TriangleMesh<double>, SphereSet<float, 3>, SphereSet<double, 3>,
                   SegmentSet<float>, SegmentSet<double>, PointCloud<float, 3>, PointCloud<double, 2>>;
TYPED_TEST_SUITE(OfEverySet, Sets);

TYPED_TEST(OfEverySet, StructuresAnswerWithTheBitsOfBruteForce) {
    using T = typename TypeParam::Scalar;
    constexpr int D = TypeParam::dimension;
    expect_always([] {
        const AnyCase<TypeParam> one;
        const auto indexes = every_index(one.set);
        const auto expect = [&](const auto&... question) {
            const Answers<T, D> want(*indexes[0], question...);
            for (const auto& index : indexes)
                if (!(Answers<T, D>(*index, question...) == want)) RC_FAIL(std::string(index->structure()));
            RC_ASSERT(bool(want.closest) == want.any && want.any == !want.all.empty());
            if (want.any) RC_ASSERT(want.closest == want.all[0]);
            if (!want.nearest.empty()) RC_ASSERT(want.near == want.nearest[0]);
        };
        for (int i = 0; i < 8; ++i) expect(one.ray());
        for (int i = 0; i < 4; ++i) expect(one.point(), *gen::inRange<std::size_t>(0, 50).as("k"), one.box());
    });
}

TYPED_TEST(OfEverySet, FirstHitsInPiecesOfAnySizeAreAllHits) {
    using T = typename TypeParam::Scalar;
    expect_always([] {
        const AnyCase<TypeParam> one;
        const auto indexes = every_index(one.set);
        const auto ray = one.ray();
        std::vector<Hit<T>> all;
        all_hits(*indexes[0], ray, all);
        for (const auto& index : indexes)
            for (std::size_t k = 1; k <= all.size() + 1; ++k) {
                // Each piece goes on after the last hit of the one before.
                std::vector<Hit<T>> joined, piece(k);
                AfterHit after;
                std::size_t n = k;
                while (n == k) {
                    n = first_hits(*index, ray, std::span(piece), {.after = after});
                    joined.insert(joined.end(), piece.begin(),
                                  piece.begin() + static_cast<std::ptrdiff_t>(n));
                    RC_ASSERT(joined.size() <= all.size());
                    after = piece.back();
                }
                if (joined != all) RC_FAIL(std::string(index->structure()) + ", k " + std::to_string(k));
            }
    });
}

/// Cases that failed once, shrunk: rays that graze the scene's own faces and lean outward by less than the
/// error of the primitives' tests.
TEST(Structures, RaysThatGrazeTheFacesOfTheSceneAreAnsweredToTheirEnd) {
    const auto expect_hit = [](const auto& set, const auto& ray) {
        for (const auto& index : every_index(set)) {
            Hit<typename std::remove_cvref_t<decltype(set)>::Scalar> hit;
            closest_hits(*index, {&ray, 1}, {&hit, 1});
            EXPECT_TRUE(hit) << index->structure();
        }
    };
    const SegmentSet<float> cross{{{{-1, -3}, {-1, 4}}, {{3, 0}, {-4, 0}}}};
    expect_hit(cross, Ray2f{{0, 4}, {-0x1p26f, 0x1p-124f}});
    const SegmentSet<double> corner{{{{0, 2}, {0, -0x1.cp53}}, {{0, 0}, {0x1p55, 0}}}};
    expect_hit(corner, Ray2d{{0x1p52, 1}, {-0x1p52, 1}});
    const TriangleMesh<float> fan{{{0, 0, 0}, {0, 0, 2}, {1, 3, 0}, {0, 1, 0}}, {{0, 0, 1}, {3, 2, 0}}, {}};
    expect_hit(fan, Ray3f{{1, 3, 4}, {0x1p-126f, 0x1p-126f, -0x1p24f}});
}

/// Gives the primitives in `list` their ids from before the shuffle, and sorts the list by `key`, then by id.
template <class List, class Key>
List as_before(List list, const std::vector<std::uint32_t>& before, Key key) {
    for (auto& x : list) x.element = x.primitive = before[x.element];
    std::sort(list.begin(), list.end(), [&](const auto& a, const auto& b) {
        return key(a) != key(b) ? key(a) < key(b) : a.element < b.element;
    });
    return list;
}

TYPED_TEST(OfEverySet, TheOrderOfPrimitivesChangesOnlyTheirIds) {
    using T = typename TypeParam::Scalar;
    constexpr int D = TypeParam::dimension;
    expect_always([] {
        AnyCase<TypeParam> one;
        // Shuffle the primitives by random keys.
        auto shuffled = one.set;
        const std::size_t n = shuffled.size();
        const auto keys = *gen::container<std::vector<int>>(n, gen::inRange(0, 1000)).as("order");
        std::vector<std::uint32_t> before(n);
        std::iota(before.begin(), before.end(), 0u);
        std::stable_sort(before.begin(), before.end(), [&](auto a, auto b) { return keys[a] < keys[b]; });
        for (std::size_t i = 0; i < n; ++i) items(shuffled)[i] = items(one.set)[before[i]];
        // Query the primitives in their first order.
        const auto oracle = build_any("brute-force", one.set);
        const auto ray = one.ray();
        const auto point = one.point();
        const auto box = one.box();
        const Answers<T, D> hits(*oracle, ray), regions(*oracle, point, n, box);
        for (const auto& index : every_index(shuffled)) {
            // The shuffled primitives give the same answers under their former ids.
            const Answers<T, D> got(*index, ray);
            RC_ASSERT(as_before(got.all, before, [](const auto& h) { return h.t; }) == hits.all);
            RC_ASSERT(got.closest.t == hits.closest.t);
            Answers<T, D> around(*index, point, n, box);
            const auto distance = [](const auto& f) { return f.distance2; };
            RC_ASSERT(as_before(around.nearest, before, distance) == regions.nearest);
            RC_ASSERT(around.near.distance2 == regions.near.distance2);
            for (auto& id : around.overlapping) id = before[id];
            std::sort(around.overlapping.begin(), around.overlapping.end());
            RC_ASSERT(around.overlapping == regions.overlapping);
        }
    });
}

/// Overwrites the primitives of `set` in place by those of `other`. The ids stay.
template <class P>
void move_to(P& set, P& other) {
    if constexpr (requires { set.vertices; })
        std::ranges::copy(other.vertices, set.vertices.begin());
    else
        std::ranges::copy_n(items(other).begin(), std::ssize(items(set)), items(set).begin());
}

TYPED_TEST(OfEverySet, RefitsAnswerWithTheBitsOfBruteForce) {
    using T = typename TypeParam::Scalar;
    constexpr int D = TypeParam::dimension;
    expect_always([] {
        AnyCase<TypeParam> one;
        const std::string structure = *gen::element<std::string>(
            "bvh:builder=binned", "bvh:builder=sweep", "bvh:builder=midpoint", "bvh:builder=equal-counts",
            "bvh:builder=lbvh", "bvh:builder=ploc", "bvh:builder=agglomerative", "bvh:builder=spatial-splits",
            "wide:width=4", "wide:width=8", "wide:width=16");
        const auto leaf = std::to_string(*gen::inRange(1, 9).as("max_leaf_size"));
        const auto index = build_any(structure + ",max_leaf_size=" + leaf, one.set);
        for (int step = 0; step < 4; ++step) {
            // Move the primitives and refit.
            AnyCase<TypeParam> now;
            items(now.set).resize(one.set.size());
            move_to(one.set, now.set);
            RC_ASSERT(index->refit() >= 0);
            RC_ASSERT(index->validate() == "");
            // Compare with brute force over the moved primitives.
            const auto oracle = build_any("brute-force", one.set);
            for (int i = 0; i < 4; ++i) {
                const auto ray = one.ray();
                RC_ASSERT((Answers<T, D>(*index, ray) == Answers<T, D>(*oracle, ray)));
            }
            const auto point = one.point();
            const auto box = one.box();
            RC_ASSERT((Answers<T, D>(*index, point, 9, box) == Answers<T, D>(*oracle, point, 9, box)));
        }
    });
}

TYPED_TEST(OfEverySet, APowerOfTwoInTheDirectionDividesT) {
    using T = typename TypeParam::Scalar;
    expect_always([] {
        const T least = std::numeric_limits<T>::min(), most = std::numeric_limits<T>::max();
        const AnyCase<TypeParam> one;
        // Multiply the direction by 2^k and divide the interval by it.
        auto ray = one.ray(), longer = ray;
        const int k = *integers(20).as("exponent");
        for (T& x : longer.direction.data) {
            x = std::ldexp(x, k);
            RC_PRE(std::abs(x) >= least || x == 0);  // subnormal components count as 0
        }
        for (T& x : ray.direction.data) RC_PRE(std::abs(x) >= least || x == 0);
        for (T* t : {&longer.t_min, &longer.t_max}) *t = std::ldexp(*t, -k);
        for (const auto& index : every_index(one.set)) {
            std::vector<Hit<T>> hits, scaled;
            all_hits(*index, ray, hits);
            all_hits(*index, longer, scaled);
            // Leave out hits at t = 0: for the other ray, whose t does not underflow, they may be just before
            // 0.
            for (auto* list : {&hits, &scaled}) std::erase_if(*list, [](const auto& h) { return h.t == 0; });
            // Compare the hits where no t is near overflow or underflow.
            const auto tame = [=](const Hit<T>& h) {
                return std::abs(h.t) > least * (1 << 21) && std::abs(h.t) < most / (1 << 21);
            };
            if (!std::ranges::all_of(hits, tame) || !std::ranges::all_of(scaled, tame)) continue;
            for (auto& h : hits) h.t = std::ldexp(h.t, -k);
            RC_ASSERT(hits == scaled);
        }
    });
}

// ---- Rays

template <class P>
class OfEveryRay : public testing::Test {};
using SetsThatRaysHit = testing::Types<TriangleMesh<float>, SphereSet<double, 3>>;
TYPED_TEST_SUITE(OfEveryRay, SetsThatRaysHit);

TYPED_TEST(OfEveryRay, IntervalsCountsAndFiltersFollowFromTheListOfHits) {
    using T = typename TypeParam::Scalar;
    expect_always([] {
        const AnyCase<TypeParam> one;
        const auto ray = one.ray();
        const auto expect_of = [&](const auto& index) {
            // all_hits and hit_count return the length of the list of all hits.
            std::vector<Hit<T>> all;
            const auto count = all_hits(index, ray, all);
            RC_ASSERT(count == all.size());
            RC_ASSERT(hit_count(index, ray) == all.size());
            // A ray with a smaller interval has the hits in that interval.
            const auto expect = [&](const Ray<T, TypeParam::dimension>& part) {
                std::vector<Hit<T>> got, kept;
                all_hits(index, part, got);
                const auto in = [&](const auto& h) { return part.t_min <= h.t && h.t <= part.t_max; };
                std::ranges::copy_if(all, std::back_inserter(kept), in);
                RC_ASSERT(got == kept);
                RC_ASSERT(closest_hit(index, part) == (kept.empty() ? Hit<T>() : kept[0]));
                RC_ASSERT(any_hit(index, part) == !kept.empty());
            };
            expect(ray);
            for (const auto& hit : all) {
                auto part = ray;
                part.t_max = hit.t;
                expect(part);
                part.t_max = std::nextafter(hit.t, T(-1));
                expect(part);
                if (std::is_same_v<TypeParam, SphereSet<T, 3>>) continue;  // spheres are hit from inside too
                part.t_max = ray.t_max;
                part.t_min = std::nextafter(hit.t, std::numeric_limits<T>::infinity());
                expect(part);
            }
            // A filter that refuses the first hits leaves the next ones.
            for (std::size_t i = 0; i < all.size(); ++i) {  // refuse the first i + 1
                const auto beyond = [&](const Hit<T>& h) {
                    return h.t > all[i].t || (h.t == all[i].t && h.element > all[i].element);
                };
                const auto next = i + 1 < all.size() ? all[i + 1] : Hit<T>();
                RC_ASSERT(closest_hit(index, ray, beyond) == next);
                RC_ASSERT(hit_count(index, ray, beyond) == all.size() - i - 1);
            }
            if (!all.empty()) {
                const auto second = closest_hit(index, ray, Except{all[0].element});
                RC_ASSERT(second == (all.size() > 1 ? all[1] : Hit<T>()));
            }
        };
        expect_of(build<Bvh>(one.set));
        expect_of(build<Grid>(one.set));
    });
}

// ---- Boxes

template <class B>
class OfEveryBox : public testing::Test {};
using Boxes = testing::Types<Box2f, Box2d, Box3f, Box3d>;
TYPED_TEST_SUITE(OfEveryBox, Boxes);

TYPED_TEST(OfEveryBox, UnionsAndIntersectionsNest) {
    using T = typename TypeParam::Scalar;
    constexpr int D = TypeParam::dimension;
    expect_always<20>([] {
        const bool wild = *gen::arbitrary<bool>();
        const auto a = *boxes<T, D>(wild), b = *boxes<T, D>(wild);
        const auto both = merged(a, b), shared = intersection(a, b);
        RC_ASSERT(both.contains(a) && both.contains(b) && both == merged(b, a));
        RC_ASSERT(both.half_area() >= a.half_area());
        RC_ASSERT(overlap(a, b) == !shared.empty());
        if (!shared.empty()) RC_ASSERT(a.contains(shared) && b.contains(shared));
        const auto p = *vectors<T, D>(wild);
        RC_ASSERT(shared.contains(p) == (a.contains(p) && b.contains(p)));
        RC_ASSERT(distance2(p, both) <= distance2(p, a));
        RC_ASSERT(a.contains(clamped(p, a)));
    });
}

TYPED_TEST(OfEveryBox, NestedBoxesHaveNestedIntervals) {
    using T = typename TypeParam::Scalar;
    constexpr int D = TypeParam::dimension;
    expect_always<20>([] {
        const bool wild = *gen::arbitrary<bool>();
        const auto inner = *boxes<T, D>(wild), outer = merged(inner, *boxes<T, D>(wild));
        const auto ray = *gen::exec([=] { return any_ray<T, D>({inner.low, outer.high}, wild); });
        const auto expect = [](const Interval<T>& in, const Interval<T>& out) {
            RC_ASSERT(out.entry <= in.entry && in.exit <= out.exit);
        };
        if (const auto in = meet(ray, inner)) {
            const auto out = meet(ray, outer);
            RC_ASSERT(out.has_value());
            expect(*in, *out);
        }
        const RayProbe<T, D> probe(ray, outer);
        if (probe.usable()) expect(probe.inside(inner, ray.t_max), probe.inside(outer, ray.t_max));
    });
}

}  // namespace
