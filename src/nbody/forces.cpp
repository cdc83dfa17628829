/// Forces within a stated error: which of the ways to sum them.
#include <hedgerow/nbody/acting_cells.h>
#include <hedgerow/nbody/forces.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include <hedgerow/index.h>
#include <hedgerow/nbody/force_check.h>
#include <hedgerow/nbody/kernels.h>
#include <hedgerow/nbody/plain_fmm.h>
#include <hedgerow/primitives/point_cloud.h>
#include <hedgerow/structures/orthtree/point_orthtree.h>

#include "multipole_forces.h"

namespace hedgerow {
namespace {

using detail::Plan;
using detail::plan_for;
using detail::Precision;

template <class Kernels>
const auto& of_order(const Kernels& kernels, int order) {
    return *std::find_if(kernels.begin(), kernels.end(), [&](const auto& k) { return k.order >= order; });
}

template <class R, class T>
std::vector<ActingCell> cells_acting_on(const Charges<T>& charges, const detail::RepeatingCube& cube,
                                        std::size_t i, const Plan& plan, const ForceOptions& options,
                                        const FmmKernel<R>& kernel, const detail::Units& units) {
    detail::Sorted<R, T> all(charges, cube, units, plan.leaf_size, kernel, serial_executor());
    detail::set_tolerances(all, all, options, plan, kernel.order, units, serial_executor());
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
               const ForceOptions& options) {
    const Plan& plan = plan_for(options.accuracy, given.period > 0);
    if (std::same_as<T, float> && options.accuracy < detail::least_accuracy_of_float)
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
    const SumOptions sum{options.threads};
    Executor& executor = options.threads.over(found.size());
    const FmmKernels kernels;
    const bool plain = !kernels && targets == nullptr && !detail::softened(charges) &&
                       !(charges.period > 0) && !with_tides && found.size() >= 2000 &&
                       options.accuracy >= 1e-4;
    // A direct sum in float errs by 2⁻²¹ a pair.
    const bool direct_is_exact = std::same_as<T, double> || plan.precision == Precision::single || !kernels;
    // Near images and tides make it slower.
    const std::size_t least_charges = !(charges.period > 0) ? plan.least_charges
                                      : plan.precision == Precision::single
                                          ? detail::least_charges_in_cube
                                          : detail::least_charges_in_cube_of_double;
    const bool few =
        charges.places.empty() ||
        (direct_is_exact && !with_tides &&
         (charges.places.size() < least_charges ||
          (targets != nullptr && !(charges.period > 0) && targets->places.size() < detail::least_targets)));
    if (few || (!kernels && !plain)) {
        if (with_tides)
            direct_tides(
                charges,
                targets != nullptr ? *targets : Targets<T>(charges.places, charges.lengths, charges.charges),
                options.tides, sum);
        return targets != nullptr ? direct_sum(charges, *targets, found, sum)
                                  : direct_sum(charges, found, sum);
    }
    in_ieee_mode([&] {
        IeeeExecutor ieee(executor);
        const auto by = [&](const auto& kernel) {
            return detail::multipole_forces(charges, cube, targets, found, plan, options, kernel, extremes,
                                            ieee);
        };
        if (plain) {
            if (!plain_forces(charges, found, options.accuracy, ieee))
                direct_sum(charges, found, {.threads = ieee});
        } else if (plan.precision != Precision::single || !by(of_order(*kernels.of_float, plan.order)))
            by(of_order(*kernels.of_double, plan.order));
    });
}

}  // namespace

template <std::floating_point T>
void forces(const Charges<T>& charges, PotentialsFound<T> found, const ForceOptions& options) {
    forces_at<T>(charges, nullptr, found, options);
}
template <std::floating_point T>
void forces(const Charges<T>& charges, const Targets<T>& targets, PotentialsFound<T> found,
            const ForceOptions& options) {
    forces_at<T>(charges, &targets, found, options);
}

template <std::floating_point T>
std::vector<ActingCell> acting_cells(const Charges<T>& given, std::size_t i, const ForceOptions& options) {
    const Plan& plan = plan_for(options.accuracy, given.period > 0);
    const detail::Extremes<T> extremes(given);  // throws for bad numbers
    const detail::RepeatingCube cube(given);
    const detail::PlacesInCube<T> in_cube(given.places, cube);
    Charges<T> charges = given;
    charges.places = in_cube.places();
    const FmmKernels kernels;
    if (!kernels || i >= charges.places.size()) return {};
    return in_ieee_mode([&] {
        const auto by = [&](const auto& kernel) {
            return cells_acting_on(charges, cube, i, plan, options, kernel, detail::Units(extremes));
        };
        return plan.precision == Precision::single ? by(of_order(*kernels.of_float, plan.order))
                                                   : by(of_order(*kernels.of_double, plan.order));
    });
}

template std::vector<ActingCell> acting_cells(const Charges<float>&, std::size_t, const ForceOptions&);
template std::vector<ActingCell> acting_cells(const Charges<double>&, std::size_t, const ForceOptions&);
template void forces(const Charges<float>&, std::span<PotentialAt<float>>, const ForceOptions&);
template void forces(const Charges<double>&, std::span<PotentialAt<double>>, const ForceOptions&);
template void forces(const Charges<float>&, const Targets<float>&, std::span<PotentialAt<float>>,
                     const ForceOptions&);
template void forces(const Charges<double>&, const Targets<double>&, std::span<PotentialAt<double>>,
                     const ForceOptions&);

}  // namespace hedgerow
