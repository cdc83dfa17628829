/// The method of Barnes and Hut in vectors: a walk for each leaf of targets.
#include <hedgerow/nbody/barnes_hut.h>

#include "sorted_charges.h"

namespace hedgerow {
namespace {

constexpr std::uint32_t group = 48;
constexpr std::size_t least_charges = 500;  // fewer are summed directly

/// Whether the precision of R suffices; else nothing is done.
template <class R, class T>
bool by_groups(const Charges<T>& charges, std::span<PotentialAt<T>> found, const BarnesHutOptions& options,
               const FmmKernel<R>& kernel, const detail::Units& units, Executor& executor) {
    detail::Sorted<R, T> sorted(charges, detail::RepeatingCube(charges), units, group, kernel, executor);
    if (!sorted.precise_enough()) return false;
    FmmCells<R>& cells = sorted.cells;
    executor.for_each_piece(cells.size(), 64, [&](std::size_t begin, std::size_t end) {
        kernel.walk_groups(cells, cells, static_cast<std::uint32_t>(begin), static_cast<std::uint32_t>(end),
                           options.opening_angle, options.quadrupoles);
        executor.look();
    });
    detail::hand_out(sorted, units, found, executor);
    return true;
}

/// Without kernels: a walk for each target.
template <class T>
void one_by_one(const Charges<T>& charges, std::span<PotentialAt<T>> found, double opening_angle,
                Executor& executor) {
    const Index<PointOrthtree<T, 3>, PointCloudView<T, 3>> index(PointCloudView<T, 3>(charges.places), {},
                                                                 executor);
    std::vector<double> all(charges.charges.size());
    for (std::size_t i = 0; i < all.size(); ++i) all[i] = static_cast<double>(charges.charges[i]);
    const BarnesHut method(index, all, opening_angle);
    executor.for_each_piece(found.size(), 64, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const PotentialAt<double> at = method(charges.places[i]);
            found[i] = {static_cast<T>(at.potential), Vec<T, 3>(at.gradient)};
        }
    });
}

}  // namespace

template <std::floating_point T>
void barnes_hut(const Charges<T>& charges, PotentialsFound<T> found, const BarnesHutOptions& options) {
    if (!(options.opening_angle > 0 && options.opening_angle < 1))
        throw UsageError("an opening angle of " + std::to_string(options.opening_angle) +
                         " is not above 0 and below 1");
    if (charges.period > 0)
        throw UsageError("this method of Barnes and Hut does not know periodic cubes: use forces");
    detail::expect_room(found.size(), charges.places.size());
    const detail::Extremes<T> extremes(charges);  // throws for bad numbers
    const FmmKernels kernels;
    if (found.size() < least_charges || (!kernels && detail::softened(charges)))
        return direct_sum(charges, found, {.threads = options.threads});
    Executor& executor = options.threads.over(found.size());
    in_ieee_mode([&] {
        IeeeExecutor ieee(executor);
        if (!kernels)
            one_by_one(charges, found, options.opening_angle, ieee);
        else if (const detail::Units units(extremes);
                 !by_groups(charges, found, options, kernels.of_float->front(), units, ieee))
            by_groups(charges, found, options, kernels.of_double->front(), units, ieee);
    });
}

template void barnes_hut(const Charges<float>&, std::span<PotentialAt<float>>, const BarnesHutOptions&);
template void barnes_hut(const Charges<double>&, std::span<PotentialAt<double>>, const BarnesHutOptions&);

}  // namespace hedgerow
