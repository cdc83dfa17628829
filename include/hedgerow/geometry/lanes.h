/// Four numbers side by side. This is the only file with vector intrinsics: SSE2, which every x86-64
/// processor has, for float and double; NEON, which every AArch64 processor has, for float. Elsewhere plain
/// loops give the same results.
#pragma once

#include <bit>
#include <cstdint>
#include <cstring>
#include <type_traits>

#include <hedgerow/geometry/vec.h>

#if defined(__aarch64__)
#include <arm_neon.h>
#endif

namespace hedgerow {

template <std::floating_point T>
using BitsOf = std::conditional_t<sizeof(T) == 4, std::uint32_t, std::uint64_t>;

/// Elementwise arithmetic on four T. `min` and `max` return the second operand when either is NaN.
template <std::floating_point T>
struct Lanes {
    T lane[4];

    static Lanes all(T x) { return {{x, x, x, x}}; }
    static Lanes halves(T low, T high) { return {{low, low, high, high}}; }
    static Lanes load(const T* p) { return {{p[0], p[1], p[2], p[3]}}; }
    /// The components, then zeros.
    template <int D>
    static Lanes of(const Vec<T, D>& a) {
        return {{a[0], a[1], D == 3 ? a[D - 1] : T(0), T(0)}};
    }
    /// (p[0], p[1], q[0], q[1])
    static Lanes load_pairs(const T* p, const T* q) { return {{p[0], p[1], q[0], q[1]}}; }
    void store(T* p) const {
        for (int i = 0; i < 4; ++i) p[i] = lane[i];
    }
    template <class F>
    static Lanes each(F f) {
        return {{f(0), f(1), f(2), f(3)}};
    }
    friend Lanes operator+(Lanes a, Lanes b) {
        return each([&](int i) { return a.lane[i] + b.lane[i]; });
    }
    friend Lanes operator-(Lanes a, Lanes b) {
        return each([&](int i) { return a.lane[i] - b.lane[i]; });
    }
    friend Lanes operator*(Lanes a, Lanes b) {
        return each([&](int i) { return product(a.lane[i], b.lane[i]); });
    }
    friend Lanes min(Lanes a, Lanes b) {
        return each([&](int i) { return a.lane[i] < b.lane[i] ? a.lane[i] : b.lane[i]; });
    }
    friend Lanes max(Lanes a, Lanes b) {
        return each([&](int i) { return a.lane[i] > b.lane[i] ? a.lane[i] : b.lane[i]; });
    }
    friend Lanes operator/(Lanes a, Lanes b) {
        return each([&](int i) { return a.lane[i] / b.lane[i]; });
    }
    friend Lanes abs(Lanes a) {
        return each([&](int i) { return std::abs(a.lane[i]); });
    }
    /// |a| with the sign of b.
    friend Lanes copysign(Lanes a, Lanes b) {
        return each([&](int i) { return std::copysign(a.lane[i], b.lane[i]); });
    }
    /// −0 and subnormal lanes become +0; NaN stays.
    Lanes normal_or_zero() const {
        return each(
            [&](int i) { return std::abs(lane[i]) < std::numeric_limits<T>::min() ? T(0) : lane[i]; });
    }
    /// Lanes 2, 3, 0, 1.
    Lanes halves_swapped() const { return {{lane[2], lane[3], lane[0], lane[1]}}; }
    /// Lanes 1, 2, 0: each lane gets the value of a triangle's next corner. The fourth lane is of no use.
    Lanes next_corner() const { return {{lane[1], lane[2], lane[0], lane[3]}}; }
    /// Lanes 2, 0, 1: each lane gets the value of a triangle's previous corner. The fourth lane is of no use.
    Lanes previous_corner() const { return {{lane[2], lane[0], lane[1], lane[3]}}; }
    /// Bit i is set if lane i is < 0 (`negative`) or > 0 (`positive`); −0 and NaN give 0.
    unsigned negative() const {
        return each_bit([&](int i) { return lane[i] < T(0); });
    }
    unsigned positive() const {
        return each_bit([&](int i) { return lane[i] > T(0); });
    }
    friend unsigned less_equal(Lanes a, Lanes b) {
        return each_bit([&](int i) { return a.lane[i] <= b.lane[i]; });
    }

private:
    template <class F>
    static unsigned each_bit(F f) {
        unsigned bits = 0;
        for (int i = 0; i < 4; ++i) bits |= static_cast<unsigned>(f(i)) << i;
        return bits;
    }
};

#if defined(__SSE2__)
template <>
struct Lanes<float> {
    __m128 v;

    static Lanes all(float x) { return {_mm_set1_ps(x)}; }
    static Lanes halves(float low, float high) {
        return {_mm_shuffle_ps(_mm_set_ss(low), _mm_set_ss(high), 0)};
    }
    static Lanes load(const float* p) { return {_mm_loadu_ps(p)}; }
    template <int D>
    static Lanes of(const Vec<float, D>& a) {
        return {_mm_setr_ps(a[0], a[1], D == 3 ? a[D - 1] : 0.0f, 0.0f)};
    }
    static Lanes load_pairs(const float* p, const float* q) {
        double low, high;  // two floats each, moved as eight bytes
        std::memcpy(&low, p, 8);
        std::memcpy(&high, q, 8);
        return {_mm_castpd_ps(_mm_set_pd(high, low))};
    }
    void store(float* p) const { _mm_storeu_ps(p, v); }
    friend Lanes operator+(Lanes a, Lanes b) { return {_mm_add_ps(a.v, b.v)}; }
    friend Lanes operator-(Lanes a, Lanes b) { return {_mm_sub_ps(a.v, b.v)}; }
    friend Lanes operator*(Lanes a, Lanes b) {
        __m128 p = _mm_mul_ps(a.v, b.v);
        asm("" : "+x"(p));  // rounded before a sum, so no multiply-add is formed
        return {p};
    }
    friend Lanes min(Lanes a, Lanes b) { return {_mm_min_ps(a.v, b.v)}; }
    friend Lanes max(Lanes a, Lanes b) { return {_mm_max_ps(a.v, b.v)}; }
    friend Lanes operator/(Lanes a, Lanes b) { return {_mm_div_ps(a.v, b.v)}; }
    friend Lanes abs(Lanes a) { return {_mm_andnot_ps(_mm_set1_ps(-0.0f), a.v)}; }
    friend Lanes copysign(Lanes a, Lanes b) {
        const __m128 sign = _mm_set1_ps(-0.0f);
        return {_mm_or_ps(_mm_andnot_ps(sign, a.v), _mm_and_ps(sign, b.v))};
    }
    Lanes normal_or_zero() const {
        const __m128 least = _mm_set1_ps(std::numeric_limits<float>::min());
        return {_mm_andnot_ps(_mm_cmplt_ps(abs(*this).v, least), v)};
    }
    Lanes halves_swapped() const { return {_mm_shuffle_ps(v, v, _MM_SHUFFLE(1, 0, 3, 2))}; }
    Lanes next_corner() const { return {_mm_shuffle_ps(v, v, _MM_SHUFFLE(3, 0, 2, 1))}; }
    Lanes previous_corner() const { return {_mm_shuffle_ps(v, v, _MM_SHUFFLE(3, 1, 0, 2))}; }
    unsigned negative() const { return bits(_mm_cmplt_ps(v, _mm_setzero_ps())); }
    unsigned positive() const { return bits(_mm_cmpgt_ps(v, _mm_setzero_ps())); }
    friend unsigned less_equal(Lanes a, Lanes b) { return bits(_mm_cmple_ps(a.v, b.v)); }

private:
    static unsigned bits(__m128 mask) { return static_cast<unsigned>(_mm_movemask_ps(mask)); }
};
/// Two SSE2 registers of two doubles each.
template <>
struct Lanes<double> {
    __m128d low, high;

    static Lanes all(double x) { return {_mm_set1_pd(x), _mm_set1_pd(x)}; }
    static Lanes halves(double low, double high) { return {_mm_set1_pd(low), _mm_set1_pd(high)}; }
    static Lanes load(const double* p) { return load_pairs(p, p + 2); }
    template <int D>
    static Lanes of(const Vec<double, D>& a) {
        return {_mm_setr_pd(a[0], a[1]), D == 3 ? _mm_set_sd(a[D - 1]) : _mm_setzero_pd()};
    }
    static Lanes load_pairs(const double* p, const double* q) { return {_mm_loadu_pd(p), _mm_loadu_pd(q)}; }
    void store(double* p) const {
        _mm_storeu_pd(p, low);
        _mm_storeu_pd(p + 2, high);
    }
    friend Lanes operator+(Lanes a, Lanes b) {
        return {_mm_add_pd(a.low, b.low), _mm_add_pd(a.high, b.high)};
    }
    friend Lanes operator-(Lanes a, Lanes b) {
        return {_mm_sub_pd(a.low, b.low), _mm_sub_pd(a.high, b.high)};
    }
    friend Lanes operator*(Lanes a, Lanes b) {
        __m128d p = _mm_mul_pd(a.low, b.low), q = _mm_mul_pd(a.high, b.high);
        asm("" : "+x"(p), "+x"(q));  // rounded before a sum, so no multiply-add is formed
        return {p, q};
    }
    friend Lanes min(Lanes a, Lanes b) { return {_mm_min_pd(a.low, b.low), _mm_min_pd(a.high, b.high)}; }
    friend Lanes max(Lanes a, Lanes b) { return {_mm_max_pd(a.low, b.low), _mm_max_pd(a.high, b.high)}; }
    friend Lanes operator/(Lanes a, Lanes b) {
        return {_mm_div_pd(a.low, b.low), _mm_div_pd(a.high, b.high)};
    }
    friend Lanes abs(Lanes a) {
        const __m128d sign = _mm_set1_pd(-0.0);
        return {_mm_andnot_pd(sign, a.low), _mm_andnot_pd(sign, a.high)};
    }
    friend Lanes copysign(Lanes a, Lanes b) {
        const __m128d sign = _mm_set1_pd(-0.0);
        const Lanes value = abs(a);
        return {_mm_or_pd(value.low, _mm_and_pd(sign, b.low)),
                _mm_or_pd(value.high, _mm_and_pd(sign, b.high))};
    }
    Lanes normal_or_zero() const {
        const __m128d least = _mm_set1_pd(std::numeric_limits<double>::min());
        const Lanes value = abs(*this);
        return {_mm_andnot_pd(_mm_cmplt_pd(value.low, least), low),
                _mm_andnot_pd(_mm_cmplt_pd(value.high, least), high)};
    }
    Lanes halves_swapped() const { return {high, low}; }
    Lanes next_corner() const { return {_mm_shuffle_pd(low, high, 1), _mm_shuffle_pd(low, high, 2)}; }
    Lanes previous_corner() const { return {_mm_shuffle_pd(high, low, 0), _mm_shuffle_pd(low, high, 3)}; }
    unsigned negative() const { return less(*this, all(0)); }
    unsigned positive() const { return less(all(0), *this); }
    friend unsigned less_equal(Lanes a, Lanes b) {
        return bits(_mm_cmple_pd(a.low, b.low), _mm_cmple_pd(a.high, b.high));
    }

private:
    static unsigned less(Lanes a, Lanes b) {
        return bits(_mm_cmplt_pd(a.low, b.low), _mm_cmplt_pd(a.high, b.high));
    }
    static unsigned bits(__m128d low, __m128d high) {
        return static_cast<unsigned>(_mm_movemask_pd(low) | _mm_movemask_pd(high) << 2);
    }
};
#elif defined(__aarch64__)
template <>
struct Lanes<float> {
    float32x4_t v;

    static Lanes all(float x) { return {vdupq_n_f32(x)}; }
    static Lanes halves(float low, float high) { return {vcombine_f32(vdup_n_f32(low), vdup_n_f32(high))}; }
    static Lanes load(const float* p) { return {vld1q_f32(p)}; }
    template <int D>
    static Lanes of(const Vec<float, D>& a) {
        return {float32x4_t{a[0], a[1], D == 3 ? a[D - 1] : 0.0f, 0.0f}};
    }
    static Lanes load_pairs(const float* p, const float* q) {
        return {vcombine_f32(vld1_f32(p), vld1_f32(q))};
    }
    void store(float* p) const { vst1q_f32(p, v); }
    friend Lanes operator+(Lanes a, Lanes b) { return {vaddq_f32(a.v, b.v)}; }
    friend Lanes operator-(Lanes a, Lanes b) { return {vsubq_f32(a.v, b.v)}; }
    friend Lanes operator*(Lanes a, Lanes b) {
        float32x4_t p = vmulq_f32(a.v, b.v);
        asm("" : "+w"(p));
        return {p};
    }
    friend Lanes min(Lanes a, Lanes b) { return {vbslq_f32(vcltq_f32(a.v, b.v), a.v, b.v)}; }
    friend Lanes max(Lanes a, Lanes b) { return {vbslq_f32(vcgtq_f32(a.v, b.v), a.v, b.v)}; }
    friend Lanes operator/(Lanes a, Lanes b) { return {vdivq_f32(a.v, b.v)}; }
    friend Lanes abs(Lanes a) { return {vabsq_f32(a.v)}; }
    friend Lanes copysign(Lanes a, Lanes b) { return {vbslq_f32(vdupq_n_u32(0x80000000u), b.v, a.v)}; }
    Lanes normal_or_zero() const {
        const uint32x4_t tiny = vcltq_f32(vabsq_f32(v), vdupq_n_f32(std::numeric_limits<float>::min()));
        return {vbslq_f32(tiny, vdupq_n_f32(0), v)};
    }
    Lanes halves_swapped() const { return {vextq_f32(v, v, 2)}; }
    Lanes next_corner() const { return permuted(1, 2, 0, 3); }
    Lanes previous_corner() const { return permuted(2, 0, 1, 3); }
    unsigned negative() const { return bits(vcltzq_f32(v)); }
    unsigned positive() const { return bits(vcgtzq_f32(v)); }
    friend unsigned less_equal(Lanes a, Lanes b) { return bits(vcleq_f32(a.v, b.v)); }

private:
    Lanes permuted(int a, int b, int c, int d) const {
        float l[4];
        store(l);
        const float r[4] = {l[a], l[b], l[c], l[d]};
        return load(r);
    }
    static unsigned bits(uint32x4_t mask) {
        const uint32x4_t weight = {1, 2, 4, 8};
        return vaddvq_u32(vandq_u32(mask, weight));
    }
};
#endif

/// Stores an integer in a lane as the bits of an ordinary floating-point value. Arithmetic runs over that
/// lane too, although its result is not used. The bits of a small integer itself would be a subnormal value,
/// on which an operation takes processors a hundred cycles and more: the binned SAH builder took twice as
/// long. (Floats from 2^30 on are not ordinary values either; that only costs time.)
template <std::floating_point T>
T number_as_lane(std::uint32_t number) {
    return std::bit_cast<T>(static_cast<BitsOf<T>>(number + std::bit_cast<BitsOf<T>>(T(1))));
}
/// The integer that number_as_lane stored.
template <std::floating_point T>
std::uint32_t number_of_lane(T lane) {
    return static_cast<std::uint32_t>(std::bit_cast<BitsOf<T>>(lane) - std::bit_cast<BitsOf<T>>(T(1)));
}

/// a·b, each lane rounded once, as by the operator.
template <std::floating_point T>
Lanes<T> product(Lanes<T> a, Lanes<T> b) {
    return a * b;
}
/// The first D lanes.
template <int D, std::floating_point T>
Vec<T, D> first(Lanes<T> a) {
    T l[4];
    a.store(l);
    Vec<T, D> v;
    for (int i = 0; i < D; ++i) v[i] = l[i];
    return v;
}
/// The largest lane.
template <std::floating_point T>
T greatest(Lanes<T> a) {
    T l[4];
    a.store(l);
    const T x = l[0] < l[1] ? l[1] : l[0], y = l[2] < l[3] ? l[3] : l[2];
    return x < y ? y : x;
}

}  // namespace hedgerow
