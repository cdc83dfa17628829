/// The first cell of an orthtree.
#pragma once

#include <cmath>

#include <hedgerow/geometry/cube.h>

namespace hedgerow {

namespace detail {
/// The least power of two that is at least x > 0.
template <std::floating_point T>
T power_of_two_above(T x) {
    int exponent;
    const T fraction = std::frexp(x, &exponent);
    return std::ldexp(T(1), fraction == T(0.5) ? exponent - 1 : exponent);
}
}  // namespace detail

/// A cube around a scene. The planes that halve it are numbers of T, and so are those that halve its
/// orthants, down to what T resolves there. So nothing is rounded when a cell is computed from its parent,
/// and every way to a cell gives the same cell. The width of the cube is a power of two. It is at least 9/8
/// of the scene's width, and at least 2^(7−p) of the largest coordinate, where p is the number of digits of
/// T. The cube's corner is an odd multiple of a small step (2^−12 of the width, if T can). So planes seldom
/// fall on the round coordinates at which models have their vertices: a primitive that touches a plane is on
/// both sides of it.
template <std::floating_point T, int D>
Cube<T, D> root_cube(const Box<T, D>& scene) {
    using limits = std::numeric_limits<T>;
    const T largest = std::max(max_component(abs(scene.low)), max_component(abs(scene.high)));
    const T wanted = std::max({max_component(scene.extent()) * T(1.125),
                               std::ldexp(largest, 7 - limits::digits), limits::denorm_min() * 128});
    const T width = detail::power_of_two_above(wanted);
    const T resolved = std::ldexp(detail::power_of_two_above(largest + width), -limits::digits);
    const T step = std::max({std::ldexp(width, -12), resolved, limits::denorm_min()});
    Cube<T, D> root{{}, width / 2};
    for (int k = 0; k < D; ++k) {
        const T beside = (width - (scene.high[k] - scene.low[k])) / 2;
        T steps = std::floor((scene.low[k] - beside) / step);
        if (std::fmod(steps, T(2)) == 0) steps -= 1;
        root.middle[k] = product(steps, step) + root.half;
    }
    return root;
}

}  // namespace hedgerow
