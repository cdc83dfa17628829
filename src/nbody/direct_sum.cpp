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
void direct(const ChargeRows<T>& sources, const TargetRows<T>& targets) {
    for (std::size_t t = 0; t < targets.count; ++t)
        for (std::size_t s = 0; s < sources.count; ++s) {
            const Vec<T, 3> apart(targets.x[t] - sources.x[s], targets.y[t] - sources.y[s],
                                  targets.z[t] - sources.z[s]);
            if (!(length2(apart) >= coincident2<T>)) continue;
            const PotentialAt<T> one = p2p(sources.charge[s], apart);
            targets.potential[t] += static_cast<double>(one.potential);
            targets.gx[t] += static_cast<double>(one.gradient[0]);
            targets.gy[t] += static_cast<double>(one.gradient[1]);
            targets.gz[t] += static_cast<double>(one.gradient[2]);
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
void direct_sum(const Charges<T>& sources, const Strided<Vec<T, 3>>& targets, std::span<PotentialAt<T>> found,
                Threads threads) {
    const std::size_t n = sources.places.size();
    detail::expect_room(found.size(), targets.size());
    // Powers of two bring coordinates and charges to about 1.
    detail::Extremes<T> extremes(sources);
    for (std::size_t i = 0; i < targets.size(); ++i) extremes.expand(targets[i], "a coordinate of target", i);
    const T scale = detail::to_unit(extremes.coordinate), of_charge = detail::to_unit(extremes.charge);
    // Copy sources and targets to rows. Multiples by powers of two are exact.
    Rows<T> source(4, n), target(3, targets.size());
    Rows<double> sums(4, targets.size());
    for (std::size_t i = 0; i < n; ++i) {
        const Vec<T, 3> p = sources.places[i] * scale;
        source[0][i] = p[0], source[1][i] = p[1], source[2][i] = p[2];
        source[3][i] = sources.charges[i] * of_charge;
    }
    for (std::size_t i = 0; i < targets.size(); ++i) {
        const Vec<T, 3> p = targets[i] * scale;
        target[0][i] = p[0], target[1][i] = p[1], target[2][i] = p[2];
    }
    const ChargeRows<T> rows{source[0], source[1], source[2], source[3], n};
    const DirectKernel<T> kernel = direct_kernel<T>();
    constexpr std::size_t piece = 64;
    Executor& executor = threads.over(targets.size() > 1 ? n * targets.size() / 64 : 0);
    executor.expect(targets.size());
    executor.for_each_piece(targets.size(), piece, [&](std::size_t begin, std::size_t end) {
        in_ieee_mode([&] {
            kernel(rows, {target[0] + begin, target[1] + begin, target[2] + begin, end - begin,
                          sums[0] + begin, sums[1] + begin, sums[2] + begin, sums[3] + begin});
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

template void direct_sum(const Charges<float>&, const Strided<Vec3f>&, std::span<PotentialAt<float>>,
                         Threads);
template void direct_sum(const Charges<double>&, const Strided<Vec3d>&, std::span<PotentialAt<double>>,
                         Threads);

}  // namespace hedgerow
