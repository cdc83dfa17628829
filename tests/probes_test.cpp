/// A probe enters boxes in rows with the bits with which it enters each box alone.
#include <gtest/gtest.h>

#include <hedgerow/hedgerow.h>
#include <hedgerow/scenes/random.h>

using namespace hedgerow;

namespace {

/// A random number. It is often a small integer, so that planes, points and rays coincide at borders; at
/// times it is huge, tiny, infinite or NaN.
template <class T>
T number(Random& random) {
    const auto small = static_cast<T>(std::floor(random.uniform(-3, 4)));
    switch (static_cast<int>(random.uniform(0, 12))) {
        case 0:
            return static_cast<T>(random.uniform(-3, 3));
        case 1:
            return std::ldexp(small, 40);
        case 2:
            return small * std::numeric_limits<T>::denorm_min();
        case 3:
            return small * std::numeric_limits<T>::infinity();  // or NaN
        case 4:
            return T(-0.0);
        default:
            return small;
    }
}
template <class T, int D>
Vec<T, D> vector(Random& random) {
    Vec<T, D> v;
    for (int i = 0; i < D; ++i) v[i] = number<T>(random);
    return v;
}

/// Rows of boxes, some empty.
template <class T, int D>
struct Boxes {
    int places, count;
    std::vector<T> planes;

    explicit Boxes(Random& random)
        : places(4 << static_cast<int>(random.uniform(0, 3))),
          count(1 + static_cast<int>(random.uniform(0, places))),
          planes(row(2 * D), std::numeric_limits<T>::quiet_NaN()) {
        for (int i = 0; i < count; ++i) {
            Box<T, D> box;
            if (random.uniform() > 0.1) box.expand(vector<T, D>(random)).expand(vector<T, D>(random));
            for (int k = 0; k < D; ++k) {
                planes[row(2 * k) + static_cast<std::size_t>(i)] = box.low[k];
                planes[row(2 * k + 1) + static_cast<std::size_t>(i)] = box.high[k];
            }
        }
    }
    /// Where a row of planes begins.
    std::size_t row(int number) const {
        return static_cast<std::size_t>(number) * static_cast<std::size_t>(places);
    }
    BoxRows<T, D> rows() const { return {planes.data(), places, count}; }
};
/// Calls f(random, boxes) for many rows of boxes, until a test fails.
template <class T, int D, class F>
void for_many(F f) {
    for (std::uint64_t i = 0; i < 100000 && !testing::Test::HasFatalFailure(); ++i) {
        SCOPED_TRACE(i);
        Random random(3, i);
        const Boxes<T, D> some(random);
        f(random, some.rows());
    }
}
template <class Probe, class T, int D>
void expect_as_each(const Probe& probe, const BoxRows<T, D>& rows, T limit, int& entries) {
    T at[BoxRows<T, D>::width], want[BoxRows<T, D>::width];
    const unsigned entered = probe.enter(rows, limit, at);
    ASSERT_EQ(entered, enter_each(probe, rows, limit, want));
    for (int i = 0; i < rows.size(); ++i)
        if ((entered >> i & 1u) != 0) {
            ASSERT_EQ(std::bit_cast<BitsOf<T>>(at[i]), std::bit_cast<BitsOf<T>>(want[i])) << i;
            ++entries;
        }
}

template <class Scalar, int dimension>
struct Of {
    using T = Scalar;
    static constexpr int D = dimension;
};
template <class>
class Probes : public testing::Test {};
using Cases = testing::Types<Of<float, 2>, Of<float, 3>, Of<double, 2>, Of<double, 3>>;
TYPED_TEST_SUITE(Probes, Cases, );

TYPED_TEST(Probes, RaysEnterRowsAsEachBox) {
    using T = typename TypeParam::T;
    constexpr int D = TypeParam::D;
    int usable = 0, entries = 0;
    for_many<T, D>([&](Random& random, const BoxRows<T, D>& rows) {
        const Ray<T, D> ray{vector<T, D>(random), vector<T, D>(random), number<T>(random)};
        Box<T, D> scene;
        for (int i = 0; i < rows.size(); ++i) scene.expand(rows[i]);
        const RayProbe<T, D> probe(ray, scene);
        if (!probe.usable()) return;
        ++usable;
        expect_as_each(probe, rows, std::abs(number<T>(random)) * 10, entries);
        expect_as_each(probe, rows, std::numeric_limits<T>::infinity(), entries);
    });
    EXPECT_GT(usable, 10000);
    EXPECT_GT(entries, 10000);
}

TYPED_TEST(Probes, PointsEnterRowsAsEachBox) {
    using T = typename TypeParam::T;
    constexpr int D = TypeParam::D;
    int entries = 0;
    for_many<T, D>([&](Random& random, const BoxRows<T, D>& rows) {
        const PointProbe<T, D> probe(vector<T, D>(random));
        expect_as_each(probe, rows, std::abs(number<T>(random)), entries);
        expect_as_each(probe, rows, std::numeric_limits<T>::infinity(), entries);
    });
    EXPECT_GT(entries, 10000);
}

TYPED_TEST(Probes, BoxesEnterRowsAsEachBox) {
    using T = typename TypeParam::T;
    constexpr int D = TypeParam::D;
    int entries = 0;
    for_many<T, D>([&](Random& random, const BoxRows<T, D>& rows) {
        Box<T, D> box;
        box.expand(vector<T, D>(random)).expand(vector<T, D>(random));
        expect_as_each(BoxProbe<T, D>(box), rows, T(0), entries);
    });
    EXPECT_GT(entries, 10000);
}

}  // namespace
