/// Kernels of forces between particles, with the processor's vectors (src/nbody/), chosen at run time.
#pragma once

#include <array>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <hedgerow/base/instruction_set.h>
#include <hedgerow/nbody/acting_cells.h>
#include <hedgerow/nbody/softening.h>

namespace hedgerow {

/// Charges in rows of coordinates. Rows are readable up to the next multiple of `row_padding`; charges there
/// are 0, and coordinates -`beyond_rows`.
template <class T>
struct ChargeRows {
    const T *x, *y, *z, *charge;
    std::size_t count;
    const T* reach = nullptr;  ///< how far each is softened, if charges are
    /// What the places lack beside these, if they are split in two parts.
    const T *low_x = nullptr, *low_y = nullptr, *low_z = nullptr;
};
inline constexpr std::size_t row_padding = 16;
/// The coordinates of padding behind targets. Padding behind charges has the opposite ones: the two are not
/// in one place, nor where charges and targets are.
inline constexpr double beyond_rows = 64;
/// Targets that are none of the charges.
inline constexpr std::size_t no_self = static_cast<std::size_t>(-1);
/// Places at which charges act, in rows that are readable up to the next multiple of `row_padding` (where
/// coordinates are `beyond_rows`), and what they do there: potentials and gradients, to which is added.
template <class T>
struct TargetRows {
    const T *x, *y, *z;
    std::size_t count;
    double *potential, *gx, *gy, *gz;
    const T* reach = nullptr;
    const T *low_x = nullptr, *low_y = nullptr, *low_z = nullptr;
    /// How much the roundings of pairs may have done, to which is added: `rounding_of_pairs` times the root
    /// of this is about the rms error of the gradient. Up to four targets share what they do together. Not
    /// finite where a source is too near for T.
    double* squares = nullptr;
    /// The number of the source that the first target is, if the targets are sources that follow each other.
    std::size_t self = no_self;
};
/// Places of unit size whose first parts are multiples of 2⁻¹¹, and the rest, err by as much as pairs at this
/// distance by their arithmetic.
inline constexpr double split_distance = 0x1p-13;
template <class T>
inline constexpr double rounding_of_pairs = sizeof(T) == 4 ? 0x1p-23 : 0x1p-52;

/// Adds the potentials Σ q/r and their gradients, of all sources at all targets but of none at itself;
/// softened by the kernel, if there are reaches, by the greater of a pair. Coordinates are about 1 or less.
/// The error of a pair is at most 2⁻²¹ of it, in double 2⁻⁴² (softened: 2⁻¹⁸ and 2⁻⁴⁰); sums are kept in T
/// for at most 1,024 sources. A source too near for T, or in the place of a target, makes sums and squares
/// that are not finite; `direct_exact` knows charges in one place: bare ones do nothing, softened ones act.
template <class T>
using DirectKernel = void (*)(const ChargeRows<T>&, const TargetRows<T>&, SofteningKernel);

template <class T>
struct FmmCells;
/// A cell of charges that acts, itself or an image of it in a periodic cube.
class FmmSource {
public:
    static constexpr std::uint32_t most_cells = 1u << 25;

    constexpr FmmSource(std::uint32_t cell, std::uint32_t image) : code_(image * most_cells + cell) {}
    constexpr std::uint32_t cell() const { return code_ % most_cells; }
    constexpr std::uint32_t image() const { return code_ / most_cells; }
    /// Another cell of the same image.
    constexpr FmmSource with(std::uint32_t other) const { return {other, image()}; }
    friend constexpr auto operator<=>(FmmSource, FmmSource) = default;

private:
    std::uint32_t code_;
};
/// A target's walk that any thread may go on with: the cells that are undecided against it, and its local
/// expansion.
template <class T>
struct FmmTask {
    std::uint32_t cell;
    std::vector<FmmSource> undecided;
    std::vector<T> local;
};
struct CellThatActs {
    FmmSource cell;
    ActsBy by;
};
/// The fast multipole method of one order (src/nbody/fmm-inl.h).
template <class T>
struct FmmKernel {
    int order;
    std::size_t multipole_stride;
    /// Computes centers, radii and multipoles of cells `first` to `end`, once those of their children are
    /// there.
    void (*upward)(FmmCells<T>&, std::uint32_t first, std::uint32_t end);
    /// Walks down to targets' cells of at most `most` of them, and appends a task for each.
    void (*walk_above)(const FmmCells<T>& sources, FmmCells<T>& targets, std::uint32_t most,
                       std::vector<FmmTask<T>>& tasks);
    /// Finishes a task: finds potentials and gradients at all targets of its cell.
    void (*walk_below)(const FmmCells<T>& sources, FmmCells<T>& targets, const FmmTask<T>&);
    /// The method of Barnes and Hut for the targets of leaves `first` to `end`, each leaf's together.
    void (*walk_groups)(const FmmCells<T>& sources, FmmCells<T>& targets, std::uint32_t first,
                        std::uint32_t end, double opening_angle, bool by_multipoles);
    /// Appends the cells that act on the target in a place of the rows.
    void (*acting)(const FmmCells<T>& sources, FmmCells<T>& targets, std::uint32_t place,
                   std::vector<CellThatActs>&);
};
/// Adds the multipole of charges of an order, or the potentials and gradients of a local expansion of an
/// order, at most `most_order_at_run_time`. Numbers of harmonics are packed: of each degree n the real part
/// of m = 0, then both parts of m = 1 to n. Rows of what is found may be written as far as they are readable.
using AddMultipole = void (*)(const ChargeRows<double>&, int order, double* multipole);
using AddLocal = void (*)(const double* local, int order, const TargetRows<double>&);
inline constexpr int most_order_at_run_time = 20;

/// Those of ascending orders.
using FmmFloatKernels = std::array<FmmKernel<float>, 4>;
using FmmDoubleKernels = std::array<FmmKernel<double>, 2>;

struct NbodyKernels {
    DirectKernel<float> direct_float;
    DirectKernel<double> direct_double, direct_exact;
    AddMultipole add_multipole;
    AddLocal add_local;
};

// Where none are in use, plain code answers.
template <>
const NbodyKernels* in_use<NbodyKernels>();
template <>
const FmmFloatKernels* in_use<FmmFloatKernels>();
template <>
const FmmDoubleKernels* in_use<FmmDoubleKernels>();

/// The kernels of the fast multipole method that are in use.
struct FmmKernels {
    const FmmFloatKernels* of_float = in_use<FmmFloatKernels>();
    const FmmDoubleKernels* of_double = in_use<FmmDoubleKernels>();

    explicit operator bool() const { return of_float != nullptr && of_double != nullptr; }
};

}  // namespace hedgerow
