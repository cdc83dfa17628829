/// The engine's specialisations of Kernel (walks/kernel.h) for points: the kernels answer closest points, k
/// nearest and all within a distance, of float triangles and points in a WideBvh in space, the closest points
/// of triangles of double, and how many points are in a ball. Of any other primitives in a WideBvh in space
/// they do the walk, and the leaves are tested as in any walk.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include <hedgerow/engine/kernel_scenes.h>
#include <hedgerow/engine/near_keys.h>
#include <hedgerow/geometry/ball.h>
#include <hedgerow/queries/closest_point.h>
#include <hedgerow/queries/lists.h>
#include <hedgerow/queries/nearest.h>
#include <hedgerow/queries/overlap_count.h>
#include <hedgerow/queries/within.h>

namespace hedgerow {

namespace detail {

template <class I>
concept NearForKernels = TrianglesForKernels<I> || CloudForKernels<I>;

/// The kernels of points over indexes I that are in use when the object is made.
template <WideForKernels I>
class PointKernel {
public:
    using T = typename I::Primitives::Scalar;

    explicit operator bool() const { return kernels_ != nullptr; }

protected:
    const AllPointKernels& all() const { return *kernels_->points; }
    const auto& kernels() const {
        if constexpr (TrianglesForKernels<I>)
            return all().triangles;
        else if constexpr (DoublesForKernels<I>)
            return all().doubles;
        else
            return all().points;
    }
    static auto scene(const I& index) { return kernel_scene(index); }
    // Squared distances of farther points may overflow; NaN is no nearer to anything.
    static bool takes(const Vec<T, 3>& point) {  // without a branch
        const auto fits = [](T x) { return unsigned(std::abs(x) <= T(largest_coordinate<float>)); };
        return (fits(point[0]) & fits(point[1]) & fits(point[2])) != 0;
    }
    // Squared distances to boxes are compared as floats. Those in a small scene of doubles would all be the
    // same, and those in a large one overflow.
    static bool takes(const I& index) {
        if constexpr (std::is_same_v<T, float>) return true;
        const auto& bounds = index.bounds();
        return takes(bounds.low) && takes(bounds.high) && max_component(bounds.extent()) > T(0x1p-40);
    }
    // Kernels leave nothing out, not even what is a little nearer.
    static bool exact(const NearLimits<T>& limits) {
        return limits.factor == 1 && limits.leave_out == no_primitive;
    }
    static bool takes(const I& index, const Vec<T, 3>& point, const NearLimits<T>& limits) {
        return takes(point) && takes(index) && exact(limits);
    }
    static bool takes_all(const I& index, const PointBatch<T, 3>& points, const NearLimits<T>& limits) {
        bool all = takes(index) && exact(limits);
        for (std::size_t i = 0; i < points.size(); ++i) all &= takes(points[i]);
        return all;
    }
    template <class Q, class... Arguments>
    static auto answer_of_walk(const I& index, Arguments&&... arguments) {
        Q query(index, arguments...);
        index.ask(query);
        return query.answer();
    }
    /// Replaces what `found` holds by the primitives that the keys name.
    template <class Found>
    static std::size_t read(const I& index, const Vec<float, 3>& point, std::span<const NearKey> keys,
                            Found& found) {
        const auto& set = index.primitives();
        found.resize(keys.size());
        for (std::size_t i = 0; i < keys.size(); ++i) {
            const PrimitiveId element = element_of(keys[i]);
            auto& near = found[i];
            near.distance2 = distance2_of(keys[i]);
            near.primitive = reported_id(set, element, 0);
            near.element = element;
            if constexpr (CloudForKernels<I>)
                near.point = set.point(element);
            else
                near.point = set.closest_point(element, point).point;
            near.instance = 0;
        }
        return found.size();
    }

private:
    const WideKernels* kernels_ = wide_kernels();
};

/// A leaf as a walk sees it.
template <class T>
Leaf leaf_of(const WideTree<T, 3>& tree, std::uint32_t number) {
    const std::uint32_t first = wide_leaf_size * number;
    std::uint32_t count = 0;
    while (count < wide_leaf_size && tree.items[first + count] != no_primitive) ++count;
    return {tree.items.data(), first, count};
}
/// Other primitives: the kernels walk, and leaves are tested as in any walk.
template <class I>
class OtherKernel : public PointKernel<I> {
public:
    /// The walk, or a kernel for each point, answers batches.
    template <class... Arguments>
    bool answer_many(const I&, Arguments&&...) const {
        return false;
    }

protected:
    using typename PointKernel<I>::T;

    template <class Q, class... Arguments>
    auto answer_of(const I& index, const Vec<T, 3>& point, const NearLimits<T>& limits,
                   Arguments&&... arguments) const {
        Q query(index, point, arguments...);
        if (done(query)) return query.answer();
        if (this->takes(index, point, limits))
            walk(index, query);
        else
            index.ask(query);
        return query.answer();
    }

private:
    template <class Q>
    void walk(const I& index, Q& query) const {
        using Asked = std::pair<const I&, Q&>;
        Asked asked{index, query};
        const auto test = [](void* asker, std::uint32_t leaf) {
            auto& [of, asks] = *static_cast<Asked*>(asker);
            of.test_leaf(asks.probe(), leaf_of(of.structure().tree(), leaf), asks);
            return asks.limit();
        };
        const WideLeaves<T> leaves{index.structure().tree(), &asked, test};
        if constexpr (std::is_same_v<T, float>)
            this->all().walk(leaves, query.probe().point(), query.limit());
        else
            this->all().walk_of_doubles(leaves, query.probe().point(), query.limit());
    }
};
template <class I>
concept ClosestForKernels = NearForKernels<I> || DoublesForKernels<I>;

}  // namespace detail

template <class Set, class I>
requires(detail::WideForKernels<I> && !detail::ClosestForKernels<I>)  //
    struct Kernel<ClosestPoint<Set>, I> : detail::OtherKernel<I> {
    using typename detail::PointKernel<I>::T;

    auto answer(const I& index, const Vec<T, 3>& point, const NearLimits<T>& limits) const {
        return this->template answer_of<ClosestPoint<Set>>(index, point, limits, limits);
    }
};
template <class Set, class I>
requires(detail::WideForKernels<I> && !detail::NearForKernels<I>)  //
    struct Kernel<Nearest<Set>, I> : detail::OtherKernel<I> {
    using typename detail::PointKernel<I>::T;

    template <class Found>
    std::size_t answer(const I& index, const Vec<T, 3>& point, std::size_t k, const NearLimits<T>& limits,
                       Found& found) const {
        return this->template answer_of<Nearest<Set>>(index, point, limits, k, limits, found);
    }
};
template <class Set, class I>
requires(detail::WideForKernels<I> && !detail::NearForKernels<I>)  //
    struct Kernel<Within<Set>, I> : detail::OtherKernel<I> {
    using typename detail::PointKernel<I>::T;

    template <class Found>
    std::size_t answer(const I& index, const Vec<T, 3>& point, const NearLimits<T>& limits,
                       Found& found) const {
        return this->template answer_of<Within<Set>>(index, point, limits, limits, found);
    }
};

template <class Set, detail::ClosestForKernels I>
struct Kernel<ClosestPoint<Set>, I> : detail::PointKernel<I> {
    using typename detail::PointKernel<I>::T;

    Near<T, 3> answer(const I& index, const Vec<T, 3>& point, const NearLimits<T>& limits) const {
        if (!this->takes(index, point, limits)) [[unlikely]]
            return this->template answer_of_walk<ClosestPoint<Set>>(index, point, limits);
        if constexpr (detail::CloudForKernels<I>)
            if (index.structure().tree().crowded) [[unlikely]]
                return closest_of_crowd(index, point, limits);
        return this->kernels().closest(this->scene(index), point, limits.distance2);
    }
    bool answer_many(const I& index, const PointBatch<T, 3>& points, const NearLimits<T>& limits,
                     Near<T, 3>* found) const {
        if (!this->takes_all(index, points, limits)) return false;
        if constexpr (detail::CloudForKernels<I>)
            if (index.structure().tree().crowded) {
                for (std::size_t i = 0; i < points.size(); ++i)
                    found[points.number(i)] = closest_of_crowd(index, points[i], limits);
                return true;
            }
        this->kernels().closest_of_many(this->scene(index), points, limits.distance2, found);
        return true;
    }

private:
    /// The first of the one nearest, since that search gives up where many points are at one place.
    Near<T, 3> closest_of_crowd(const I& index, const Vec<T, 3>& point, const NearLimits<T>& limits) const {
        const Scratch<std::vector<Near<T, 3>>> found;
        found->reserve(1);
        const Kernel<Nearest<Set>, I> nearest;
        return nearest.answer(index, point, 1, limits, *found) == 0 ? Near<T, 3>() : found->front();
    }
};

template <class Set, detail::NearForKernels I>
struct Kernel<Nearest<Set>, I> : detail::PointKernel<I> {
    std::size_t answer(const I& index, const Vec<float, 3>& point, std::size_t k,
                       const NearLimits<float>& limits, std::vector<Near<float, 3>>& found) const {
        if (k > most_nearest || !this->takes(index, point, limits)) [[unlikely]]
            return this->template answer_of_walk<Nearest<Set>>(index, point, k, limits, found);
        alignas(64) NearKey keys[most_nearest];
        const std::size_t count =
            this->kernels().nearest(this->scene(index), point, k, limits.distance2, keys);
        if constexpr (detail::CloudForKernels<I>)
            if (count == gave_up) [[unlikely]]
                return this->template answer_of_walk<NearestAmongTies<Set>>(index, point, k, limits, found);
        return this->read(index, point, {keys, count}, found);
    }
    bool answer_many(const I& index, const PointBatch<float, 3>& points, std::size_t k,
                     const NearLimits<float>& limits, PrimitiveId* ids, float* distances2) const {
        if (k > most_nearest || !this->takes_all(index, points, limits)) return false;
        this->kernels().nearest_of_many(this->scene(index), points, k, limits.distance2, ids, distances2);
        if constexpr (detail::CloudForKernels<I>)
            if (k > 0 && index.structure().tree().crowded)
                answer_given_up(index, points, k, limits, ids, distances2);
        return true;
    }

private:
    /// Answers the points whose rows the kernel has marked.
    void answer_given_up(const I& index, const PointBatch<float, 3>& points, std::size_t k,
                         const NearLimits<float>& limits, PrimitiveId* ids, float* distances2) const {
        const Scratch<std::vector<Near<float, 3>>> kept;
        std::vector<Near<float, 3>>& found = *kept;
        for (std::size_t i = 0; i < points.size(); ++i) {
            const std::size_t first = k * points.number(i);
            if (ids != nullptr ? ids[first] != gave_up_id : distances2[first] != gave_up_distance2) continue;
            this->template answer_of_walk<NearestAmongTies<Set>>(index, points[i], k, limits, found);
            found.resize(k);
            for (std::size_t j = 0; j < k; ++j) {
                if (ids != nullptr) ids[first + j] = found[j].element;
                if (distances2 != nullptr) distances2[first + j] = found[j].distance2;
            }
        }
    }
};

template <class Set, detail::NearForKernels I>
struct Kernel<Within<Set>, I> : detail::PointKernel<I> {
    std::size_t answer(const I& index, const Vec<float, 3>& point, const NearLimits<float>& limits,
                       std::vector<Near<float, 3>>& found) const {
        if (!this->takes(index, point, limits)) [[unlikely]]
            return this->template answer_of_walk<Within<Set>>(index, point, limits, found);
        return this->read(index, point, sorted_keys(index, point, limits), found);
    }
    /// Appends the list of what is within the limits of each point. False, and
    /// nothing is written, where a point is none for the kernels.
    bool answer_many(const I& index, const PointBatch<float, 3>& points, const NearLimits<float>& limits,
                     NearLists<float>& lists) const {
        if (!this->takes_all(index, points, limits)) return false;
        for (std::size_t i = 0; i < points.size(); ++i) {
            const auto keys = sorted_keys(index, points[i], limits);
            const std::size_t first = lists.ids.size();
            lists.ids.resize(first + keys.size()), lists.distances2.resize(first + keys.size());
            PrimitiveId* const ids = lists.ids.data() + first;
            float* const distances2 = lists.distances2.data() + first;
            for (std::size_t k = 0; k < keys.size(); ++k) {
                ids[k] = element_of(keys[k]);
                distances2[k] = distance2_of(keys[k]);
            }
            lists.offsets.push_back(lists.ids.size());
        }
        return true;
    }

private:
    /// The keys of one query, in memory that the thread keeps until the next.
    std::span<const NearKey> sorted_keys(const I& index, const Vec<float, 3>& point,
                                         const NearLimits<float>& limits) const {
        std::vector<NearKey>& kept = kept_by_thread();
        kept.resize(std::max<std::size_t>(kept.capacity(), 64));
        NearKeys keys{kept.data(), 0, kept.size(), [](NearKeys& full) {
                          kept_by_thread().resize(2 * full.room);
                          full.keys = kept_by_thread().data(), full.room = kept_by_thread().size();
                      }};
        this->kernels().within(this->scene(index), point, limits.distance2, keys);
        static thread_local std::vector<NearKey> other;
        sort_keys({keys.keys, keys.size}, other);
        return {keys.keys, keys.size};
    }
    static std::vector<NearKey>& kept_by_thread() {
        static thread_local std::vector<NearKey> kept;
        return kept;
    }
};

template <class Set, detail::CloudForKernels I>
struct Kernel<OverlapCount<Set, Sphere<float, 3>>, I> : detail::PointKernel<I> {
    std::size_t answer(const I& index, const Sphere<float, 3>& ball) const {
        if (!this->takes(ball.center) || !(ball.radius >= 0 && ball.radius <= largest_coordinate<float>))
            [[unlikely]]
            return this->template answer_of_walk<OverlapCount<Set, Sphere<float, 3>>>(index, ball);
        return this->all().points_in_ball(this->scene(index), ball);
    }
};

}  // namespace hedgerow
