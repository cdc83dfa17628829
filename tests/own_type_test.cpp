/// A primitive type that is not the library's, in every structure: its answers have the bits of brute force.
#include "../src/any/build_any.h"

#include <hedgerow/scenes/sets.h>

#include "matrix.h"

using namespace hedgerow;

namespace {

/// Discs across the z axis.
template <class T>
struct Discs {
    using Scalar = T;
    static constexpr int dimension = 3;
    std::vector<Vec<T, 3>> centers;
    T radius;

    std::size_t size() const { return centers.size(); }
    Box<T, 3> bounds(std::size_t i) const {
        const Vec<T, 3> r(radius, radius, T(0));
        return {centers[i] - r, centers[i] + r};
    }
    std::optional<Meeting<T>> meet(std::size_t i, const Ray<T, 3>& ray) const {
        const T t = (centers[i][2] - ray.origin[2]) / ray.direction[2];
        if (!(ray.t_min <= t && t <= ray.t_max) || !holds(i, ray.at(t))) return std::nullopt;
        return Meeting<T>{t, T(0), T(0)};
    }
    Vec<T, 3> closest_point(std::size_t i, const Vec<T, 3>& p) const {
        const Vec<T, 3> from = from_axis(i, p);
        const T away = length(from);
        return clamped(away <= radius ? p : centers[i] + from * (radius / away), bounds(i));
    }
    Foot<T, 3> farthest_point(std::size_t i, const Vec<T, 3>& p) const {
        const Vec<T, 3> from = from_axis(i, p);
        const T away = length(from);
        const Vec<T, 3> beyond =
            away > 0 ? centers[i] - from * (radius / away) : centers[i] + Vec<T, 3>(radius, T(0), T(0));
        const Vec<T, 3> farthest = clamped(beyond, bounds(i));
        return {distance2(p, farthest), farthest};
    }
    bool overlaps(std::size_t i, const Box<T, 3>& box) const {
        return overlap(box, bounds(i)) && holds(i, clamped(centers[i], box));
    }
    /// Other regions overlap a disc where they contain its center.
    template <Region R>
    bool overlaps(std::size_t i, const R& region) const {
        return lies_in(centers[i], region);
    }
    template <Region R>
    bool lies_within(std::size_t i, const R& region) const {
        const Box<T, 3> box = bounds(i);
        for (const T x : {box.low[0], box.high[0]})
            for (const T y : {box.low[1], box.high[1]})
                if (!lies_in(Vec<T, 3>(x, y, centers[i][2]), region)) return false;
        return true;
    }

private:
    Vec<T, 3> from_axis(std::size_t i, const Vec<T, 3>& p) const {
        Vec<T, 3> from = p - centers[i];
        from[2] = 0;
        return from;
    }
    /// Whether a point, projected along z, is in the disc.
    bool holds(std::size_t i, const Vec<T, 3>& p) const {
        return length2(from_axis(i, p)) <= product(radius, radius);
    }
};

template <class T>
class OwnType : public testing::Test {};
using Scalars = testing::Types<float, double>;
TYPED_TEST_SUITE(OwnType, Scalars);

TYPED_TEST(OwnType, IsAnsweredByEveryStructureAsByBruteForce) {
    using T = TypeParam;
    Discs<T> discs{points<T>(300).points, T(0.05)};
    for (int i = 0; i < 30; ++i) discs.centers.push_back(discs.centers[0]);
    auto targets = discs.centers;
    for (auto& p : targets) p[0] += discs.radius;
    matrix::expect_equal("discs", discs, targets);
    matrix::expect_equal("one disc", Discs<T>{{{1, 2, 3}}, T(2)}, {{1, 2, 3}, {3, 2, 3}});
}

}  // namespace
