/// Triangles that wait for the exact test of their distance.
#if defined(HEDGEROW_ENGINE_EXACT_TESTS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef HEDGEROW_ENGINE_EXACT_TESTS_INL_H
#undef HEDGEROW_ENGINE_EXACT_TESTS_INL_H
#else
#define HEDGEROW_ENGINE_EXACT_TESTS_INL_H
#endif

#include <cstdint>

#include <hwy/highway.h>

#include <hedgerow/engine/kernels.h>

#include "exact_distances-inl.h"

HWY_BEFORE_NAMESPACE();
namespace hedgerow::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

// The exact tests of triangles, done for as many at once as a vector has doubles, of whatever queries. An
// Answer, which is copied, has take(block, place, distance2, foot): a triangle at a place of its block has
// been tested; `foot` is not yet rounded and clamped.
template <class Answer>
class ExactTests {
public:
    explicit ExactTests(const TriangleBlock<float>* blocks) : blocks_(blocks) {}

    // Has the triangle at a place of the blocks tested by the next `flush`.
    HWY_INLINE void add(const Vec<float, 3>& p, std::uint32_t place, Answer answer) {
        const float* const corners = &blocks_[place / 8].corner[0][0][place % 8];
        for (int row = 0; row < 9; ++row) rows_[row][count_] = corners[8 * row];
        for (int k = 0; k < 3; ++k) rows_[9 + k][count_] = p[k];
        places_[count_] = place;
        answers_[count_] = answer;
        if (++count_ == lanes) flush();
    }
    // What fills the other lanes is left from earlier tests.
    HWY_NOINLINE void flush() {
        const auto vector = [&](int first_row, int step) __attribute__((always_inline)) {
            const auto row = [&](int axis) __attribute__((always_inline)) {
                return hn::PromoteTo(d, hn::Load(f, rows_[first_row + step * axis]));
            };
            return Coordinates<Doubles>{row(0), row(1), row(2)};
        };
        const ExactFeet<Doubles> feet(d, vector(9, 1), vector(0, 3), vector(1, 3), vector(2, 3));
        alignas(64) float distances2[lanes];
        alignas(64) double x[lanes], y[lanes], z[lanes];
        hn::Store(hn::DemoteTo(f, feet.distance2()), f, distances2);
        hn::Store(feet.point().x, d, x), hn::Store(feet.point().y, d, y), hn::Store(feet.point().z, d, z);
        for (int i = 0; i < count_; ++i)
            answers_[i].take(blocks_[places_[i] / 8], places_[i] % 8, distances2[i], {x[i], y[i], z[i]});
        count_ = 0;
    }

private:
    using Doubles = hn::CappedTag<double, 8>;
    static constexpr Doubles d{};
    static constexpr hn::Rebind<float, Doubles> f{};
    static constexpr int lanes = static_cast<int>(hn::MaxLanes(d));

    const TriangleBlock<float>* blocks_;
    int count_ = 0;
    alignas(64) float rows_[12][lanes] = {};  // corners by axis, as in a block, then p
    std::uint32_t places_[lanes];
    Answer answers_[lanes];
};

}  // namespace hedgerow::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
