/// Sums over all pairs: charges in rows, by the kernels in use or one after the other.
#include <hedgerow/nbody/direct_sum.h>

#include <vector>

#include <hedgerow/nbody/kernels.h>
#include <hedgerow/parallel/ieee_executor.h>

#include "far_images.h"
#include "lattice_sums.h"
#include "rows.h"

namespace hedgerow {
namespace {

/// Numbers in rows, whose last ones are padding.
template <class T>
class Rows {
public:
    Rows(std::size_t rows, std::size_t count)
        : stride_((count + 2 * row_padding - 1) / row_padding * row_padding),
          numbers_(rows * stride_, T(0)) {}
    T* operator[](std::size_t row) { return numbers_.data() + row * stride_; }
    const T* operator[](std::size_t row) const { return numbers_.data() + row * stride_; }

private:
    std::size_t stride_;
    std::vector<T> numbers_;
};

/// What `DirectKernel` does, one pair after the other.
template <class T>
void direct(const ChargeRows<T>& sources, const TargetRows<T>& targets, SofteningKernel kernel) {
    for (std::size_t t = 0; t < targets.count; ++t)
        for (std::size_t s = 0; s < sources.count; ++s) {
            const Vec3d apart(Vec<T, 3>(targets.x[t] - sources.x[s], targets.y[t] - sources.y[s],
                                        targets.z[t] - sources.z[s]));
            const double distance2 = length2(apart);
            if (!(distance2 >= static_cast<double>(coincident2<T>))) continue;
            const T reach = sources.reach == nullptr ? T(0) : std::max(sources.reach[s], targets.reach[t]);
            const KernelShare share = SoftenedInverse{kernel, static_cast<double>(reach)}(distance2);
            const double charge = static_cast<double>(sources.charge[s]);
            targets.potential[t] += charge * share.potential;
            const Vec3d gradient = apart * (charge * share.slope);
            targets.gx[t] += gradient[0], targets.gy[t] += gradient[1], targets.gz[t] += gradient[2];
        }
}
template <class T>
DirectKernel<T> direct_kernel() {
    const NbodyKernels* const kernels = nbody_kernels();
    if (kernels == nullptr) return direct<T>;
    if constexpr (std::same_as<T, float>)
        return kernels->direct_float;
    else
        return kernels->direct_double;
}

/// The sum in R, of all charges in the images of a periodic cube, or of the charges themselves.
template <class R, class T>
void sum_pairs(const Charges<T>& sources, const Targets<T>& targets, const detail::Extremes<T>& extremes,
               std::span<PotentialAt<T>> found, Executor& executor) {
    const std::size_t n = sources.places.size(), count = targets.places.size();
    // Powers of two bring coordinates and charges to about 1: such multiples are exact.
    const R scale = static_cast<R>(detail::to_unit(extremes.coordinate)),
            of_charge = static_cast<R>(detail::to_unit(extremes.charge));
    const bool softened = detail::softened(sources);
    Rows<R> source(softened ? 5 : 4, n), target(softened ? 4 : 3, count);
    Rows<double> sums(4, count);
    for (std::size_t i = 0; i < n; ++i) {
        source[3][i] = static_cast<R>(sources.charges[i]) * of_charge;
        if (softened) source[4][i] = static_cast<R>(detail::reach_of(sources, i)) * scale;
    }
    for (std::size_t i = 0; i < count; ++i) {
        for (int k = 0; k < 3; ++k) target[std::size_t(k)][i] = static_cast<R>(targets.places[i][k]) * scale;
        if (softened) target[3][i] = static_cast<R>(detail::reach_of(targets, sources.softening, i)) * scale;
    }
    const ChargeRows<R> rows{source[0], source[1], source[2], source[3], n, softened ? source[4] : nullptr};
    const DirectKernel<R> kernel = direct_kernel<R>();
    const double side = detail::side_of(sources) * static_cast<double>(scale);
    const std::vector<Vec3d> images = side > 0 ? detail::near_image_places(side) : std::vector<Vec3d>(1);
    const auto move_sources_by = [&](const Vec3d& shift) {
        for (std::size_t i = 0; i < n; ++i)
            for (int k = 0; k < 3; ++k)
                source[std::size_t(k)][i] =
                    static_cast<R>(sources.places[i][k]) * scale + static_cast<R>(shift[k]);
    };
    executor.expect(count * images.size());
    for (const Vec3d& image : images) {
        move_sources_by(image);
        executor.for_each_piece(count, 64, [&](std::size_t begin, std::size_t end) {
            kernel(
                rows,
                {target[0] + begin, target[1] + begin, target[2] + begin, end - begin, sums[0] + begin,
                 sums[1] + begin, sums[2] + begin, sums[3] + begin, softened ? target[3] + begin : nullptr},
                sources.softening.kernel);
            executor.advance(end - begin);
        });
    }
    if constexpr (std::same_as<R, double>) {
        if (side > 0) {
            move_sources_by(Vec3d());
            detail::FarImages(side, detail::most_far_order, {source[0], source[1], source[2], n}, source[3],
                              executor)
                .act({target[0], target[1], target[2], count, sums[0], sums[1], sums[2], sums[3]}, executor);
        }
    }
    // Scale the sums back: a potential by charge and length, a gradient by another length.
    const double of_potential = static_cast<double>(scale) / static_cast<double>(of_charge),
                 of_gradient = of_potential * static_cast<double>(scale);
    for (std::size_t i = 0; i < count; ++i)
        found[i] = {static_cast<T>(sums[0][i] * of_potential),
                    {static_cast<T>(sums[1][i] * of_gradient), static_cast<T>(sums[2][i] * of_gradient),
                     static_cast<T>(sums[3][i] * of_gradient)}};
}

}  // namespace

template <std::floating_point T>
void direct_sum(const Charges<T>& sources, const Targets<T>& targets, std::span<PotentialAt<T>> found,
                Threads threads) {
    const std::size_t n = sources.places.size(), count = targets.places.size();
    detail::expect_room(found.size(), count);
    detail::Extremes<T> extremes(sources);
    extremes.expand(targets, sources);
    Executor& executor = threads.over(count > 1 ? n * count / 64 : 0);
    in_ieee_mode([&] {
        IeeeExecutor ieee(executor);
        if (!(sources.period > 0)) return sum_pairs<T>(sources, targets, extremes, found, ieee);
        const detail::PlacesInCube<T> places(sources.places, sources.period),
            at(targets.places, sources.period);
        Charges<T> in_cube = sources;
        in_cube.places = places.places();
        sum_pairs<double>(in_cube, Targets<T>(at.places(), targets.lengths), extremes, found, ieee);
    });
}

template <std::floating_point T>
void direct_tides(const Charges<T>& sources, const Targets<T>& targets, std::span<Tides> found,
                  Threads threads) {
    const std::size_t n = sources.places.size(), count = targets.places.size();
    detail::expect_room(found.size(), count);
    detail::Extremes<T> extremes(sources);
    extremes.expand(targets, sources);
    const double side = detail::side_of(sources), least = static_cast<double>(extremes.coordinate) * 0x1p-320;
    const detail::PlacesInCube<T> places(sources.places, sources.period), at(targets.places, sources.period);
    const std::vector<Vec3d> images = side > 0 ? detail::near_image_places(side) : std::vector<Vec3d>(1);
    IeeeExecutor executor(threads.over(count > 1 ? n * count / 8 : 0));
    executor.for_each_piece(count, 16, [&](std::size_t begin, std::size_t end) {
        for (std::size_t t = begin; t < end; ++t) {
            const double own = static_cast<double>(detail::reach_of(targets, sources.softening, t));
            Tides sum;
            for (const Vec3d& image : images)
                for (std::size_t s = 0; s < n; ++s) {
                    const Vec3d d = Vec3d(places.places()[s]) - Vec3d(at.places()[t]) + image;
                    const double d2 = length2(d), charge = static_cast<double>(sources.charges[s]);
                    if (!(d2 > least * least)) continue;
                    const SoftenedInverse softened{
                        sources.softening.kernel,
                        std::max(own, static_cast<double>(detail::reach_of(sources, s)))};
                    const double slope = softened(d2).slope, bend = softened.bend(d2);
                    sum += Tides{slope + bend * d[0] * d[0], slope + bend * d[1] * d[1],
                                 slope + bend * d[2] * d[2], bend * d[0] * d[1],
                                 bend * d[0] * d[2],         bend * d[1] * d[2]} *
                           charge;
                }
            found[t] = sum;
        }
    });
    if (!(side > 0)) return;
    // What far images do.
    Rows<double> source(4, n), target(3, count), rows(6, count);
    for (std::size_t i = 0; i < n; ++i) source[3][i] = static_cast<double>(sources.charges[i]);
    for (std::size_t k = 0; k < 3; ++k) {
        for (std::size_t i = 0; i < n; ++i) source[k][i] = static_cast<double>(places.places()[i][int(k)]);
        for (std::size_t i = 0; i < count; ++i) target[k][i] = static_cast<double>(at.places()[i][int(k)]);
    }
    const detail::TideRows tides(rows[0], static_cast<std::size_t>(rows[1] - rows[0]));
    detail::FarImages(side, detail::most_far_order, {source[0], source[1], source[2], n}, source[3], executor)
        .bend({target[0], target[1], target[2], count}, tides, executor);
    for (std::size_t i = 0; i < count; ++i) found[i] += tides[i];
}

template void direct_tides(const Charges<float>&, const Targets<float>&, std::span<Tides>, Threads);
template void direct_tides(const Charges<double>&, const Targets<double>&, std::span<Tides>, Threads);
template void direct_sum(const Charges<float>&, const Targets<float>&, std::span<PotentialAt<float>>,
                         Threads);
template void direct_sum(const Charges<double>&, const Targets<double>&, std::span<PotentialAt<double>>,
                         Threads);

}  // namespace hedgerow
