/// The fast multipole method over cells in rows: moments from the leaves up, then each target's walk down.
///
/// A target walks with the cells that are yet undecided against it, and hands to its children what it leaves
/// undecided, so no lists of pairs are stored. Of an undecided pair the larger cell is opened, by a rule of
/// the unordered pair, and the test of a pair is symmetric to the last bit: so what a does to b, b does to a,
/// though each is found by a walk of its own (dual walk: Dehnen 2002; all bits are the same for any number of
/// threads). The children of a cell lie side by side, and are tested at once against the other cell.
#if defined(HEDGEROW_NBODY_FMM_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef HEDGEROW_NBODY_FMM_INL_H
#undef HEDGEROW_NBODY_FMM_INL_H
#else
#define HEDGEROW_NBODY_FMM_INL_H
#endif

#include <algorithm>
#include <cmath>

#include <hedgerow/geometry/box.h>

#include "cells.h"
#include "direct-inl.h"
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

template <class T, int p>
class Fmm {
public:
    static constexpr int q = p + 1, of_multipole = packed_count(p), of_local = packed_count(q);
    static constexpr std::size_t stride = (of_multipole + 3) / 4 * 4;
    static constexpr std::uint32_t most_children = 8;
    // The sum of two radii over the distance of the centers stays below this: no estimate holds near 1.
    static constexpr double opening_angle = 0.8;
    using F = hn::ScalableTag<T>;
    using V = hn::Vec<F>;
    using Eight = hn::CappedTag<T, most_children>;
    using W = hn::Vec<Eight>;

    // ---- Upward

    static void upward(FmmCells<T>& cells, std::uint32_t first, std::uint32_t end) {
        for (std::uint32_t c = first; c < end; ++c) {
            T* const multipole = cells.multipoles.data() + c * stride;
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

    // ---- Down

    // The cells that act on a target as a whole, and those that are undecided against it.
    struct Lists {
        std::vector<std::uint32_t> far, undecided;
    };

    explicit Fmm(FmmCells<T>& cells) : cells_(cells), levels_(cells.levels.size() + 1) {}

    // Walks from the root to all cells of at most `most` charges or without children, and calls
    // hand_over(cell, undecided, local) for each.
    template <class HandOver>
    void walk_above(std::uint32_t most, HandOver hand_over) {
        Lists root;
        root.undecided.push_back(0);
        T local[of_local] = {};
        walk(0, local, root, 0, most, hand_over);
    }
    void walk_below(std::uint32_t cell, const std::vector<std::uint32_t>& undecided, const T* handed) {
        Lists mine;
        mine.undecided = undecided;
        T local[of_local];
        std::copy_n(handed, of_local, local);
        const auto nobody = [](std::uint32_t, const std::vector<std::uint32_t>&, const T*) {};
        walk(cell, local, mine, 0, 0, nobody);
    }

private:
    struct alignas(64) Level {
        Lists lists[most_children];
        T local[most_children][of_local];
    };

    static T power_of_two_of(T x) { return x > 0 ? std::ldexp(T(1), std::ilogb(x)) : T(1); }

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
        T radius2 = 0;
        for (std::size_t i = first; i < end; ++i) {
            const T dx = cells.dx[i] = static_cast<T>(cells.x[i] - cells.cx[c]);
            const T dy = cells.dy[i] = static_cast<T>(cells.y[i] - cells.cy[c]);
            const T dz = cells.dz[i] = static_cast<T>(cells.z[i] - cells.cz[c]);
            radius2 = HWY_MAX(radius2, dx * dx + dy * dy + dz * dz);
        }
        cells.radius[c] = std::sqrt(radius2) * T(1.00001);
        cells.weight[c] = static_cast<T>(weight);
        cells.scale[c] = power_of_two_of(cells.radius[c]);
        const F f;
        V sums[of_multipole];
        for (V& sum : sums) sum = hn::Zero(f);
        const V unit = hn::Set(f, 1 / cells.scale[c]);
        for (std::size_t i = first; i < end; i += hn::Lanes(f)) {
            const auto here = hn::FirstN(f, end - i);
            const auto row = [&](const BareVector<T>& all)
                                 HWY_ATTR { return hn::IfThenElseZero(here, hn::LoadU(f, all.data() + i)); };
            expand_points<p>(f, row(cells.charge), hn::Mul(unit, row(cells.dx)), hn::Mul(unit, row(cells.dy)),
                             hn::Mul(unit, row(cells.dz)), sums);
        }
        for (int k = 0; k < of_multipole; ++k) multipole[k] = hn::GetLane(hn::SumOfLanes(f, sums[k]));
    }

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
        T radius = 0;
        for (std::uint32_t k = first; k < end; ++k) {
            const double dx = cells.cx[k] - cells.cx[c], dy = cells.cy[k] - cells.cy[c],
                         dz = cells.cz[k] - cells.cz[c];
            radius =
                HWY_MAX(radius, static_cast<T>(std::sqrt(dx * dx + dy * dy + dz * dz)) + cells.radius[k]);
        }
        cells.radius[c] = radius * T(1.00001);
        cells.weight[c] = static_cast<T>(weight);
        cells.scale[c] = power_of_two_of(cells.radius[c]);
        // A child in one place has a multipole in any unit, but no unit of its own.
        for (std::uint32_t k = first; k < end; ++k)
            if (!(cells.radius[k] > 0)) cells.scale[k] = cells.scale[c];
        // Shift the children's multipoles here, a child a lane.
        const Eight f;
        const Children children(cells, c);
        alignas(64) T rows[of_multipole][most_children] = {};
        for (std::uint32_t i = 0; i < cells.children[c]; ++i)
            for (int k = 0; k < of_multipole; ++k)
                rows[k][i] = cells.multipoles[(first + i) * stride + std::size_t(k)];
        W sums[of_multipole];
        for (W& sum : sums) sum = hn::Zero(f);
        for (std::uint32_t i = 0; i < cells.children[c]; i += static_cast<std::uint32_t>(hn::Lanes(f))) {
            W part[of_multipole], shifted[of_multipole];
            with_powers<p>(hn::Load(f, children.scale + i), [&](int k, W power) HWY_ATTR {
                part[k] = hn::Mul(power, hn::Load(f, rows[k] + i));
            });
            shift_multipoles<p>(f, part, hn::Load(f, children.x + i), hn::Load(f, children.y + i),
                                hn::Load(f, children.z + i), shifted);
            for (int k = 0; k < of_multipole; ++k) sums[k] = hn::Add(sums[k], shifted[k]);
        }
        for (int k = 0; k < of_multipole; ++k) multipole[k] = hn::GetLane(hn::SumOfLanes(f, sums[k]));
    }

    // Which of the cells from `first` on, at most eight, may act on cell c by their multipoles, and c on
    // them: the errors of both are within the tolerances. Bits are those of the cells. The arithmetic of a
    // pair is the same from both sides.
    unsigned far_apart(std::uint32_t c, std::uint32_t first, std::uint32_t count) const {
        const Eight f;
        alignas(64) T x[most_children], y[most_children], z[most_children];
        for (std::uint32_t i = 0; i < most_children; ++i) {
            x[i] = static_cast<T>(cells_.cx[first + i] - cells_.cx[c]);
            y[i] = static_cast<T>(cells_.cy[first + i] - cells_.cy[c]);
            z[i] = static_cast<T>(cells_.cz[first + i] - cells_.cz[c]);
        }
        unsigned far = 0;
        for (std::uint32_t i = 0; i < count; i += static_cast<std::uint32_t>(hn::Lanes(f))) {
            const W dx = hn::Load(f, x + i), dy = hn::Load(f, y + i), dz = hn::Load(f, z + i);
            const W distance = hn::Sqrt(hn::MulAdd(dx, dx, hn::MulAdd(dy, dy, hn::Mul(dz, dz))));
            const auto row = [&](const std::vector<T>& all)
                                 HWY_ATTR { return hn::LoadU(f, all.data() + first + i); };
            const auto own = [&](const std::vector<T>& all) HWY_ATTR { return hn::Set(f, all[c]); };
            const W radii = row(cells_.radius), radius = own(cells_.radius);
            const auto apart =
                hn::Lt(hn::Add(radii, radius), hn::Mul(hn::Set(f, T(opening_angle)), distance));
            const auto there =
                hn::Lt(error(f, distance, own(cells_.weight), own(cells_.reach), radius, radii),
                       row(cells_.tolerance));
            const auto here = hn::Lt(error(f, distance, row(cells_.weight), row(cells_.reach), radii, radius),
                                     own(cells_.tolerance));
            std::uint8_t bits[8] = {};
            hn::StoreMaskBits(f, hn::And(apart, hn::And(here, there)), bits);
            far |= unsigned(bits[0]) << i;
        }
        return far & ((1u << count) - 1);
    }
    // The estimated error of a conversion, from a source of a weight and a radius into a target of a radius.
    // The degrees above p that the multipole lacks fall from that of degree p, (reach/distance)ᵖ, by the
    // source's radius a degree; those that the local expansion lacks, by the target's radius.
    static HWY_INLINE W error(Eight f, W distance, W weight, W reach, W source_radius, W radius) {
        const W one = hn::Set(f, T(1));
        const W a = hn::Div(one, hn::Sub(distance, radius)), b = hn::Div(one, hn::Sub(distance, reach));
        // Sums of all degrees above the first that is left out: n·tⁿ gives 1/(1 − t)².
        const W by_source = hn::Mul(reach, a), by_target = hn::Mul(radius, b),
                next = hn::Mul(source_radius, a);
        const auto summed = [&](W first, W ratio) HWY_ATTR {
            const W gap = hn::Sub(one, ratio);
            return hn::Div(first, hn::Mul(gap, gap));
        };
        W of_source = summed(hn::Mul(next, hn::Mul(a, a)), next),
          of_target = summed(hn::Mul(b, b), by_target);
        for (int k = 0; k < p; ++k)
            of_source = hn::Mul(of_source, by_source), of_target = hn::Mul(of_target, by_target);
        return hn::Mul(weight, hn::MulAdd(of_target, by_target, of_source));
    }

    // Adds what far cells do to a cell's local expansion.
    void convert_all(std::uint32_t c, std::vector<std::uint32_t>& far, T* local) {
        const F f;
        constexpr std::size_t most_lanes = 64 / sizeof(T);
        const std::size_t lanes = hn::Lanes(f);
        V sums[of_local];
        for (V& sum : sums) sum = hn::Zero(f);
        alignas(64) T rows[of_multipole][most_lanes], x[most_lanes], y[most_lanes], z[most_lanes],
            scale[most_lanes];
        for (std::size_t i = 0; i < far.size(); i += lanes) {
            for (std::size_t j = 0; j < lanes; ++j) {
                if (i + j >= far.size()) {  // nothing, at some distance
                    for (auto& row : rows) row[j] = 0;
                    x[j] = scale[j] = 1, y[j] = z[j] = 0;
                    continue;
                }
                const std::uint32_t source = far[i + j];
                const T* const multipole = cells_.multipoles.data() + source * stride;
                for (int k = 0; k < of_multipole; ++k) rows[k][j] = multipole[k];
                x[j] = static_cast<T>(cells_.cx[c] - cells_.cx[source]);
                y[j] = static_cast<T>(cells_.cy[c] - cells_.cy[source]);
                z[j] = static_cast<T>(cells_.cz[c] - cells_.cz[source]);
                scale[j] = cells_.scale[source];
            }
            V multipoles[of_multipole];
            for (int k = 0; k < of_multipole; ++k) multipoles[k] = hn::Load(f, rows[k]);
            convert<p>(f, multipoles, hn::Load(f, x), hn::Load(f, y), hn::Load(f, z), hn::Load(f, scale),
                       hn::Set(f, cells_.scale[c]), sums);
        }
        for (int k = 0; k < of_local; ++k) local[k] += hn::GetLane(hn::SumOfLanes(f, sums[k]));
    }

    template <class HandOver>
    void walk(std::uint32_t c, T* local, Lists& mine, std::size_t depth, std::uint32_t most,
              const HandOver& hand_over) {
        const bool leaf = cells_.is_leaf(c);
        if (most > 0 && (leaf || cells_.count[c] <= most))
            return convert_and_hand_over(c, local, mine, hand_over);
        Level& level = levels_[depth];
        for (Lists& lists : level.lists) lists.far.clear(), lists.undecided.clear();
        near_.clear();
        for (std::size_t k = 0; k < mine.undecided.size(); ++k) decide(c, mine.undecided[k], mine, level);
        if (!mine.far.empty()) convert_all(c, mine.far, local);
        if (leaf) return finish(c, local);
        hand_down(c, local, level);
        for (std::uint32_t i = 0; i < cells_.children[c]; ++i)
            walk(cells_.child[c] + i, level.local[i], level.lists[i], depth + 1, most, hand_over);
    }
    template <class HandOver>
    void convert_and_hand_over(std::uint32_t c, T* local, Lists& mine, const HandOver& hand_over) {
        if (!mine.far.empty()) convert_all(c, mine.far, local);
        hand_over(c, mine.undecided, local);
    }
    // Opens one cell of an undecided pair, the target c and a source, and tests its children against the
    // other.
    void decide(std::uint32_t c, std::uint32_t source, Lists& mine, Level& level) {
        const bool leaf = cells_.is_leaf(c), source_leaf = cells_.is_leaf(source);
        if (leaf && source_leaf) {
            // Charges in one place do nothing to each other, however many they are.
            if (source != c || cells_.radius[c] > 0) near_.push_back(source);
            return;
        }
        const std::uint32_t child = cells_.child[c], children = cells_.children[c];
        if (source == c) {
            for (std::uint32_t i = 0; i < children; ++i) {
                const unsigned far = far_apart(child + i, child, children);
                for (std::uint32_t j = 0; j < children; ++j) add(level.lists[i], child + j, far >> j & 1u);
            }
            return;
        }
        const T radius = cells_.radius[c], other = cells_.radius[source];
        if (leaf || (!source_leaf && (other > radius || (other == radius && source > c)))) {
            const unsigned far = far_apart(c, cells_.child[source], cells_.children[source]);
            for (std::uint32_t j = 0; j < cells_.children[source]; ++j)
                add(mine, cells_.child[source] + j, far >> j & 1u);
        } else {
            const unsigned far = far_apart(source, child, children);
            for (std::uint32_t i = 0; i < children; ++i) add(level.lists[i], source, far >> i & 1u);
        }
    }
    static void add(Lists& lists, std::uint32_t cell, unsigned far) {
        (far ? lists.far : lists.undecided).push_back(cell);
    }

    // Shifts a cell's local expansion to its children, a child a lane.
    void hand_down(std::uint32_t c, const T* local, Level& level) const {
        const Eight f;
        const Children children(cells_, c);
        for (std::uint32_t i = 0; i < cells_.children[c]; i += static_cast<std::uint32_t>(hn::Lanes(f))) {
            W whole[of_local], part[of_local];
            for (int k = 0; k < of_local; ++k) whole[k] = hn::Set(f, local[k]);
            shift_locals<q>(f, whole, hn::Load(f, children.x + i), hn::Load(f, children.y + i),
                            hn::Load(f, children.z + i), part);
            alignas(64) T row[most_children];
            with_powers<q>(hn::Load(f, children.scale + i), [&](int k, W power) HWY_ATTR {
                hn::Store(hn::Mul(power, part[k]), f, row);
                for (std::uint32_t j = 0; j < hn::Lanes(f) && i + j < cells_.children[c]; ++j)
                    level.local[i + j][k] = row[j];
            });
        }
    }

    // What near leaves and the local expansion do to the charges of a leaf.
    void finish(std::uint32_t c, const T* local) {
        // Gather the near charges, as offsets from this leaf's center.
        std::size_t sources = 0;
        for (const std::uint32_t near : near_) sources += cells_.count[near];
        for (BareVector<T>* row : {&x_, &y_, &z_, &charge_})
            if (row->size() < sources + row_padding) row->resize(2 * sources + row_padding);
        std::size_t at = 0;
        for (const std::uint32_t near : near_) {
            const T dx = static_cast<T>(cells_.cx[near] - cells_.cx[c]),
                    dy = static_cast<T>(cells_.cy[near] - cells_.cy[c]),
                    dz = static_cast<T>(cells_.cz[near] - cells_.cz[c]);
            const std::size_t first = cells_.first[near], end = first + cells_.count[near];
            for (std::size_t i = first; i < end; ++i, ++at) {
                x_[at] = cells_.dx[i] + dx, y_[at] = cells_.dy[i] + dy, z_[at] = cells_.dz[i] + dz;
                charge_[at] = cells_.charge[i];
            }
        }
        for (std::size_t i = at; i < at + row_padding; ++i) x_[i] = y_[i] = z_[i] = charge_[i] = 0;
        const std::size_t first = cells_.first[c], count = cells_.count[c];
        const std::size_t row = count + row_padding;
        sums_.assign(4 * row, 0.0);
        double *const potential = sums_.data(), *const gx = potential + row, *const gy = gx + row,
                      *const gz = gy + row;
        direct<T>({x_.data(), y_.data(), z_.data(), charge_.data(), sources},
                  {cells_.dx.data() + first, cells_.dy.data() + first, cells_.dz.data() + first, count,
                   potential, gx, gy, gz});
        // Add the local expansion.
        const F f;
        const V unit = hn::Set(f, 1 / cells_.scale[c]);
        constexpr std::size_t most_lanes = 64 / sizeof(T);
        for (std::size_t i = 0; i < count; i += hn::Lanes(f)) {
            const auto place = [&](const BareVector<T>& all)
                                   HWY_ATTR { return hn::Mul(unit, hn::LoadU(f, all.data() + first + i)); };
            V far[4];
            evaluate_local<q>(f, local, place(cells_.dx), place(cells_.dy), place(cells_.dz), far[0], far[1],
                              far[2], far[3]);
            alignas(64) T out[4][most_lanes];
            for (int k = 0; k < 4; ++k) hn::Store(k == 0 ? far[k] : hn::Mul(unit, far[k]), f, out[k]);
            for (std::size_t j = 0; j < hn::Lanes(f) && i + j < count; ++j) {
                const std::size_t t = first + i + j;
                cells_.potential[t] = static_cast<T>(potential[i + j] + static_cast<double>(out[0][j]));
                cells_.gx[t] = static_cast<T>(gx[i + j] + static_cast<double>(out[1][j]));
                cells_.gy[t] = static_cast<T>(gy[i + j] + static_cast<double>(out[2][j]));
                cells_.gz[t] = static_cast<T>(gz[i + j] + static_cast<double>(out[3][j]));
            }
        }
    }

    FmmCells<T>& cells_;
    std::vector<Level> levels_;
    std::vector<std::uint32_t> near_;
    BareVector<T> x_, y_, z_, charge_;
    std::vector<double> sums_;
};

}  // namespace hedgerow::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
