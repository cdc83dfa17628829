/// Sums over all pairs: charges in rows, by the kernels in use or one after the other.
#include <hedgerow/nbody/direct_sum.h>

#include <vector>

#include <hedgerow/nbody/kernels.h>

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

}  // namespace

template <std::floating_point T>
void direct_sum(const Charges<T>& sources, const Targets<T>& targets, std::span<PotentialAt<T>> found,
                Threads threads) {
    const std::size_t n = sources.places.size(), count = targets.places.size();
    detail::expect_room(found.size(), count);
    // Powers of two bring coordinates and charges to about 1.
    detail::Extremes<T> extremes(sources);
    extremes.expand(targets);
    const T scale = detail::to_unit(extremes.coordinate), of_charge = detail::to_unit(extremes.charge);
    // Copy sources and targets to rows. Multiples by powers of two are exact.
    const bool softened = detail::softened(sources);
    Rows<T> source(softened ? 5 : 4, n), target(softened ? 4 : 3, count);
    Rows<double> sums(4, count);
    for (std::size_t i = 0; i < n; ++i) {
        const Vec<T, 3> p = sources.places[i] * scale;
        source[0][i] = p[0], source[1][i] = p[1], source[2][i] = p[2];
        source[3][i] = sources.charges[i] * of_charge;
        if (softened) source[4][i] = detail::reach_of(sources, i) * scale;
    }
    for (std::size_t i = 0; i < count; ++i) {
        const Vec<T, 3> p = targets.places[i] * scale;
        target[0][i] = p[0], target[1][i] = p[1], target[2][i] = p[2];
        if (softened) target[3][i] = detail::reach_of(targets, sources.softening, i) * scale;
    }
    const ChargeRows<T> rows{source[0], source[1], source[2], source[3], n, softened ? source[4] : nullptr};
    const DirectKernel<T> kernel = direct_kernel<T>();
    constexpr std::size_t piece = 64;
    Executor& executor = threads.over(count > 1 ? n * count / 64 : 0);
    executor.expect(count);
    executor.for_each_piece(count, piece, [&](std::size_t begin, std::size_t end) {
        in_ieee_mode([&] {
            kernel(
                rows,
                {target[0] + begin, target[1] + begin, target[2] + begin, end - begin, sums[0] + begin,
                 sums[1] + begin, sums[2] + begin, sums[3] + begin, softened ? target[3] + begin : nullptr},
                sources.softening.kernel);
        });
        // Scale the sums back: a potential by charge and length, a gradient by another length.
        const double of_potential = static_cast<double>(scale) / static_cast<double>(of_charge),
                     of_gradient = of_potential * static_cast<double>(scale);
        for (std::size_t i = begin; i < end; ++i)
            found[i] = {static_cast<T>(sums[0][i] * of_potential),
                        {static_cast<T>(sums[1][i] * of_gradient), static_cast<T>(sums[2][i] * of_gradient),
                         static_cast<T>(sums[3][i] * of_gradient)}};
        executor.advance(end - begin);
    });
}

template void direct_sum(const Charges<float>&, const Targets<float>&, std::span<PotentialAt<float>>,
                         Threads);
template void direct_sum(const Charges<double>&, const Targets<double>&, std::span<PotentialAt<double>>,
                         Threads);

}  // namespace hedgerow
