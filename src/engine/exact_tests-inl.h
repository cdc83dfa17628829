/// Triangles that wait for the exact test of their distance.
#if defined(HEDGEROW_ENGINE_EXACT_TESTS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef HEDGEROW_ENGINE_EXACT_TESTS_INL_H
#undef HEDGEROW_ENGINE_EXACT_TESTS_INL_H
#else
#define HEDGEROW_ENGINE_EXACT_TESTS_INL_H
#endif

#include <cstdint>
#include <type_traits>

#include <hwy/highway.h>

#include <hedgerow/engine/kernels.h>
#include <hedgerow/geometry/distance.h>

#include "exact_distances-inl.h"

HWY_BEFORE_NAMESPACE();
namespace hedgerow::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

// The exact tests of triangles, done for as many at once as a vector has doubles, of whatever queries. An
// Answer, which is copied, has take(id, distance2, foot): the triangle of that id has been tested.
template <class T, class Answer>
class ExactTests {
public:
    explicit ExactTests(const TriangleBlock<T>* blocks) : blocks_(blocks) {}

    // Has the triangle at a place of the blocks tested by the next `flush`.
    HWY_INLINE void add(const Vec<T, 3>& p, std::uint32_t place, Answer answer) {
        const T* const corners = &blocks_[place / 8].corner[0][0][place % 8];
        for (int row = 0; row < 9; ++row) rows_[row][count_] = corners[8 * row];
        for (int k = 0; k < 3; ++k) rows_[9 + k][count_] = p[k];
        places_[count_] = place;
        answers_[count_] = answer;
        if (++count_ == lanes) flush();
    }
    // What fills the other lanes is left from earlier tests, or if there is one test it fills all of them:
    // then the edges are tried only if its foot needs them.
    HWY_NOINLINE void flush() {
        const Coordinates<Scalars> a = corner(0, 3), b = corner(1, 3), c = corner(2, 3), p = corner(9, 1);
        const ExactFeet<Doubles> feet(d, promoted(p), promoted(a), promoted(b), promoted(c));
        const Coordinates<Doubles>& exact = feet.point();
        const auto clamped_axis = [&](auto foot, auto ax, auto bx, auto cx) __attribute__((always_inline)) {
            const auto low = lesser(lesser(ax, bx), cx), high = greater(greater(ax, bx), cx);
            return lesser(greater(rounded(foot), low), high);
        };
        alignas(64) T distances2[lanes], x[lanes], y[lanes], z[lanes];
        hn::Store(rounded(feet.distance2()), s, distances2);
        hn::Store(clamped_axis(exact.x, a.x, b.x, c.x), s, x);
        hn::Store(clamped_axis(exact.y, a.y, b.y, c.y), s, y);
        hn::Store(clamped_axis(exact.z, a.z, b.z, c.z), s, z);
        const unsigned scaled = std::is_same_v<T, float> ? 0 : bits_of(d, scaled_of(a, b, c, p));
        for (int i = 0; i < count_; ++i) {
            const PrimitiveId id = blocks_[places_[i] / 8].id[places_[i] % 8];
            if ((scaled >> i & 1) == 0)
                answers_[i].take(id, distances2[i], {x[i], y[i], z[i]});
            else
                take_scaled(i, id);
        }
        count_ = 0;
    }

private:
    using Doubles = hn::CappedTag<double, 8>;
    static constexpr Doubles d{};
    using Scalars = hn::Rebind<T, Doubles>;
    static constexpr Scalars s{};
    static constexpr int lanes = static_cast<int>(hn::MaxLanes(d));

    HWY_INLINE Coordinates<Scalars> corner(int first_row, int step) const {
        const auto row = [&](int axis) __attribute__((always_inline)) {
            const T* const all = rows_[first_row + step * axis];
            return count_ == 1 ? hn::Set(s, *all) : hn::Load(s, all);
        };
        return {row(0), row(1), row(2)};
    }
    static HWY_INLINE Coordinates<Doubles> promoted(const Coordinates<Scalars>& v) {
        if constexpr (std::is_same_v<T, double>)
            return v;
        else
            return {hn::PromoteTo(d, v.x), hn::PromoteTo(d, v.y), hn::PromoteTo(d, v.z)};
    }
    static HWY_INLINE hn::Vec<Scalars> rounded(hn::Vec<Doubles> v) {
        if constexpr (std::is_same_v<T, double>)
            return v;
        else
            return hn::DemoteTo(s, v);
    }
    // Where `closest_point` may scale vectors of doubles (detail::safe_scale).
    static HWY_INLINE hn::Mask<Doubles> scaled_of(const Coordinates<Scalars>& a,
                                                  const Coordinates<Scalars>& b,
                                                  const Coordinates<Scalars>& c,
                                                  const Coordinates<Scalars>& p) {
        const Coordinates<Doubles> at = promoted(a), ab = minus(promoted(b), at), ac = minus(promoted(c), at),
                                   ap = minus(promoted(p), at);
        const auto largest = [](const Coordinates<Doubles>& v) __attribute__((always_inline)) {
            return hn::Max(hn::Max(hn::Abs(v.x), hn::Abs(v.y)), hn::Abs(v.z));
        };
        const auto m = hn::Max(hn::Max(largest(ab), largest(ac)), largest(ap));
        return hn::Or(hn::Le(m, hn::Set(d, 0x1p-200)), hn::Ge(m, hn::Set(d, 0x1p200)));
    }
    HWY_NOINLINE void take_scaled(int i, PrimitiveId id) {
        const auto at = [&](int row, int step) {
            return Vec<T, 3>(rows_[row][i], rows_[row + step][i], rows_[row + 2 * step][i]);
        };
        const Foot<T, 3> foot = closest_point(at(9, 1), Triangle<T, 3>{at(0, 3), at(1, 3), at(2, 3)});
        answers_[i].take(id, foot.distance2, foot.point);
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

    const TriangleBlock<T>* blocks_;
    int count_ = 0;
    alignas(64) T rows_[12][lanes] = {};  // corners by axis, as in a block, then p
    std::uint32_t places_[lanes];
    Answer answers_[lanes];
};

}  // namespace hedgerow::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
