/// Lists of the neighbours of points in an order of cells.
#pragma once

#include <algorithm>
#include <limits>

#include <hedgerow/geometry/radius.h>

#include "cell_kernels.h"

namespace hedgerow::detail {

/// A bound of the distances whose squares, rounded to T, are at most a maximum.
template <std::floating_point T>
double farthest_within(T max_distance2) {
    return std::sqrt(static_cast<double>(std::max(max_distance2, T(0))) +
                     static_cast<double>(std::numeric_limits<T>::denorm_min())) *
           (1 + 0x1p-22);
}

/// Lists neighbours within a squared distance, by the kernels in use or pair by pair.
template <std::floating_point T, int D>
class CellLister {
public:
    /// For the points of `asking`, their neighbours in `order`, which is the same order or has the same axes.
    CellLister(const CellOrder<T, D>& asking, const CellOrder<T, D>& order, T max_distance2, Listed listed,
               bool distances)
        : asking_(asking),
          order_(order),
          limit2_(max_distance2),
          surely_within_(max_distance2 >= 0 ? std::sqrt(static_cast<double>(max_distance2)) : -1),
          farthest_within_(farthest_within(max_distance2)),
          distances_(distances) {
        double side = 0;
        for (int k = 0; k < D; ++k) {
            const CellAxis& axis = order.axes()[k];
            side = std::max(side, axis.side());
            task_.wraps |= axis.wraps();
            plain_ &= !(axis.period() > 0);
        }
        task_.asking = &asking, task_.order = &order, task_.listed = listed, task_.scale = 1 / side;
        for (int k = 0; k < D; ++k) {
            const CellAxis& axis = order.axes()[k];
            if (axis.wraps()) task_.periods[k] = static_cast<float>(axis.period() * task_.scale);
            if (asking.wrapped() || order.wrapped())
                moved_ = std::max(moved_, 2 * unit_roundoff<T> * axis.period() * task_.scale);
        }
        task_.asker = this, task_.counts = counts_.data();
        task_.is_near = [](const void* asker, std::uint32_t i, std::uint32_t j) {
            return static_cast<const CellLister*>(asker)->distance2(i, j) <=
                   static_cast<const CellLister*>(asker)->limit2_;
        };
    }

    CellLister(const CellLister&) = delete;  // its task points into it
    CellLister& operator=(const CellLister&) = delete;

    /// Lists the neighbours of the points of cells [begin, end), one list after the other, in `ids` and, if
    /// they are asked for, `distances2`: vectors that become longer where that is needed. Writes the end of
    /// each list to `ends`, and returns the last.
    template <class Ids, class Distances>
    std::size_t list(std::size_t begin, std::size_t end, std::size_t* ends, Ids& ids, Distances& distances2) {
        const auto& cells = asking_.cells();
        const CellKernels* const kernels = in_use<CellKernels>();
        const std::uint32_t first = cells[begin].first;
        const double points = cells[end].first - first;
        std::size_t size = 0;
        CellSweep<T, D>(asking_, order_)
            .for_each_cell(begin, end, [&](std::size_t cell, const auto& numbers, auto runs) {
                task_.runs = runs;
                const std::uint32_t last = cells[cell + 1].first;
                std::size_t around = 0;
                for (const auto& run : runs) around += run.end - run.first;
                if (kernels != nullptr) prepare(numbers, around);
                for (std::uint32_t i = cells[cell].first; i < last; i = task_.end) {
                    task_.first = i, task_.end = std::min(last, i + task_.most_points);
                    const std::size_t room = size + (task_.end - i) * around + 2 * CellOrder<T, D>::padding;
                    if (ids.size() < room)
                        ids.resize(enough(room, size, (task_.end - first) / points, ids.size()));
                    task_.found = ids.data() + size;
                    if (kernels != nullptr)
                        kernels->template of<T, D>().list(task_);
                    else
                        list_pair_by_pair();
                    for (std::uint32_t k = i; k < task_.end; ++k) ends[k - first] = size += counts_[k - i];
                }
            });
        if (distances_) {
            if (distances2.size() < size + CellOrder<T, D>::padding)
                distances2.resize(size + CellOrder<T, D>::padding);
            std::size_t at = 0;
            for (std::uint32_t i = first; i < cells[end].first; at = ends[i++ - first])
                measure(i, ids.data() + at, ends[i - first] - at, distances2.data() + at);
        }
        return size;
    }

    /// Writes the squared distances from a point that asks to others. May write `CellOrder::padding` more.
    void measure(std::uint32_t i, const std::uint32_t* points, std::size_t size, T* distances2) const {
        if (const CellKernels* const kernels = in_use<CellKernels>(); kernels != nullptr && plain_)
            return kernels->template of<T, D>().measure(order_, asking_.point(i), points, size, distances2);
        for (std::size_t k = 0; k < size; ++k) distances2[k] = distance2(i, points[k]);
    }

private:
    T distance2(std::uint32_t i, std::uint32_t j) const {
        return image_distance2(asking_.point(i), order_.point(j), order_.axes().periods());
    }
    /// A length of lists that have `size` numbers for a share of the points: for as many for the others, and
    /// a tenth more; but what was too short once is likely to be again.
    static std::size_t enough(std::size_t room, std::size_t size, double share, std::size_t before) {
        const double expected = 1.1 * static_cast<double>(size) / share;
        return std::max({room, static_cast<std::size_t>(expected), share < 0.9 ? before + before / 2 : 0});
    }
    void list_pair_by_pair() {
        std::uint32_t* found = task_.found;
        for (std::uint32_t i = task_.first; i < task_.end; ++i) {
            const std::uint32_t* const first = found;
            for (const auto& run : task_.runs)
                for (std::uint32_t j = task_.listed == Listed::later ? std::max(run.first, i + 1) : run.first;
                     j < run.end; ++j)
                    if ((j != i || task_.listed == Listed::all) && distance2(i, j) <= limit2_) *found++ = j;
            task_.counts[i - task_.first] = static_cast<std::uint32_t>(found - first);
        }
    }
    /// Sets a cell's middle, the squared distances between which the filter leaves a pair in doubt, and the
    /// kernel's arrays for so many points.
    ///
    /// In units of the longest cell, let δ bound the error of a coordinate relative to the cell's middle. It
    /// is at most 3 in magnitude and rounded four times: 2^-20 is more. What is subtracted is rounded too, by
    /// less than 2^-46 of its magnitude, and coordinates that were wrapped by `moved_`. A difference along an
    /// axis then errs by less than 2δ and a last bit, and the square of a distance r by less than 2·√3·r·2δ +
    /// 12·δ² + 2^-21·r², where the last term has room for the roundings of the rule itself and of the bounds.
    void prepare(const std::array<std::uint32_t, D>& numbers, std::size_t around) {
        double far = order_.axes().farthest();  // the rule's differences are those of places as given
        for (int k = 0; k < D; ++k) {
            const CellAxis& axis = order_.axes()[k];
            task_.middle[k] = axis.middle(numbers[static_cast<std::size_t>(k)]);
            far = std::max(far, std::abs(task_.middle[k]) + axis.period());
        }
        const double delta = 0x1p-20 + 0x1p-46 * far * task_.scale + moved_;
        constexpr double beyond_all = 64;  // of the cells that touch
        const double sure = std::min(surely_within_ * task_.scale, beyond_all),
                     r = std::min(farthest_within_ * task_.scale, beyond_all);
        const double error = 12 * r * delta + 24 * delta * delta + 0x1p-20 * r * r;
        task_.certain2 = static_cast<float>(sure < 0 ? -1 : sure * sure - error);
        task_.possible2 = static_cast<float>(r * r + error);
        const std::size_t room = around + CellOrder<T, D>::padding;
        if (ids_.size() < room) {
            ids_.resize(2 * room);
            for (auto& row : at_) row.resize(ids_.size());
        }
        for (std::size_t k = 0; k < 3; ++k) task_.at[k] = at_[k].data();
        task_.id = ids_.data();
    }

    const CellOrder<T, D>&asking_, &order_;
    T limit2_;
    double surely_within_,
        farthest_within_;  // distances; squares below the least number of T round up or down
    double moved_ = 0;
    bool distances_, plain_ = true;  // plain: without periods
    CellTask<T, D> task_ = {};
    std::array<std::uint32_t, CellTask<T, D>::most_points> counts_;
    std::array<BareVector<float>, 3> at_;
    BareVector<std::uint32_t> ids_;
};

}  // namespace hedgerow::detail
