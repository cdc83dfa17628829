/// Fixed-size vectors: data and elementwise arithmetic only. A product that is then added goes through
/// `product`, so that no compiler fuses multiplication and addition, and every build gives the same bits.
#pragma once

#include <array>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <limits>

#include <hedgerow/geometry/rounding.h>

namespace hedgerow {

/// What components may be: float, double, and whatever else is computed with like these (number_lanes.h).
template <class T>
inline constexpr bool is_number = std::floating_point<T>;
template <class T>
concept VecNumber = is_number<T>;

/// A point or direction with D components of type T (float or double). D is 2 or 3, or 1 on a line, where
/// only points exist.
template <VecNumber T, int D>
struct Vec {
    using Scalar = T;
    static constexpr int dimension = D;

    T data[D] = {};

    constexpr Vec() = default;
    constexpr explicit Vec(T x) requires(D == 1) : data{x} {}
    constexpr Vec(T x, T y) requires(D == 2) : data{x, y} {}
    constexpr Vec(T x, T y, T z) requires(D == 3) : data{x, y, z} {}
    template <std::floating_point U>
    constexpr explicit Vec(const Vec<U, D>& other) {
        for (int i = 0; i < D; ++i) data[i] = rounded_to<T>(other[i]);
    }

    /// The vector whose components are all `value`.
    static constexpr Vec all(T value) {
        Vec v;
        for (int i = 0; i < D; ++i) v[i] = value;
        return v;
    }

    constexpr T operator[](int i) const { return data[i]; }
    constexpr T& operator[](int i) { return data[i]; }
    constexpr T x() const { return data[0]; }
    constexpr T y() const { return data[1]; }
    constexpr T z() const requires(D == 3) { return data[2]; }

    friend constexpr bool operator==(const Vec&, const Vec&) = default;
    friend constexpr Vec& operator+=(Vec& a, const Vec& b) { return a = a + b; }
    friend constexpr Vec& operator-=(Vec& a, const Vec& b) { return a = a - b; }
    friend constexpr Vec& operator*=(Vec& a, T s) { return a = a * s; }
    friend constexpr Vec& operator/=(Vec& a, T s) { return a = a / s; }
};

using Vec2f = Vec<float, 2>;
using Vec2d = Vec<double, 2>;
using Vec3f = Vec<float, 3>;
using Vec3d = Vec<double, 3>;

/// Applies f to each component (or pair of components). Written without loops: at -O2, g++ 12 keeps the
/// loops, and with them the vectors in memory.
template <class T, int D, class F>
constexpr Vec<T, D> map(const Vec<T, D>& a, F f) {
    if constexpr (D == 1) return Vec<T, D>(f(a[0]));
    if constexpr (D == 2) return {f(a[0]), f(a[1])};
    if constexpr (D == 3) return {f(a[0]), f(a[1]), f(a[2])};
}
template <class T, int D, class F>
constexpr Vec<T, D> map(const Vec<T, D>& a, const Vec<T, D>& b, F f) {
    if constexpr (D == 1) return Vec<T, D>(f(a[0], b[0]));
    if constexpr (D == 2) return {f(a[0], b[0]), f(a[1], b[1])};
    if constexpr (D == 3) return {f(a[0], b[0]), f(a[1], b[1]), f(a[2], b[2])};
}

template <class T, int D>
constexpr Vec<T, D> operator+(const Vec<T, D>& a, const Vec<T, D>& b) {
    return map(a, b, [](T x, T y) { return x + y; });
}
template <class T, int D>
constexpr Vec<T, D> operator-(const Vec<T, D>& a, const Vec<T, D>& b) {
    return map(a, b, [](T x, T y) { return x - y; });
}
template <class T, int D>
constexpr Vec<T, D> operator-(const Vec<T, D>& a) {
    return map(a, [](T x) { return -x; });
}
template <class T, int D>
constexpr Vec<T, D> operator*(const Vec<T, D>& a, T s) {
    return map(a, [s](T x) { return product(x, s); });
}
template <class T, int D>
constexpr Vec<T, D> operator*(T s, const Vec<T, D>& a) {
    return a * s;
}
template <class T, int D>
constexpr Vec<T, D> operator/(const Vec<T, D>& a, T s) {
    return map(a, [s](T x) { return x / s; });
}
template <class T, int D>
constexpr Vec<T, D> min(const Vec<T, D>& a, const Vec<T, D>& b) {
    return map(a, b, [](T x, T y) { return y < x ? y : x; });
}
template <class T, int D>
constexpr Vec<T, D> max(const Vec<T, D>& a, const Vec<T, D>& b) {
    return map(a, b, [](T x, T y) { return x < y ? y : x; });
}
template <class T, int D>
constexpr Vec<T, D> abs(const Vec<T, D>& a) {
    return map(a, [](T x) { return x < 0 ? -x : x + T(0); });
}

/// Sum of products in the order of the axes.
template <class T, int D>
constexpr T dot(const Vec<T, D>& a, const Vec<T, D>& b) {
    T sum = product(a[0], b[0]);
    for (int i = 1; i < D; ++i) sum += product(a[i], b[i]);
    return sum;
}
template <class T>
constexpr Vec<T, 3> cross(const Vec<T, 3>& a, const Vec<T, 3>& b) {
    return {product(a[1], b[2]) - product(a[2], b[1]), product(a[2], b[0]) - product(a[0], b[2]),
            product(a[0], b[1]) - product(a[1], b[0])};
}
template <class T, int D>
constexpr T length2(const Vec<T, D>& a) {
    return dot(a, a);
}
template <class T, int D>
T length(const Vec<T, D>& a) {
    return std::sqrt(length2(a));
}
/// a / |a|; a vector of length 0 is returned as it is.
template <class T, int D>
Vec<T, D> normalized(const Vec<T, D>& a) {
    const T l = length(a);
    return l > 0 ? a / l : a;
}
template <class T, int D>
constexpr bool finite(const Vec<T, D>& a) {
    for (int i = 0; i < D; ++i)
        if (!(a[i] - a[i] == 0)) return false;
    return true;
}
/// Largest component.
template <class T, int D>
constexpr T max_component(const Vec<T, D>& a) {
    T m = a[0];
    for (int i = 1; i < D; ++i) m = m < a[i] ? a[i] : m;
    return m;
}
/// Axis of the component of largest magnitude; the first of equals.
template <class T, int D>
constexpr int max_axis(const Vec<T, D>& a) {
    const Vec<T, D> m = abs(a);
    int axis = m[1] > m[0];
    if constexpr (D == 3) axis = m[2] > (m[1] > m[0] ? m[1] : m[0]) ? 2 : axis;
    return axis;
}

}  // namespace hedgerow
