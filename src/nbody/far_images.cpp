/// What far images do: by kernels, or by the operators as they are described.
#include "far_images.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <hedgerow/nbody/kernels.h>
#include <hedgerow/nbody/operators.h>

#include "lattice_sums.h"
#include "packed.h"

namespace hedgerow::detail {
namespace {

static_assert(most_far_order + 1 <= most_order_at_run_time);
constexpr std::size_t piece = 256, task = 16 * piece;
constexpr double third = 2 * std::numbers::pi / 3;

template <int order>
Harmonics<double, order> unpacked(const double* packed, int degrees) {
    Harmonics<double, order> all;
    for (int n = 0; n <= degrees; ++n)
        for (int m = 0; m <= n; ++m) {
            all.re[all.at(n, m)] = packed[re(n, m)];
            all.im[all.at(n, m)] = m > 0 ? packed[im(n, m)] : 0;
        }
    return all;
}

// As the kernels of that name, without vectors.
void add_multipole(const ChargeRows<double>& charges, int order, double* multipole) {
    for (std::size_t i = 0; i < charges.count; ++i)
        for_each_regular<most_far_order>(Vec3d(charges.x[i], charges.y[i], charges.z[i]),
                                         [&](int n, int m, Complex<double> x) {
                                             if (n > order) return;
                                             multipole[re(n, m)] += charges.charge[i] * x.re;
                                             if (m > 0) multipole[im(n, m)] += charges.charge[i] * x.im;
                                         });
}
void add_packed_local(const double* packed, int order, const TargetRows<double>& targets) {
    const auto local = unpacked<most_far_order + 1>(packed, order);
    for (std::size_t i = 0; i < targets.count; ++i) {
        const auto at = l2p(local, Vec3d(targets.x[i], targets.y[i], targets.z[i]));
        targets.potential[i] += at.potential;
        targets.gx[i] += at.gradient[0], targets.gy[i] += at.gradient[1], targets.gz[i] += at.gradient[2];
    }
}

// L(k, l) = (−1)ᵏ · Σ conj M(n, m) · Λ(n + k, m + l), with the sums Λ over the lattice for S.
std::vector<double> converted(const std::vector<double>& packed, int order) {
    const auto multipole = unpacked<most_far_order>(packed.data(), order);
    const auto sums = far_lattice_sums();
    std::vector<double> local(std::size_t(packed_count(order + 1)));
    for (int k = 0; k <= order + 1; ++k)
        for (int l = 0; l <= k; ++l) {
            Complex<double> sum{0, 0};
            for (int n = k % 2; n <= order; n += 2)
                for (int m = -n; m <= n; ++m)
                    if ((m + l) % 4 == 0 && std::abs(m + l) <= n + k)
                        sum = sum + sums[Harmonics<double, 0>::at(n + k, std::abs(m + l))] *
                                        conj(harmonic(multipole, n, m));
            const double sign = k % 2 == 0 ? 1 : -1;
            local[std::size_t(re(k, l))] = sign * sum.re;
            if (l > 0) local[std::size_t(im(k, l))] = sign * sum.im;
        }
    return local;
}

/// A piece of the rows, in units of the side, from the middle of the cube.
struct Piece {
    alignas(64) std::array<double, piece> x{}, y{}, z{}, charge{}, potential{}, gx{}, gy{}, gz{};
    std::size_t first, count;

    Piece(const PlaceRows& places, std::size_t begin, double side, const Vec3d& middle)
        : first(begin), count(std::min(piece, places.count - begin)) {
        for (std::size_t i = 0; i < count; ++i) {
            x[i] = (places.x[first + i] - middle[0]) / side;
            y[i] = (places.y[first + i] - middle[1]) / side;
            z[i] = (places.z[first + i] - middle[2]) / side;
        }
    }
    Vec3d place(std::size_t i) const { return {x[i], y[i], z[i]}; }
};

}  // namespace

std::vector<Vec3d> near_image_places(double side) {
    std::vector<Vec3d> places;
    for (int x = -near_images; x <= near_images; ++x)
        for (int y = -near_images; y <= near_images; ++y)
            for (int z = -near_images; z <= near_images; ++z) places.push_back(Vec3d(x, y, z) * side);
    return places;
}

int far_order(double accuracy) {
    return std::clamp(4 + static_cast<int>(std::ceil(-1.5 * std::log10(accuracy))), 5, most_far_order);
}

template <class R>
FarImages::FarImages(double side, const Vec3d& middle, int order, const PlaceRows& places, const R* charges,
                     Executor& executor)
    : side_(side), middle_(middle), order_(order) {
    // A multipole of each task, then their sum by a tree: the same bits for any number of threads, and for
    // any way to share the tasks.
    const NbodyKernels* const kernels = in_use<NbodyKernels>();
    const auto add = kernels != nullptr ? kernels->add_multipole : add_multipole;
    const std::size_t stride = std::size_t(packed_count(order)) + 1, tasks = (places.count + task - 1) / task;
    std::vector<double> all(tasks * stride);
    executor.for_each_piece(tasks, 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin * task; i < std::min(places.count, end * task); i += piece) {
            Piece here(places, i, side_, middle_);
            std::copy_n(charges + i, here.count, here.charge.begin());
            double* const of_task = all.data() + i / task * stride;
            add({here.x.data(), here.y.data(), here.z.data(), here.charge.data(), here.count}, order,
                of_task);
            for (std::size_t k = 0; k < here.count; ++k)
                of_task[stride - 1] += here.charge[k] * length2(here.place(k));
        }
    });
    for (std::size_t apart = 1; apart < tasks; apart *= 2)
        for (std::size_t i = 0; i + apart < tasks; i += 2 * apart)
            for (std::size_t k = 0; k < stride; ++k) all[i * stride + k] += all[(i + apart) * stride + k];
    std::vector<double> multipole(stride);
    if (tasks > 0) std::copy_n(all.begin(), stride, multipole.begin());
    const double second = multipole.back();  // Σ q·|y|²
    multipole.pop_back();
    local_ = converted(multipole, order);
    // R(1, 0) = z, R(1, 1) = (x + iy)/2.
    charge_ = multipole[0];
    dipole_ = {2 * multipole[std::size_t(re(1, 1))], 2 * multipole[std::size_t(im(1, 1))],
               multipole[std::size_t(re(1, 0))]};
    local_[0] += third * second;
}

void FarImages::act(const TargetRows<double>& targets, Executor& executor) const {
    const NbodyKernels* const kernels = in_use<NbodyKernels>();
    const AddLocal add = kernels != nullptr ? kernels->add_local : add_packed_local;
    const PlaceRows places{targets.x, targets.y, targets.z, targets.count};
    executor.for_each_piece((places.count + piece - 1) / piece, 4, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin * piece; i < std::min(places.count, end * piece); i += piece) {
            Piece here(places, i, side_, middle_);
            const TargetRows<double> rows{here.x.data(),  here.y.data(),         here.z.data(),
                                          here.count,     here.potential.data(), here.gx.data(),
                                          here.gy.data(), here.gz.data()};
            add(local_.data(), order_ + 1, rows);
            const double of_potential = 1 / side_, of_gradient = of_potential / side_;
            for (std::size_t k = 0; k < here.count; ++k) {
                // The even charge: 2π/3 · Σ q·|x − y|².
                const Vec3d x = here.place(k), slope = (x * charge_ - dipole_) * (2 * third);
                const double potential = third * (charge_ * length2(x) - 2 * dot(x, dipole_));
                const std::size_t t = i + k;
                targets.potential[t] += (here.potential[k] + potential) * of_potential;
                targets.gx[t] += (here.gx[k] + slope[0]) * of_gradient;
                targets.gy[t] += (here.gy[k] + slope[1]) * of_gradient;
                targets.gz[t] += (here.gz[k] + slope[2]) * of_gradient;
            }
        }
    });
}

void FarImages::bend(const PlaceRows& places, const TideRows& tides, Executor& executor) const {
    const NbodyKernels* const kernels = in_use<NbodyKernels>();
    const AddLocal add = kernels != nullptr ? kernels->add_local : add_packed_local;
    const double unit = 1 / (side_ * side_ * side_), even = 2 * third * charge_ * unit;
    executor.for_each_piece((places.count + piece - 1) / piece, 4, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin * piece; i < std::min(places.count, end * piece); i += piece) {
            const Piece here(places, i, side_, middle_);
            const TideRows rows = tides.from(i);
            add_local_tides(local_.data(), order_ + 1, here.x.data(), here.y.data(), here.z.data(),
                            here.count, unit, add, rows);
            for (std::size_t k = 0; k < here.count; ++k) rows.add(k, {even, even, even, 0, 0, 0});
        }
    });
}

template FarImages::FarImages(double, const Vec3d&, int, const PlaceRows&, const float*, Executor&);
template FarImages::FarImages(double, const Vec3d&, int, const PlaceRows&, const double*, Executor&);

}  // namespace hedgerow::detail
