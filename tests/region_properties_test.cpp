/// Properties of every question of a region, tested on generated sets and regions, which shrink when they
/// fail.
#include <hedgerow/any_index.h>

#include "generated.h"

using namespace hedgerow;
using namespace hedgerow::generated;
namespace gen = rc::gen;

namespace hedgerow {

template <class T, int D>
void showValue(const HalfSpace<T, D>& h, std::ostream& out) {
    out << rc::toString(h.normal) << "·x <= " << h.offset;
}
template <class T, int D>
void showValue(const Cone<T, D>& c, std::ostream& out) {
    out << "cone from " << rc::toString(c.apex()) << " along " << rc::toString(c.axis()) << ", slope "
        << c.slope() << ", height " << c.height();
}

}  // namespace hedgerow

namespace {

template <class P>
class RegionProperties : public testing::Test {};
using Sets = testing::Types<TriangleMesh<float>, TriangleMesh<double>, SphereSet<float, 3>,
                            SegmentSet<double>, PointCloud<float, 3>, PointCloud<double, 2>>;
TYPED_TEST_SUITE(RegionProperties, Sets);

/// Expects of an index that its answers follow from each other, and are `want` of those that overlap.
template <std::floating_point T, int D, class R>
void expect_consistent(const AnyIndex<T, D>& index, const R& region, const std::vector<PrimitiveId>& want,
                       const std::vector<PrimitiveId>& want_contained) {
    std::vector<PrimitiveId> found, inside;
    RC_ASSERT(overlapping(index, region, found) == want.size());
    RC_ASSERT(found == want);
    RC_ASSERT(contained(index, region, inside) == want_contained.size());
    RC_ASSERT(inside == want_contained);
    RC_ASSERT(std::ranges::includes(found, inside));
    RC_ASSERT(overlap_count(index, region) == found.size());
    RC_ASSERT(any_overlap(index, region) == !found.empty());
}
template <class P, class R>
std::vector<PrimitiveId> expect_consistent_everywhere(const P& set, const R& region) {
    std::vector<PrimitiveId> want, inside;
    const auto plain = build<BruteForce>(set);
    overlapping(plain, region, want), contained(plain, region, inside);
    const char* const octree = P::dimension == 3 ? "octree:leaf_size=1" : "quadtree:leaf_size=1";
    for (const char* name : {"brute-force", "wide:max_leaf_size=1", "bvh", "kdtree", octree, "grid"})
        expect_consistent(*build_any(name, set), region, want, inside);
    return want;
}

TYPED_TEST(RegionProperties, AnswersFollowFromEachOther) {
    using T = typename TypeParam::Scalar;
    constexpr int D = TypeParam::dimension;
    expect_always([] {
        const AnyCase<TypeParam> c;
        const auto vector = [&](const char* name) { return *vectors<T, D>(c.wild).as(name); };
        const auto number = [&](const char* name) { return *numbers<T>(c.wild).as(name); };
        switch (*gen::inRange(0, 4).as("shape")) {
            case 0:
                expect_consistent_everywhere(c.set, Sphere<T, D>{vector("center"), number("radius")});
                break;
            case 1:
                expect_consistent_everywhere(c.set, Box<T, D>{vector("low"), vector("high")});
                break;
            case 2:
                expect_consistent_everywhere(
                    c.set, Cone<T, D>{vector("apex"), vector("axis"), number("slope"), number("height")});
                break;
            default: {
                std::vector<HalfSpace<T, D>> planes;
                for (int i = *gen::inRange(0, 6).as("planes"); i > 0; --i)
                    planes.push_back({vector("normal"), number("offset")});
                expect_consistent_everywhere(c.set, Hull<T, D>{planes});
            }
        }
    });
}
TYPED_TEST(RegionProperties, AHalfSpaceAndItsComplementCoverAll) {
    using T = typename TypeParam::Scalar;
    constexpr int D = TypeParam::dimension;
    expect_always([] {
        const AnyCase<TypeParam> c;
        const HalfSpace<T, D> low{*vectors<T, D>(c.wild).as("normal"), *numbers<T>(c.wild).as("offset")};
        const auto below = expect_consistent_everywhere(c.set, low);
        const auto above = expect_consistent_everywhere(c.set, HalfSpace<T, D>{-low.normal, -low.offset});
        std::vector<PrimitiveId> all;
        std::ranges::set_union(below, above, std::back_inserter(all));
        RC_ASSERT(all.size() == c.set.size());
    });
}

}  // namespace
