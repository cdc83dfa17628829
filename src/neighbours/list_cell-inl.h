/// Lists the neighbours of the points of a cell.
#if defined(HEDGEROW_NEIGHBOURS_LIST_CELL_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef HEDGEROW_NEIGHBOURS_LIST_CELL_INL_H
#undef HEDGEROW_NEIGHBOURS_LIST_CELL_INL_H
#else
#define HEDGEROW_NEIGHBOURS_LIST_CELL_INL_H
#endif

#include <cstddef>
#include <cstdint>
#include <limits>

#include <hwy/highway.h>

#include "cell_kernels.h"

#include "engine/boxes-inl.h"
#include "engine/stack-inl.h"

HWY_BEFORE_NAMESPACE();
namespace hedgerow::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

using CellLanes = Floats<16>;

// Coordinates less an origin, times a scale, as floats: of one, or of as many as there are lanes. For floats
// the origin is subtracted in two parts.
template <class T>
class Local;
template <>
class Local<float> {
public:
    HWY_INLINE Local(double origin, double scale)
        : high_(static_cast<float>(origin)),
          low_(static_cast<float>(origin - static_cast<double>(high_))),
          scale_(static_cast<float>(scale)) {}
    HWY_INLINE float one(float x) const { return ((x - high_) - low_) * scale_; }
    HWY_INLINE hn::Vec<CellLanes> lanes(const float* from) const {
        constexpr CellLanes f;
        const auto apart = hn::Sub(hn::Sub(hn::LoadU(f, from), hn::Set(f, high_)), hn::Set(f, low_));
        return hn::Mul(apart, hn::Set(f, scale_));
    }

private:
    float high_, low_, scale_;
};
template <>
class Local<double> {
public:
    HWY_INLINE Local(double origin, double scale) : origin_(origin), scale_(scale) {}
    HWY_INLINE float one(double x) const { return static_cast<float>((x - origin_) * scale_); }
    HWY_INLINE hn::Vec<CellLanes> lanes(const double* from) const {
        constexpr CellLanes f;
        constexpr hn::CappedTag<double, 16> d;
        constexpr hn::Rebind<float, decltype(d)> half;
        const auto part = [&](const double* some) HWY_ATTR {
            return hn::DemoteTo(
                half, hn::Mul(hn::Sub(hn::LoadU(d, some), hn::Set(d, origin_)), hn::Set(d, scale_)));
        };
        return hn::Combine(f, part(from + hn::MaxLanes(d)), part(from));
    }

private:
    double origin_, scale_;
};

// Copies the points of the runs to the task's arrays, from the first that asks on if only later ones are
// listed. Lanes after the last are NaN. Returns how many there are.
template <class T, int D>
HWY_INLINE std::size_t copy_around(const detail::CellTask<T, D>& task) {
    constexpr CellLanes f;
    constexpr hn::RebindToUnsigned<CellLanes> u;
    constexpr std::size_t lanes = hn::MaxLanes(f);
    const auto steps = hn::Iota(u, 0);
    std::size_t size = 0;
    for (const auto& run : task.runs) {
        const std::uint32_t from =
            task.listed == detail::Listed::later ? std::max(run.first, task.first) : run.first;
        if (from >= run.end) continue;
        const std::size_t count = run.end - from;
        for (int k = 0; k < D; ++k) {
            const T* const along = task.order->along(k) + from;
            float* const to = task.at[k] + size;
            const Local<T> local(task.middle[k] - run.shift[k], task.scale);
            for (std::size_t i = 0; i < count; i += lanes) hn::StoreU(local.lanes(along + i), f, to + i);
        }
        std::uint32_t* const ids = task.id + size;
        for (std::size_t i = 0; i < count; i += lanes)
            hn::StoreU(hn::Add(hn::Set(u, from + static_cast<std::uint32_t>(i)), steps), u, ids + i);
        size += count;
    }
    hn::StoreU(hn::Set(f, std::numeric_limits<float>::quiet_NaN()), f, task.at[0] + size);
    return size;
}

// The lanes of pairs in doubt that are near.
template <class T, int D>
HWY_NOINLINE hn::Mask<CellLanes> measured(const detail::CellTask<T, D>& task, std::uint32_t i,
                                          const std::uint32_t* ids, hn::Mask<CellLanes> unsure) {
    constexpr CellLanes f;
    alignas(64) float near[hn::MaxLanes(f)] = {};
    for (unsigned bits = bits_of(f, unsure); bits != 0; bits &= bits - 1) {
        const auto lane = static_cast<std::size_t>(std::countr_zero(bits));
        near[lane] = task.is_near(task.asker, i, ids[lane]) ? 1 : 0;
    }
    return hn::Gt(hn::Load(f, near), hn::Zero(f));
}

// See CellTask. Filters in floats relative to the cell's middle.
template <bool wraps, detail::Listed listed, class T, int D>
HWY_INLINE void list_by_filter(const detail::CellTask<T, D>& task) {
    constexpr CellLanes f;
    constexpr hn::RebindToUnsigned<CellLanes> u;
    constexpr hn::RebindToSigned<CellLanes> s;
    constexpr std::size_t lanes = hn::MaxLanes(f);
    const std::size_t size = copy_around(task);
    const auto certain2 = hn::Set(f, task.certain2), possible2 = hn::Set(f, task.possible2);
    const float *const x = task.at[0], *const y = task.at[1], *const z = task.at[2];
    const std::uint32_t* const ids = task.id;
    const auto wrapped = [&](hn::Vec<CellLanes> away, [[maybe_unused]] int k) HWY_ATTR {
        if constexpr (!wraps) return away;
        if (task.periods[k] == 0) return away;
        const auto turns = hn::Round(hn::Mul(away, hn::Set(f, 1 / task.periods[k])));
        return hn::NegMulAdd(turns, hn::Set(f, task.periods[k]), away);
    };
    const T *const own_x = task.asking->along(0), *const own_y = task.asking->along(1),
                   *const own_z = task.asking->along(D - 1);
    const Local<T> local_x(task.middle[0], task.scale), local_y(task.middle[1], task.scale),
        local_z(task.middle[D - 1], task.scale);
    // A point that asks, and the end of its list.
    struct Own {
        hn::Vec<CellLanes> x, y, z;
        std::uint32_t number;
        std::uint32_t* found;
    };
    const auto own = [&](std::uint32_t i, std::uint32_t* found) HWY_ATTR {
        return Own{hn::Set(f, local_x.one(own_x[i])), hn::Set(f, local_y.one(own_y[i])),
                   hn::Set(f, D == 3 ? local_z.one(own_z[i]) : 0), i, found};
    };
    // Adds those of the points from `at` on that are near to a list.
    const auto add = [&](Own& p, std::size_t at, hn::Vec<CellLanes> to_x, hn::Vec<CellLanes> to_y,
                         hn::Vec<CellLanes> to_z, hn::Vec<decltype(u)> id) HWY_ATTR {
        const auto dx = wrapped(hn::Sub(to_x, p.x), 0), dy = wrapped(hn::Sub(to_y, p.y), 1);
        auto distance2 = hn::MulAdd(dx, dx, hn::Mul(dy, dy));
        if constexpr (D == 3) {
            const auto dz = wrapped(hn::Sub(to_z, p.z), 2);
            distance2 = hn::MulAdd(dz, dz, distance2);
        }
        auto near = hn::Le(distance2, certain2), possible = hn::Le(distance2, possible2);
        if constexpr (listed != detail::Listed::all) {
            const auto self = hn::Set(u, p.number);
            const auto other =
                hn::RebindMask(f, listed == detail::Listed::later ? hn::Gt(id, self) : hn::Ne(id, self));
            near = hn::And(near, other), possible = hn::And(possible, other);
        }
        const auto unsure = hn::AndNot(near, possible);
        if (HWY_UNLIKELY(!hn::AllFalse(f, unsure)))
            near = hn::Or(near, measured(task, p.number, ids + at, unsure));
        hn::StoreU(compressed(s, hn::BitCast(s, id), hn::RebindMask(s, near)), s,
                   reinterpret_cast<std::int32_t*>(p.found));
        p.found += hn::CountTrue(f, near);
    };
    const auto z_from = [&](std::size_t at) HWY_ATTR {
        if constexpr (D == 3)
            return hn::LoadU(f, z + at);
        else
            return hn::Zero(f);
    };
    // Two points at a time, since what they read is the same. The list of the second is moved to its place.
    std::uint32_t* found = task.found;
    std::uint32_t i = task.first;
    for (; i + 1 < task.end; i += 2) {
        std::uint32_t* const apart = found + size + lanes;
        Own p = own(i, found), q = own(i + 1, apart);
        for (std::size_t at = 0; at < size; at += lanes) {
            const auto to_x = hn::LoadU(f, x + at), to_y = hn::LoadU(f, y + at), to_z = z_from(at);
            const auto id = hn::LoadU(u, ids + at);
            add(p, at, to_x, to_y, to_z, id);
            add(q, at, to_x, to_y, to_z, id);
        }
        const auto of_p = static_cast<std::size_t>(p.found - found),
                   of_q = static_cast<std::size_t>(q.found - apart);
        for (std::size_t k = 0; k < of_q; k += lanes) hn::StoreU(hn::LoadU(u, apart + k), u, p.found + k);
        task.counts[i - task.first] = static_cast<std::uint32_t>(of_p);
        task.counts[i + 1 - task.first] = static_cast<std::uint32_t>(of_q);
        found += of_p + of_q;
    }
    if (i < task.end) {
        Own p = own(i, found);
        for (std::size_t at = 0; at < size; at += lanes)
            add(p, at, hn::LoadU(f, x + at), hn::LoadU(f, y + at), z_from(at), hn::LoadU(u, ids + at));
        task.counts[i - task.first] = static_cast<std::uint32_t>(p.found - found);
    }
}

template <bool wraps, class T, int D>
HWY_INLINE void list_by_kind(const detail::CellTask<T, D>& task) {
    using enum detail::Listed;
    if (task.listed == all)
        list_by_filter<wraps, all>(task);
    else if (task.listed == others)
        list_by_filter<wraps, others>(task);
    else
        list_by_filter<wraps, later>(task);
}
template <class T, int D>
void list_cell(const detail::CellTask<T, D>& task) {
    if (task.wraps)
        list_by_kind<true>(task);
    else
        list_by_kind<false>(task);
}

// See CellKernelsOf.
template <class T, int D>
void measure(const detail::CellOrder<T, D>& order, const Vec<T, D>& p, const std::uint32_t* points,
             std::size_t size, T* distances2) {
    constexpr hn::CappedTag<double, 8> d;
    constexpr hn::Rebind<T, decltype(d)> t;
    constexpr hn::Rebind<std::uint32_t, decltype(d)> u;
    constexpr std::size_t lanes = hn::MaxLanes(d);
    for (std::size_t i = 0; i < size; i += lanes) {
        const auto number = hn::IfThenElseZero(hn::FirstN(u, size - i), hn::LoadU(u, points + i));
        auto sum = hn::Zero(d);
        for (int k = 0; k < D; ++k) {
            hn::Vec<decltype(d)> at;
            if constexpr (sizeof(T) == 4)
                at =
                    hn::PromoteTo(d, hn::GatherIndex(t, order.along(k),
                                                     hn::BitCast(hn::RebindToSigned<decltype(u)>(), number)));
            else
                at = hn::GatherIndex(d, order.along(k),
                                     hn::PromoteTo(hn::RebindToSigned<decltype(d)>(),
                                                   hn::BitCast(hn::RebindToSigned<decltype(u)>(), number)));
            const auto away = hn::Sub(hn::Set(d, static_cast<double>(p[k])), at);
            sum = k == 0 ? hn::Mul(away, away) : hn::Add(sum, hn::Mul(away, away));
        }
        if constexpr (sizeof(T) == 4)
            hn::StoreU(hn::DemoteTo(t, sum), t, distances2 + i);
        else
            hn::StoreU(sum, d, distances2 + i);
    }
}

// See CellKernels.
inline std::size_t number(const PrimitiveId* number_of, const std::uint32_t* points, std::size_t size,
                          PrimitiveId least, std::uint32_t* kept, PrimitiveId* numbers) {
    constexpr hn::RebindToUnsigned<CellLanes> u;
    constexpr hn::RebindToSigned<CellLanes> s;
    std::size_t count = 0;
    for (std::size_t i = 0; i < size; i += hn::MaxLanes(u)) {
        const auto here = hn::FirstN(s, size - i);
        const auto point = hn::IfThenElseZero(here, hn::BitCast(s, hn::LoadU(u, points + i)));
        const auto id = hn::GatherIndex(s, reinterpret_cast<const std::int32_t*>(number_of), point);
        const auto some =
            hn::And(here, hn::RebindMask(s, hn::Not(hn::Lt(hn::BitCast(u, id), hn::Set(u, least)))));
        hn::StoreU(compressed(s, point, some), s, reinterpret_cast<std::int32_t*>(kept + count));
        hn::StoreU(compressed(s, id, some), s, reinterpret_cast<std::int32_t*>(numbers + count));
        count += hn::CountTrue(s, some);
    }
    return count;
}

// See CellKernels.
inline void rank(const std::uint32_t* numbers, std::size_t size, std::uint32_t* ranks) {
    constexpr hn::RebindToUnsigned<CellLanes> u;
    for (std::size_t i = 0; i < size; i += hn::MaxLanes(u)) {
        const auto some = hn::LoadU(u, numbers + i);
        auto less = hn::Zero(u);
        for (std::size_t k = 0; k < size; ++k)
            less = hn::Sub(less, hn::VecFromMask(u, hn::Lt(hn::Set(u, numbers[k]), some)));
        hn::StoreU(less, u, ranks + i);
    }
}

}  // namespace hedgerow::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
