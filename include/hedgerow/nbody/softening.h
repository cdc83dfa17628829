/// Softened charges: spread over a ball, so that a force stays finite where two of them pass each other.
///
/// Beyond its reach a softened charge acts as a point, exactly. So expansions stay right, which they would
/// not for Plummer's softening, that reaches everywhere. Lengths are nevertheless stated as Plummer's:
/// charges of all kernels have the same potential, 1/length, in their centers.
#pragma once

#include <cmath>

#include <hedgerow/nbody/potential.h>

namespace hedgerow {

enum class SofteningKernel {
    wendland,  ///< the C² function of Wendland (1995) as density; its reach is 3 lengths
    spline,    ///< the cubic spline of Monaghan and Lattanzio (1985), as in GADGET; 2.8 lengths
};

/// How charges are softened: not at all, if the length is 0. Two charges of unlike lengths act on each other
/// by the greater one, so that both pull alike.
struct Softening {
    SofteningKernel kernel = SofteningKernel::wendland;
    double length = 0;  ///< of charges that have none of their own

    /// How far apart two charges of a length stop being points.
    double reach(double of_length) const {
        return of_length * (kernel == SofteningKernel::wendland ? 3.0 : 2.8);
    }
};

/// A softened charge as a kernel of the distance (as `InverseDistance`); `reach` is greater than 0.
struct SoftenedInverse {
    SofteningKernel kernel;
    double reach;

    KernelShare operator()(double distance2) const {
        if (!(distance2 < reach * reach)) return InverseDistance()(distance2);
        const double u = std::sqrt(distance2) / reach, u2 = u * u;
        double potential, force;
        if (kernel == SofteningKernel::wendland) {
            potential = 3 + u2 * (-7 + u2 * (21 + u * (-28 + u * (15 - 3 * u))));
            force = 14 + u2 * (-84 + u * (140 + u * (-90 + 21 * u)));
        } else if (u < 0.5) {
            potential = 2.8 - u2 * (16.0 / 3 + u2 * (-9.6 + 6.4 * u));
            force = 32.0 / 3 + u2 * (-38.4 + 32 * u);
        } else {
            potential = 3.2 - 1 / (15 * u) - u2 * (32.0 / 3 + u * (-16 + u * (9.6 - 32.0 / 15 * u)));
            force = 64.0 / 3 - 48 * u + u2 * (38.4 - 32.0 / 3 * u) - 1 / (15 * u2 * u);
        }
        return {potential / reach, -force / (reach * reach * reach)};
    }
    /// As that of `InverseDistance`.
    double bend(double distance2) const {
        if (!(distance2 < reach * reach)) return InverseDistance().bend(distance2);
        const double u = std::sqrt(distance2) / reach, reach2 = reach * reach;
        const double change = kernel == SofteningKernel::wendland ? -168 + u * (420 + u * (-360 + 105 * u))
                              : u < 0.5                           ? -76.8 + 96 * u
                                        : -48 / u + 76.8 - 32 * u + 0.2 / (u * u * u * u * u);
        return -change / (reach2 * reach2 * reach);
    }
};

}  // namespace hedgerow
