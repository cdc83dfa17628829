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
// Answer, which is copied, has take(id, distance2, foot): the triangle of that id has been tested.
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
        const Coordinates<Floats> a = corner(0, 3), b = corner(1, 3), c = corner(2, 3), p = corner(9, 1);
        const ExactFeet<Doubles> feet(d, promoted(p), promoted(a), promoted(b), promoted(c));
        const Coordinates<Doubles>& exact = feet.point();
        const auto clamped_axis = [&](auto foot, auto ax, auto bx, auto cx) __attribute__((always_inline)) {
            const auto low = lesser(lesser(ax, bx), cx), high = greater(greater(ax, bx), cx);
            return lesser(greater(hn::DemoteTo(f, foot), low), high);
        };
        alignas(32) float distances2[lanes], x[lanes], y[lanes], z[lanes];
        hn::Store(hn::DemoteTo(f, feet.distance2()), f, distances2);
        hn::Store(clamped_axis(exact.x, a.x, b.x, c.x), f, x);
        hn::Store(clamped_axis(exact.y, a.y, b.y, c.y), f, y);
        hn::Store(clamped_axis(exact.z, a.z, b.z, c.z), f, z);
        for (int i = 0; i < count_; ++i)
            answers_[i].take(blocks_[places_[i] / 8].id[places_[i] % 8], distances2[i], {x[i], y[i], z[i]});
        count_ = 0;
    }

private:
    using Doubles = hn::CappedTag<double, 8>;
    static constexpr Doubles d{};
    using Floats = hn::Rebind<float, Doubles>;
    static constexpr Floats f{};
    static constexpr int lanes = static_cast<int>(hn::MaxLanes(d));

    HWY_INLINE Coordinates<Floats> corner(int first_row, int step) const {
        const auto row = [&](int axis) __attribute__((always_inline)) {
            return hn::Load(f, rows_[first_row + step * axis]);
        };
        return {row(0), row(1), row(2)};
    }
    static HWY_INLINE Coordinates<Doubles> promoted(const Coordinates<Floats>& v) {
        return {hn::PromoteTo(d, v.x), hn::PromoteTo(d, v.y), hn::PromoteTo(d, v.z)};
    }
    // Of zeros of either sign the first, like `min` and `max` of geometry/vec.h.
    template <class V>
    static HWY_INLINE V lesser(V a, V b) {
        return hn::IfThenElse(hn::Lt(b, a), b, a);
    }
    template <class V>
    static HWY_INLINE V greater(V a, V b) {
        return hn::IfThenElse(hn::Lt(a, b), b, a);
    }

    const TriangleBlock<float>* blocks_;
    int count_ = 0;
    alignas(64) float rows_[12][lanes] = {};  // corners by axis, as in a block, then p
    std::uint32_t places_[lanes];
    Answer answers_[lanes];
};

}  // namespace hedgerow::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
