/// Forces by the fast multipole method: tolerances, the walk of targets, and errors that are measured where
/// gradients turn out to be less than estimated (docs/design/046-near-pairs.md).
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <vector>

#include <hedgerow/nbody/direct_sum.h>
#include <hedgerow/nbody/forces.h>
#include <hedgerow/nbody/kernels.h>

#include "far_images.h"
#include "plan.h"
#include "sorted_charges.h"
#include "tolerances.h"

namespace hedgerow::detail {

/// How many times as large errors add up to be where charges lie on surfaces and lines. Neighbouring cells
/// are alike there, so what their multipoles lack does not cancel. Measured on shells, plane lattices and
/// helices.
inline constexpr double errors_on_surfaces = 3;

/// Between 1 and that, by how many parts of a divided cell hold charges: nearly eight in space, four on
/// surfaces, two on lines.
template <class Tree>
double errors_by_shape(const Tree& tree) {
    const std::size_t divided = (tree.node_count() - 1) / Tree::width;
    if (divided == 0) return 1;
    std::size_t parts = 0;
    for (std::uint32_t i = 0; i < divided; ++i) {
        const OrthantNode* const children = tree.children(OrthantNode::inner_over(i, 0));
        for (unsigned k = 0; k < Tree::width; ++k) parts += !children[k].empty();
    }
    const double mean = static_cast<double>(parts) / static_cast<double>(divided);
    return 1 + (errors_on_surfaces - 1) * std::clamp(7 - mean, 0.0, 1.0);
}

/// Returns what a tolerance is of the gradient that it was set by.
template <class R, class T>
double set_tolerances(const Sorted<R, T>& sources, Sorted<R, T>& at, const ForceOptions& options,
                      const Plan& plan, int order_of_multipoles, const Units& units, Executor& executor) {
    const int order = order_of_multipoles + 1;  // of the errors
    const bool in_double = plan.precision != Precision::single;
    const double counts = plan.error_per_bound * errors_by_shape(sources.tree) *
                          (sources.cells.side == 0 ? 1
                           : in_double             ? errors_in_cube_of_double
                                                   : errors_in_cube);
    at.cells.share_of_gradient = share_of_pairs * options.accuracy;
    at.cells.share_of_tolerance = share_of_pairs * counts;
    const double share = options.accuracy / counts;
    set_tolerances(at.cells, share, order, executor, [&](std::uint32_t leaf) {
        if (options.sizes.empty()) {
            const Spot spot = spot_of(at.cells, leaf);
            const Strength strength = strength_at(sources.cells, spot);
            if (strength.varies || is_uneven(at.cells, leaf))
                return set_leaf(sources.cells, at.cells, leaf, order, [&](std::size_t i) {
                    const Vec3d place(at.cells.x[i], at.cells.y[i], at.cells.z[i]);
                    return strength_at(sources.cells, {place, 0, spot.softest}).least;
                });
            return set_leaf(sources.cells, at.cells, leaf, order,
                            [&](std::size_t) { return strength.least; });
        }
        set_leaf(sources.cells, at.cells, leaf, order,
                 [&](std::size_t i) { return options.sizes[at.tree.items()[i]] / units.gradient(); });
    });
    return share;
}
/// Adds what the far images in a periodic cube do.
template <class R>
void add_far_images(const FmmCells<R>& sources, FmmCells<R>& at, double accuracy, Executor& executor) {
    const std::size_t charges = sources.x.size() - row_padding, targets = at.potential.size();
    const FarImages images(sources.side, sources.middle, far_order(accuracy),
                           {sources.x.data(), sources.y.data(), sources.z.data(), charges},
                           sources.charge.data(), executor);
    images.act({at.x.data(), at.y.data(), at.z.data(), targets, at.potential.data(), at.gx.data(),
                at.gy.data(), at.gz.data()},
               executor);
    if (!at.tides.empty())
        images.bend({at.x.data(), at.y.data(), at.z.data(), targets}, at.tide_rows(), executor);
}
/// Finds forces at targets, or at the charges themselves. Returns what set_tolerances does.
template <class R, class T>
double act(const Sorted<R, T>& sources, Sorted<R, T>& at, std::span<PotentialAt<T>> found, const Plan& plan,
           const ForceOptions& options, const FmmKernel<R>& kernel, const Units& units, Executor& executor) {
    const double share = set_tolerances(sources, at, options, plan, kernel.order, units, executor);
    FmmCells<R>& cells = at.cells;
    cells.tides.resize(6 * options.tides.size());
    // Down: each target's walk.
    const std::size_t n = found.size();
    executor.expect(n);
    std::vector<FmmTask<R>> tasks;
    kernel.walk_above(sources.cells, cells, static_cast<std::uint32_t>(n / 128 + 1), tasks);
    executor.for_each_piece(tasks.size(), 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i)
            kernel.walk_below(sources.cells, cells, tasks[i]), executor.advance(cells.count[tasks[i].cell]);
    });
    if (sources.cells.side > 0) add_far_images(sources.cells, cells, options.accuracy, executor);
    hand_out(at, units, found, executor);
    hand_out(at, units, options.tides, executor);
    return share;
}
/// The targets where gradients are less than half of what tolerances were set by: errors may be beyond the
/// accuracy there. `share` is what `act` returned.
template <class R, class T>
std::vector<std::size_t> less_than_estimated(const Sorted<R, T>& sources, const Sorted<R, T>& at,
                                             double share) {
    const FmmCells<R>& cells = at.cells;
    std::vector<std::size_t> less;
    for (std::uint32_t leaf = 0; leaf < cells.size(); ++leaf) {
        if (!cells.is_leaf(leaf)) continue;
        const double size = static_cast<double>(cells.tolerance[leaf]) / share;
        if (size < 1.01 * least_size(sources.cells, cells, leaf)) continue;
        for (std::size_t i = cells.first[leaf]; i < cells.first[leaf] + cells.count[leaf]; ++i)
            if (length(Vec3d(cells.gx[i], cells.gy[i], cells.gz[i])) < size / 2)
                less.push_back(at.tree.items()[i]);
    }
    return less;
}
/// Some of the targets.
template <class T>
struct FewTargets {
    std::vector<Vec<T, 3>> places;
    std::vector<T> lengths, charges;

    FewTargets(const Targets<T>& all, const std::vector<std::size_t>& some) {
        for (const std::size_t i : some) {
            places.push_back(all.places[i]);
            if (!all.lengths.empty()) lengths.push_back(all.lengths[i]);
            if (!all.charges.empty()) charges.push_back(all.charges[i]);
        }
    }
    Targets<T> view() const { return {places, lengths, charges}; }
};
/// Whether gradients at a few of some targets, summed over all pairs, show that the accuracy is kept. Errors
/// are shares of the gradient, or of `least` if that is more.
template <class T>
bool are_accurate(const Charges<T>& charges, const Targets<T>& targets, const std::vector<std::size_t>& some,
                  std::span<const PotentialAt<T>> found, double least, double accuracy, Executor& executor) {
    const std::size_t most = charges.period > 0 ? 16 : 64, step = (some.size() + most - 1) / most;
    std::vector<std::size_t> few;
    for (std::size_t k = 0; k < some.size(); k += step) few.push_back(some[k]);
    const FewTargets<T> at(targets, few);
    std::vector<PotentialAt<T>> want(few.size());
    direct_sum(charges, at.view(), std::span(want), {.threads = executor});
    double squares = 0;
    for (std::size_t k = 0; k < few.size(); ++k) {
        const Vec3d gradient(want[k].gradient);
        const double error =
            length(Vec3d(found[few[k]].gradient) - gradient) / std::max(length(gradient), least);
        squares += error * error;
    }
    return squares <= accuracy * accuracy / 4 * static_cast<double>(few.size());
}
/// Whether the precision of R suffices; else nothing is done. Gradients may be much less than is estimated,
/// as they are within a shell. Errors there are measured, and if they are too large, forces are found anew,
/// by tolerances of what was found: those of targets there; or those between all charges, so that they add up
/// to nothing.
template <class R, class T>
bool multipole_forces(const Charges<T>& charges, const RepeatingCube& cube, const Targets<T>* others,
                      std::span<PotentialAt<T>> found, const Plan& plan, const ForceOptions& options,
                      const FmmKernel<R>& kernel, const Extremes<T>& extremes, Executor& executor) {
    const Units units(extremes);
    Sorted<R, T> sources(charges, cube, units, plan.leaf_size, kernel, executor);
    if (!sources.precise_enough()) return false;
    sources.cells.pairs_in_float = plan.precision == Precision::mixed;
    const Targets<T> targets =
        others != nullptr ? *others : Targets<T>(charges.places, charges.lengths, charges.charges);
    const auto act_at = [&](const Targets<T>& some, std::span<PotentialAt<T>> here, const ForceOptions& how) {
        const auto act_on = [&](Sorted<R, T>& at) {
            const double share = act(sources, at, here, plan, how, kernel, units, executor);
            return how.sizes.empty() ? less_than_estimated(sources, at, share) : std::vector<std::size_t>();
        };
        if (others == nullptr) return act_on(sources);
        Sorted<R, T> at(some, charges, units, plan.leaf_size, kernel, executor);
        return act_on(at);
    };
    // Nothing acts on sources that are no targets.
    if (others != nullptr)
        std::fill(sources.cells.tolerance.begin(), sources.cells.tolerance.end(),
                  std::numeric_limits<R>::infinity());
    const std::vector<std::size_t> less = act_at(targets, found, options);
    const std::size_t few = others == nullptr ? found.size() / 1000 : 0;
    const double least = units.gradient() * least_size(sources.cells, sources.cells, 0);
    ForceOptions how = options;
    constexpr int most_rounds = 8;
    for (int round = 0; round < most_rounds && less.size() > few &&
                        !are_accurate<T>(charges, targets, less, found, least, options.accuracy, executor);
         ++round) {
        if (round > 0) how.accuracy /= 2;
        std::vector<double> sizes;
        const auto add_size = [&](const PotentialAt<T>& at) { sizes.push_back(length(Vec3d(at.gradient))); };
        if (others == nullptr) {
            for (const PotentialAt<T>& at : found) add_size(at);
            how.sizes = sizes;
            act_at(targets, found, how);
            continue;
        }
        for (const std::size_t i : less) add_size(found[i]);
        std::vector<PotentialAt<T>> here(less.size());
        std::vector<Tides> tides(options.tides.empty() ? 0 : less.size());
        how.sizes = sizes, how.tides = tides;
        act_at(FewTargets<T>(targets, less).view(), here, how);
        for (std::size_t k = 0; k < less.size(); ++k) {
            found[less[k]] = here[k];
            if (!tides.empty()) options.tides[less[k]] = tides[k];
        }
    }
    if (others != nullptr)
        for (std::size_t i = 0; i < found.size(); ++i)
            found[i].potential -= static_cast<T>(own_potential(targets, charges.softening, i));
    return true;
}

}  // namespace hedgerow::detail
