/// The cells of an octree of charges in rows, as the kernels of the fast multipole method read them.
#pragma once

#include <cstdint>
#include <vector>

#include <hedgerow/base/bare_vector.h>
#include <hedgerow/geometry/vec.h>
#include <hedgerow/nbody/kernels.h>

#include "tides.h"

namespace hedgerow {

/// Cells are numbered by level, from the root, and the children of a cell lie side by side. Charges are in
/// the order of the leaves. Expansions are about the center of charge (by |q|), in units of the cell's
/// `scale`, a power of two near its radius. Rows have `row_padding` numbers more than there are cells or
/// charges, so that vectors may be read beyond the last ones.
template <class T>
struct FmmCells {
    // Of each charge: its place, its offset from its leaf's center, its charge, and how far it is softened,
    // if charges are.
    BareVector<double> x, y, z;
    BareVector<T> dx, dy, dz, charge, soft;
    SofteningKernel softening = SofteningKernel::wendland;
    bool pairs_in_float = false;  ///< pairs are summed in float, of places in two parts, where T is double
    /// What roundings of pairs may do at a target: so much of its gradient, or so many of the errors that a
    /// conversion may make in its leaf, if that is more.
    double share_of_gradient = 5e-5, share_of_tolerance = 0;
    // Of each cell: its charges, its children (none: a leaf), ...
    std::vector<std::uint32_t> first, count, child, children;
    // ... its center, the radius around its charges, the effective radius of its multipole (how far it
    // reaches) and of its charges as targets (how far they spread), Σ |q|, the unit of its expansions, the
    // greatest reach of a softened charge, and the error that a conversion may make in it.
    std::vector<double> cx, cy, cz;
    std::vector<T> radius, reach, spread, weight, scale, softest, tolerance;
    std::vector<std::uint32_t> levels;  ///< the first cell of each level, and the number of cells
    BareVector<T> multipoles;           ///< packed numbers of each cell, `multipole_stride` apart
    std::size_t multipole_stride = 0;
    // In a periodic cube its side, its middle, and where its near images are; else nothing, and the cells
    // themselves.
    double side = 0;
    Vec3d middle;
    std::vector<Vec3d> images{Vec3d()};
    // What is found, by charge.
    BareVector<double> potential, gx, gy, gz;
    BareVector<double> tides;  ///< if they are wanted: six rows (`TideRows`)
    detail::TideRows tide_rows() { return {tides.data(), potential.size()}; }

    std::size_t size() const { return first.size(); }
    bool is_leaf(std::size_t c) const { return children[c] == 0; }
    /// A cell as a source, where it is itself.
    FmmSource itself(std::uint32_t c) const { return {c, static_cast<std::uint32_t>(images.size() / 2)}; }
};

}  // namespace hedgerow
