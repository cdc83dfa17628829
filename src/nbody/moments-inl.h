/// Centers, radii and multipoles of cells, from the leaves up.
#if defined(HEDGEROW_NBODY_MOMENTS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef HEDGEROW_NBODY_MOMENTS_INL_H
#undef HEDGEROW_NBODY_MOMENTS_INL_H
#else
#define HEDGEROW_NBODY_MOMENTS_INL_H
#endif

#include <algorithm>
#include <cmath>
#include <limits>

#include <hedgerow/geometry/box.h>

#include "cells.h"
#include "shifts-inl.h"

HWY_BEFORE_NAMESPACE();
namespace hedgerow::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

// What |M(n, m)|² is multiplied by in the power of a degree, the root of the sum of (n − m)!(n + m)!·|M(n,
// m)|² over all m.
template <class T>
constexpr T power_weight(int n, int m) {
    return static_cast<T>(factorial(n - m) * factorial(n + m) * (m == 0 ? 1 : 2));
}

// What the kernels of an order share.
template <class T, int p>
struct Expansions {
    static constexpr int q = p + 1, of_multipole = packed_count(p), of_local = packed_count(q);
    static constexpr std::size_t stride = (of_multipole + 3) / 4 * 4;
    static constexpr std::uint32_t most_children = 8;
    using F = hn::ScalableTag<T>;
    using V = hn::Vec<F>;
    using Eight = hn::CappedTag<T, most_children>;
    using W = hn::Vec<Eight>;

    // The offsets of a cell's children from it in units of its scale, and their scales in that unit.
    struct Children {
        alignas(64) T x[most_children] = {}, y[most_children] = {}, z[most_children] = {},
                      scale[most_children];
        Children(const FmmCells<T>& cells, std::uint32_t c) {
            const T per_unit = 1 / cells.scale[c];
            std::fill_n(scale, most_children, T(1));
            for (std::uint32_t i = 0; i < cells.children[c]; ++i) {
                const std::uint32_t k = cells.child[c] + i;
                x[i] = static_cast<T>(cells.cx[k] - cells.cx[c]) * per_unit;
                y[i] = static_cast<T>(cells.cy[k] - cells.cy[c]) * per_unit;
                z[i] = static_cast<T>(cells.cz[k] - cells.cz[c]) * per_unit;
                scale[i] = cells.scale[k] * per_unit;
            }
        }
    };
    // Calls f(k, power) with the numbers of each degree n and the n-th power of a ratio.
    template <int order, class G>
    static HWY_INLINE void with_powers(W ratio, G g) {
        W power = hn::Set(Eight(), T(1));
        for (int n = 0; n <= order; ++n) {
            for (int k = n * n; k < (n + 1) * (n + 1); ++k) g(k, power);
            power = hn::Mul(power, ratio);
        }
    }
};

template <class T, int p>
class Moments {
    using E = Expansions<T, p>;
    using F = typename E::F;
    using V = typename E::V;
    using Eight = typename E::Eight;
    using W = typename E::W;
    static constexpr int q = E::q, of_multipole = E::of_multipole;

public:
    static void upward(FmmCells<T>& cells, std::uint32_t first, std::uint32_t end) {
        for (std::uint32_t c = first; c < end; ++c) {
            T* const multipole = cells.multipoles.data() + c * E::stride;
            if (cells.is_leaf(c))
                gather_points(cells, c, multipole);
            else
                gather_children(cells, c, multipole);
            // The multipole acts at most as one of all charges at this distance does, by its two highest
            // degrees.
            T reach = 0;
            for (int n = HWY_MAX(1, p - 1); n <= p; ++n) {
                T power2 = 0;
                for (int m = 0; m <= n; ++m) {
                    const T a = multipole[re(n, m)], b = m > 0 ? multipole[im(n, m)] : T(0);
                    power2 += power_weight<T>(n, m) * (a * a + b * b);
                }
                const T weight = cells.weight[c];
                if (weight > 0) reach = HWY_MAX(reach, std::pow(std::sqrt(power2) / weight, T(1) / T(n)));
            }
            cells.reach[c] = HWY_MIN(cells.radius[c], reach * cells.scale[c]);
        }
    }

private:
    // The unit of a radius, of which powers and inverses are numbers of T.
    static T power_of_two_of(T x) {
        constexpr int least = std::numeric_limits<T>::min_exponent + 26;
        return x > 0 ? std::ldexp(T(1), std::max(std::ilogb(x), least)) : T(1);
    }

    // Sets a leaf's center, radius and offsets of charges, and its multipole.
    static void gather_points(FmmCells<T>& cells, std::uint32_t c, T* multipole) {
        const std::size_t first = cells.first[c], end = first + cells.count[c];
        double weight = 0;
        Vec3d weighted;
        Box3d box;
        for (std::size_t i = first; i < end; ++i) {
            const double w = std::abs(static_cast<double>(cells.charge[i]));
            const Vec3d place(cells.x[i], cells.y[i], cells.z[i]);
            weighted = weighted + place * w, weight += w;
            box.expand(place);
        }
        // In the box in spite of roundings, so that charges in one place have no radius.
        const Vec3d center = weight > 0 ? min(max(weighted / weight, box.low), box.high) : box.center();
        cells.cx[c] = center[0], cells.cy[c] = center[1], cells.cz[c] = center[2];
        T radius2 = 0, softest = 0;
        for (std::size_t i = first; i < end; ++i) {
            const T dx = cells.dx[i] = static_cast<T>(cells.x[i] - cells.cx[c]);
            const T dy = cells.dy[i] = static_cast<T>(cells.y[i] - cells.cy[c]);
            const T dz = cells.dz[i] = static_cast<T>(cells.z[i] - cells.cz[c]);
            radius2 = HWY_MAX(radius2, dx * dx + dy * dy + dz * dz);
            if (!cells.soft.empty()) softest = HWY_MAX(softest, cells.soft[i]);
        }
        cells.softest[c] = softest;
        cells.radius[c] = std::sqrt(radius2) * T(1.00001);
        cells.weight[c] = static_cast<T>(weight);
        cells.scale[c] = power_of_two_of(cells.radius[c]);
        const F f;
        V sums[of_multipole];
        for (V& sum : sums) sum = hn::Zero(f);
        const V unit = hn::Set(f, 1 / cells.scale[c]);
        for (std::size_t i = first; i < end; i += hn::Lanes(f)) {
            // What follows the last point belongs to another cell, and perhaps to another thread.
            const auto row = [&](const BareVector<T>& all) HWY_ATTR {
                if (i + hn::Lanes(f) <= end) return hn::LoadU(f, all.data() + i);
                alignas(64) T last[HWY_MAX_BYTES / sizeof(T)] = {};
                std::copy(all.data() + i, all.data() + end, last);
                return hn::Load(f, last);
            };
            const V x = hn::Mul(unit, row(cells.dx)), y = hn::Mul(unit, row(cells.dy)),
                    z = hn::Mul(unit, row(cells.dz));
            expand_points<p>(f, row(cells.charge), x, y, z, sums);
        }
        for (int k = 0; k < of_multipole; ++k) multipole[k] = hn::GetLane(hn::SumOfLanes(f, sums[k]));
    }

    static void gather_children(FmmCells<T>& cells, std::uint32_t c, T* multipole) {
        const std::uint32_t first = cells.child[c], end = first + cells.children[c];
        double x = 0, y = 0, z = 0, weight = 0;
        for (std::uint32_t k = first; k < end; ++k) {
            const double w = static_cast<double>(cells.weight[k]);
            x += w * cells.cx[k], y += w * cells.cy[k], z += w * cells.cz[k], weight += w;
        }
        if (weight > 0) {
            cells.cx[c] = x / weight, cells.cy[c] = y / weight, cells.cz[c] = z / weight;
        } else {
            cells.cx[c] = cells.cx[first], cells.cy[c] = cells.cy[first], cells.cz[c] = cells.cz[first];
        }
        T radius = 0, softest = 0;
        for (std::uint32_t k = first; k < end; ++k) {
            const double dx = cells.cx[k] - cells.cx[c], dy = cells.cy[k] - cells.cy[c],
                         dz = cells.cz[k] - cells.cz[c];
            radius =
                HWY_MAX(radius, static_cast<T>(std::sqrt(dx * dx + dy * dy + dz * dz)) + cells.radius[k]);
            softest = HWY_MAX(softest, cells.softest[k]);
        }
        cells.radius[c] = radius * T(1.00001);
        cells.softest[c] = softest;
        cells.weight[c] = static_cast<T>(weight);
        cells.scale[c] = power_of_two_of(cells.radius[c]);
        // A child in one place has a multipole in any unit, but no unit of its own.
        for (std::uint32_t k = first; k < end; ++k)
            if (!(cells.radius[k] > 0)) cells.scale[k] = cells.scale[c];
        // Shift the children's multipoles here, a child a lane.
        const Eight f;
        const typename E::Children children(cells, c);
        alignas(64) T rows[of_multipole][E::most_children] = {};
        for (std::uint32_t i = 0; i < cells.children[c]; ++i)
            for (int k = 0; k < of_multipole; ++k)
                rows[k][i] = cells.multipoles[(first + i) * E::stride + std::size_t(k)];
        W sums[of_multipole];
        for (W& sum : sums) sum = hn::Zero(f);
        for (std::uint32_t i = 0; i < cells.children[c]; i += static_cast<std::uint32_t>(hn::Lanes(f))) {
            W part[of_multipole], shifted[of_multipole];
            E::template with_powers<p>(hn::Load(f, children.scale + i), [&](int k, W power) HWY_ATTR {
                part[k] = hn::Mul(power, hn::Load(f, rows[k] + i));
            });
            shift_multipoles<p>(f, part, hn::Load(f, children.x + i), hn::Load(f, children.y + i),
                                hn::Load(f, children.z + i), shifted);
            for (int k = 0; k < of_multipole; ++k) sums[k] = hn::Add(sums[k], shifted[k]);
        }
        for (int k = 0; k < of_multipole; ++k) multipole[k] = hn::GetLane(hn::SumOfLanes(f, sums[k]));
    }
};

}  // namespace hedgerow::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
