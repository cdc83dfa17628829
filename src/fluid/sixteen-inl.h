/// Sixteen floats side by side in as many vectors as that takes, with the same bits for vectors of any
/// length.
#if defined(HEDGEROW_FLUID_SIXTEEN_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef HEDGEROW_FLUID_SIXTEEN_INL_H
#undef HEDGEROW_FLUID_SIXTEEN_INL_H
#else
#define HEDGEROW_FLUID_SIXTEEN_INL_H
#endif

#include <cstddef>
#include <cstdint>

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace hedgerow::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

// Four numbers: those of a vector whose halves are added to each other until four are left.
template <class D>
HWY_INLINE auto folded(D d, hn::Vec<D> v) {
    if constexpr (hn::MaxLanes(d) <= 4) {
        return v;
    } else {
        constexpr hn::Half<D> half;
        return folded(half, hn::Add(hn::LowerHalf(half, v), hn::UpperHalf(half, v)));
    }
}

struct Sixteen {
    using Tag = hn::CappedTag<float, 16>;
    using Signed = hn::RebindToSigned<Tag>;
    using Unsigned = hn::RebindToUnsigned<Tag>;
    static constexpr std::size_t lanes = hn::MaxLanes(Tag()), parts = 16 / lanes;

    hn::Vec<Tag> part[parts];

    HWY_INLINE Sixteen() : Sixteen(0.0f) {}
    static HWY_INLINE Sixteen all(float x) { return Sixteen(x); }
    friend HWY_INLINE Sixteen operator+(Sixteen a, const Sixteen& b) {
        for (std::size_t p = 0; p < parts; ++p) a.part[p] = hn::Add(a.part[p], b.part[p]);
        return a;
    }
    friend HWY_INLINE Sixteen operator-(Sixteen a, const Sixteen& b) {
        for (std::size_t p = 0; p < parts; ++p) a.part[p] = hn::Sub(a.part[p], b.part[p]);
        return a;
    }
    friend HWY_INLINE Sixteen operator*(Sixteen a, const Sixteen& b) {
        for (std::size_t p = 0; p < parts; ++p) a.part[p] = hn::Mul(a.part[p], b.part[p]);
        return a;
    }
    friend HWY_INLINE Sixteen operator/(Sixteen a, const Sixteen& b) {
        for (std::size_t p = 0; p < parts; ++p) a.part[p] = hn::Div(a.part[p], b.part[p]);
        return a;
    }
    friend HWY_INLINE Sixteen larger(Sixteen a, const Sixteen& b) {
        for (std::size_t p = 0; p < parts; ++p) a.part[p] = hn::Max(a.part[p], b.part[p]);
        return a;
    }
    friend HWY_INLINE Sixteen root(Sixteen a) {
        for (std::size_t p = 0; p < parts; ++p) a.part[p] = hn::Sqrt(a.part[p]);
        return a;
    }
    // Adds number k to number k + 8, then k to k + 4, k + 2 and k + 1.
    HWY_INLINE float sum() const {
        constexpr hn::CappedTag<float, 4> four;
        constexpr hn::Half<decltype(four)> two;
        hn::Vec<Tag> half[parts];
        for (std::size_t p = 0; p < parts; ++p) half[p] = part[p];
        for (std::size_t n = parts / 2; n > 0; n /= 2)
            for (std::size_t p = 0; p < n; ++p) half[p] = hn::Add(half[p], half[p + n]);
        const auto quarter = folded(Tag(), half[0]);
        const auto pair = hn::Add(hn::LowerHalf(two, quarter), hn::UpperHalf(two, quarter));
        alignas(16) float rest[4];
        hn::StoreU(pair, two, rest);
        return rest[0] + rest[1];
    }

private:
    explicit HWY_INLINE Sixteen(float x) {
        for (std::size_t p = 0; p < parts; ++p) part[p] = hn::Set(Tag(), x);
    }
};

// The numbers of up to sixteen neighbours; others are 0.
struct SixteenIds {
    hn::Vec<Sixteen::Signed> part[Sixteen::parts];
    std::size_t count;

    HWY_INLINE SixteenIds(const std::uint32_t* from, std::size_t left) : count(left) {
        constexpr Sixteen::Signed s;
        for (std::size_t p = 0; p < Sixteen::parts; ++p)
            part[p] = hn::IfThenElseZero(
                first(s, p), hn::LoadU(s, reinterpret_cast<const std::int32_t*>(from) + p * Sixteen::lanes));
    }
    // What stands for neighbours, and another number for the others.
    HWY_INLINE Sixteen or_else(Sixteen a, float other) const {
        constexpr Sixteen::Tag f;
        for (std::size_t p = 0; p < Sixteen::parts; ++p)
            a.part[p] = hn::IfThenElse(first(f, p), a.part[p], hn::Set(f, other));
        return a;
    }

private:
    template <class D>
    HWY_INLINE hn::Mask<D> first(D d, std::size_t p) const {
        const std::size_t before = p * Sixteen::lanes;
        return hn::FirstN(d, count > before ? HWY_MIN(count - before, Sixteen::lanes) : 0);
    }
};

HWY_INLINE Sixteen gathered(const float* from, const SixteenIds& ids) {
    Sixteen all;
    for (std::size_t p = 0; p < Sixteen::parts; ++p)
        all.part[p] = hn::GatherIndex(Sixteen::Tag(), from, ids.part[p]);
    return all;
}
// One number less each of some, modulo 2^32, as signed numbers.
HWY_INLINE Sixteen differences(std::uint32_t one, const std::uint32_t* from, const SixteenIds& ids) {
    constexpr Sixteen::Signed s;
    constexpr Sixteen::Unsigned u;
    Sixteen all;
    for (std::size_t p = 0; p < Sixteen::parts; ++p) {
        const auto theirs =
            hn::BitCast(u, hn::GatherIndex(s, reinterpret_cast<const std::int32_t*>(from), ids.part[p]));
        all.part[p] = hn::ConvertTo(Sixteen::Tag(), hn::BitCast(s, hn::Sub(hn::Set(u, one), theirs)));
    }
    return all;
}

}  // namespace hedgerow::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
