/// Numbers that provoke rounding errors: a few units in the last place apart, powers of two, multiples of
/// 0.1, huge, tiny, cancelling, equal.
#pragma once

#include <cmath>
#include <limits>

#include <hedgerow/geometry/box.h>
#include <hedgerow/scenes/random.h>

namespace hedgerow::nasty {

/// The number `steps` units in the last place away from x.
template <class T>
T nudged(T x, int steps) {
    for (; steps > 0; --steps) x = std::nextafter(x, std::numeric_limits<T>::infinity());
    for (; steps < 0; ++steps) x = std::nextafter(x, -std::numeric_limits<T>::infinity());
    return x;
}

/// Draws numbers of one kind. Kinds are mixed by drawing from several. No expression draws twice, so that the
/// numbers are the same whatever the order of evaluation.
template <class T>
class Numbers {
public:
    enum class Kind { noise, integers, powers, decimals, uniform, wide };
    static constexpr int kinds = 6;

    Numbers(Kind kind, Random& random) : kind_(kind), random_(random) {
        for (T& b : base_) b = uniform();
    }
    static Numbers any(Random& random) { return {static_cast<Kind>(random.bits() % kinds), random}; }

    T operator()() {
        switch (kind_) {
            case Kind::noise: {  // one of four numbers, 0 to 3 units in the last place up
                const T base = base_[below(4)];
                return nudged(base, static_cast<int>(below(4)));
            }
            case Kind::integers:
                return T(static_cast<int>(below(9)) - 4);
            case Kind::powers: {
                const T sign = below(2) == 0 ? T(-1) : T(1);
                return std::ldexp(sign, static_cast<int>(below(41)) - 20);
            }
            case Kind::decimals: {
                const T decimal = T(0.1) * T(static_cast<int>(below(21)) - 10);
                return nudged(decimal, static_cast<int>(below(3)) - 1);
            }
            case Kind::uniform:
                return uniform();
            case Kind::wide: {
                const T x = uniform();
                return std::ldexp(x, static_cast<int>(below(2 * reach + 1)) - reach);
            }
        }
        return T(0);
    }
    template <int D>
    Vec<T, D> vec() {
        Vec<T, D> v;
        for (int k = 0; k < D; ++k) v[k] = (*this)();
        return v;
    }

private:
    /// The largest exponent of `wide`, within the library's bounds on coordinates.
    static constexpr int reach = std::is_same_v<T, float> ? 59 : 479;

    std::uint64_t below(std::uint64_t n) { return random_.bits() % n; }
    T uniform() { return static_cast<T>(2 * random_.uniform() - 1); }

    Kind kind_;
    Random& random_;
    T base_[4];
};

}  // namespace hedgerow::nasty
