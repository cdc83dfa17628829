/// What the kernels of neighbours in cells do (cell_kernels.cpp).
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <tuple>

#include <hedgerow/base/instruction_set.h>
#include "cell_sweep.h"

namespace hedgerow::detail {

/// Which points are listed: of another set all, of the asking points' own all but the asking one, or only
/// those after it.
enum class Listed { all, others, later };

/// A cell whose points' neighbours are listed, and the arrays of the caller for that. Lengths are in units of
/// `1 / scale`.
template <std::floating_point T, int D>
struct CellTask {
    const CellOrder<T, D>*asking, *order;
    std::span<const NearRun<D>> runs;  ///< the points of `order` around the cell
    std::uint32_t first, end;          ///< the points of `asking` in the cell that ask, at most `most_points`
    Vec<double, D> middle;             ///< of the cell
    double scale;
    Listed listed;
    float periods[3] = {};  ///< of axes along which differences are wrapped
    bool wraps = false;     ///< whether there are any
    float certain2,
        possible2;  ///< squared distances: up to the first a point is near, beyond the second it is not
    /// Whether two points between these bounds are near, of which the first asks.
    bool (*is_near)(const void* asker, std::uint32_t i, std::uint32_t j);
    const void* asker;
    float* at[3];       ///< room for all points of the runs and `CellOrder::padding` more, for each axis
    std::uint32_t* id;  ///< as much
    /// The lists, one after the other, ascending: room for as many for each point as the runs have, and for
    /// twice `CellOrder::padding` more. And the length of each.
    static constexpr std::uint32_t most_points = 64;
    std::uint32_t* found;
    std::uint32_t* counts;
};

/// The kernels of an instruction set for points of one kind.
template <std::floating_point T, int D>
struct CellKernelsOf {
    void (*list)(const CellTask<T, D>&);
    /// Writes the squared distances from p to points of an order, as `closest_point` measures them. Writes up
    /// to `CellOrder::padding` more.
    void (*measure)(const CellOrder<T, D>&, const Vec<T, D>& p, const std::uint32_t* points, std::size_t size,
                    T* distances2);
};
struct CellKernels {
    std::tuple<CellKernelsOf<float, 2>, CellKernelsOf<float, 3>, CellKernelsOf<double, 2>,
               CellKernelsOf<double, 3>>
        all;
    /// Writes of some points those whose numbers are at least `least`, and their numbers. Returns how many
    /// these are. Writes up to `CellOrder::padding` more.
    std::size_t (*number)(const PrimitiveId* number_of, const std::uint32_t* points, std::size_t size,
                          PrimitiveId least, std::uint32_t* kept, PrimitiveId* numbers);
    /// Writes for each of some different numbers how many are less. Reads and writes up to
    /// `CellOrder::padding` more. O(n²), in vectors.
    void (*rank)(const std::uint32_t* numbers, std::size_t size, std::uint32_t* ranks);

    template <std::floating_point T, int D>
    const CellKernelsOf<T, D>& of() const {
        return std::get<CellKernelsOf<T, D>>(all);
    }
};

}  // namespace hedgerow::detail

namespace hedgerow {
// Where none are in use, every pair is measured.
template <>
const detail::CellKernels* in_use<detail::CellKernels>();
}  // namespace hedgerow
