/// Axis-aligned boxes: closed, possibly flat. The empty box has low = +infinity and high = −infinity.
#pragma once

#include <hedgerow/geometry/vec.h>

namespace hedgerow {

template <std::floating_point T, int D>
struct Box {
    using Scalar = T;
    static constexpr int dimension = D;

    Vec<T, D> low = Vec<T, D>::all(std::numeric_limits<T>::infinity());
    Vec<T, D> high = Vec<T, D>::all(-std::numeric_limits<T>::infinity());

    constexpr bool empty() const {
        for (int i = 0; i < D; ++i)
            if (!(low[i] <= high[i])) return true;
        return false;
    }
    constexpr Box& expand(const Vec<T, D>& p) {
        low = min(low, p);
        high = max(high, p);
        return *this;
    }
    constexpr Box& expand(const Box& b) {
        low = min(low, b.low);
        high = max(high, b.high);
        return *this;
    }
    constexpr Vec<T, D> extent() const { return high - low; }
    constexpr Vec<T, D> center() const { return low * T(0.5) + high * T(0.5); }
    constexpr bool contains(const Vec<T, D>& p) const {
        for (int i = 0; i < D; ++i)
            if (!(low[i] <= p[i] && p[i] <= high[i])) return false;
        return true;
    }
    constexpr bool contains(const Box& b) const {
        for (int i = 0; i < D; ++i)
            if (!(low[i] <= b.low[i] && b.high[i] <= high[i])) return false;
        return true;
    }
    /// Half the surface area (3D) or half the perimeter (2D), the SAH's measure of a box; 0 for an empty box.
    constexpr T half_area() const {
        if (empty()) return T(0);
        const Vec<T, D> e = extent();
        if constexpr (D == 2)
            return e[0] + e[1];
        else
            return product(e[0] + e[1], e[2]) + product(e[0], e[1]);
    }
    friend constexpr bool operator==(const Box&, const Box&) = default;
};

using Box2f = Box<float, 2>;
using Box2d = Box<double, 2>;
using Box3f = Box<float, 3>;
using Box3d = Box<double, 3>;

template <class T, int D>
constexpr Box<T, D> merged(Box<T, D> a, const Box<T, D>& b) {
    return a.expand(b);
}
template <class T, int D>
constexpr Box<T, D> intersection(const Box<T, D>& a, const Box<T, D>& b) {
    Box<T, D> r;
    r.low = max(a.low, b.low);
    r.high = min(a.high, b.high);
    return r;
}

}  // namespace hedgerow
