/// Winding numbers by expansion: the terms of a node's children, and the angles of a leaf's triangles.
#if defined(HEDGEROW_ENGINE_WINDING_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef HEDGEROW_ENGINE_WINDING_INL_H
#undef HEDGEROW_ENGINE_WINDING_INL_H
#else
#define HEDGEROW_ENGINE_WINDING_INL_H
#endif

#include <cstddef>
#include <cstdint>
#include <limits>
#include <type_traits>

#include <hwy/highway.h>

#include <hedgerow/engine/kernels.h>
#include <hedgerow/engine/winding_walk.h>
#include <hedgerow/queries/half_angles.h>
#include <hedgerow/queries/winding_terms.h>

#include "boxes-inl.h"
#include "compiled.h"
#include "coordinates-inl.h"

HWY_BEFORE_NAMESPACE();
namespace hedgerow::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

// Calls f with each number from begin to end − 1 as a constant.
template <int begin, int end, class F>
HWY_INLINE void for_each_constant(F f) {
    if constexpr (begin < end) {
        f(std::integral_constant<int, begin>());
        for_each_constant<begin + 1, end>(f);
    }
}

// Does what `WindingRow::expanded` does, for a vector of children: the same operations in the same order.
// `row` is the place of the first of them, and `width` the length of a row.
template <class D, int width>
struct Expanded {
    using V = hn::Vec<D>;
    V value, error;

    HWY_INLINE Expanded(D d, const double* row, const Coordinates<D>& x) {
        const auto get = [&](int k) __attribute__((always_inline)) {
            return hn::LoadU(d, row + k * width);
        };
        const V one = hn::Set(d, 1.0);
        const Coordinates<D> offset =
            minus(x, Coordinates<D>{get(WindingRow::center), get(WindingRow::center + 1),
                                    get(WindingRow::center + 2)});
        const V u = hn::Div(one, hn::Sqrt(product(offset, offset))), s = hn::Mul(get(WindingRow::radius), u);
        const Coordinates<D> e = times(offset, hn::Mul(s, u));
        const V s2 = hn::Mul(s, s), s4 = hn::Mul(s2, s2);
        value = hn::Mul(summed_up(d, row, e, s2), u);
        const V norms =
            hn::Add(get(WindingRow::norms),
                    hn::Mul(s, hn::Add(get(WindingRow::norms + 1), hn::Mul(s, get(WindingRow::norms + 2)))));
        const V near = hn::Mul(hn::Mul(s4, s), norms);
        const V rest = hn::Mul(hn::Mul(get(WindingRow::tail), hn::Mul(s4, s4)),
                               hn::Sub(hn::Set(d, 9.0), hn::Mul(hn::Set(d, 8.0), s)));
        const V left = hn::Sub(one, s);
        const V far = hn::Div(hn::Add(rest, get(WindingRow::roundings)), hn::Mul(left, left));
        error = hn::IfThenElse(hn::Lt(s, hn::Set(d, WindingRow::nearest)),
                               hn::Mul(hn::Mul(u, u), hn::Add(near, far)),
                               hn::Set(d, std::numeric_limits<double>::infinity()));
    }

private:
    static HWY_INLINE V summed_up(D d, const double* row, const Coordinates<D>& e, V s2) {
        constexpr int summed = WindingRow::summed;
        V sum = hn::Zero(d), cosine = hn::Set(d, 1.0), sine = hn::Zero(d);
        const double* next = row + WindingRow::coefficients * width;
        const auto read = [&]() __attribute__((always_inline)) {
            const V x = hn::LoadU(d, next);
            next += width;
            return x;
        };
        for_each_constant<0, summed + 1>([&](auto order) __attribute__((always_inline)) {
            constexpr int m = order;
            V before = hn::Zero(d), p = hn::Set(d, 1.0), of_cosine = hn::Zero(d), of_sine = hn::Zero(d);
            for_each_constant<m, summed + 1>([&](auto degree) __attribute__((always_inline)) {
                constexpr int n = degree;
                if constexpr (n > 0) of_cosine = hn::Add(of_cosine, hn::Mul(read(), p));
                if constexpr (m > 0) of_sine = hn::Add(of_sine, hn::Mul(read(), p));
                V after = hn::Mul(e.z, p);
                if constexpr (n > m)
                    after = hn::Sub(after, hn::Mul(hn::Mul(hn::Set(d, WindingRow::step(n, m)), s2), before));
                before = p, p = after;
            });
            if constexpr (m == 0)
                sum = hn::Add(sum, of_cosine);
            else
                sum = hn::Add(sum, hn::Add(hn::Mul(cosine, of_cosine), hn::Mul(sine, of_sine)));
            const V turned = hn::Sub(hn::Mul(e.x, cosine), hn::Mul(e.y, sine));
            sine = hn::Add(hn::Mul(e.x, sine), hn::Mul(e.y, cosine));
            cosine = turned;
        });
        return sum;
    }
};

// Does what HalfAngles does, for the triangles of a block at once.
class HalfAnglesOfBlocks {
public:
    HWY_INLINE HalfAnglesOfBlocks(const Vec<double, 3>& point, double scale) : point_(point), scale_(scale) {}

    HWY_INLINE void add(const TriangleBlock<float>& block, int count) {
        const Coordinates<D> x = all_lanes(d, point_);
        const V scale = hn::Set(d, scale_);
        for (int i = 0; i < count; i += lanes) {
            const auto corner = [&](int c) __attribute__((always_inline)) {
                const auto row = [&](int axis) __attribute__((always_inline)) {
                    return hn::PromoteTo(d, hn::Load(f, block.corner[axis][c] + i));
                };
                return times(minus(Coordinates<D>{row(0), row(1), row(2)}, x), scale);
            };
            add(block, i, hn::FirstN(d, static_cast<std::size_t>(count - i)), corner(0), corner(1),
                corner(2));
        }
    }
    double turns() const { return HalfAngles::turns(re_, im_, turns_); }

private:
    using D = hn::CappedTag<double, HalfAngles::count>;
    using V = hn::Vec<D>;
    static constexpr D d{};
    static constexpr hn::Rebind<float, D> f{};
    static constexpr int lanes = static_cast<int>(hn::MaxLanes(d));

    HWY_INLINE void add(const TriangleBlock<float>& block, int i, hn::Mask<D> there, const Coordinates<D>& a,
                        const Coordinates<D>& b, const Coordinates<D>& c) {
        const V la = hn::Sqrt(product(a, a)), lb = hn::Sqrt(product(b, b)), lc = hn::Sqrt(product(c, c));
        const V size = hn::Mul(hn::Mul(la, lb), lc), zero = hn::Zero(d);
        V real = hn::Add(hn::Add(hn::Add(size, hn::Mul(product(a, b), lc)), hn::Mul(product(b, c), la)),
                         hn::Mul(product(c, a), lb));
        V imaginary = product(a, cross(b, c));
        const auto doubt = hn::And(
            there,
            hn::Or(
                hn::And(hn::Lt(real, zero), hn::Le(hn::Abs(imaginary), hn::Mul(hn::Set(d, 0x1p-46), size))),
                hn::Not(hn::Gt(hn::Add(hn::Abs(real), hn::Abs(imaginary)), hn::Set(d, HalfAngles::least)))));
        if (!hn::AllFalse(d, doubt)) settle(block, i, bits_of(d, doubt), size, real, imaginary);
        // The products of both.
        const V re = hn::Load(d, re_ + i), im = hn::Load(d, im_ + i);
        const V next_re = hn::Sub(hn::Mul(re, real), hn::Mul(im, imaginary));
        const V next_im = hn::Add(hn::Mul(re, imaginary), hn::Mul(im, real));
        const auto up = hn::Ge(im, zero), too = hn::Ge(imaginary, zero), now = hn::Ge(next_im, zero);
        const auto turned = hn::And(there, hn::AndNot(hn::Xor(up, too), hn::Xor(up, now)));
        const V turn = hn::IfThenElse(up, hn::Set(d, 1.0), hn::Set(d, -1.0));
        hn::Store(hn::Add(hn::Load(d, turns_ + i), hn::IfThenElseZero(turned, turn)), d, turns_ + i);
        const V per_magnitude = hn::Div(hn::Set(d, 1.0), hn::Add(hn::Abs(next_re), hn::Abs(next_im)));
        hn::Store(hn::IfThenElse(there, hn::Mul(next_re, per_magnitude), re), d, re_ + i);
        hn::Store(hn::IfThenElse(there, hn::Mul(next_im, per_magnitude), im), d, im_ + i);
    }
    static HWY_INLINE Coordinates<D> cross(const Coordinates<D>& a, const Coordinates<D>& b) {
        return {hn::Sub(hn::Mul(a.y, b.z), hn::Mul(a.z, b.y)), hn::Sub(hn::Mul(a.z, b.x), hn::Mul(a.x, b.z)),
                hn::Sub(hn::Mul(a.x, b.y), hn::Mul(a.y, b.x))};
    }
    HWY_NOINLINE void settle(const TriangleBlock<float>& block, int first, unsigned places, V size, V& real,
                             V& imaginary) const {
        alignas(64) double sizes[lanes], reals[lanes], imaginaries[lanes];
        hn::Store(size, d, sizes), hn::Store(real, d, reals), hn::Store(imaginary, d, imaginaries);
        for (; places != 0; places &= places - 1) {
            const int i = std::countr_zero(places);
            const HalfAngle h =
                detail::settled_half_angle({reals[i], imaginaries[i]}, sizes[i], block, first + i, point_);
            reals[i] = h.real, imaginaries[i] = h.imaginary;
        }
        real = hn::Load(d, reals), imaginary = hn::Load(d, imaginaries);
    }

    alignas(64) double re_[HalfAngles::count] = {1, 1, 1, 1, 1, 1, 1, 1};
    alignas(64) double im_[HalfAngles::count] = {};
    alignas(64) double turns_[HalfAngles::count] = {};
    Vec<double, 3> point_;
    double scale_;
};

// Does what PlainWindings does, in a tree of nodes of W children.
template <int W>
class Windings {
public:
    HWY_INLINE Windings(const WideExpansion& all, const WindingQuery& query)
        : all_(all), terms_(query.terms), x_(query.scaled), angles_(query.point, query.to_unit) {}

    HWY_NOINLINE unsigned expand(std::uint32_t node, std::size_t row, double threshold, double& sum) {
        const double* const rows = all_.rows + std::size_t(W) * WindingRow::count * node;
        const Coordinates<D> x = all_lanes(d, x_);
        const V most = hn::Set(d, threshold);
        const int children = all_.tree.nodes.children(node);
        V errors[parts];
        unsigned opened = 0;
        for (int p = 0; p < parts; ++p) {
            const Expanded<D, W> term(d, rows + p * lanes, x);
            const auto there =
                hn::FirstN(d, static_cast<std::size_t>(children > p * lanes ? children - p * lanes : 0));
            const auto kept = hn::And(there, hn::Le(term.error, most));
            opened |= bits_of(d, hn::AndNot(kept, there)) << (p * lanes);
            errors[p] = hn::IfThenElseZero(kept, term.error);
            hn::Store(errors[p], d, terms_.errors + row * W + p * lanes);
            hn::Store(hn::IfThenElseZero(kept, term.value), d, terms_.values + row * W + p * lanes);
        }
        sum += sum_of(errors);
        return opened;
    }
    HWY_NOINLINE unsigned open(std::size_t row, double threshold, double& sum) {
        const V most = hn::Set(d, threshold);
        V errors[parts];
        hn::Mask<D> large[parts];
        unsigned opened = 0;
        for (int p = 0; p < parts; ++p) {
            errors[p] = hn::Load(d, terms_.errors + row * W + p * lanes);
            large[p] = hn::Gt(errors[p], most);
            opened |= bits_of(d, large[p]) << (p * lanes);
        }
        if (opened == 0) return 0;
        for (int p = 0; p < parts; ++p) {
            double *const at = terms_.errors + row * W + p * lanes, *const values =
                                                                        terms_.values + row * W + p * lanes;
            hn::Store(hn::IfThenZeroElse(large[p], errors[p]), d, at);
            hn::Store(hn::IfThenZeroElse(large[p], hn::Load(d, values)), d, values);
            errors[p] = hn::IfThenElseZero(large[p], errors[p]);
        }
        sum -= sum_of(errors);
        return opened;
    }
    HWY_NOINLINE double add_leaf(std::uint32_t block, std::uint32_t count) {
        if (all_.blocks == nullptr) return all_.leaves.add(all_.leaves.sum, block, count);
        angles_.add(all_.blocks[block], static_cast<int>(count));
        return count * HalfAngles::rounding;
    }
    HWY_NOINLINE double total(std::size_t rows) const {
        V sums[parts];
        for (int p = 0; p < parts; ++p) sums[p] = hn::Zero(d);
        for (std::size_t row = 0; row < rows; ++row)
            for (int p = 0; p < parts; ++p)
                sums[p] = hn::Add(sums[p], hn::Load(d, terms_.values + row * W + p * lanes));
        return sum_of(sums) + angles_.turns();
    }

private:
    using D = hn::CappedTag<double, W>;
    using V = hn::Vec<D>;
    static constexpr D d{};
    static constexpr int lanes = static_cast<int>(hn::MaxLanes(d)), parts = W / lanes;

    // The sum of a row, by halves.
    static HWY_INLINE double sum_of(V* parts_of_row) {
        for (int half = parts / 2; half > 0; half /= 2)
            for (int p = 0; p < half; ++p) parts_of_row[p] = hn::Add(parts_of_row[p], parts_of_row[p + half]);
        alignas(64) double sums[lanes];
        hn::Store(parts_of_row[0], d, sums);
        for (int half = lanes / 2; half > 0; half /= 2)
            for (int i = 0; i < half; ++i) sums[i] += sums[i + half];
        return sums[0];
    }

    const WideExpansion& all_;
    WindingTerms terms_;
    Vec<double, 3> x_;
    HalfAnglesOfBlocks angles_;
};

template <int W>
struct WindingNumber {
    static double answer(const WideExpansion& all, const WindingQuery* query) {
        Windings<W> windings(all, *query);
        const NoVisits count;
        return windings.total(sum_windings(all.tree, windings, query->error, query->terms, count));
    }
};

}  // namespace hedgerow::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
