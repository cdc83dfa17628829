/// Tools for tests of geometry: arithmetic that is wider than the library's, and shapes with integer
/// coordinates.
#pragma once

#include <gtest/gtest.h>

#include <cmath>

#include <hedgerow/geometry/box.h>
#include <hedgerow/scenes/random.h>

namespace hedgerow::exact {

__extension__ using Int = __int128;

/// Vectors of long double, whose arithmetic uses no code of the library.
using Real = long double;
struct Real3 {
    Real x, y, z;
};
inline Real3 operator+(Real3 a, Real3 b) {
    return {a.x + b.x, a.y + b.y, a.z + b.z};
}
inline Real3 operator*(Real3 a, Real s) {
    return {a.x * s, a.y * s, a.z * s};
}
inline Real3 operator-(Real3 a, Real3 b) {
    return a + b * -1;
}
inline Real dot(Real3 a, Real3 b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
inline Real3 cross(Real3 a, Real3 b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline Real size(Real3 a) {
    return std::sqrt(dot(a, a));
}
template <class T, int D>
inline Real3 real(const Vec<T, D>& v) {
    return {v[0], v[1], D == 3 ? v[D - 1] : T(0)};
}

inline int integer(Random& random, int reach) {
    return static_cast<int>(random.bits() % static_cast<std::uint64_t>(2 * reach + 1)) - reach;
}
/// A vector of random integers, |x| <= reach, times 2^exponent.
template <class T, int D>
Vec<T, D> integers(Random& random, int reach, int exponent = 0) {
    return map(Vec<T, D>(), [&](T) { return std::ldexp(T(integer(random, reach)), exponent); });
}
template <class T, int D>
Vec<T, D> in_ball(Random& random, double radius) {
    return Vec<T, D>(random.direction<D>() * (radius * random.uniform()));
}
template <class T, int D>
Box<T, D> box_of(const Vec<T, D>& a, const Vec<T, D>& b) {
    return Box<T, D>().expand(a).expand(b);
}

}  // namespace hedgerow::exact
