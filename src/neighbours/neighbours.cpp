#include <hedgerow/ask/neighbours.h>

#include <atomic>
#include <cmath>
#include <numeric>
#include <optional>
#include <tuple>

#include <hedgerow/base/error.h>

#include "cell_lists.h"
#include "in_turn.h"

namespace hedgerow {

namespace {

/// The lists of the points of a part, one after the other, and where each ends. The vectors may be longer.
template <class T>
struct PartLists {
    BareVector<std::size_t> ends;
    BareVector<PrimitiveId> ids;
    BareVector<T> distances2;
    std::size_t points, size;
};

/// Writes the lists in the order of cells.
template <class T, int D>
void list_in_order(const detail::CellOrder<T, D>& order, T max_distance2, detail::Listed listed,
                   NearLists<T>& lists, bool distances, Threads threads) {
    const std::size_t n = order.size();
    const auto lister = [&] {
        return detail::CellLister<T, D>(order, order, max_distance2, listed, distances);
    };
    lists.offsets.resize(n + 1);
    lists.offsets[0] = 0;
    std::size_t* const offsets = lists.offsets.data();
    if (Executor& executor = threads.over(n); &executor == &serial_executor()) {
        lister().list(0, order.cells().size() - 1, offsets + 1, lists.ids, lists.distances2);
    } else {
        using Part = PartLists<T>;
        const auto begins = detail::parts_of(order);
        const auto first = [&](std::size_t part) { return order.cells()[begins[part]].first; };
        const auto grow = [](auto& vector, std::size_t size, double expected) {
            if (vector.size() < size) vector.resize(std::max(size, static_cast<std::size_t>(expected)));
        };
        detail::in_turn<Part>(
            begins.size() - 1, executor,
            [&](std::size_t i, Part& part) {
                part.points = first(i + 1) - first(i);
                part.ends.resize(std::max(part.ends.size(), part.points));
                part.size =
                    lister().list(begins[i], begins[i + 1], part.ends.data(), part.ids, part.distances2);
            },
            [&](std::size_t i, const Part& part) {
                const std::size_t size = offsets[first(i)] + part.size;
                // Expect about as many neighbours for the points to come, and a tenth more.
                const double share = static_cast<double>(first(i + 1)) / static_cast<double>(n),
                             expected = 1.1 * static_cast<double>(size) / share;
                grow(lists.ids, size, expected);
                if (distances) grow(lists.distances2, size, expected);
                offsets[first(i + 1)] = size;
            },
            [&](std::size_t i, const Part& part) {
                const std::size_t at = offsets[first(i)];
                for (std::size_t k = 0; k + 1 < part.points; ++k)
                    offsets[first(i) + k + 1] = at + part.ends[k];
                std::copy_n(part.ids.begin(), part.size, lists.ids.begin() + at);
                if (distances) std::copy_n(part.distances2.begin(), part.size, lists.distances2.begin() + at);
            });
    }
    lists.ids.resize(offsets[n]);
    lists.distances2.resize(distances ? offsets[n] : 0);
}

/// How many of some different numbers are less than each.
class Ranking {
public:
    static constexpr std::size_t room = 16;  // that may be read beyond the numbers

    const std::uint32_t* of(const std::uint32_t* numbers, std::size_t size) {
        if (ranks_.size() < size + room) ranks_.resize(2 * size + room);
        constexpr std::size_t longest = 512;  // that is not sorted
        if (const auto* const kernels = in_use<detail::CellKernels>();
            kernels != nullptr && size <= longest) {
            kernels->rank(numbers, size, ranks_.data());
            return ranks_.data();
        }
        places_.resize(size);
        std::iota(places_.begin(), places_.end(), 0);
        std::sort(places_.begin(), places_.end(), [&](auto a, auto b) { return numbers[a] < numbers[b]; });
        for (std::size_t k = 0; k < size; ++k) ranks_[places_[k]] = static_cast<std::uint32_t>(k);
        return ranks_.data();
    }

private:
    BareVector<std::uint32_t> ranks_, places_;
};

/// Lists whose numbers are replaced by those of the caller's array, ascending.
template <class T, int D>
class Renumbering {
public:
    using Order = detail::CellOrder<T, D>;
    /// With `once` only greater numbers than that of the point itself are listed.
    Renumbering(const Order& asking, const Order& order, bool once, bool distances)
        : asking_(asking), order_(order), once_(once), distances_(distances) {}

    /// Renumbers the lists of a part whose first point is `first`, in place, and measures distances.
    void renumber(const detail::CellLister<T, D>& lister, std::size_t first, PartLists<T>& part) {
        std::size_t begin = 0, to = 0;
        if (distances_) part.distances2.resize(std::max(part.distances2.size(), part.size + room));
        for (std::size_t i = 0; i < part.points; ++i) {
            const std::size_t end = part.ends[i];
            if (list_.size() < end - begin + room)
                for (auto* const vector : {&list_, &kept_}) vector->resize(2 * (end - begin + room));
            const PrimitiveId least = once_ ? asking_.order()[first + i] + 1 : 0;
            const std::size_t size = number(part.ids.data() + begin, end - begin, least);
            const std::uint32_t* const ranks = ranking_.of(list_.data(), size);
            for (std::size_t k = 0; k < size; ++k) part.ids[to + ranks[k]] = list_[k];
            if (distances_) {
                if (distances2_.size() < size + room) distances2_.resize(2 * size + room);
                lister.measure(static_cast<std::uint32_t>(first + i), kept_.data(), size, distances2_.data());
                for (std::size_t k = 0; k < size; ++k) part.distances2[to + ranks[k]] = distances2_[k];
            }
            begin = end, part.ends[i] = to += size;
        }
        part.size = to;
    }

private:
    static constexpr std::size_t room = Order::padding;
    /// Writes the numbers that are at least `least` to `list_`, and the points with them to `kept_`.
    std::size_t number(const std::uint32_t* points, std::size_t count, PrimitiveId least) {
        if (const auto* const kernels = in_use<detail::CellKernels>(); kernels != nullptr)
            return kernels->number(order_.order().data(), points, count, least, kept_.data(), list_.data());
        std::size_t size = 0;
        for (std::size_t k = 0; k < count; ++k) {
            list_[size] = order_.order()[points[k]], kept_[size] = points[k];
            size += list_[size] >= least;
        }
        return size;
    }
    const Order &asking_, &order_;
    bool once_, distances_;
    BareVector<std::uint32_t> list_, kept_;
    Ranking ranking_;
    BareVector<T> distances2_;
};

/// Lists of neighbours of a caller, in the order of his points.
template <class T>
struct ListsOf {
    NearLists<T>& lists;
    bool distances;

    void start(const std::vector<std::size_t>& offsets) {
        lists.offsets.clear();
        lists.offsets.append(offsets);
        lists.ids.resize(offsets.back());
        lists.distances2.resize(distances ? offsets.back() : 0);
    }
    void write(std::size_t point, const PrimitiveId* ids, const T* distances2, std::size_t size) const {
        const std::size_t to = lists.offsets[point];
        std::copy_n(ids, size, lists.ids.begin() + to);
        if (distances) std::copy_n(distances2, size, lists.distances2.begin() + to);
    }
};
/// The same as pairs.
template <class T>
struct PairsOf {
    std::vector<PairWithin<T>>& pairs;
    static constexpr bool distances = true;
    std::vector<std::size_t> first = {};

    void start(const std::vector<std::size_t>& offsets) {
        first = offsets;
        if (pairs.capacity() < offsets.back()) pairs.clear();
        pairs.resize(offsets.back());
    }
    void write(std::size_t point, const PrimitiveId* ids, const T* distances2, std::size_t size) const {
        PairWithin<T>* const to = pairs.data() + first[point];
        for (std::size_t k = 0; k < size; ++k)
            to[k] = {static_cast<PrimitiveId>(point), ids[k], distances2[k]};
    }
};

/// Finds the neighbours of points that ask, of the same order or of another one over the same axes, and hands
/// them over by the numbers of the caller's arrays: first where the list of each point begins, then each
/// list.
template <class T, int D, class Taker>
void list_renumbered(const detail::CellOrder<T, D>& asking, const detail::CellOrder<T, D>& order,
                     T max_distance2, detail::Listed listed, Taker taker, Executor& executor) {
    const bool once = listed == detail::Listed::later;
    const auto begins = detail::parts_of(asking);
    const auto first = [&](std::size_t part) { return asking.cells()[begins[part]].first; };
    const auto number = [&](std::size_t i) { return asking.order()[i]; };
    std::vector<PartLists<T>> parts(begins.size() - 1);
    std::vector<std::size_t> offsets(asking.size() + 1);
    executor.for_each_piece(parts.size(), 1, [&](std::size_t from, std::size_t to) {
        detail::CellLister<T, D> lister(asking, order, max_distance2, once ? detail::Listed::others : listed,
                                        false);
        Renumbering<T, D> renumbering(asking, order, once, taker.distances);
        for (std::size_t i = from; i < to; ++i) {
            PartLists<T>& part = parts[i];
            part.points = first(i + 1) - first(i);
            part.ends.resize(part.points);
            part.size = lister.list(begins[i], begins[i + 1], part.ends.data(), part.ids, part.distances2);
            renumbering.renumber(lister, first(i), part);
            for (std::size_t k = 0, begin = 0; k < part.points; begin = part.ends[k], ++k)
                offsets[number(first(i) + k) + 1] = part.ends[k] - begin;
        }
    });
    std::partial_sum(offsets.begin(), offsets.end(), offsets.begin());
    taker.start(offsets);
    executor.for_each_piece(parts.size(), 1, [&](std::size_t from, std::size_t to) {
        for (std::size_t i = from; i < to; ++i) {
            const PartLists<T>& part = parts[i];
            for (std::size_t k = 0, begin = 0; k < part.points; begin = part.ends[k], ++k)
                taker.write(number(first(i) + k), part.ids.data() + begin, part.distances2.data() + begin,
                            part.ends[k] - begin);
        }
    });
}

template <int D>
Periods<D> periods_of(const NeighbourOptions& options) {
    Periods<D> periods;
    for (int k = 0; k < D; ++k) {
        periods[k] = options.periods[k];
        if (!(periods[k] >= 0) || std::isinf(periods[k]))
            throw UsageError("a period of " + std::to_string(periods[k]) + " along axis " +
                             std::to_string(k) + " is not a length, nor 0 where space does not repeat");
    }
    return periods;
}

/// Lists the neighbours of one set.
template <class T, int D>
void list_neighbours(const Strided<Vec<T, D>>& points, T max_distance2, NearLists<T>& lists,
                     const NeighbourOptions& options) {
    const Periods<D> periods = periods_of<D>(options);
    if (options.order != nullptr) options.order->clear();
    if (points.empty()) {
        lists.clear();
        return;
    }
    IeeeExecutor executor(options.threads.over(points.size()));
    const detail::CellAxes<T, D> axes(std::span(&points, 1), detail::farthest_within(max_distance2), periods,
                                      executor);
    const detail::CellOrder<T, D> order(points, axes, executor);
    const auto& ids = order.order();
    const auto listed = options.once ? detail::Listed::later : detail::Listed::others;
    if (options.order != nullptr) options.order->assign(ids.begin(), ids.end());
    if (options.order != nullptr || std::is_sorted(ids.begin(), ids.end()))
        list_in_order(order, max_distance2, listed, lists, options.distances, options.threads);
    else
        list_renumbered(order, order, max_distance2, listed, ListsOf<T>{lists, options.distances}, executor);
}
/// How many distances are measured to list the neighbours of points among others.
template <class T, int D>
std::uint64_t pairs_in_touching_cells(const detail::CellOrder<T, D>& asking,
                                      const detail::CellOrder<T, D>& order, Executor& executor) {
    const auto& cells = asking.cells();
    std::atomic<std::uint64_t> pairs = 0;
    executor.for_each_piece(cells.size() - 1, worth_a_task, [&](std::size_t begin, std::size_t end) {
        std::uint64_t here = 0;
        detail::CellSweep<T, D>(asking, order)
            .for_each_cell(begin, end, [&](std::size_t cell, const auto&, auto runs) {
                std::uint64_t around = 0;
                for (const auto& run : runs) around += run.end - run.first;
                here += around * (cells[cell + 1].first - cells[cell].first);
            });
        pairs += here;
    });
    return pairs;
}
/// Sorts each list by (distance², id).
template <class T>
void sort_by_distance(NearLists<T>& lists, Executor& executor) {
    executor.for_each_piece(lists.offsets.size() - 1, 256, [&](std::size_t from, std::size_t to) {
        std::vector<std::pair<T, PrimitiveId>> list;
        for (std::size_t i = from; i < to; ++i) {
            const std::size_t begin = lists.offsets[i], end = lists.offsets[i + 1];
            list.clear();
            for (std::size_t k = begin; k < end; ++k) list.emplace_back(lists.distances2[k], lists.ids[k]);
            std::sort(list.begin(), list.end());
            for (std::size_t k = begin; k < end; ++k)
                std::tie(lists.distances2[k], lists.ids[k]) = list[k - begin];
        }
    });
}

/// Finds the neighbours of points among others. Returns false, and finds none, if more than `most_measured`
/// distances, where that is given, would be measured for each point that asks.
template <class T, int D, class Taker>
bool list_among(const Strided<Vec<T, D>>& points, const Strided<Vec<T, D>>& asking, T max_distance2,
                const Periods<D>& periods, Taker taker, Threads threads,
                std::optional<std::uint64_t> most_measured = {}) {
    if (points.empty() || asking.empty()) {
        taker.start(std::vector<std::size_t>(asking.size() + 1));
        return true;
    }
    IeeeExecutor executor(threads.over(points.size() + asking.size()));
    const std::array sets = {points, asking};
    const detail::CellAxes<T, D> axes(sets, detail::farthest_within(max_distance2), periods, executor);
    const detail::CellOrder<T, D> order(points, axes, executor), of_asking(asking, axes, executor);
    if (most_measured && pairs_in_touching_cells(of_asking, order, executor) / *most_measured > asking.size())
        return false;
    list_renumbered(of_asking, order, max_distance2, detail::Listed::all, taker, executor);
    return true;
}

}  // namespace

template <std::floating_point T, int D>
void detail::CellNeighbours<T, D>::list(const Points& points, T max_distance2, NearLists<T>& lists,
                                        const NeighbourOptions& options) {
    in_ieee_mode([&] {
        list_in_own_memory(lists, [&](auto& own) { list_neighbours(points, max_distance2, own, options); });
    });
}
template <std::floating_point T, int D>
void detail::CellNeighbours<T, D>::list(const Points& points, const Points& asking, T max_distance2,
                                        NearLists<T>& lists, const NeighbourOptions& options) {
    if (options.once || options.order != nullptr)
        throw UsageError("pairs once, and points in the order of cells, are for neighbours of one set");
    in_ieee_mode([&] {
        list_in_own_memory(lists, [&](auto& own) {
            list_among(points, asking, max_distance2, periods_of<D>(options),
                       ListsOf<T>{own, options.distances}, options.threads);
        });
    });
}

template <std::floating_point T, int D>
std::size_t detail::CellNeighbours<T, D>::pairs(const Points& points, T max_distance2,
                                                std::vector<PairWithin<T>>& found, Threads threads) {
    in_ieee_mode([&] {
        if (points.empty()) return found.clear();
        IeeeExecutor executor(threads.over(points.size()));
        const CellAxes<T, D> axes(std::span(&points, 1), farthest_within(max_distance2), {}, executor);
        const CellOrder<T, D> order(points, axes, executor);
        list_renumbered(order, order, max_distance2, Listed::later, PairsOf<T>{found}, executor);
    });
    return found.size();
}
template <std::floating_point T, int D>
std::size_t detail::CellNeighbours<T, D>::pairs(const Points& a, const Points& b, T max_distance2,
                                                std::vector<PairWithin<T>>& found, Threads threads) {
    in_ieee_mode([&] { list_among(b, a, max_distance2, {}, PairsOf<T>{found}, threads); });
    return found.size();
}

template <std::floating_point T, int D>
bool detail::CellNeighbours<T, D>::within(const Points& points, const Points& asking, T max_distance2,
                                          NearLists<T>& lists, Threads threads) {
    // Sorting a point by its cell takes about a tenth of the time of a walk. The distances of a cell's points
    // are measured 16 at once: 4096 take about as long as a walk that finds few.
    constexpr std::size_t points_for_each = 16, least = 256, most_measured_for_each = 4096;
    if (points.empty() || asking.size() < std::max(least, points.size() / points_for_each)) return false;
    for (std::size_t i = 0; i < asking.size(); ++i)
        for (int k = 0; k < D; ++k)
            if (!(std::abs(asking[i][k]) <= largest_coordinate<T>)) return false;
    return in_ieee_mode([&] {
        if (!list_among(points, asking, max_distance2, {}, ListsOf<T>{lists, true}, threads,
                        most_measured_for_each))
            return false;
        IeeeExecutor executor(threads.over(points.size() + asking.size()));
        sort_by_distance(lists, executor);
        return true;
    });
}

template struct detail::CellNeighbours<float, 2>;
template struct detail::CellNeighbours<float, 3>;
template struct detail::CellNeighbours<double, 2>;
template struct detail::CellNeighbours<double, 3>;

}  // namespace hedgerow
