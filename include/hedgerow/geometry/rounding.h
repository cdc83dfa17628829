/// The basis of the numerics contract: products that are rounded before they are added, exact products, and
/// the guard against a caller's flush-to-zero mode.
#pragma once

#ifdef __FAST_MATH__
#error "hedgerow: -ffast-math (or -Ofast) breaks the numerics contract; build without it"
#endif

#include <algorithm>
#include <cmath>
#include <concepts>
#include <limits>
#include <type_traits>
#include <utility>

#if defined(__SSE2__)
#include <emmintrin.h>
#endif

namespace hedgerow {

namespace detail {
/// Makes the optimiser take x for a number that it knows nothing of. Emits no instruction with g++ or clang
/// on x86-64 and AArch64.
template <class T>
void hide(T& x) {
#if defined(__GNUC__) && (defined(__x86_64__) || defined(__SSE2__))
    asm("" : "+x"(x));
#elif defined(__GNUC__) && defined(__aarch64__)
    asm("" : "+w"(x));
#else
    volatile T hidden = x;
    x = hidden;
#endif
}
}  // namespace detail

/// Returns x as it is, but hides from the optimiser that x is a product, so that no multiply-add is formed
/// with it. (g++ contracts across statements and ignores the pragma against that.)
template <std::floating_point T>
constexpr T rounded(T x) {
    if (!std::is_constant_evaluated()) detail::hide(x);
    return x;
}

/// a·b, rounded once.
template <std::floating_point T>
constexpr T product(T a, T b) {
    return rounded(a * b);
}

/// x rounded to T, which stays rounded when it is widened again. Without it, g++ 12 at -O2 puts two
/// neighbours that go from double to float and back into one register and drops both conversions. Costs no
/// instruction for a single number, and one for two neighbours.
template <std::floating_point T, std::floating_point U>
constexpr T rounded_to(U x) {
    if constexpr (sizeof(T) < sizeof(U))
        return rounded(static_cast<T>(x));
    else
        return x;
}

/// Unit roundoff: 2^-24 for float, 2^-53 for double.
template <std::floating_point T>
inline constexpr T unit_roundoff = std::numeric_limits<T>::epsilon() / 2;

/// The largest magnitude that a coordinate may have: 2^60 for float, 2^480 for double. Up to it, sums of a
/// few products of two such coordinates do not overflow.
template <std::floating_point T>
inline constexpr T largest_coordinate = std::is_same_v<T, float> ? T(0x1p60) : T(0x1p480L);

/// The greatest T that is not above x, and the least T that is not below x.
template <std::floating_point T>
T rounded_down(double x) {
    const T near = rounded_to<T>(x);
    return static_cast<double>(near) > x ? std::nextafter(near, -std::numeric_limits<T>::infinity()) : near;
}
template <std::floating_point T>
T rounded_up(double x) {
    return -rounded_down<T>(-x);
}

/// The least T that is not below a + b. Uses Knuth's error of a sum, which is exact but for overflow.
template <std::floating_point T>
T sum_rounded_up(T a, T b) {
    const T sum = a + b, of_b = sum - a;
    const T error = (a - (sum - of_b)) + (b - of_b);
    return error > 0 ? std::nextafter(sum, std::numeric_limits<T>::infinity()) : sum;
}

/// An unevaluated sum high + low, with |low| <= u·|high|.
template <std::floating_point T>
struct TwoSum {
    T high, low;
};

/// high + low == a·b exactly, short of overflow and underflow (Dekker 1971; Veltkamp's splitting).
template <std::floating_point T>
constexpr TwoSum<T> two_product(T a, T b) {
    constexpr T splitter = std::is_same_v<T, float> ? T(0x1p12 + 1) : T(0x1p27 + 1);
    const auto split = [](T x) {
        const T c = product(splitter, x);
        const T high = c - rounded(c - x);
        return TwoSum<T>{high, x - high};
    };
    const T p = product(a, b);
    const auto [ah, al] = split(a);
    const auto [bh, bl] = split(b);
    const T low = product(al, bl) - (((p - product(ah, bh)) - product(al, bh)) - product(ah, bl));
    return {p, low};
}

/// a·b − c·d with the right sign and a relative error of a few roundings, short of underflow.
template <std::floating_point T>
constexpr T difference_of_products(T a, T b, T c, T d) {
    const auto p = two_product(a, b);
    const auto q = two_product(c, d);
    return (p.high - q.high) + (p.low - q.low);
}

/// A power of two that scales a magnitude m to about 1. Returns 1 where products of four such numbers neither
/// overflow nor underflow anyway.
inline double scale_to_one(double m) {
    if (!(m > 0) || (m > 0x1p-200 && m < 0x1p200)) return 1;
    return std::ldexp(1.0, -std::max(std::ilogb(m), -1000));
}

namespace detail {
#if defined(__SSE2__)
using FloatControl = unsigned;
inline FloatControl float_control() {
    return _mm_getcsr();
}
inline void set_float_control(FloatControl c) {
    _mm_setcsr(c);
}
inline constexpr FloatControl not_ieee = 0xE040;  // flush to zero, denormals are zero, rounding mode
#elif defined(__aarch64__)
using FloatControl = unsigned long;
inline FloatControl float_control() {
    FloatControl c;
    asm volatile("mrs %0, fpcr" : "=r"(c));
    return c;
}
inline void set_float_control(FloatControl c) {
    asm volatile("msr fpcr, %0" ::"r"(c));
}
inline constexpr FloatControl not_ieee = 0x3C00000ul;  // rounding mode, flush to zero, default NaN
#else
using FloatControl = unsigned;
inline FloatControl float_control() {
    return 0;
}
inline void set_float_control(FloatControl) {}
inline constexpr FloatControl not_ieee = 0;
#endif

/// Calls f from a function of its own: the compiler may move arithmetic past a change of the mode, but not a
/// call.
template <class F>
[[gnu::noinline]] decltype(auto) call(F& f) {
    asm volatile("" ::: "memory");
    return f();
}
inline bool is_ieee_mode(FloatControl c) {
    return (c & not_ieee) == 0;
}
}  // namespace detail

/// While it exists, the calling thread computes with round-to-nearest and subnormals on; then its mode of
/// before is restored. Calls of functions that are compiled elsewhere are sure to be in that mode; the
/// compiler may move other arithmetic out of the scope (see in_ieee_mode).
class IeeeMode {
public:
    IeeeMode() : saved_(detail::float_control()) {
        if (!detail::is_ieee_mode(saved_)) detail::set_float_control(saved_ & ~detail::not_ieee);
    }
    ~IeeeMode() {
        if (!detail::is_ieee_mode(saved_)) detail::set_float_control(saved_);
    }
    IeeeMode(const IeeeMode&) = delete;
    IeeeMode& operator=(const IeeeMode&) = delete;

private:
    detail::FloatControl saved_;
};

namespace detail {
template <class F>
[[gnu::noinline]] decltype(auto) run_in_ieee_mode(F& f) {
    const IeeeMode mode;
    return call(f);
}
}  // namespace detail

/// Calls f with round-to-nearest and subnormals on, whatever mode the calling thread is in, and restores that
/// mode afterwards.
template <class F>
decltype(auto) in_ieee_mode(F&& f) {
    if (detail::is_ieee_mode(detail::float_control())) [[likely]]
        return f();
    return detail::run_in_ieee_mode(f);
}

}  // namespace hedgerow
