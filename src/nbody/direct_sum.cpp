/// Sums over all pairs: charges in rows, by the kernels in use or one after the other.
#include <hedgerow/nbody/direct_sum.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <span>
#include <vector>

#include <hedgerow/geometry/elementary_parts.h>
#include <hedgerow/nbody/kernels.h>
#include <hedgerow/parallel/ieee_executor.h>

#include "far_images.h"
#include "lattice_sums.h"
#include "plain_pairs.h"
#include "rows.h"
#include "runs.h"

namespace hedgerow {
namespace {

/// Numbers in rows, whose last ones are padding.
template <class T>
class Rows {
public:
    Rows(std::size_t rows, std::size_t count, T padding = T(0))
        : stride_((count + 2 * row_padding - 1) / row_padding * row_padding),
          numbers_(rows * stride_, padding) {}
    T* operator[](std::size_t row) { return numbers_.data() + row * stride_; }
    const T* operator[](std::size_t row) const { return numbers_.data() + row * stride_; }

private:
    std::size_t stride_;
    std::vector<T> numbers_;
};

/// The kernels in use.
template <class T>
DirectKernel<T> direct_kernel() {
    const NbodyKernels* const kernels = in_use<NbodyKernels>();
    if (kernels == nullptr) return detail::direct_plain<T>;
    if constexpr (std::same_as<T, float>)
        return kernels->direct_float;
    else
        return kernels->direct_double;
}
DirectKernel<double> exact_kernel() {
    const NbodyKernels* const kernels = in_use<NbodyKernels>();
    return kernels == nullptr ? detail::direct_plain<double> : kernels->direct_exact;
}

/// The charges and targets of a sum, in rows of R and in units that are powers of two: coordinates and
/// charges are about 1, with the caller's bits.
template <class R>
class SumRows {
public:
    /// Of targets that are the charges themselves, or any others.
    template <class T>
    SumRows(const Charges<T>& sources, const detail::RepeatingCube& cube, const Targets<T>& targets,
            bool at_charges, const detail::Extremes<T>& extremes)
        : sources_(sources.places.size()),
          targets_(targets.places.size()),
          at_charges_(at_charges),
          softened_(detail::softened(sources)),
          kernel_(sources.softening.kernel),
          length_(static_cast<double>(detail::to_unit(extremes.coordinate))),
          charge_(static_cast<double>(detail::to_unit(extremes.charge))),
          side_(cube.side * length_),
          middle_(cube.middle * length_),
          place_(3, sources_, R(-beyond_rows)),
          target_(3, targets_, R(beyond_rows)),
          image_(3, side_ > 0 ? sources_ : 0, R(-beyond_rows)),
          low_source_(3, sources_),
          low_target_(3, targets_),
          of_source_(2, sources_),
          of_target_(1, targets_),
          sums_(5, targets_) {
        const auto in_units = [&](T x) { return static_cast<R>(static_cast<double>(x) * length_); };
        for (std::size_t i = 0; i < sources_; ++i) {
            for (int k = 0; k < 3; ++k) place_[row(k)][i] = in_units(sources.places[i][k]);
            of_source_[0][i] = static_cast<R>(static_cast<double>(sources.charges[i]) * charge_);
            if (softened_) of_source_[1][i] = in_units(detail::reach_of(sources, i));
        }
        for (std::size_t i = 0; i < targets_; ++i) {
            for (int k = 0; k < 3; ++k) target_[row(k)][i] = in_units(targets.places[i][k]);
            if (softened_) of_target_[0][i] = in_units(detail::reach_of(targets, sources.softening, i));
        }
        images_ = side_ > 0 ? detail::near_image_places(side_) : std::vector<Vec3d>(1);
    }

    /// Adds what all sources do, or their near images in a periodic cube.
    void sum(DirectKernel<R> kernel, Executor& executor) {
        executor.expect(targets_ * images_.size());
        for_each_image([&](bool among_sources) {
            executor.for_each_piece(targets_, 64, [&](std::size_t begin, std::size_t end) {
                kernel(sources(), targets(begin, end - begin, among_sources), kernel_);
                executor.advance(end - begin);
            });
        });
    }
    /// Sums anew, by another kernel, at some targets.
    void sum_again(const std::vector<std::size_t>& at, DirectKernel<R> kernel, Executor& executor) {
        for (const std::size_t i : at)
            for (std::size_t k = 0; k < 5; ++k) sums_[k][i] = 0;
        for_each_image([&](bool among_sources) {
            executor.for_each_piece(at.size(), 64, [&](std::size_t begin, std::size_t end) {
                detail::for_each_run(std::span(at).subspan(begin, end - begin),
                                     [&](std::size_t first, std::size_t count) {
                                         kernel(sources(), targets(first, count, among_sources), kernel_);
                                     });
            });
        });
    }
    /// Of some targets those with a source too near for the kernel that summed.
    std::vector<std::size_t> in_doubt(const std::vector<std::size_t>& at) const {
        std::vector<std::size_t> doubtful;
        for (const std::size_t i : at)
            if (!(sums_[4][i] < std::numeric_limits<double>::infinity())) doubtful.push_back(i);
        return doubtful;
    }
    /// Adds what far images do.
    void add_far_images(Executor& executor) requires std::same_as<R, double> {
        if (!(side_ > 0)) return;
        detail::FarImages(side_, middle_, detail::most_far_order, {place_[0], place_[1], place_[2], sources_},
                          of_source_[0], executor)
            .act({target_[0], target_[1], target_[2], targets_, sums_[0], sums_[1], sums_[2], sums_[3]},
                 executor);
    }

    PotentialAt<double> found(std::size_t i) const {
        const double of_potential = length_ / charge_, of_gradient = of_potential * length_;
        return {sums_[0][i] * of_potential,
                {sums_[1][i] * of_gradient, sums_[2][i] * of_gradient, sums_[3][i] * of_gradient}};
    }

private:
    static std::size_t row(int axis) { return static_cast<std::size_t>(axis); }
    /// Calls f with the sources where each image is; whether targets are among them is its argument.
    template <class F>
    void for_each_image(F f) {
        for (const Vec3d& shift : images_) {
            // Places in two parts, so that none is rounded: charges at opposite faces may be close.
            if (side_ > 0)
                for (int k = 0; k < 3; ++k)
                    for (std::size_t i = 0; i < sources_; ++i) {
                        const auto moved = detail::two_sum(place_[row(k)][i], static_cast<R>(shift[k]));
                        image_[row(k)][i] = moved.high, low_source_[row(k)][i] = moved.low;
                    }
            f(at_charges_ && shift == Vec3d());
        }
    }
    ChargeRows<R> sources() const {
        const Rows<R>& at = side_ > 0 ? image_ : place_;
        return {at[0],          at[1],          at[2],
                of_source_[0],  sources_,       softened_ ? of_source_[1] : nullptr,
                low_source_[0], low_source_[1], low_source_[2]};
    }
    TargetRows<R> targets(std::size_t first, std::size_t count, bool among_sources) {
        const auto from = [&](auto& rows, std::size_t k) { return rows[k] + first; };
        return {from(target_, 0),
                from(target_, 1),
                from(target_, 2),
                count,
                from(sums_, 0),
                from(sums_, 1),
                from(sums_, 2),
                from(sums_, 3),
                softened_ ? from(of_target_, 0) : nullptr,
                from(low_target_, 0),
                from(low_target_, 1),
                from(low_target_, 2),
                from(sums_, 4),
                among_sources ? first : no_self};
    }

    std::size_t sources_, targets_;
    bool at_charges_, softened_;
    SofteningKernel kernel_;
    double length_, charge_, side_;
    Vec3d middle_;
    Rows<R> place_, target_, image_, low_source_, low_target_, of_source_, of_target_;
    Rows<double> sums_;
    std::vector<Vec3d> images_;
};

/// The sum at targets, or at the charges themselves: first in T, or in a periodic cube in double of places in
/// two parts; then more carefully where a source is too near.
template <class T>
void sum_pairs(const Charges<T>& sources, const detail::RepeatingCube& cube, const Targets<T>& targets,
               bool at_charges, const detail::Extremes<T>& extremes, std::span<PotentialAt<T>> found,
               Executor& executor) {
    std::vector<std::size_t> all(targets.places.size());
    std::iota(all.begin(), all.end(), std::size_t{0});
    const auto hand_out = [&](const auto& rows, const std::vector<std::size_t>& some) {
        for (const std::size_t i : some) {
            const PotentialAt<double> at = rows.found(i);
            found[i] = {static_cast<T>(at.potential - detail::own_potential(targets, sources.softening, i)),
                        Vec<T, 3>(at.gradient)};
        }
    };
    const auto in_double = [&](std::vector<std::size_t> some, DirectKernel<double> kernel, auto... careful) {
        SumRows<double> rows(sources, cube, targets, at_charges, extremes);
        some.size() == all.size() ? rows.sum(kernel, executor) : rows.sum_again(some, kernel, executor);
        std::vector<std::size_t> doubtful = rows.in_doubt(some);
        for (const DirectKernel<double> next : {careful...})
            if (!doubtful.empty()) {
                rows.sum_again(doubtful, next, executor);
                doubtful = rows.in_doubt(doubtful);
            }
        rows.add_far_images(executor);
        hand_out(rows, some);
    };
    if (sources.period > 0) return in_double(all, exact_kernel(), detail::direct_plain<double>);
    if constexpr (std::same_as<T, double>) {
        in_double(all, direct_kernel<double>(), exact_kernel(), detail::direct_plain<double>);
    } else {
        SumRows<float> rows(sources, cube, targets, at_charges, extremes);
        rows.sum(direct_kernel<float>(), executor);
        hand_out(rows, all);
        if (const auto doubtful = rows.in_doubt(all); !doubtful.empty())
            in_double(doubtful, exact_kernel(), detail::direct_plain<double>);
    }
}

template <class T>
void sum_directly(const Charges<T>& sources, const Targets<T>& targets, bool at_charges,
                  std::span<PotentialAt<T>> found, Threads threads) {
    const std::size_t n = sources.places.size(), count = targets.places.size();
    detail::expect_room(found.size(), count);
    detail::Extremes<T> extremes(sources);
    extremes.expand(targets, sources);
    Executor& executor = threads.over(count > 1 ? n * count / 64 : 0);
    in_ieee_mode([&] {
        IeeeExecutor ieee(executor);
        const detail::RepeatingCube cube(sources);
        const detail::PlacesInCube<T> places(sources.places, cube), at(targets.places, cube);
        Charges<T> in_cube = sources;
        in_cube.places = places.places();
        sum_pairs<T>(in_cube, cube, Targets<T>(at.places(), targets.lengths, targets.charges), at_charges,
                     extremes, found, ieee);
    });
}

}  // namespace

template <std::floating_point T>
void direct_sum(const Charges<T>& sources, const Targets<T>& targets, PotentialsFound<T> found,
                const SumOptions& options) {
    // Where targets are the first of bare charges, the sum is the same without what each does to itself, and
    // faster.
    const Strided<Vec<T, 3>>&charges = sources.places, &at = targets.places;
    const bool at_charges = !detail::softened(sources) && !at.empty() && at.size() <= charges.size() &&
                            at.at(0) == charges.at(0) && at.stride() == charges.stride();
    sum_directly(sources, targets, at_charges, found, options.threads);
}
template <std::floating_point T>
void direct_sum(const Charges<T>& charges, PotentialsFound<T> found, const SumOptions& options) {
    const std::size_t count = found.size(), n = charges.places.size();
    if (count > n) detail::expect_room(count, n);
    const Strided<T> lengths = charges.lengths.size() == n ? charges.lengths.part(0, count) : charges.lengths;
    sum_directly(charges, Targets<T>(charges.places.part(0, count), lengths), true, found, options.threads);
}

template <std::floating_point T>
void direct_tides(const Charges<T>& sources, const Targets<T>& targets, std::span<Tides> found,
                  const SumOptions& options) {
    const std::size_t n = sources.places.size(), count = targets.places.size();
    detail::expect_room(found.size(), count);
    detail::Extremes<T> extremes(sources);
    extremes.expand(targets, sources);
    const double side = detail::side_of(sources);
    const detail::RepeatingCube cube(sources);
    const detail::PlacesInCube<T> places(sources.places, cube), at(targets.places, cube);
    const std::vector<Vec3d> images = side > 0 ? detail::near_image_places(side) : std::vector<Vec3d>(1);
    IeeeExecutor executor(options.threads.over(count > 1 ? n * count / 8 : 0));
    executor.for_each_piece(count, 16, [&](std::size_t begin, std::size_t end) {
        for (std::size_t t = begin; t < end; ++t) {
            const double own = static_cast<double>(detail::reach_of(targets, sources.softening, t));
            Tides sum;
            for (const Vec3d& image : images)
                for (std::size_t s = 0; s < n; ++s) {
                    // Charges at opposite faces may be close.
                    const Vec3d from(places.places()[s]), to(at.places()[t]);
                    Vec3d d;
                    for (int k = 0; k < 3; ++k) {
                        const auto moved = detail::two_sum(from[k], image[k]);
                        d[k] = (moved.high - to[k]) + moved.low;
                    }
                    const double d2 = length2(d), charge = static_cast<double>(sources.charges[s]),
                                 reach = std::max(own, static_cast<double>(detail::reach_of(sources, s)));
                    if (!(d2 > 0 || reach > 0)) continue;
                    const SoftenedInverse softened{sources.softening.kernel, reach};
                    const double slope = softened(d2).slope, bend = softened.bend(d2);
                    sum += Tides{slope + bend * d[0] * d[0], slope + bend * d[1] * d[1],
                                 slope + bend * d[2] * d[2], bend * d[0] * d[1],
                                 bend * d[0] * d[2],         bend * d[1] * d[2]} *
                           charge;
                }
            if (!targets.charges.empty() && own > 0) {  // without what it does itself
                const double slope = SoftenedInverse{sources.softening.kernel, own}(0).slope;
                sum += Tides{slope, slope, slope} * -static_cast<double>(targets.charges[t]);
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
    detail::FarImages(side, cube.middle, detail::most_far_order, {source[0], source[1], source[2], n},
                      source[3], executor)
        .bend({target[0], target[1], target[2], count}, tides, executor);
    for (std::size_t i = 0; i < count; ++i) found[i] += tides[i];
}

template void direct_tides(const Charges<float>&, const Targets<float>&, std::span<Tides>, const SumOptions&);
template void direct_tides(const Charges<double>&, const Targets<double>&, std::span<Tides>,
                           const SumOptions&);
template void direct_sum(const Charges<float>&, const Targets<float>&, std::span<PotentialAt<float>>,
                         const SumOptions&);
template void direct_sum(const Charges<double>&, const Targets<double>&, std::span<PotentialAt<double>>,
                         const SumOptions&);
template void direct_sum(const Charges<float>&, std::span<PotentialAt<float>>, const SumOptions&);
template void direct_sum(const Charges<double>&, std::span<PotentialAt<double>>, const SumOptions&);

}  // namespace hedgerow
