/// Vectors of three coordinates in lanes.
#if defined(HEDGEROW_ENGINE_COORDINATES_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef HEDGEROW_ENGINE_COORDINATES_INL_H
#undef HEDGEROW_ENGINE_COORDINATES_INL_H
#else
#define HEDGEROW_ENGINE_COORDINATES_INL_H
#endif

#include <hwy/highway.h>

#include <hedgerow/geometry/vec.h>

HWY_BEFORE_NAMESPACE();
namespace hedgerow::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

// A vector in each lane. The axes have names, since g++ keeps arrays of vectors in memory.
template <class F>
struct Coordinates {
    using V = hn::Vec<F>;
    V x, y, z;
};

template <class F, class T>
HWY_INLINE Coordinates<F> all_lanes(F f, const Vec<T, 3>& p) {
    return {hn::Set(f, p[0]), hn::Set(f, p[1]), hn::Set(f, p[2])};
}
template <class F>
HWY_INLINE Coordinates<F> plus(const Coordinates<F>& a, const Coordinates<F>& b) {
    return {hn::Add(a.x, b.x), hn::Add(a.y, b.y), hn::Add(a.z, b.z)};
}
template <class F>
HWY_INLINE Coordinates<F> minus(const Coordinates<F>& a, const Coordinates<F>& b) {
    return {hn::Sub(a.x, b.x), hn::Sub(a.y, b.y), hn::Sub(a.z, b.z)};
}
template <class F>
HWY_INLINE Coordinates<F> least(const Coordinates<F>& a, const Coordinates<F>& b) {
    return {hn::Min(a.x, b.x), hn::Min(a.y, b.y), hn::Min(a.z, b.z)};
}
template <class F>
HWY_INLINE Coordinates<F> greatest(const Coordinates<F>& a, const Coordinates<F>& b) {
    return {hn::Max(a.x, b.x), hn::Max(a.y, b.y), hn::Max(a.z, b.z)};
}
template <class F>
HWY_INLINE Coordinates<F> chosen(hn::Mask<F> where, const Coordinates<F>& yes, const Coordinates<F>& no) {
    return {hn::IfThenElse(where, yes.x, no.x), hn::IfThenElse(where, yes.y, no.y),
            hn::IfThenElse(where, yes.z, no.z)};
}

// Each operation rounded by itself, in the order of geometry/vec.h.
template <class F, class V>
HWY_INLINE Coordinates<F> times(const Coordinates<F>& a, V s) {
    return {hn::Mul(a.x, s), hn::Mul(a.y, s), hn::Mul(a.z, s)};
}
template <class F>
HWY_INLINE hn::Vec<F> product(const Coordinates<F>& a, const Coordinates<F>& b) {
    return hn::Add(hn::Add(hn::Mul(a.x, b.x), hn::Mul(a.y, b.y)), hn::Mul(a.z, b.z));
}

// Fused where the processor can, for bounds.
template <class F, class V>
HWY_INLINE Coordinates<F> minus(const Coordinates<F>& a, V s, const Coordinates<F>& b) {
    return {hn::NegMulAdd(s, b.x, a.x), hn::NegMulAdd(s, b.y, a.y), hn::NegMulAdd(s, b.z, a.z)};
}
template <class F>
HWY_INLINE hn::Vec<F> dot(const Coordinates<F>& a, const Coordinates<F>& b) {
    return hn::MulAdd(a.z, b.z, hn::MulAdd(a.y, b.y, hn::Mul(a.x, b.x)));
}

}  // namespace hedgerow::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
