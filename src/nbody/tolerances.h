/// How large an error a conversion may make in each cell of targets, and how far its targets spread.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include <hedgerow/geometry/vec.h>
#include <hedgerow/parallel/executor.h>

#include "cells.h"
#include "rows.h"

namespace hedgerow::detail {

/// Where gradients are estimated: a place, how far targets spread around it, and how far they are softened.
struct Spot {
    Vec3d place;
    double radius, softest;
};
/// How far a cell of sources is from a place; in a periodic cube, its nearest image.
template <class R>
Vec3d offset(const FmmCells<R>& sources, std::uint32_t source, const Vec3d& place) {
    return to_nearest_image(Vec3d(sources.cx[source], sources.cy[source], sources.cz[source]) - place,
                            sources.side);
}
template <class R>
Spot spot_of(const FmmCells<R>& targets, std::uint32_t leaf) {
    return {{targets.cx[leaf], targets.cy[leaf], targets.cz[leaf]},
            static_cast<double>(targets.radius[leaf]),
            static_cast<double>(targets.softest[leaf])};
}
/// Whether targets of a leaf are so unevenly spread that one estimate does not serve them all, as those of a
/// clump and of what is around it.
template <class R>
bool is_uneven(const FmmCells<R>& targets, std::uint32_t leaf) {
    const double radius = static_cast<double>(targets.radius[leaf]);
    double sum = 0;
    const std::size_t first = targets.first[leaf], count = targets.count[leaf];
    for (std::size_t i = first; i < first + count; ++i) {
        const double x = static_cast<double>(targets.dx[i]), y = static_cast<double>(targets.dy[i]),
                     z = static_cast<double>(targets.dz[i]);
        sum += x * x + y * y + z * z;
    }
    return sum < 0.1 * static_cast<double>(count) * radius * radius;
}
/// About the least gradient around a place, and whether that is not known well: it may be many times as large
/// elsewhere around the place, or vanish there.
struct Strength {
    double least;
    bool varies;
};
/// The gradient of all cells as single charges (Barnes and Hut), each farther away by the radius, or a
/// hundredth of the sum of their sizes. In a periodic cube what cells do nearly cancels: so that it does
/// here, cells are small, not moved away, and nearest images do less along an axis the nearer they are to its
/// turning point, where the next image does as much. What single charges in place of cells may have wrong is
/// taken off, since it may be more than all that is left. A gradient changes by at most 2·Σ |q|/r³ a length.
template <class R>
Strength strength_at(const FmmCells<R>& sources, const Spot& spot) {
    thread_local std::vector<std::uint32_t> stack;
    const bool periodic = sources.side > 0;
    const double opening_angle = periodic ? 1.0 : 0.7;
    const std::vector<R>& extents = periodic ? sources.radius : sources.reach;
    const double per_side = periodic ? 1 / sources.side : 0;
    Vec3d sum;
    double size = 0, size_here = 0, doubt = 0, bend = 0;
    stack.assign(1, 0);
    while (!stack.empty()) {
        const std::uint32_t other = stack.back();
        stack.pop_back();
        const Vec3d apart = offset(sources, other, spot.place);
        const double distance = length(apart);
        if (!sources.is_leaf(other) && !(static_cast<double>(extents[other]) < opening_angle * distance)) {
            for (std::uint32_t i = 0; i < sources.children[other]; ++i)
                stack.push_back(sources.child[other] + i);
            continue;
        }
        const double charge = static_cast<double>(sources.multipoles[other * sources.multipole_stride]),
                     weight = static_cast<double>(sources.weight[other]);
        // No place within a cell is nearer to its charge than the cell is wide.
        const double reach = static_cast<double>(extents[other]), near = std::max(distance, reach);
        if (!(near > 0)) continue;
        // What is softened acts about as Plummer's charges do.
        const double soft = std::max(static_cast<double>(sources.softest[other]), spot.softest) / 3,
                     softened = soft > 0 ? std::sqrt(near * near + soft * soft) : near,
                     far = softened + spot.radius, least = std::min(softened, near + spot.radius);
        if (!periodic) {
            const double per_volume = 1 / (far * far * softened);
            sum += apart * (charge * per_volume), size += weight * per_volume * least;
            continue;
        }
        const double per_softened = 1 / softened, along = per_softened * per_softened * per_softened;
        const auto between = [&](double x) {
            const double t = 2 * std::abs(x) * per_side;
            return x * (1 - t * t * t);
        };
        sum += Vec3d(between(apart[0]), between(apart[1]), between(apart[2])) * (charge * along);
        size += weight / (far * far) * (per_softened * least);
        size_here += weight * per_softened * per_softened, bend += weight * along;
        const double share = reach / near;
        doubt += weight / (near * near) * (share * share);
    }
    const double left = length(sum) - doubt;
    return {std::max(left, 0.01 * size),
            periodic && (size_here > 8 * size || (left > 0.01 * size && left < 2 * bend * spot.radius))};
}
/// What counts of the errors in a cell: the mean of some power of them as shares of the gradients, so that a
/// few targets that are far out or where gradients are small count as they should.
constexpr double error_power = 4;

/// What errors are at most shares of at targets of a leaf, however small gradients are: a hundredth of all
/// charge at the far side of all of them; in a cube, of its own images.
template <class R>
double least_size(const FmmCells<R>& sources, const FmmCells<R>& targets, std::uint32_t leaf) {
    const double farthest =
        std::max(length(offset(sources, 0, spot_of(targets, leaf).place)) +
                     static_cast<double>(sources.radius[0]) + static_cast<double>(targets.radius[leaf]),
                 sources.side / 2);
    return 0.01 * static_cast<double>(sources.weight[0]) / (farthest * farthest);
}
/// Sets the tolerance and the spread of a leaf. size_of tells about the size of the gradient at each target,
/// in the units of the cells.
template <class R, class F>
void set_leaf(const FmmCells<R>& sources, FmmCells<R>& targets, std::uint32_t leaf, int order, F size_of) {
    const double least = least_size(sources, targets, leaf);
    const std::size_t first = targets.first[leaf], end = first + targets.count[leaf];
    const double per_radius = targets.radius[leaf] > 0 ? 1 / static_cast<double>(targets.radius[leaf]) : 0;
    thread_local std::vector<double> sizes;
    sizes.clear();
    for (std::size_t i = first; i < end; ++i) sizes.push_back(std::max(size_of(i), least));
    const double smallest = *std::min_element(sizes.begin(), sizes.end());
    double weights = 0, spread = 0;
    for (std::size_t i = first; i < end; ++i) {
        const double inverse = smallest > 0 ? smallest / sizes[i - first] : 1, inverse2 = inverse * inverse,
                     x = static_cast<double>(targets.dx[i]) * per_radius,
                     y = static_cast<double>(targets.dy[i]) * per_radius,
                     z = static_cast<double>(targets.dz[i]) * per_radius, r2 = x * x + y * y + z * z;
        double power = 1;
        for (int k = 0; k < order; ++k) power *= r2;
        weights += inverse2 * inverse2, spread += inverse2 * inverse2 * power * power;
    }
    targets.spread[leaf] =
        targets.radius[leaf] * static_cast<R>(std::pow(spread / weights, 1 / (error_power * order)));
    targets.tolerance[leaf] = static_cast<R>(
        smallest * std::pow(static_cast<double>(targets.count[leaf]) / weights, 1 / error_power));
}
/// Sets tolerances and spreads of all cells above the leaves, as if the targets of a cell were all on its far
/// side, and takes the share of the tolerances that a conversion may err by.
template <class R>
void set_cells(FmmCells<R>& targets, double share, int order) {
    for (std::size_t c = targets.size(); c-- > 0;) {
        if (targets.is_leaf(c)) continue;
        double count = 0, spread = 0, least = static_cast<double>(targets.tolerance[targets.child[c]]);
        const std::uint32_t first = targets.child[c], end = first + targets.children[c];
        for (std::uint32_t k = first; k < end; ++k)
            least = std::min(least, static_cast<double>(targets.tolerance[k]));
        for (std::uint32_t k = first; k < end; ++k) {
            const double dx = targets.cx[k] - targets.cx[c], dy = targets.cy[k] - targets.cy[c],
                         dz = targets.cz[k] - targets.cz[c];
            const double far =
                std::sqrt(dx * dx + dy * dy + dz * dz) + static_cast<double>(targets.spread[k]);
            const double tolerance = static_cast<double>(targets.tolerance[k]),
                         inverse = least > 0       ? least / tolerance
                                   : tolerance > 0 ? 0
                                                   : 1;
            const double weight = targets.count[k] * inverse * inverse * inverse * inverse;
            count += weight;
            spread += weight * std::pow(far / static_cast<double>(targets.radius[c]), error_power * order);
        }
        targets.tolerance[c] = static_cast<R>(least * std::pow(targets.count[c] / count, 1 / error_power));
        targets.spread[c] =
            std::min(targets.radius[c],
                     targets.radius[c] * static_cast<R>(std::pow(spread / count, 1 / (error_power * order))));
    }
    for (R& tolerance : targets.tolerance) tolerance *= static_cast<R>(share);
}
template <class R, class F>
void set_tolerances(FmmCells<R>& targets, double share, int order, Executor& executor, F set) {
    executor.for_each_piece(targets.size(), 64, [&](std::size_t begin, std::size_t end) {
        for (std::size_t c = begin; c < end; ++c)
            if (targets.is_leaf(c)) set(static_cast<std::uint32_t>(c));
    });
    set_cells(targets, share, order);
}

}  // namespace hedgerow::detail
