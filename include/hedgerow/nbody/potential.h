/// Potentials of charges, and the kernels of the distance that they are sums of.
#pragma once

#include <cmath>
#include <span>
#include <string>
#include <type_traits>

#include <hedgerow/base/error.h>
#include <hedgerow/geometry/vec.h>

namespace hedgerow {

/// A potential Σ q·φ(r) and its gradient. Where charges are masses and φ is 1/r, the acceleration is G times
/// the gradient.
template <std::floating_point T, int D = 3>
struct PotentialAt {
    T potential{};
    Vec<T, D> gradient{};
};

/// Where the potentials of many places are written: a vector of them will do, since T is that of the charges.
template <class T>
using PotentialsFound = std::type_identity_t<std::span<PotentialAt<T>>>;

/// A tidal tensor: the second derivatives of a potential Σ q·φ(r). Where charges are masses, G times these
/// are how fast the acceleration changes from place to place.
struct Tides {
    double xx = 0, yy = 0, zz = 0, xy = 0, xz = 0, yz = 0;

    Tides& operator+=(const Tides& b) {
        xx += b.xx, yy += b.yy, zz += b.zz, xy += b.xy, xz += b.xz, yz += b.yz;
        return *this;
    }
    friend Tides operator+(Tides a, const Tides& b) { return a += b; }
    friend Tides operator*(const Tides& a, double s) {
        return {a.xx * s, a.yy * s, a.zz * s, a.xy * s, a.xz * s, a.yz * s};
    }
};

namespace detail {
/// Throws InputError unless there is one charge for each point.
inline void expect_one_charge_each(std::size_t charges, std::size_t points) {
    if (charges != points)
        throw InputError(std::to_string(charges) + " charges for " + std::to_string(points) +
                         " places: give one each");
}
}  // namespace detail

/// A kernel tells φ(r) and φ'(r)/r of a squared distance above 0: what a unit charge does, and by how much
/// the offset from the charge is multiplied to give the gradient.
struct KernelShare {
    double potential, slope;
};
/// Charges and masses in space.
struct InverseDistance {
    KernelShare operator()(double distance2) const {
        const double potential = 1 / std::sqrt(distance2);
        return {potential, -potential / distance2};
    }
    /// (φ'/r)'/r, by which the product of the offset with itself is multiplied in the tidal tensor; its
    /// diagonal is φ'/r more.
    double bend(double distance2) const { return 3 / (distance2 * distance2 * std::sqrt(distance2)); }
};
/// Charges in the plane, vortices, line masses.
struct MinusLogarithm {
    KernelShare operator()(double distance2) const { return {-std::log(distance2) / 2, -1 / distance2}; }
};

}  // namespace hedgerow
