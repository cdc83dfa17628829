/// What charges of near leaves do to the targets of a leaf, pair by pair: gathered in rows, as offsets from
/// the center of the leaf; where roundings may have done too much, summed again of the places as they are
/// given (docs/design/046-near-pairs.md).
#if defined(HEDGEROW_NBODY_NEAR_PAIRS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef HEDGEROW_NBODY_NEAR_PAIRS_INL_H
#undef HEDGEROW_NBODY_NEAR_PAIRS_INL_H
#else
#define HEDGEROW_NBODY_NEAR_PAIRS_INL_H
#endif

#include <algorithm>
#include <cmath>
#include <limits>

#include <hedgerow/geometry/elementary_parts.h>

#include "cells.h"
#include "direct-inl.h"
#include "plain_pairs.h"
#include "runs.h"
#include "tides-inl.h"

HWY_BEFORE_NAMESPACE();
namespace hedgerow::HWY_NAMESPACE {

// Charges or targets in rows of P, in the unit of a leaf's expansion: where they are, or as offsets of type T
// from its center.
template <class T, class P, Pairs by>
struct PairRows {
    static constexpr bool in_two_parts = by != Pairs::plain;
    BareVector<P> place[3], low[3], charge, soft;

    void make_room(std::size_t count) {
        const auto grow = [&](BareVector<P>& row) {
            if (row.size() < count + row_padding) row.resize(2 * count + row_padding);
        };
        for (int k = 0; k < 3; ++k) {
            grow(place[k]);
            if (in_two_parts) grow(low[k]);
        }
        grow(charge), grow(soft);
    }
    // Writes an axis' offsets from number `at` on; offset(i) tells them.
    template <class G>
    void put(int axis, std::size_t at, std::size_t count, G offset) {
        P* const high = place[axis].data() + at;
        if constexpr (by == Pairs::split) {
            // Differences of first parts are exact: these are multiples of 2⁻¹¹.
            constexpr T grid = 2048;
            P* const rest = low[axis].data() + at;
            for (std::size_t i = 0; i < count; ++i) {
                const T x = offset(i), part = std::nearbyint(x * grid) / grid;
                high[i] = static_cast<P>(part), rest[i] = static_cast<P>(x - part);
            }
        } else {
            for (std::size_t i = 0; i < count; ++i) high[i] = static_cast<P>(offset(i));
        }
    }
    // Pads the rows from number `at` on.
    void close(std::size_t at, double beyond) {
        for (int k = 0; k < 3; ++k) {
            std::fill_n(place[k].data() + at, row_padding, P(beyond));
            if (in_two_parts) std::fill_n(low[k].data() + at, row_padding, P(0));
        }
        std::fill_n(charge.data() + at, row_padding, P(0));
        std::fill_n(soft.data() + at, row_padding, P(0));
    }
};

// The pairs of one leaf of targets after the other. The targets may be the sources themselves.
template <class T>
class NearPairs {
    // Offsets are in two parts where P is less precise than T.
    template <class P>
    using Offsets = PairRows<T, P, std::is_same_v<P, T> ? Pairs::plain : Pairs::split>;
    using Exact = PairRows<T, double, Pairs::exact>;

public:
    // Of the leaf in hand: the leaves that act by pairs, and cells that act as single charges.
    std::vector<FmmSource> near;
    std::vector<std::uint32_t> single;

    NearPairs(const FmmCells<T>& sources, FmmCells<T>& targets) : sources_(sources), targets_(targets) {}

    // Takes a leaf in hand.
    void take(std::uint32_t leaf) {
        leaf_ = leaf, first_ = targets_.first[leaf], count_ = targets_.count[leaf];
        per_unit_ = 1 / targets_.scale[leaf];
        place_targets(targets_in_);
    }
    // Its targets, as offsets from its center in the unit of its expansion.
    const Offsets<T>& targets() const { return targets_in_; }

    // Adds what is summed over pairs to the potentials and gradients that the targets have. Where roundings
    // may have made errors beyond what is allowed, as they do in close pairs, pairs are summed again.
    void add() {
        if (!sources_.pairs_in_float) {
            sum(gather(sources_in_), sources_in_, targets_in_);
        } else if constexpr (!std::is_same_v<T, float>) {
            place_targets(float_targets_);
            sum(gather(float_sources_), float_sources_, float_targets_);
        }
        const double unit2 = static_cast<double>(per_unit_) * static_cast<double>(per_unit_),
                     rounding = sources_.pairs_in_float ? rounding_of_pairs<float> : rounding_of_pairs<T>,
                     least = targets_.share_of_tolerance * static_cast<double>(targets_.tolerance[leaf_]);
        constexpr double infinity = std::numeric_limits<double>::infinity();
        doubtful_.clear();
        for (std::size_t i = 0; i < count_; ++i) {
            const double error = rounding * unit2 * std::sqrt(squares()[i]),
                         allowed =
                             HWY_MAX(targets_.share_of_gradient * length(gradient_with_pairs(i)), least);
            if (error < infinity && error <= allowed)
                add_sums(i);
            else
                doubtful_.push_back(i);
        }
        if (doubtful_.empty()) return;
        sum_exactly(direct<double, Pairs::exact>);
        const auto good = [&](std::size_t i) {
            const bool finite = squares()[i] < infinity;
            if (finite) add_sums(i);
            return finite;
        };
        doubtful_.erase(std::remove_if(doubtful_.begin(), doubtful_.end(), good), doubtful_.end());
        if (doubtful_.empty()) return;
        sum_exactly(detail::direct_plain<double>);
        for (const std::size_t i : doubtful_) add_sums(i);
    }
    // Tidal tensors summed over pairs, in the unit of the leaf's expansion.
    detail::TideRows tides() {
        const std::size_t charges = place_exactly();
        sums_.assign(HWY_MAX(6 * count_, 5 * stride()), 0.0);
        const detail::TideRows found(sums_.data(), count_);
        direct_tides(rows_of(exact_sources_, charges), rows_at(exact_targets_, 0, count_), sources_.softening,
                     found);
        return found;
    }

private:
    std::size_t stride() const { return count_ + row_padding; }
    const double* squares() const { return sums_.data() + 4 * stride(); }

    template <class AnyRows>
    void place_targets(AnyRows& rows) const {
        rows.make_room(count_);
        const T* const offsets[] = {targets_.dx.data() + first_, targets_.dy.data() + first_,
                                    targets_.dz.data() + first_};
        for (int k = 0; k < 3; ++k)
            rows.put(k, 0, count_, [&](std::size_t i) { return offsets[k][i] * per_unit_; });
        close_targets(rows);
    }
    template <class AnyRows>
    void close_targets(AnyRows& rows) const {
        using P = std::remove_cvref_t<decltype(rows.soft[0])>;
        if (!sources_.soft.empty())
            for (std::size_t i = 0; i < count_; ++i)
                rows.soft[i] = static_cast<P>(targets_.soft[first_ + i] * per_unit_);
        rows.close(count_, beyond_rows);
    }
    // Gathers the charges as offsets from the center of the leaf, computed as those of targets are. Returns
    // how many they are.
    template <class AnyRows>
    std::size_t gather(AnyRows& rows) {
        const double center[] = {targets_.cx[leaf_], targets_.cy[leaf_], targets_.cz[leaf_]};
        return gather(rows,
                      [&](int axis, std::size_t at, std::size_t count, const double* places, double shift) {
                          rows.put(axis, at, count, [&](std::size_t i) {
                              return static_cast<T>(places[i] - center[axis] + shift) * per_unit_;
                          });
                      });
    }
    // put(axis, at, count, places, shift) writes an axis' numbers of some charges from number `at` on.
    template <class AnyRows, class Put>
    std::size_t gather(AnyRows& rows, Put put) {
        using P = std::remove_cvref_t<decltype(rows.soft[0])>;
        std::size_t charges = single.size();
        for (const FmmSource cell : near) charges += sources_.count[cell.cell()];
        rows.make_room(charges);
        std::size_t at = 0;
        self_ = no_self;
        for (const FmmSource cell : near) {
            if (&sources_ == &targets_ && cell == sources_.itself(leaf_)) self_ = at;
            const std::size_t first = sources_.first[cell.cell()], count = sources_.count[cell.cell()];
            const Vec3d& shift = sources_.images[cell.image()];
            const double* const places[] = {sources_.x.data() + first, sources_.y.data() + first,
                                            sources_.z.data() + first};
            for (int k = 0; k < 3; ++k) put(k, at, count, places[k], shift[k]);
            for (std::size_t i = 0; i < count; ++i)
                rows.charge[at + i] = static_cast<P>(sources_.charge[first + i]);
            if (!sources_.soft.empty())
                for (std::size_t i = 0; i < count; ++i)
                    rows.soft[at + i] = static_cast<P>(sources_.soft[first + i] * per_unit_);
            at += count;
        }
        for (const std::uint32_t cell : single) {
            const double* const places[] = {&sources_.cx[cell], &sources_.cy[cell], &sources_.cz[cell]};
            for (int k = 0; k < 3; ++k) put(k, at, 1, places[k], 0);
            rows.charge[at] = static_cast<P>(sources_.multipoles[cell * sources_.multipole_stride]);
            rows.soft[at] = 0, ++at;
        }
        rows.close(at, -beyond_rows);
        return charges;
    }
    // Gathers charges and targets where they are, without the roundings of an offset, in two parts.
    std::size_t place_exactly() {
        const double per_unit = static_cast<double>(per_unit_);
        const auto put = [&](Exact& rows, int axis, std::size_t at, std::size_t count, const double* places,
                             double shift) {
            for (std::size_t i = 0; i < count; ++i) {
                const auto moved = detail::two_sum(places[i], shift);
                rows.place[axis][at + i] = moved.high * per_unit;
                rows.low[axis][at + i] = moved.low * per_unit;
            }
        };
        exact_targets_.make_room(count_);
        const double* const places[] = {targets_.x.data() + first_, targets_.y.data() + first_,
                                        targets_.z.data() + first_};
        for (int k = 0; k < 3; ++k) put(exact_targets_, k, 0, count_, places[k], 0);
        close_targets(exact_targets_);
        return gather(exact_sources_,
                      [&](int axis, std::size_t at, std::size_t count, const double* of_axis, double shift) {
                          put(exact_sources_, axis, at, count, of_axis, shift);
                      });
    }

    template <class P, Pairs by>
    ChargeRows<P> rows_of(const PairRows<T, P, by>& from, std::size_t charges) const {
        return {from.place[0].data(),
                from.place[1].data(),
                from.place[2].data(),
                from.charge.data(),
                charges,
                sources_.soft.empty() ? nullptr : from.soft.data(),
                from.low[0].data(),
                from.low[1].data(),
                from.low[2].data()};
    }
    // Targets from number `first` on.
    template <class P, Pairs by>
    TargetRows<P> rows_at(const PairRows<T, P, by>& at, std::size_t first, std::size_t count) {
        double* const sums = sums_.data() + first;
        return {at.place[0].data() + first,
                at.place[1].data() + first,
                at.place[2].data() + first,
                count,
                sums,
                sums + stride(),
                sums + 2 * stride(),
                sums + 3 * stride(),
                sources_.soft.empty() ? nullptr : at.soft.data() + first,
                at.low[0].data() + first,
                at.low[1].data() + first,
                at.low[2].data() + first,
                sums + 4 * stride(),
                self_ == no_self ? no_self : self_ + first};
    }
    template <class P, Pairs by>
    void sum(std::size_t charges, const PairRows<T, P, by>& from, const PairRows<T, P, by>& at) {
        sums_.assign(5 * stride(), 0.0);
        direct<P, by>(rows_of(from, charges), rows_at(at, 0, count_), sources_.softening);
    }
    // Sums again at doubtful targets.
    void sum_exactly(DirectKernel<double> kernel) {
        const std::size_t charges = place_exactly();
        for (const std::size_t i : doubtful_)
            for (std::size_t k = 0; k < 5; ++k) sums_[k * stride() + i] = 0;
        detail::for_each_run(doubtful_, [&](std::size_t first, std::size_t count) {
            kernel(rows_of(exact_sources_, charges), rows_at(exact_targets_, first, count),
                   sources_.softening);
        });
    }
    Vec3d gradient_with_pairs(std::size_t i) const {
        const double per_unit = static_cast<double>(per_unit_);
        const std::size_t t = first_ + i;
        return Vec3d(targets_.gx[t], targets_.gy[t], targets_.gz[t]) +
               Vec3d(sums_[stride() + i], sums_[2 * stride() + i], sums_[3 * stride() + i]) *
                   (per_unit * per_unit);
    }
    void add_sums(std::size_t i) {
        const Vec3d gradient = gradient_with_pairs(i);
        const std::size_t t = first_ + i;
        targets_.potential[t] += sums_[i] * static_cast<double>(per_unit_);
        targets_.gx[t] = gradient[0], targets_.gy[t] = gradient[1], targets_.gz[t] = gradient[2];
    }

    const FmmCells<T>& sources_;
    FmmCells<T>& targets_;
    // The leaf in hand, its first target and how many they are, and the inverse of the unit.
    std::uint32_t leaf_ = 0;
    std::size_t first_ = 0, count_ = 0;
    T per_unit_ = 1;
    Offsets<T> sources_in_, targets_in_;
    Offsets<float> float_sources_, float_targets_;
    Exact exact_sources_, exact_targets_;
    std::size_t self_ = no_self;         // the first of the targets' own rows among sources
    std::vector<double> sums_;           // potentials, gradients and `squares` of pairs
    std::vector<std::size_t> doubtful_;  // targets
};

}  // namespace hedgerow::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
