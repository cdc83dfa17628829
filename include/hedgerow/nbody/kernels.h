/// Kernels of forces between particles, with the processor's vectors (src/nbody/), chosen at run time.
#pragma once

#include <cstddef>

#include <hedgerow/base/instruction_set.h>

namespace hedgerow {

/// Charges in rows of coordinates. Rows are readable up to the next multiple of `row_padding`; charges there
/// are 0, and coordinates numbers.
template <class T>
struct ChargeRows {
    const T *x, *y, *z, *charge;
    std::size_t count;
};
inline constexpr std::size_t row_padding = 16;
/// Places at which charges act, in rows that are readable up to the next multiple of `row_padding`, and what
/// they do there: potentials and gradients, to which is added.
template <class T>
struct TargetRows {
    const T *x, *y, *z;
    std::size_t count;
    double *potential, *gx, *gy, *gz;
};

/// Adds the potentials Σ q/r and their gradients, of all sources at all targets. Sources whose squared
/// distance is below `coincident2` do nothing. Coordinates are about 1 or less, so that no power of a
/// distance overflows. The error of a pair is at most 2⁻²¹ of it, in double 2⁻⁴²; sums are kept in T for at
/// most 1,024 sources.
template <class T>
using DirectKernel = void (*)(const ChargeRows<T>&, const TargetRows<T>&);
template <class T>
inline constexpr T coincident2 = sizeof(T) == 4 ? T(0x1p-80) : T(0x1p-640);

/// The kernels of one instruction set.
struct NbodyKernels {
    DirectKernel<float> direct_float;
    DirectKernel<double> direct_double;
};
/// The kernels in use, or nullptr where plain code answers.
const NbodyKernels* nbody_kernels();

}  // namespace hedgerow
