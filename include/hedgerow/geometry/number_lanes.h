/// Numbers that are four floats or four doubles side by side, and functions that take them in place of one
/// number. What is written with them serves both, and gives each lane the bits that a single number gets.
/// Each lane is a case of its own, unlike those of lanes.h, which are parts of one box or triangle. g++ and
/// clang turn vectors of 16 bytes into the instructions of any processor, so nothing here knows an
/// instruction set.
///
/// Where single numbers branch, lanes need both ways: `if (any(condition))` computes a way if some lane takes
/// it, and `select` or `only` gives it to those lanes.
#pragma once

#include <cmath>
#include <concepts>
#include <cstdint>
#include <limits>
#include <type_traits>

#include <hedgerow/geometry/vec.h>

namespace hedgerow {

template <std::floating_point T>
class NumberLanes;
using FloatLanes = NumberLanes<float>;
using DoubleLanes = NumberLanes<double>;

/// Lanes in registers of 16 bytes: one for floats and masks of these, two for doubles.
template <class T>
struct LaneRegisters {
    static constexpr int count = 4, in_register = 16 / int(sizeof(T)), registers = count / in_register;
    using Register [[gnu::vector_size(16)]] = T;

    Register all[registers];

    static LaneRegisters same(T x) {
        LaneRegisters r;
        for (Register& each : r.all) each = x - Register{};
        return r;
    }
    /// f(k) is lane k.
    template <class F>
    static LaneRegisters each(F f) {
        if constexpr (registers == 1)
            return {{Register{f(0), f(1), f(2), f(3)}}};
        else
            return {{Register{f(0), f(1)}, Register{f(2), f(3)}}};
    }
    T operator[](int k) const { return all[k / in_register][k % in_register]; }
    /// What f makes of the registers of a, and of others.
    template <class F, class A, class... More>
    static LaneRegisters of(F f, const A& a, const More&... more) {
        LaneRegisters r;
        for (int i = 0; i < registers; ++i) r.all[i] = f(a.all[i], more.all[i]...);
        return r;
    }
};

/// A condition of each of four lanes. && and || look at both sides.
template <std::floating_point T>
class LaneMaskOf {
public:
    /// All bits of a lane are set, or none.
    using Bits = LaneRegisters<std::conditional_t<sizeof(T) == 4, std::int32_t, std::int64_t>>;
    using Number = NumberLanes<T>;

    LaneMaskOf() : LaneMaskOf(false) {}
    explicit LaneMaskOf(bool b) : bits_(Bits::same(b ? -1 : 0)) {}
    explicit LaneMaskOf(const Bits& bits) : bits_(bits) {}
    template <class F>
    static LaneMaskOf each(F f) {
        using Lane = std::remove_cvref_t<decltype(Bits()[0])>;
        return LaneMaskOf(Bits::each([&](int k) { return Lane(f(k) ? -1 : 0); }));
    }

    bool operator[](int k) const { return bits_[k] != 0; }
    friend LaneMaskOf operator!(LaneMaskOf a) {
        return LaneMaskOf(Bits::of([](auto x) { return ~x; }, a.bits_));
    }
    friend LaneMaskOf operator&&(LaneMaskOf a, LaneMaskOf b) {
        return LaneMaskOf(Bits::of([](auto x, auto y) { return x & y; }, a.bits_, b.bits_));
    }
    friend LaneMaskOf operator||(LaneMaskOf a, LaneMaskOf b) {
        return LaneMaskOf(Bits::of([](auto x, auto y) { return x | y; }, a.bits_, b.bits_));
    }
    /// Whether a condition holds anywhere.
    friend bool any(LaneMaskOf m) {
        using Halves [[gnu::vector_size(16)]] = std::int64_t;
        auto all = (Halves)m.bits_.all[0];
        for (int i = 1; i < Bits::registers; ++i) all |= (Halves)m.bits_.all[i];
        return (all[0] | all[1]) != 0;
    }
    /// a where the condition holds, else b (or 0).
    friend LaneMaskOf select(LaneMaskOf c, LaneMaskOf a, LaneMaskOf b) { return (c && a) || (!c && b); }
    friend Number select(LaneMaskOf c, Number a, Number b) {
        return Number(Number::Registers::of([](auto m, auto x, auto y) { return m ? x : y; }, c.bits_,
                                            a.registers(), b.registers()));
    }
    friend Number only(LaneMaskOf c, Number a) {
        return Number(Number::Registers::of([](auto m, auto x) { return (decltype(x))(m & (decltype(m))x); },
                                            c.bits_, a.registers()));
    }

private:
    Bits bits_;
};
using LaneMask = LaneMaskOf<float>;

/// Four numbers with the arithmetic of one: a T is that number in all lanes. `lesser` and `greater` return a
/// where one of both is NaN.
template <std::floating_point T>
class NumberLanes {
public:
    using Registers = LaneRegisters<T>;
    using Mask = LaneMaskOf<T>;
    static constexpr int count = Registers::count;

    NumberLanes() : NumberLanes(T(0)) {}
    NumberLanes(T x) : v_(Registers::same(x)) {}  // a number is meant for all lanes
    explicit NumberLanes(const Registers& v) : v_(v) {}
    /// f(k) is lane k.
    template <class F>
    static NumberLanes each(F f) {
        return NumberLanes(Registers::each(f));
    }
    /// Each lane rounded to T.
    template <std::floating_point U>
    explicit NumberLanes(const NumberLanes<U>& other)
        : NumberLanes(each([&](int k) { return rounded_to<T>(other[k]); })) {}

    T operator[](int k) const { return v_[k]; }
    const Registers& registers() const { return v_; }

    friend NumberLanes operator+(NumberLanes a, NumberLanes b) {
        return of([](auto x, auto y) { return x + y; }, a, b);
    }
    friend NumberLanes operator-(NumberLanes a, NumberLanes b) {
        return of([](auto x, auto y) { return x - y; }, a, b);
    }
    friend NumberLanes operator*(NumberLanes a, NumberLanes b) {
        return of([](auto x, auto y) { return x * y; }, a, b);
    }
    friend NumberLanes operator/(NumberLanes a, NumberLanes b) {
        return of([](auto x, auto y) { return x / y; }, a, b);
    }
    friend NumberLanes operator-(NumberLanes a) {
        return of([](auto x) { return -x; }, a);
    }
    NumberLanes& operator+=(NumberLanes b) { return *this = *this + b; }
    NumberLanes& operator*=(NumberLanes b) { return *this = *this * b; }
    friend Mask operator<(NumberLanes a, NumberLanes b) {
        return mask([](auto x, auto y) { return x < y; }, a, b);
    }
    friend Mask operator>(NumberLanes a, NumberLanes b) { return b < a; }
    friend Mask operator<=(NumberLanes a, NumberLanes b) {
        return mask([](auto x, auto y) { return x <= y; }, a, b);
    }
    friend Mask operator>=(NumberLanes a, NumberLanes b) { return b <= a; }
    friend Mask equal(NumberLanes a, NumberLanes b) {
        return mask([](auto x, auto y) { return x == y; }, a, b);
    }

    /// a·b, rounded once.
    friend NumberLanes product(NumberLanes a, NumberLanes b) {
        const auto rounded_product = [](auto x, auto y) {
            auto p = x * y;
            detail::hide(p);
            return p;
        };
        return of(rounded_product, a, b);
    }
    friend NumberLanes lesser(NumberLanes a, NumberLanes b) { return select(b < a, b, a); }
    friend NumberLanes greater(NumberLanes a, NumberLanes b) { return select(a < b, b, a); }
    friend NumberLanes root(NumberLanes a) {
        return each([&](int k) { return std::sqrt(a[k]); });
    }
    friend NumberLanes magnitude(NumberLanes a) {
        return of([](auto x) { return (decltype(x))((Bits)x & ~sign); }, a);
    }
    friend Mask has_minus(NumberLanes a) {
        return mask([](auto x) { return (Bits)x < 0; }, a);
    }
    friend NumberLanes with_sign_of(NumberLanes a, NumberLanes b) {
        return of([](auto x, auto y) { return (decltype(x))(((Bits)x & ~sign) | ((Bits)y & sign)); }, a, b);
    }
    /// The greatest whole number up to a, for |a| below 2³¹; otherwise 0. Zeros have no sign.
    friend NumberLanes floored(NumberLanes a) {
        const NumberLanes known = only(magnitude(a) < T(0x1p31), a);
        const NumberLanes toward_zero =
            each([&](int k) { return static_cast<T>(static_cast<std::int32_t>(known[k])); });
        return toward_zero - only(toward_zero > known, 1);
    }

private:
    using Bits = typename Mask::Bits::Register;
    using Integer = std::conditional_t<sizeof(T) == 4, std::int32_t, std::int64_t>;
    static constexpr Integer sign = std::numeric_limits<Integer>::min();

    template <class F, class... A>
    static NumberLanes of(F f, const A&... a) {
        return NumberLanes(Registers::of(f, a.v_...));
    }
    template <class F, class... A>
    static Mask mask(F f, const A&... a) {
        return Mask(Mask::Bits::of(f, a.v_...));
    }

    Registers v_;
};

template <std::floating_point T>
inline constexpr bool is_number<NumberLanes<T>> = true;

/// How many numbers F has, and number k of them.
template <class F>
inline constexpr int number_count = std::floating_point<F> ? 1 : 4;
template <std::floating_point T>
T lane(T x, int) {
    return x;
}
template <std::floating_point T>
T lane(const NumberLanes<T>& x, int k) {
    return x[k];
}
template <std::floating_point T>
Vec<T, 3> lane(const Vec<NumberLanes<T>, 3>& a, int k) {
    return {a[0][k], a[1][k], a[2][k]};
}
/// What a comparison of two numbers says.
template <class F>
using MaskOf = decltype(F() < F());
/// The type of a single number; and a number of doubles for one of floats.
template <class F>
using NumberOf = decltype(lane(F(), 0));
template <class F>
using WideOf = std::conditional_t<std::is_same_v<F, float>, double, DoubleLanes>;
template <class F>
Vec<WideOf<F>, 3> widened(const Vec<F, 3>& a) {
    using D = WideOf<F>;
    return {D(a[0]), D(a[1]), D(a[2])};
}
template <std::floating_point T>
float in_float(T x) {
    return rounded_to<float>(x);
}
template <std::floating_point T>
FloatLanes in_float(const NumberLanes<T>& x) {
    return FloatLanes(x);
}
template <class D>
auto in_float(const Vec<D, 3>& a) {
    return Vec<decltype(in_float(a[0])), 3>(in_float(a[0]), in_float(a[1]), in_float(a[2]));
}

/// The same of single numbers.
constexpr bool any(bool b) {
    return b;
}
constexpr bool select(bool c, std::same_as<bool> auto a, std::same_as<bool> auto b) {
    return c ? a : b;
}
constexpr float select(bool c, float a, float b) {
    return c ? a : b;
}
constexpr double select(bool c, double a, double b) {
    return c ? a : b;
}
template <std::floating_point T>
constexpr T only(bool c, T a) {
    return c ? a : T(0);
}
template <std::floating_point T>
constexpr bool equal(T a, std::type_identity_t<T> b) {
    return a == b;
}
template <std::floating_point T>
constexpr T lesser(T a, std::type_identity_t<T> b) {
    return b < a ? b : a;
}
template <std::floating_point T>
constexpr T greater(T a, std::type_identity_t<T> b) {
    return a < b ? b : a;
}
template <std::floating_point T>
T root(T x) {
    return std::sqrt(x);
}
template <std::floating_point T>
T magnitude(T x) {
    return std::abs(x);
}
template <std::floating_point T>
bool has_minus(T x) {
    return std::signbit(x);
}
template <std::floating_point T>
T with_sign_of(T x, std::type_identity_t<T> of) {
    return std::copysign(x, of);
}
template <std::floating_point T>
T floored(T x) {
    return std::floor(x);
}

/// The same of vectors, and of both kinds of numbers.
template <class F, int D>
Vec<F, D> select(MaskOf<F> c, const Vec<F, D>& a, const Vec<F, D>& b) {
    return map(a, b, [c](F x, F y) { return select(c, x, y); });
}
template <class F, int D>
Vec<F, D> only(MaskOf<F> c, const Vec<F, D>& a) {
    return map(a, [c](F x) { return only(c, x); });
}
template <class F>
MaskOf<F> equal(const Vec<F, 3>& a, const Vec<F, 3>& b) {
    return equal(a[0], b[0]) && equal(a[1], b[1]) && equal(a[2], b[2]);
}
template <class F>
F clamped(F x, std::type_identity_t<F> low, std::type_identity_t<F> high) {
    return select(x < low, low, select(high < x, high, x));
}
template <std::floating_point T, int D>
NumberLanes<T> max_component(const Vec<NumberLanes<T>, D>& a) {
    NumberLanes<T> m = a[0];
    for (int i = 1; i < D; ++i) m = greater(m, a[i]);
    return m;
}
template <std::floating_point T, int D>
Vec<NumberLanes<T>, D> min(const Vec<NumberLanes<T>, D>& a, const Vec<NumberLanes<T>, D>& b) {
    return map(a, b, [](auto x, auto y) { return lesser(x, y); });
}
template <std::floating_point T, int D>
Vec<NumberLanes<T>, D> max(const Vec<NumberLanes<T>, D>& a, const Vec<NumberLanes<T>, D>& b) {
    return map(a, b, [](auto x, auto y) { return greater(x, y); });
}
template <std::floating_point T, int D>
Vec<NumberLanes<T>, D> abs(const Vec<NumberLanes<T>, D>& a) {
    return map(a, [](auto x) { return magnitude(x); });
}
template <std::floating_point T, int D>
Vec<NumberLanes<T>, D> normalized(const Vec<NumberLanes<T>, D>& a) {
    const NumberLanes<T> l = root(length2(a));
    return select(l > 0, a / l, a);
}

/// The number, or the numbers, that f(k) returns for each; and the vectors.
template <class F, class Of>
F each_lane(const Of& f) {
    if constexpr (number_count<F> == 1)
        return f(0);
    else
        return F::each(f);
}
template <class F, class Of>
Vec<F, 3> each_vector(const Of& f) {
    if constexpr (number_count<F> == 1) {
        return f(0);
    } else {
        const decltype(f(0)) all[] = {f(0), f(1), f(2), f(3)};
        const auto component = [&](int i) { return F::each([&](int k) { return all[k][i]; }); };
        return {component(0), component(1), component(2)};
    }
}

/// A member of four structures side by side: of(k) is the structure of lane k. Members are read one by one
/// where they were written: a load of what several smaller stores have written waits for all of them.
template <class Of, class S, std::floating_point T>
NumberLanes<T> in_lanes(const Of& of, T S::*member) {
    return NumberLanes<T>::each([&](int k) { return of(k).*member; });
}
template <class Of, class S>
LaneMask in_lanes(const Of& of, bool S::*member) {
    return LaneMask::each([&](int k) { return of(k).*member; });
}
template <class Of, class S, std::floating_point T>
Vec<NumberLanes<T>, 3> in_lanes(const Of& of, Vec<T, 3> S::*member) {
    const auto component = [&](int i) {
        return NumberLanes<T>::each([&](int k) { return (of(k).*member)[i]; });
    };
    return {component(0), component(1), component(2)};
}

}  // namespace hedgerow
