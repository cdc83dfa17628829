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
#include <limits>

#include "any_order-inl.h"
#include "moments-inl.h"
#include "near_pairs-inl.h"
#include "points-inl.h"

HWY_BEFORE_NAMESPACE();
namespace hedgerow::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

// One vector of 16-byte blocks: numbers `first` and those after it of every row that starts a block of rows.
template <class F, class T = hn::TFromD<F>>
HWY_INLINE hn::Vec<F> load_blocks(F f, const T* const* rows, std::size_t first) {
    if constexpr (hn::MaxLanes(f) * sizeof(T) <= 16) {
        return hn::LoadU(f, rows[0] + first);
    } else {
        const hn::Half<F> half;
        return hn::Combine(f, load_blocks(half, rows + hn::MaxLanes(half), first),
                           load_blocks(half, rows, first));
    }
}
// Loads `count` numbers of as many rows as a vector has lanes, a row a lane: by transposes of blocks of 16
// bytes.
template <std::size_t count, class F, class T = hn::TFromD<F>, class V = hn::Vec<F>>
HWY_INLINE void load_columns(F f, const T* const* rows, V* columns) {
    constexpr std::size_t of_block = 16 / sizeof(T);
    static_assert(count % of_block == 0);
    for (std::size_t k = 0; k < count; k += of_block) {
        V v[of_block];
        for (std::size_t i = 0; i < of_block; ++i) v[i] = load_blocks(f, rows + i, k);
        V* const out = columns + k;
        if constexpr (of_block == 2) {
            out[0] = hn::InterleaveLower(f, v[0], v[1]), out[1] = hn::InterleaveUpper(f, v[0], v[1]);
        } else {
            const V a = hn::InterleaveLower(f, v[0], v[2]), b = hn::InterleaveLower(f, v[1], v[3]),
                    c = hn::InterleaveUpper(f, v[0], v[2]), d = hn::InterleaveUpper(f, v[1], v[3]);
            out[0] = hn::InterleaveLower(f, a, b), out[1] = hn::InterleaveUpper(f, a, b);
            out[2] = hn::InterleaveLower(f, c, d), out[3] = hn::InterleaveUpper(f, c, d);
        }
    }
}

// The walk of targets, which may be the sources themselves.
template <class T, int p>
class Fmm {
    using E = Expansions<T, p>;
    using F = typename E::F;
    using V = typename E::V;
    using Eight = typename E::Eight;
    using W = typename E::W;
    static constexpr int q = E::q, of_multipole = E::of_multipole, of_local = E::of_local;
    static constexpr std::uint32_t most_children = E::most_children;
    // The sum of two radii over the distance of the centers stays below this: no estimate holds near 1.
    static constexpr double opening_angle = 0.8;
    // A cell without a radius has the scale of its parent. Powers of that over a distance overflow nearer by.
    static constexpr double most_scale = 16;

public:
    Fmm(const FmmCells<T>& sources, FmmCells<T>& targets)
        : sources_(sources),
          targets_(targets),
          alone_(&sources == &targets),
          levels_(targets.levels.size() + 1),
          pairs_(sources, targets) {}

    // Walks from the root to all cells of at most `most` targets or without children, and makes each a task.
    void walk_above(std::uint32_t most, std::vector<FmmTask<T>>& tasks) {
        Lists all = root();
        T local[of_local] = {};
        walk(0, local, all, 0, most, &tasks);
    }
    void walk_below(const FmmTask<T>& task) {
        Lists mine;
        mine.undecided = task.undecided;
        T local[of_local];
        std::copy_n(task.local.data(), of_local, local);
        walk(task.cell, local, mine, 0, 0, nullptr);
    }

    // Walks down to one target, and lists what acts on it.
    void acting(std::uint32_t place, std::vector<CellThatActs>& found) {
        Lists mine = root();
        const auto list = [&](const std::vector<FmmSource>& cells, ActsBy by) {
            for (const FmmSource cell : cells) found.push_back({cell, by});
        };
        for (std::uint32_t c = 0, depth = 0;; ++depth) {
            Level& level = levels_[depth];
            clear(level);
            for (std::size_t k = 0; k < mine.undecided.size(); ++k) decide(c, mine.undecided[k], mine, level);
            list(mine.far, ActsBy::conversion), list(large_leaves_, ActsBy::points);
            list(small_, ActsBy::multipole), list(pairs_.near, ActsBy::pairs);
            if (targets_.is_leaf(c)) return;
            std::uint32_t i = 0;
            while (place >= targets_.first[targets_.child[c] + i] + targets_.count[targets_.child[c] + i])
                ++i;
            mine = level.lists[i], c = targets_.child[c] + i;
        }
    }

    // The method of Barnes and Hut for the targets of a leaf together: a cell acts by its multipole, or as
    // one charge, if its radius is less than so many times the least distance of its center from them. One
    // without a radius is one charge.
    void walk_group(std::uint32_t leaf, double angle, bool by_multipoles) {
        pairs_.near.clear(), pairs_.single.clear(), small_.clear();
        stack_.assign(1, 0);
        while (!stack_.empty()) {
            const std::uint32_t source = stack_.back();
            stack_.pop_back();
            const double dx = sources_.cx[source] - targets_.cx[leaf],
                         dy = sources_.cy[source] - targets_.cy[leaf],
                         dz = sources_.cz[source] - targets_.cz[leaf];
            const double distance = std::sqrt(dx * dx + dy * dy + dz * dz) - double(targets_.radius[leaf]),
                         radius = double(sources_.radius[source]),
                         soft = double(HWY_MAX(sources_.softest[source], targets_.softest[leaf]));
            if (radius < angle * distance && radius + soft < distance)
                by_multipoles&& radius > 0 ? small_.push_back(sources_.itself(source))
                                           : pairs_.single.push_back(source);
            else if (!sources_.is_leaf(source))
                for (std::uint32_t i = 0; i < sources_.children[source]; ++i)
                    stack_.push_back(sources_.child[source] + i);
            else if (!alone_ || source != leaf || targets_.radius[leaf] > 0)
                pairs_.near.push_back(sources_.itself(source));
        }
        const T nothing[of_local] = {};
        finish(leaf, nothing);
    }

private:
    // The sources that act on a target as a whole, and those that are undecided against it.
    struct Lists {
        std::vector<FmmSource> far, undecided;
    };
    struct alignas(64) Level {
        Lists lists[most_children];
        T local[most_children][of_local];
    };

    // What is undecided against the root of targets: the root of sources, and its images in a periodic cube.
    Lists root() const {
        Lists lists;
        lists.undecided = {sources_.itself(0)};
        for (std::uint32_t i = 0; i < sources_.images.size(); ++i)
            if (const FmmSource image(0, i); image != sources_.itself(0))
                add(lists, image, 1, far_apart(targets_, 0, sources_, 0, 1, sources_.images[i]));
        return lists;
    }
    void clear(Level& level) {
        for (Lists& lists : level.lists) lists.far.clear(), lists.undecided.clear();
        pairs_.near.clear(), small_.clear(), large_leaves_.clear();
    }
    void walk(std::uint32_t c, T* local, Lists& mine, std::size_t depth, std::uint32_t most,
              std::vector<FmmTask<T>>* tasks) {
        const bool leaf = targets_.is_leaf(c);
        if (tasks != nullptr && (leaf || targets_.count[c] <= most)) {
            convert_all(c, mine.far, local);
            tasks->push_back({c, std::move(mine.undecided), {local, local + of_local}});
            return;
        }
        Level& level = levels_[depth];
        clear(level);
        for (std::size_t k = 0; k < mine.undecided.size(); ++k) decide(c, mine.undecided[k], mine, level);
        convert_all(c, mine.far, local);
        for (const FmmSource large : large_leaves_) expand_leaf(c, large, local);
        if (leaf) return finish(c, local);
        hand_down(c, local, level);
        for (std::uint32_t i = 0; i < targets_.children[c]; ++i)
            walk(targets_.child[c] + i, level.local[i], level.lists[i], depth + 1, most, tasks);
    }

    // Opens one cell of an undecided pair, the target c and a source, and tests its children against the
    // other.
    void decide(std::uint32_t c, FmmSource acting, Lists& mine, Level& level) {
        const std::uint32_t source = acting.cell();
        const bool leaf = targets_.is_leaf(c), source_leaf = sources_.is_leaf(source);
        const std::uint32_t child = targets_.child[c], children = targets_.children[c];
        const Vec3d& shift = sources_.images[acting.image()];
        if (is_itself(c, acting) && !leaf) {
            for (std::uint32_t i = 0; i < children; ++i)
                add(level.lists[i], acting.with(child), children,
                    far_apart(targets_, child + i, sources_, child, children, shift));
            return;
        }
        const T radius = targets_.radius[c], other = sources_.radius[source];
        const bool source_larger = other > radius || (other == radius && acting > sources_.itself(c));
        if (source_larger ? source_leaf : leaf) {
            beside_leaf(c, acting, source_larger, mine, level);
        } else if (source_larger) {
            const std::uint32_t first = sources_.child[source], count = sources_.children[source];
            add(mine, acting.with(first), count, far_apart(targets_, c, sources_, first, count, shift));
        } else {
            const unsigned far = far_apart(sources_, source, targets_, child, children, -shift);
            for (std::uint32_t i = 0; i < children; ++i) add(level.lists[i], acting, 1, far >> i & 1u);
        }
    }
    // Decides about a leaf and a smaller cell, of which one is the target. If the leaf is the one whose
    // expansions would not converge, its charges are taken one by one. Opening the cell would not help: its
    // parts are each acceptable in the end, but lie on one side, and their errors add up.
    void beside_leaf(std::uint32_t c, FmmSource acting, bool source_larger, Lists& mine, Level& level) {
        const std::uint32_t source = acting.cell();
        const Vec3d& shift = sources_.images[acting.image()];
        const bool by_points = source_larger ? apart_by_points(sources_, source, targets_, c, -shift)
                                             : apart_by_points(targets_, c, sources_, source, shift);
        if (by_points) {
            (source_larger ? large_leaves_ : small_).push_back(acting);
        } else if (targets_.is_leaf(c) && sources_.is_leaf(source)) {
            // Charges in one place are no pairs, however many they are (`add_pile`).
            if (!is_itself(c, acting) || targets_.radius[c] > 0) pairs_.near.push_back(acting);
        } else if (source_larger) {
            for (std::uint32_t i = 0; i < targets_.children[c]; ++i)
                level.lists[i].undecided.push_back(acting);
        } else {
            for (std::uint32_t j = 0; j < sources_.children[source]; ++j)
                mine.undecided.push_back(acting.with(sources_.child[source] + j));
        }
    }
    bool is_itself(std::uint32_t c, FmmSource acting) const { return alone_ && acting == sources_.itself(c); }
    // Adds cells, from a first one on, to those that are far, if their bits are set, else to those that are
    // undecided.
    static void add(Lists& lists, FmmSource first, std::uint32_t count, unsigned far) {
        for (std::uint32_t j = 0; j < count; ++j)
            (far >> j & 1u ? lists.far : lists.undecided).push_back(first.with(first.cell() + j));
    }

    // Which of some cells, at most eight, may act on another by their multipoles, and it on them: the errors
    // of both are within the tolerances. Bits are those of the cells. The arithmetic of a pair is the same
    // from both sides; `shift` is that of the cells.
    static unsigned far_apart(const FmmCells<T>& ones, std::uint32_t one, const FmmCells<T>& cells,
                              std::uint32_t first, std::uint32_t count, const Vec3d& shift) {
        const Eight f;
        alignas(64) T x[most_children], y[most_children], z[most_children];
        for (std::uint32_t i = 0; i < most_children; ++i) {
            x[i] = static_cast<T>(cells.cx[first + i] - ones.cx[one] + shift[0]);
            y[i] = static_cast<T>(cells.cy[first + i] - ones.cy[one] + shift[1]);
            z[i] = static_cast<T>(cells.cz[first + i] - ones.cz[one] + shift[2]);
        }
        unsigned far = 0;
        for (std::uint32_t i = 0; i < count; i += static_cast<std::uint32_t>(hn::Lanes(f))) {
            const W dx = hn::Load(f, x + i), dy = hn::Load(f, y + i), dz = hn::Load(f, z + i);
            const W distance = hn::Sqrt(hn::MulAdd(dx, dx, hn::MulAdd(dy, dy, hn::Mul(dz, dz))));
            const auto row = [&](const std::vector<T>& all)
                                 HWY_ATTR { return hn::LoadU(f, all.data() + first + i); };
            const auto own = [&](const std::vector<T>& all) HWY_ATTR { return hn::Set(f, all[one]); };
            const W radii = row(cells.radius), radius = own(ones.radius), both = hn::Add(radii, radius);
            const W soft = hn::Max(row(cells.softest), own(ones.softest));
            const W scale = hn::Max(row(cells.scale), own(ones.scale));
            const auto apart = hn::And(hn::And(hn::Lt(both, hn::Mul(hn::Set(f, T(opening_angle)), distance)),
                                               hn::Lt(hn::Add(both, soft), distance)),
                                       hn::Lt(scale, hn::Mul(hn::Set(f, T(most_scale)), distance)));
            const auto there =
                errors(f, distance, own(ones.weight), own(ones.reach), radius, row(cells.spread));
            const auto here =
                errors(f, distance, row(cells.weight), row(cells.reach), radii, own(ones.spread));
            const auto good = hn::And(hn::Le(hn::Add(there.of_source, there.of_target), row(cells.tolerance)),
                                      hn::Le(hn::Add(here.of_source, here.of_target), own(ones.tolerance)));
            std::uint8_t bits[8] = {};
            hn::StoreMaskBits(f, hn::And(apart, good), bits);
            far |= unsigned(bits[0]) << i;
        }
        return far & ((1u << count) - 1);
    }
    // Whether a cell may act on each charge of a leaf by its multipole, and they on it. Worth it if the cell
    // has some charges.
    static bool apart_by_points(const FmmCells<T>& leaves, std::uint32_t leaf, const FmmCells<T>& cells,
                                std::uint32_t c, const Vec3d& shift) {
        if (cells.count[c] < q * q / 4) return false;
        const double dx = cells.cx[c] - leaves.cx[leaf] + shift[0],
                     dy = cells.cy[c] - leaves.cy[leaf] + shift[1],
                     dz = cells.cz[c] - leaves.cz[leaf] + shift[2];
        const T distance = static_cast<T>(std::sqrt(dx * dx + dy * dy + dz * dz));
        const T both = leaves.radius[leaf] + cells.radius[c];
        if (!(both < T(opening_angle) * distance &&
              both + HWY_MAX(leaves.softest[leaf], cells.softest[c]) < distance &&
              HWY_MAX(leaves.scale[leaf], cells.scale[c]) < T(most_scale) * distance))
            return false;
        const hn::CappedTag<T, 1> f;
        const auto set = [&](T x) { return hn::Set(f, x); };
        const auto first = [](auto v) { return hn::GetLane(v); };
        const auto here = errors(f, set(distance), set(cells.weight[c]), set(cells.reach[c]),
                                 set(cells.radius[c]), set(leaves.spread[leaf]));
        const auto there = errors(f, set(distance), set(leaves.weight[leaf]), set(leaves.reach[leaf]),
                                  set(leaves.radius[leaf]), set(cells.spread[c]));
        return first(here.of_source) <= leaves.tolerance[leaf] &&
               first(there.of_target) <= cells.tolerance[c];
    }
    // The estimated errors of a conversion, from a source of a weight and a radius into a target of a spread.
    // The degrees above p that the multipole lacks fall from that of degree p, (reach/distance)ᵖ, by the
    // source's radius a degree; those that the local expansion lacks, by the target's spread.
    template <class X>
    struct Errors {
        X of_source, of_target;
    };
    template <class D, class X = hn::Vec<D>>
    static HWY_INLINE Errors<X> errors(D f, X distance, X weight, X reach, X source_radius, X spread) {
        const X one = hn::Set(f, T(1));
        const X a = hn::Div(one, hn::Sub(distance, spread)), b = hn::Div(one, hn::Sub(distance, reach));
        const X by_source = hn::Mul(reach, a), by_target = hn::Mul(spread, b),
                next = hn::Mul(source_radius, a);
        // Sums of all degrees above the first that is left out: n·tⁿ gives 1/(1 − t)².
        const auto summed = [&](X first, X ratio) HWY_ATTR {
            const X gap = hn::Sub(one, ratio);
            return hn::Div(first, hn::Mul(gap, gap));
        };
        X of_source = hn::Mul(weight, summed(hn::Mul(next, hn::Mul(a, a)), next)),
          of_target = hn::Mul(weight, summed(hn::Mul(by_target, hn::Mul(b, b)), by_target));
        for (int k = 0; k < p; ++k)
            of_source = hn::Mul(of_source, by_source), of_target = hn::Mul(of_target, by_target);
        return {of_source, of_target};
    }

    // How far a target's center is from that of a source.
    HWY_INLINE Vec3d offset(std::uint32_t c, FmmSource acting) const {
        const Vec3d& shift = sources_.images[acting.image()];
        const std::uint32_t source = acting.cell();
        return {targets_.cx[c] - sources_.cx[source] - shift[0],
                targets_.cy[c] - sources_.cy[source] - shift[1],
                targets_.cz[c] - sources_.cz[source] - shift[2]};
    }
    // Adds what far cells do to a cell's local expansion.
    void convert_all(std::uint32_t c, const std::vector<FmmSource>& far, T* local) const {
        if (far.empty()) return;
        const F f;
        constexpr std::size_t most_lanes = 64 / sizeof(T);
        const std::size_t lanes = hn::Lanes(f);
        V sums[of_local];
        for (V& sum : sums) sum = hn::Zero(f);
        static constexpr T nothing[E::stride] = {};
        const T* rows[most_lanes];
        alignas(64) T x[most_lanes], y[most_lanes], z[most_lanes], scale[most_lanes];
        for (std::size_t i = 0; i < far.size(); i += lanes) {
            for (std::size_t j = 0; j < lanes; ++j) {
                if (i + j >= far.size()) {  // nothing, at some distance
                    rows[j] = nothing, x[j] = scale[j] = 1, y[j] = z[j] = 0;
                    continue;
                }
                const std::uint32_t source = far[i + j].cell();
                const Vec3d from = offset(c, far[i + j]);
                rows[j] = sources_.multipoles.data() + source * E::stride;
                x[j] = static_cast<T>(from[0]), y[j] = static_cast<T>(from[1]);
                z[j] = static_cast<T>(from[2]);
                scale[j] = sources_.scale[source];
            }
            V multipoles[E::stride];
            load_columns<E::stride>(f, rows, multipoles);
            convert<p>(f, multipoles, hn::Load(f, x), hn::Load(f, y), hn::Load(f, z), hn::Load(f, scale),
                       hn::Set(f, targets_.scale[c]), sums);
        }
        for (int k = 0; k < of_local; ++k) local[k] += hn::GetLane(hn::SumOfLanes(f, sums[k]));
    }

    // Adds what the charges of a leaf do to a cell's local expansion.
    void expand_leaf(std::uint32_t c, FmmSource acting, T* local) const {
        const F f;
        const std::uint32_t leaf = acting.cell();
        V sums[of_local];
        for (V& sum : sums) sum = hn::Zero(f);
        const T per_unit = 1 / targets_.scale[c];
        const V unit = hn::Set(f, per_unit);
        const Vec3d apart = offset(c, acting);
        const V x = hn::Set(f, static_cast<T>(apart[0])), y = hn::Set(f, static_cast<T>(apart[1])),
                z = hn::Set(f, static_cast<T>(apart[2]));
        const std::size_t first = sources_.first[leaf], end = first + sources_.count[leaf];
        for (std::size_t i = first; i < end; i += hn::Lanes(f)) {
            const auto here = hn::FirstN(f, end - i);
            const auto from = [&](V center, const BareVector<T>& offsets) HWY_ATTR {
                return hn::Mul(unit,
                               hn::Sub(center, hn::IfThenElseZero(here, hn::LoadU(f, offsets.data() + i))));
            };
            expand_at<q>(f, hn::IfThenElseZero(here, hn::LoadU(f, sources_.charge.data() + i)),
                         from(x, sources_.dx), from(y, sources_.dy), from(z, sources_.dz), sums);
        }
        for (int k = 0; k < of_local; ++k) local[k] += per_unit * hn::GetLane(hn::SumOfLanes(f, sums[k]));
    }

    // Shifts a cell's local expansion to its children, a child a lane.
    void hand_down(std::uint32_t c, const T* local, Level& level) const {
        const Eight f;
        const typename E::Children children(targets_, c);
        for (std::uint32_t i = 0; i < targets_.children[c]; i += static_cast<std::uint32_t>(hn::Lanes(f))) {
            W whole[of_local], part[of_local];
            for (int k = 0; k < of_local; ++k) whole[k] = hn::Set(f, local[k]);
            shift_locals<q>(f, whole, hn::Load(f, children.x + i), hn::Load(f, children.y + i),
                            hn::Load(f, children.z + i), part);
            alignas(64) T row[most_children];
            E::template with_powers<q>(hn::Load(f, children.scale + i), [&](int k, W power) HWY_ATTR {
                hn::Store(hn::Mul(power, part[k]), f, row);
                for (std::uint32_t j = 0; j < hn::Lanes(f) && i + j < targets_.children[c]; ++j)
                    level.local[i + j][k] = row[j];
            });
        }
    }

    // What near leaves and the local expansion do to the charges of a leaf.
    void finish(std::uint32_t c, const T* local) {
        pairs_.take(c);
        add_expansions(c, local);
        pairs_.add();
        if (alone_ && !(targets_.radius[c] > 0) && !sources_.soft.empty()) {
            const std::size_t first = targets_.first[c];
            detail::add_pile(sources_.charge.data() + first, sources_.soft.data() + first, sources_.count[c],
                             sources_.softening, targets_.potential.data() + first);
        }
        if (targets_.tides.empty()) return;
        // Small cells act pair by pair here.
        pairs_.near.insert(pairs_.near.end(), small_.begin(), small_.end());
        add_tides(c, local);
    }
    // Sets what the local expansion, whose potential is not in the unit, and small cells do.
    void add_expansions(std::uint32_t c, const T* local) {
        const std::size_t first = targets_.first[c], count = targets_.count[c];
        const F f;
        const auto& places = pairs_.targets();
        const double of_gradient = static_cast<double>(1 / targets_.scale[c]);
        constexpr std::size_t most_lanes = 64 / sizeof(T);
        for (std::size_t i = 0; i < count; i += hn::Lanes(f)) {
            V far[4];
            evaluate_local<q>(f, local, hn::LoadU(f, places.place[0].data() + i),
                              hn::LoadU(f, places.place[1].data() + i),
                              hn::LoadU(f, places.place[2].data() + i), far[0], far[1], far[2], far[3]);
            for (const FmmSource small : small_) add_small(c, small, i, far);
            alignas(64) T out[4][most_lanes];
            for (int k = 0; k < 4; ++k) hn::Store(far[k], f, out[k]);
            for (std::size_t j = 0; j < hn::Lanes(f) && i + j < count; ++j) {
                const auto far_at = [&](int k) { return static_cast<double>(out[k][j]); };
                const std::size_t t = first + i + j;
                targets_.potential[t] = far_at(0);
                targets_.gx[t] = far_at(1) * of_gradient, targets_.gy[t] = far_at(2) * of_gradient;
                targets_.gz[t] = far_at(3) * of_gradient;
            }
        }
    }

    // Adds tidal tensors: of near charges, and of the local expansion.
    void add_tides(std::uint32_t c, const T* local) {
        const std::size_t first = targets_.first[c], count = targets_.count[c];
        const detail::TideRows pairs = pairs_.tides(), found = targets_.tide_rows().from(first);
        const double per_unit = static_cast<double>(1 / targets_.scale[c]), unit2 = per_unit * per_unit;
        for (std::size_t i = 0; i < count; ++i) {
            for (std::size_t k = 0; k < 6; ++k) found.row[k][i] = 0;
            found.add(i, pairs[i] * (unit2 * per_unit));
        }
        constexpr std::size_t at_once = 256;
        alignas(64) double place[3][at_once + row_padding];
        const auto& places = pairs_.targets();
        for (std::size_t i = 0; i < count; i += at_once) {
            const std::size_t here = HWY_MIN(at_once, count - i);
            for (std::size_t j = 0; j < here + row_padding; ++j) {
                const std::size_t t = HWY_MIN(i + j, count - 1);
                place[0][j] = static_cast<double>(places.place[0][t]);
                place[1][j] = static_cast<double>(places.place[1][t]);
                place[2][j] = static_cast<double>(places.place[2][t]);
            }
            detail::add_local_tides(local, q, place[0], place[1], place[2], here, unit2, add_local,
                                    found.from(i));
        }
    }

    // Adds what a small cell does to targets of a leaf, from number i on.
    HWY_INLINE void add_small(std::uint32_t c, FmmSource acting, std::size_t i, V* far) const {
        const F f;
        const auto& places = pairs_.targets();
        const std::uint32_t small = acting.cell();
        const Vec3d apart = offset(c, acting);
        const T per_unit = 1 / sources_.scale[small], ratio = targets_.scale[c] * per_unit;
        const auto from = [&](double center, const BareVector<T>& row) HWY_ATTR {
            return hn::MulAdd(hn::LoadU(f, row.data() + i), hn::Set(f, ratio),
                              hn::Set(f, static_cast<T>(center) * per_unit));
        };
        V found[4];
        evaluate_multipole<p>(f, sources_.multipoles.data() + small * E::stride,
                              from(apart[0], places.place[0]), from(apart[1], places.place[1]),
                              from(apart[2], places.place[2]), found[0], found[1], found[2], found[3]);
        for (int k = 0; k < 4; ++k) {
            const V potential = hn::Mul(found[k], hn::Set(f, per_unit));
            far[k] = k == 0 ? hn::Add(far[0], potential) : hn::MulAdd(potential, hn::Set(f, ratio), far[k]);
        }
    }

    const FmmCells<T>& sources_;
    FmmCells<T>& targets_;
    const bool alone_;  // the targets are the sources
    std::vector<Level> levels_;
    NearPairs<T> pairs_;
    // Of the target in hand: cells that act on its charges by their multipoles, and leaves whose charges act
    // on its local expansion.
    std::vector<FmmSource> small_, large_leaves_;
    std::vector<std::uint32_t> stack_;  // the cells that a walk has yet to look at
};

}  // namespace hedgerow::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
