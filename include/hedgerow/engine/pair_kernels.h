/// The engine's specialisation of Kernel (walks/kernel.h) for pairs of points within a radius: of float
/// points in space, of one set in a WideBvh, or of any set and one in a WideBvh.
#pragma once

#include <algorithm>
#include <cmath>
#include <mutex>
#include <span>
#include <tuple>
#include <utility>
#include <vector>

#include <hedgerow/base/bare_vector.h>
#include <hedgerow/engine/point_kernels.h>
#include <hedgerow/parallel/ieee_executor.h>
#include <hedgerow/queries/pairs_within.h>

namespace hedgerow {

namespace detail {

/// The neighbours of some points in an index, found by blocks of eight points: the leaves near a block are
/// looked for once, and each of its points is measured to all that these hold, in vectors.
class NeighbourLists {
public:
    /// The neighbours of a point, ascending.
    struct Neighbours {
        const PrimitiveId* ids = nullptr;
        const float* distances2 = nullptr;
        std::size_t count = 0;
    };

    NeighbourLists(const NeighbourKernels& kernels, const WidePoints& scene, float max_distance2, bool later)
        : kernels_(kernels), scene_(scene), max_distance2_(max_distance2), later_(later) {}

    void add(const PointBlock<float, 3>& block) {
        constexpr std::size_t places = PointBlock<float, 3>::size;
        const std::span<const std::uint32_t> leaves = leaves_near(block);
        NeighbourArrays to = arrays(places * leaves.size() + 16, places * places * leaves.size());
        kernels_.list(scene_, leaves.data(), leaves.size(), block, max_distance2_, later_, to);
        for (std::size_t i = 0; i < places; ++i) {
            const std::uint32_t count = to.counts[i];
            if (count == 0) continue;
            if (count > most_ranked) sort(size_, count);
            lists_.push_back({block.id[i], count});
            size_ += count;
        }
    }
    /// Calls f(id, neighbours) for each point that has any.
    template <class F>
    void for_each(F f) const {
        std::size_t at = 0;
        for (const auto& [id, count] : lists_) {
            f(id, Neighbours{&ids_[at], &distances2_[at], count});
            at += count;
        }
    }

private:
    /// The neighbours of a point, after those of the points before it.
    struct List {
        PrimitiveId id;
        std::uint32_t count;
    };

    /// Rows of as many numbers each, aligned to 64 bytes.
    template <class T, std::size_t count>
    class Rows {
    public:
        void make_room(std::size_t size) {
            const std::size_t lines = (size + 15) / 16;
            if (lines <= lines_) return;
            lines_ = 2 * lines;
            all_.resize(count * lines_);
        }
        T* operator[](std::size_t i) { return all_[i * lines_].numbers; }

    private:
        struct alignas(64) Line {
            T numbers[16];
        };
        BareVector<Line> all_;
        std::size_t lines_ = 0;
    };

    std::span<const std::uint32_t> leaves_near(const PointBlock<float, 3>& block) {
        static thread_local std::vector<std::uint32_t> leaves(64);
        while (true) {
            const std::size_t count =
                kernels_.leaves(scene_, block, max_distance2_, leaves.data(), leaves.size());
            if (count <= leaves.size()) return {leaves.data(), count};
            leaves.resize(2 * count);
        }
    }
    /// Room for so many points near a block, and for so many neighbours of its points.
    NeighbourArrays arrays(std::size_t near, std::size_t found) {
        static thread_local Rows<float, 4> numbers;
        static thread_local Rows<PrimitiveId, 2> ids;
        numbers.make_room(near), ids.make_room(near);
        if (ids_.size() < size_ + found) {
            ids_.resize(2 * (size_ + found));
            distances2_.resize(ids_.size());
        }
        return {{numbers[0], numbers[1], numbers[2]}, ids[0], ids[1], numbers[3], ids_.data() + size_,
                distances2_.data() + size_,           {}};
    }
    void sort(std::size_t first, std::size_t count) {
        static thread_local std::vector<std::pair<PrimitiveId, float>> list;
        list.clear();
        for (std::size_t k = first; k < first + count; ++k) list.emplace_back(ids_[k], distances2_[k]);
        std::sort(list.begin(), list.end());
        for (std::size_t k = 0; k < count; ++k) std::tie(ids_[first + k], distances2_[first + k]) = list[k];
    }

    const NeighbourKernels& kernels_;
    const WidePoints scene_;
    float max_distance2_;
    bool later_;
    std::vector<List> lists_;
    BareVector<PrimitiveId> ids_;
    BareVector<float> distances2_;
    std::size_t size_ = 0;
};

/// Makes one list of the pairs of all parts, ascending, of a set of some points.
inline void join_lists(const std::vector<NeighbourLists>& parts, std::size_t points, Executor& threads,
                       std::vector<PairWithin<float>>& found) {
    std::vector<NeighbourLists::Neighbours> of(points);
    for (const NeighbourLists& part : parts)
        part.for_each([&](PrimitiveId id, const auto& neighbours) { of[id] = neighbours; });
    std::vector<std::size_t> ends(points);
    std::size_t total = 0;
    for (std::size_t i = 0; i < points; ++i) ends[i] = total += of[i].count;
    if (found.capacity() < total) found.clear();
    found.resize(total);
    threads.for_each_piece(points, 4096, [&](std::size_t begin, std::size_t end) {
        // The lists of points with near numbers may lie far apart.
        constexpr std::size_t ahead = 8, line = 64 / sizeof(PrimitiveId);
        for (std::size_t i = begin; i < end; ++i) {
            const auto& next = of[std::min(i + ahead, points - 1)];
            for (std::size_t k = 0; k < next.count; k += line) {
                __builtin_prefetch(next.ids + k);
                __builtin_prefetch(next.distances2 + k);
            }
            const auto& [ids, distances2, count] = of[i];
            PairWithin<float>* const to = found.data() + (ends[i] - count);
            for (std::size_t k = 0; k < count; ++k)
                to[k] = {static_cast<PrimitiveId>(i), ids[k], distances2[k]};
        }
    });
}

}  // namespace detail

template <class A, class B, detail::CloudForKernels I>
struct Kernel<PairsWithin<A, B>, I> : detail::PointKernel<I> {
    using Pairs = std::vector<PairWithin<float>>;

    /// Writes the pairs of the points of an index to `found`. False, and nothing is written, where the walk
    /// has to answer.
    bool answer_all(const I& index, float max_distance2, Executor& executor, Pairs& found) const {
        if (!takes(index, max_distance2)) return false;
        constexpr std::size_t each = 256;
        const auto& blocks = index.packed();
        std::vector parts((blocks.size() + each - 1) / each, lists(index, max_distance2, true));
        IeeeExecutor(executor).for_each_piece(parts.size(), 1, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin * each; i < std::min(end * each, blocks.size()); ++i)
                parts[i / each].add(blocks.data()[i]);
        });
        detail::join_lists(parts, index.size(), executor, found);
        return true;
    }
    /// Those of a point of an index of any structure, and one of `index`.
    template <class Other>
    bool answer_all(const Other& a, const I& index, float max_distance2, Executor& executor,
                    Pairs& found) const {
        if (!takes(a, max_distance2) || !takes(index, max_distance2)) return false;
        const auto& set = a.primitives();
        std::vector<Vec<float, 3>> points(set.size());
        for (std::size_t i = 0; i < points.size(); ++i) points[i] = set.point(i);
        std::vector<detail::NeighbourLists> parts;
        std::mutex adding;
        IeeeExecutor threads(executor);
        const auto list = [&](const PointBatch<float, 3>& part) {
            constexpr std::size_t each = 2048;
            for (std::size_t first = 0; first < part.size(); first += each) {
                auto some = lists(index, max_distance2, false);
                add(part.part(first, std::min(each, part.size() - first)), some);
                const std::lock_guard lock(adding);
                parts.push_back(std::move(some));
            }
        };
        for_each_part<float, 3>(std::span<const Vec<float, 3>>(points), index.bounds(), index.bytes(),
                                threads, list);
        detail::join_lists(parts, points.size(), executor, found);
        return true;
    }

private:
    template <class Other>
    static bool takes(const Other& index, float max_distance2) {
        using Points = detail::PointKernel<I>;
        return index.size() > 0 && Points::takes(index.bounds().low) && Points::takes(index.bounds().high) &&
               max_distance2 >= 0;
    }
    detail::NeighbourLists lists(const I& index, float max_distance2, bool later) const {
        return {this->all().neighbours, this->scene(index), max_distance2, later};
    }
    /// Adds the neighbours of points, eight in a block.
    static void add(const PointBatch<float, 3>& points, detail::NeighbourLists& lists) {
        PointBlocks<float, 3> blocks(points.size());
        for (std::size_t i = 0; i < PointBlock<float, 3>::size * blocks.size(); ++i) {
            if (i < points.size())
                blocks.set(i, points[i], static_cast<PrimitiveId>(points.number(i)));
            else
                blocks.clear(i);
        }
        for (std::size_t i = 0; i < blocks.size(); ++i) lists.add(blocks.data()[i]);
    }
};

}  // namespace hedgerow
