/// The engine of points (walks/engine.h): kernels answer closest points, k nearest and all within a distance,
/// of float triangles and points in a WideBvh in space, the closest points of triangles of double, and how
/// many points are in a ball. Of any other primitives in a WideBvh in space they do the walk, and the leaves
/// are tested as in any walk.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include <hedgerow/engine/kernel_scenes.h>
#include <hedgerow/engine/near_keys.h>
#include <hedgerow/geometry/ball.h>
#include <hedgerow/queries/cell_neighbours.h>
#include <hedgerow/queries/closest_point.h>
#include <hedgerow/queries/near_rows.h>
#include <hedgerow/queries/nearest.h>
#include <hedgerow/queries/overlap_count.h>
#include <hedgerow/queries/within.h>
#include <hedgerow/walks/engine.h>

namespace hedgerow {

namespace detail {

template <class I>
concept NearForKernels = TrianglesForKernels<I> || CloudForKernels<I>;

/// The kernels of points over indexes I that are in use when the object is made.
template <WideForKernels I>
class PointEngine {
public:
    using T = typename I::Primitives::Scalar;

    explicit PointEngine(const I& index) : index_(index) {}
    explicit operator bool() const { return kernels_ != nullptr; }

protected:
    using Points = Strided<Vec<T, 3>>;

    const I& index() const { return index_; }
    const AllPointKernels& all() const { return *kernels_; }
    const auto& kernels() const {
        if constexpr (TrianglesForKernels<I>)
            return all().triangles;
        else if constexpr (DoublesForKernels<I>)
            return all().doubles;
        else
            return all().points;
    }
    auto scene() const { return kernel_scene(index_); }
    bool crowded() const { return index_.structure().tree().crowded; }
    // Squared distances of farther points may overflow; NaN is no nearer to anything.
    static bool takes(const Vec<T, 3>& point) {  // without a branch
        const auto fits = [](T x) { return unsigned(std::abs(x) <= T(largest_coordinate<float>)); };
        return (fits(point[0]) & fits(point[1]) & fits(point[2])) != 0;
    }
    // Squared distances to boxes are compared as floats. Those in a small scene of doubles would all be the
    // same, and those in a large one overflow.
    bool takes_index() const {
        if constexpr (std::is_same_v<T, float>) return true;
        const auto& bounds = index_.bounds();
        return takes(bounds.low) && takes(bounds.high) && max_component(bounds.extent()) > T(0x1p-40);
    }
    bool takes(const Vec<T, 3>& point, const NearLimits<T>& limits) const {
        return takes(point) && takes_index() && limits.plain();
    }
    static bool takes_all(const PointBatch<T, 3>& points) {
        bool all = true;
        for (std::size_t i = 0; i < points.size(); ++i) all &= takes(points[i]);
        return all;
    }
    /// Calls many(part) for parts of the points of a batch that the kernels take, and one(i) for all others.
    template <class Many, class One>
    void for_each_taken(const Points& points, bool any, Executor& executor, Many many, One one) const {
        for_each_part(points, index_.bounds(), index_.bytes(), executor, [&](const auto& part) {
            if (any && takes_all(part)) return many(part);
            for (std::size_t i = 0; i < part.size(); ++i) one(part.number(i));
        });
    }
    template <class Q, class... Arguments>
    auto answer_of_walk(Arguments&&... arguments) const {
        Q query(index_, arguments...);
        index_.ask(query);
        return query.answer();
    }
    /// Replaces what `found` holds by the primitives that the keys name.
    template <class Found>
    std::size_t read(const Vec<float, 3>& point, std::span<const NearKey> keys, Found& found) const {
        const auto& set = index_.primitives();
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
    const I& index_;
    const AllPointKernels* kernels_ = in_use<AllPointKernels>();
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
class OtherEngine : public PointEngine<I> {
public:
    using PointEngine<I>::PointEngine;

protected:
    using typename PointEngine<I>::T;

    template <class Q, class... Arguments>
    auto answer_of(const Vec<T, 3>& point, const NearLimits<T>& limits, Arguments&&... arguments) const {
        Q query(this->index(), point, arguments...);
        if (done(query)) return query.answer();
        if (this->takes(point, limits))
            walk(query);
        else
            this->index().ask(query);
        return query.answer();
    }

private:
    template <class Q>
    void walk(Q& query) const {
        using Asked = std::pair<const I&, Q&>;
        Asked asked{this->index(), query};
        const auto test = [](void* asker, std::uint32_t leaf) {
            auto& [of, asks] = *static_cast<Asked*>(asker);
            of.test_leaf(asks.probe(), leaf_of(of.structure().tree(), leaf), asks);
            return asks.limit();
        };
        const WideLeaves<T> leaves{this->index().structure().tree(), &asked, test};
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
    struct EngineFor<ClosestPoint<Set>, I> : detail::OtherEngine<I> {
    using detail::OtherEngine<I>::OtherEngine;
    using typename detail::PointEngine<I>::T;

    auto answer(const Vec<T, 3>& point, const NearLimits<T>& limits) const {
        return this->template answer_of<ClosestPoint<Set>>(point, limits, limits);
    }
};
template <class Set, class I>
requires(detail::WideForKernels<I> && !detail::NearForKernels<I>)  //
    struct EngineFor<Nearest<Set>, I> : detail::OtherEngine<I> {
    using detail::OtherEngine<I>::OtherEngine;
    using typename detail::PointEngine<I>::T;

    template <class Found>
    std::size_t answer(const Vec<T, 3>& point, std::size_t k, const NearLimits<T>& limits,
                       Found& found) const {
        return this->template answer_of<Nearest<Set>>(point, limits, k, limits, found);
    }
};
template <class Set, class I>
requires(detail::WideForKernels<I> && !detail::NearForKernels<I>)  //
    struct EngineFor<Within<Set>, I> : detail::OtherEngine<I> {
    using detail::OtherEngine<I>::OtherEngine;
    using typename detail::PointEngine<I>::T;

    template <class Found>
    std::size_t answer(const Vec<T, 3>& point, const NearLimits<T>& limits, Found& found) const {
        return this->template answer_of<Within<Set>>(point, limits, limits, found);
    }
};

template <class Set, detail::ClosestForKernels I>
struct EngineFor<ClosestPoint<Set>, I> : detail::PointEngine<I> {
    using detail::PointEngine<I>::PointEngine;
    using typename detail::PointEngine<I>::T;

    Near<T, 3> answer(const Vec<T, 3>& point, const NearLimits<T>& limits) const {
        if (!this->takes(point, limits)) [[unlikely]]
            return this->template answer_of_walk<ClosestPoint<Set>>(point, limits);
        if constexpr (detail::CloudForKernels<I>)
            if (this->crowded()) [[unlikely]]
                return closest_of_crowd(point, limits);
        return this->kernels().closest(this->scene(), point, limits.distance2);
    }
    template <class How>
    void answer_batch(const Strided<Vec<T, 3>>& points, Near<T, 3>* found, const How& how) const {
        const auto limits = NearLimits<T>::of_batch(how.options);
        this->for_each_taken(
            points, limits.plain() && how.options.leave_out.none() && this->takes_index(), how.executor,
            [&](const PointBatch<T, 3>& part) {
                if constexpr (detail::CloudForKernels<I>)
                    if (this->crowded()) {
                        for (std::size_t i = 0; i < part.size(); ++i)
                            found[part.number(i)] = closest_of_crowd(part[i], limits);
                        return;
                    }
                this->kernels().closest_of_many(this->scene(), part, limits.distance2, found);
            },
            how.rest);
    }

private:
    /// The first of the one nearest, since that search gives up where many points are at one place.
    Near<T, 3> closest_of_crowd(const Vec<T, 3>& point, const NearLimits<T>& limits) const {
        const Scratch<std::vector<Near<T, 3>>> found;
        found->reserve(1);
        const EngineFor<Nearest<Set>, I> nearest(this->index());
        return nearest.answer(point, 1, limits, *found) == 0 ? Near<T, 3>() : found->front();
    }
};

template <class Set, detail::NearForKernels I>
struct EngineFor<Nearest<Set>, I> : detail::PointEngine<I> {
    using detail::PointEngine<I>::PointEngine;

    std::size_t answer(const Vec<float, 3>& point, std::size_t k, const NearLimits<float>& limits,
                       std::vector<Near<float, 3>>& found) const {
        if (k > most_nearest || !this->takes(point, limits)) [[unlikely]]
            return this->template answer_of_walk<Nearest<Set>>(point, k, limits, found);
        alignas(64) NearKey keys[most_nearest];
        const std::size_t count = this->kernels().nearest(this->scene(), point, k, limits.distance2, keys);
        if constexpr (detail::CloudForKernels<I>)
            if (count == gave_up) [[unlikely]]
                return this->template answer_of_walk<NearestAmongTies<Set>>(point, k, limits, found);
        return this->read(point, {keys, count}, found);
    }
    template <class How>
    void answer_lists(const Strided<Vec<float, 3>>& points, std::size_t k, NearLists<float>& lists,
                      const How& how) const {
        // Rows have a place more for what is left out.
        const auto limits = NearLimits<float>::of_batch(how.options);
        detail::list_by_rows(lists, points.size(), k, how.options, [&](const auto& rows) {
            this->for_each_taken(
                points, k > 0 && rows.width <= most_nearest && limits.plain(), how.executor,
                [&](const PointBatch<float, 3>& part) {
                    this->kernels().nearest_of_many(this->scene(), part, rows.width, limits.distance2,
                                                    rows.ids, rows.distances2);
                    if constexpr (detail::CloudForKernels<I>)
                        if (this->crowded()) answer_given_up(part, limits, rows);
                },
                [&](std::size_t i) { how.rest(i, rows[i]); });
        });
    }

private:
    /// Answers the points whose rows the kernel has marked.
    void answer_given_up(const PointBatch<float, 3>& points, const NearLimits<float>& limits,
                         const detail::NearRows<float, PrimitiveId>& rows) const {
        const Scratch<std::vector<Near<float, 3>>> kept;
        std::vector<Near<float, 3>>& found = *kept;
        for (std::size_t i = 0; i < points.size(); ++i) {
            const auto row = rows[points.number(i)];
            if (row.ids[0] != gave_up_id) continue;
            this->template answer_of_walk<NearestAmongTies<Set>>(points[i], rows.width, limits, found);
            found.resize(rows.width);
            for (std::size_t j = 0; j < rows.width; ++j) {
                row.ids[j] = found[j].element;
                row.distances2[j] = found[j].distance2;
            }
        }
    }
};

template <class Set, detail::NearForKernels I>
struct EngineFor<Within<Set>, I> : detail::PointEngine<I> {
    using detail::PointEngine<I>::PointEngine;

    std::size_t answer(const Vec<float, 3>& point, const NearLimits<float>& limits,
                       std::vector<Near<float, 3>>& found) const {
        if (!this->takes(point, limits)) [[unlikely]]
            return this->template answer_of_walk<Within<Set>>(point, limits, found);
        return this->read(point, sorted_keys(point, limits), found);
    }
    template <class How>
    void answer_lists(const Strided<Vec<float, 3>>& points, NearLists<float>& lists, const How& how) const {
        if (detail::listed_by_cells(this->index(), points, lists, how.options)) return;
        const auto limits = NearLimits<float>::of_batch(how.options);
        detail::list_in_pieces(points.size(), how.executor, lists,
                               [&](std::size_t begin, std::size_t end, NearLists<float>& to) {
                                   const auto part = PointBatch<float, 3>(points).part(begin, end - begin);
                                   const bool taken = limits.factor == 1 && this->takes_all(part);
                                   for (std::size_t i = begin; i < end; ++i)
                                       taken ? append(points[i], limits, to) : how.rest(i, to);
                               });
        detail::leave_out_of(lists, how.options);
    }

private:
    /// Appends the list of what is within the limits of a point.
    void append(const Vec<float, 3>& point, const NearLimits<float>& limits, NearLists<float>& to) const {
        const auto keys = sorted_keys(point, limits);
        const std::size_t first = to.ids.size();
        to.ids.resize(first + keys.size()), to.distances2.resize(first + keys.size());
        PrimitiveId* const ids = to.ids.data() + first;
        float* const distances2 = to.distances2.data() + first;
        for (std::size_t k = 0; k < keys.size(); ++k) {
            ids[k] = element_of(keys[k]);
            distances2[k] = distance2_of(keys[k]);
        }
        to.offsets.push_back(to.ids.size());
    }
    /// The keys of one query, in memory that the thread keeps until the next.
    std::span<const NearKey> sorted_keys(const Vec<float, 3>& point, const NearLimits<float>& limits) const {
        std::vector<NearKey>& kept = kept_by_thread();
        kept.resize(std::max<std::size_t>(kept.capacity(), 64));
        NearKeys keys{kept.data(), 0, kept.size(), [](NearKeys& full) {
                          kept_by_thread().resize(2 * full.room);
                          full.keys = kept_by_thread().data(), full.room = kept_by_thread().size();
                      }};
        this->kernels().within(this->scene(), point, limits.distance2, keys);
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
struct EngineFor<OverlapCount<Set, Sphere<float, 3>>, I> : detail::PointEngine<I> {
    using detail::PointEngine<I>::PointEngine;

    std::size_t answer(const Sphere<float, 3>& ball) const {
        if (!this->takes(ball.center) || !(ball.radius >= 0 && ball.radius <= largest_coordinate<float>))
            [[unlikely]]
            return this->template answer_of_walk<OverlapCount<Set, Sphere<float, 3>>>(ball);
        return this->all().points_in_ball(this->scene(), ball);
    }
};

}  // namespace hedgerow
