/// Forces within a stated error: the plan, the cells, and the steps of the fast multipole method over them.
#include <hedgerow/nbody/acting_cells.h>
#include <hedgerow/nbody/forces.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include <hedgerow/index.h>
#include <hedgerow/nbody/force_check.h>
#include <hedgerow/nbody/kernels.h>
#include <hedgerow/nbody/plain_fmm.h>
#include <hedgerow/primitives/point_cloud.h>
#include <hedgerow/structures/orthtree/point_orthtree.h>

#include "far_images.h"
#include "sorted_charges.h"
#include "tolerances.h"

namespace hedgerow {
namespace {

/// What is computed in float: all; pairs alone, of places in two parts; or nothing.
enum class Precision { single, mixed, twofold };
/// How an accuracy is reached: the order of multipoles, the precision, at most what the rms error of the
/// gradients is to the bound that each conversion keeps where charges fill space, how long leaves are, so
/// that pairs and conversions take about as long, and below how many charges a direct sum is faster. Errors
/// were measured on a cube, a lattice, Plummer's and Hernquist's spheres, a disc, two unlike clusters, and
/// charges that cancel.
struct Plan {
    double least_accuracy;
    int order;
    Precision precision;
    double error_per_bound;
    std::uint32_t leaf_size;
    std::size_t least_charges;
};
constexpr Plan plans[] = {
    {3e-3, 3, Precision::single, 0.85, 80, 1000},   {2e-4, 4, Precision::single, 1.0, 80, 1500},
    {1e-5, 6, Precision::single, 0.75, 80, 2500},   {1e-6, 8, Precision::mixed, 1.0, 80, 6000},
    {3e-7, 11, Precision::mixed, 0.4, 80, 8000},    {1e-8, 11, Precision::twofold, 0.4, 80, 8000},
    {1e-9, 11, Precision::twofold, 0.8, 80, 12000},
};
/// Targets that are fewer are summed directly, since the charges' cells take longer.
constexpr std::size_t least_targets = 256;
/// So few charges of a periodic cube are summed directly, and so few where expansions are in double.
constexpr std::size_t least_charges_in_cube = 32, least_charges_in_cube_of_double = 256;
constexpr double most_accuracy = 0.1;
/// In a periodic cube gradients are small sums of large parts, whose errors count so many times, and so do
/// roundings of sums in float; and cubes of even charge have a moment of degree 4, which the lowest order
/// lacks in all images alike.
constexpr double errors_in_cube = 2.6, errors_in_cube_of_double = 3, least_in_cube = 2e-3,
                 least_for_floats_in_cube = 2e-6;

/// Gradients in float are rounded by some 3e-8.
constexpr double least_accuracy_of_float = 1e-7;
/// What roundings of pairs may do, as a share of the error that is asked for.
constexpr double share_of_pairs = 0.5;

const Plan& plan_for(double accuracy, bool periodic) {
    const Plan& finest = plans[std::size(plans) - 1];
    if (!(accuracy >= finest.least_accuracy && accuracy <= most_accuracy)) {
        char given[32];
        std::snprintf(given, sizeof given, "%g", accuracy);
        throw UsageError(std::string("an accuracy of ") + given + " is not from 1e-9 to 0.1");
    }
    const double needed = periodic ? std::min(accuracy / 2, least_in_cube) : accuracy;
    for (const Plan& plan : plans)
        if (needed >= plan.least_accuracy &&
            !(periodic && plan.precision == Precision::mixed && needed < least_for_floats_in_cube))
            return plan;
    return finest;
}

/// How many times as large errors add up to be where charges lie on surfaces and lines. Neighbouring cells
/// are alike there, so what their multipoles lack does not cancel. Measured on shells, plane lattices and
/// helices.
constexpr double errors_on_surfaces = 3;

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
double set_tolerances(const detail::Sorted<R, T>& sources, detail::Sorted<R, T>& at,
                      const ForceOptions& options, const Plan& plan, int order_of_multipoles,
                      const detail::Units& units, Executor& executor) {
    const int order = order_of_multipoles + 1;  // of the errors
    const bool in_double = plan.precision != Precision::single;
    const double counts = plan.error_per_bound * errors_by_shape(sources.tree) *
                          (sources.cells.side == 0 ? 1
                           : in_double             ? errors_in_cube_of_double
                                                   : errors_in_cube);
    at.cells.share_of_gradient = share_of_pairs * options.accuracy;
    at.cells.share_of_tolerance = share_of_pairs * counts;
    const double share = options.accuracy / counts;
    detail::set_tolerances(at.cells, share, order, executor, [&](std::uint32_t leaf) {
        if (options.sizes.empty()) {
            const detail::Spot spot = detail::spot_of(at.cells, leaf);
            const detail::Strength strength = detail::strength_at(sources.cells, spot);
            if (strength.varies || detail::is_uneven(at.cells, leaf))
                return detail::set_leaf(sources.cells, at.cells, leaf, order, [&](std::size_t i) {
                    const Vec3d place(at.cells.x[i], at.cells.y[i], at.cells.z[i]);
                    return detail::strength_at(sources.cells, {place, 0, spot.softest}).least;
                });
            return detail::set_leaf(sources.cells, at.cells, leaf, order,
                                    [&](std::size_t) { return strength.least; });
        }
        detail::set_leaf(sources.cells, at.cells, leaf, order,
                         [&](std::size_t i) { return options.sizes[at.tree.items()[i]] / units.gradient(); });
    });
    return share;
}
/// Adds what the far images in a periodic cube do.
template <class R>
void add_far_images(const FmmCells<R>& sources, FmmCells<R>& at, double accuracy, Executor& executor) {
    const std::size_t charges = sources.x.size() - row_padding, targets = at.potential.size();
    const detail::FarImages images(sources.side, sources.middle, detail::far_order(accuracy),
                                   {sources.x.data(), sources.y.data(), sources.z.data(), charges},
                                   sources.charge.data(), executor);
    images.act({at.x.data(), at.y.data(), at.z.data(), targets, at.potential.data(), at.gx.data(),
                at.gy.data(), at.gz.data()},
               executor);
    if (!at.tides.empty())
        images.bend({at.x.data(), at.y.data(), at.z.data(), targets}, at.tide_rows(), executor);
}
/// Finds forces at targets, or at the charges themselves. Returns the targets where gradients are less than
/// half of what tolerances were set by: errors may be beyond the accuracy there.
template <class R, class T>
std::vector<std::size_t> act(const detail::Sorted<R, T>& sources, detail::Sorted<R, T>& at,
                             std::span<PotentialAt<T>> found, const Plan& plan, const ForceOptions& options,
                             const FmmKernel<R>& kernel, const detail::Units& units, Executor& executor) {
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
    detail::hand_out(at, units, found, executor);
    detail::hand_out(at, units, options.tides, executor);
    std::vector<std::size_t> less;
    for (std::uint32_t leaf = 0; leaf < cells.size(); ++leaf) {
        if (!cells.is_leaf(leaf)) continue;
        const double size = static_cast<double>(cells.tolerance[leaf]) / share;
        if (size < 1.01 * detail::least_size(sources.cells, cells, leaf)) continue;
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
    direct_sum(charges, at.view(), std::span(want), executor);
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
bool multipole_forces(const Charges<T>& charges, const detail::RepeatingCube& cube, const Targets<T>* others,
                      std::span<PotentialAt<T>> found, const Plan& plan, const ForceOptions& options,
                      const FmmKernel<R>& kernel, const detail::Extremes<T>& extremes, Executor& executor) {
    const detail::Units units(extremes);
    detail::Sorted<R, T> sources(charges, cube, units, plan.leaf_size, kernel, executor);
    if (!sources.precise_enough()) return false;
    sources.cells.pairs_in_float = plan.precision == Precision::mixed;
    const Targets<T> targets =
        others != nullptr ? *others : Targets<T>(charges.places, charges.lengths, charges.charges);
    const auto act_at = [&](const Targets<T>& some, std::span<PotentialAt<T>> here, const ForceOptions& how) {
        if (others == nullptr) return act(sources, sources, here, plan, how, kernel, units, executor);
        detail::Sorted<R, T> at(some, charges, units, plan.leaf_size, kernel, executor);
        return act(sources, at, here, plan, how, kernel, units, executor);
    };
    // Nothing acts on sources that are no targets.
    if (others != nullptr)
        std::fill(sources.cells.tolerance.begin(), sources.cells.tolerance.end(),
                  std::numeric_limits<R>::infinity());
    const std::vector<std::size_t> less = act_at(targets, found, options);
    const std::size_t few = others == nullptr ? found.size() / 1000 : 0;
    const double farthest = 2 * static_cast<double>(sources.cells.radius[0]),
                 least = units.gradient() * 0.01 * static_cast<double>(sources.cells.weight[0]) /
                         (farthest * farthest);
    ForceOptions how = options;
    constexpr int most_rounds = 8;
    for (int round = 0; round < most_rounds && options.sizes.empty() && less.size() > few &&
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
            found[i].potential -= static_cast<T>(detail::own_potential(targets, charges.softening, i));
    return true;
}
template <class Kernels>
const auto& of_order(const Kernels& kernels, int order) {
    return *std::find_if(kernels.begin(), kernels.end(), [&](const auto& k) { return k.order >= order; });
}

template <class R, class T>
std::vector<ActingCell> cells_acting_on(const Charges<T>& charges, const detail::RepeatingCube& cube,
                                        std::size_t i, const Plan& plan, const ForceOptions& options,
                                        const FmmKernel<R>& kernel, const detail::Units& units) {
    detail::Sorted<R, T> all(charges, cube, units, plan.leaf_size, kernel, serial_executor());
    set_tolerances(all, all, options, plan, kernel.order, units, serial_executor());
    const auto items = all.tree.items();
    const auto place = std::find(items.begin(), items.end(), static_cast<PrimitiveId>(i)) - items.begin();
    std::vector<CellThatActs> found;
    kernel.acting(all.cells, all.cells, static_cast<std::uint32_t>(place), found);
    std::vector<ActingCell> acting;
    for (const CellThatActs& one : found) {
        Box3d box;
        const std::size_t first = all.cells.first[one.cell.cell()], count = all.cells.count[one.cell.cell()];
        const Vec3d shift = all.cells.images[one.cell.image()] / units.length;
        for (std::size_t k = first; k < first + count; ++k)
            box.expand(Vec3d(charges.places[items[k]]) + shift);
        acting.push_back({box, count, one.by});
    }
    return acting;
}

/// Without kernels: as the method is described. Cells are opened farther until errors that are measured at
/// some charges are half of what is allowed. Returns whether they are.
template <class T>
bool plain_forces(const Charges<T>& charges, std::span<PotentialAt<T>> found, double accuracy,
                  Executor& executor) {
    const Index<PointOrthtree<T, 3>, PointCloudView<T, 3>> index(PointCloudView<T, 3>(charges.places),
                                                                 {.leaf_size = 32}, executor);
    std::vector<double> all(charges.charges.size());
    for (std::size_t i = 0; i < all.size(); ++i) all[i] = static_cast<double>(charges.charges[i]);
    const ForceCheck check(charges, 1000, executor);
    for (const double opening_angle : {0.5, 0.35, 0.25}) {
        const auto sums = PlainFmm<6>(opening_angle)(index, all);
        bool finite = true;  // powers of the distances of a body far out are beyond double
        for (std::size_t i = 0; i < sums.size(); ++i) {
            found[i] = {static_cast<T>(sums[i].potential), Vec<T, 3>(sums[i].gradient)};
            finite = finite && std::isfinite(length2(found[i].gradient));
        }
        const ForceErrors errors = check.errors_of(std::span<const PotentialAt<T>>(found));
        if (finite && errors.rms <= accuracy / 2 && errors.largest <= 5 * accuracy) return true;
    }
    return false;
}

template <class T>
void forces_at(const Charges<T>& given, const Targets<T>* given_targets, std::span<PotentialAt<T>> found,
               const ForceOptions& options, Threads threads) {
    const Plan& plan = plan_for(options.accuracy, given.period > 0);
    if (std::same_as<T, float> && options.accuracy < least_accuracy_of_float)
        throw UsageError("an accuracy below 1e-7 is beyond what numbers of float hold: use double");
    detail::expect_room(found.size(),
                        given_targets != nullptr ? given_targets->places.size() : given.places.size());
    detail::Extremes<T> extremes(given);  // throws for bad numbers
    if (given_targets != nullptr) extremes.expand(*given_targets, given);
    if (!options.sizes.empty() && options.sizes.size() != found.size())
        throw InputError(std::to_string(options.sizes.size()) + " sizes of gradients for " +
                         std::to_string(found.size()) + " targets: give one each, or none");
    const bool with_tides = !options.tides.empty();
    if (with_tides) detail::expect_room(options.tides.size(), found.size());
    if (found.empty()) return;
    // Bring all places into the cube, if there is one.
    const detail::RepeatingCube cube(given);
    const detail::PlacesInCube<T> in_cube(given.places, cube),
        targets_in_cube(given_targets != nullptr ? given_targets->places : Strided<Vec<T, 3>>(), cube);
    Charges<T> charges = given;
    charges.places = in_cube.places();
    std::optional<Targets<T>> other;
    if (given_targets != nullptr)
        other.emplace(targets_in_cube.places(), given_targets->lengths, given_targets->charges);
    const Targets<T>* const targets = other ? &*other : nullptr;
    Executor& executor = threads.over(found.size());
    const NbodyKernels* const kernels = nbody_kernels();
    const bool plain = kernels == nullptr && targets == nullptr && !detail::softened(charges) &&
                       !(charges.period > 0) && !with_tides && found.size() >= 2000 &&
                       options.accuracy >= 1e-4;
    // A direct sum in float errs by 2⁻²¹ a pair.
    const bool direct_is_exact =
        std::same_as<T, double> || plan.precision == Precision::single || kernels == nullptr;
    // Near images and tides make it slower.
    const std::size_t least_charges = !(charges.period > 0)                 ? plan.least_charges
                                      : plan.precision == Precision::single ? least_charges_in_cube
                                                                            : least_charges_in_cube_of_double;
    const bool few =
        charges.places.empty() ||
        (direct_is_exact && !with_tides &&
         (charges.places.size() < least_charges ||
          (targets != nullptr && !(charges.period > 0) && targets->places.size() < least_targets)));
    if (few || (kernels == nullptr && !plain)) {
        if (with_tides)
            direct_tides(
                charges,
                targets != nullptr ? *targets : Targets<T>(charges.places, charges.lengths, charges.charges),
                options.tides, threads);
        return targets != nullptr ? direct_sum(charges, *targets, found, threads)
                                  : direct_sum(charges, found, threads);
    }
    in_ieee_mode([&] {
        IeeeExecutor ieee(executor);
        const auto by = [&](const auto& kernel) {
            return multipole_forces(charges, cube, targets, found, plan, options, kernel, extremes, ieee);
        };
        if (plain) {
            if (!plain_forces(charges, found, options.accuracy, ieee)) direct_sum(charges, found, ieee);
        } else if (plan.precision != Precision::single || !by(of_order(*kernels->fmm_float, plan.order)))
            by(of_order(*kernels->fmm_double, plan.order));
    });
}

}  // namespace

template <std::floating_point T>
void forces(const Charges<T>& charges, std::span<PotentialAt<T>> found, const ForceOptions& options,
            Threads threads) {
    forces_at<T>(charges, nullptr, found, options, threads);
}
template <std::floating_point T>
void forces(const Charges<T>& charges, const Targets<T>& targets, std::span<PotentialAt<T>> found,
            const ForceOptions& options, Threads threads) {
    forces_at<T>(charges, &targets, found, options, threads);
}

template <std::floating_point T>
std::vector<ActingCell> acting_cells(const Charges<T>& given, std::size_t i, const ForceOptions& options) {
    const Plan& plan = plan_for(options.accuracy, given.period > 0);
    const detail::Extremes<T> extremes(given);  // throws for bad numbers
    const detail::RepeatingCube cube(given);
    const detail::PlacesInCube<T> in_cube(given.places, cube);
    Charges<T> charges = given;
    charges.places = in_cube.places();
    const NbodyKernels* const kernels = nbody_kernels();
    if (kernels == nullptr || i >= charges.places.size()) return {};
    return in_ieee_mode([&] {
        const auto by = [&](const auto& kernel) {
            return cells_acting_on(charges, cube, i, plan, options, kernel, detail::Units(extremes));
        };
        return plan.precision == Precision::single ? by(of_order(*kernels->fmm_float, plan.order))
                                                   : by(of_order(*kernels->fmm_double, plan.order));
    });
}

template std::vector<ActingCell> acting_cells(const Charges<float>&, std::size_t, const ForceOptions&);
template std::vector<ActingCell> acting_cells(const Charges<double>&, std::size_t, const ForceOptions&);
template void forces(const Charges<float>&, std::span<PotentialAt<float>>, const ForceOptions&, Threads);
template void forces(const Charges<double>&, std::span<PotentialAt<double>>, const ForceOptions&, Threads);
template void forces(const Charges<float>&, const Targets<float>&, std::span<PotentialAt<float>>,
                     const ForceOptions&, Threads);
template void forces(const Charges<double>&, const Targets<double>&, std::span<PotentialAt<double>>,
                     const ForceOptions&, Threads);

}  // namespace hedgerow
