/// The engine's specialisations of Kernel (walks/kernel.h) for points: the kernels answer closest points, k
/// nearest and all within a distance, of float triangles and points in a WideBvh in space, and how many
/// points are in a ball.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include <hedgerow/engine/near_keys.h>
#include <hedgerow/engine/ray_kernels.h>
#include <hedgerow/geometry/ball.h>
#include <hedgerow/queries/closest_point.h>
#include <hedgerow/queries/nearest.h>
#include <hedgerow/queries/overlap_count.h>
#include <hedgerow/queries/within.h>

namespace hedgerow {

namespace detail {

/// Indexes of points that the kernels can search.
template <class I>
concept CloudForKernels = requires(const I& index) {
    { index.structure().tree() } -> std::same_as<const WideTree<float, 3>&>;
    { index.packed() } -> std::same_as<const PointBlocks<float, 3>&>;
};
template <class I>
concept NearForKernels = TrianglesForKernels<I> || CloudForKernels<I>;

/// The kernels of points over indexes I that are in use when the object is made.
template <NearForKernels I>
class PointKernel {
public:
    explicit operator bool() const { return kernels_ != nullptr; }

protected:
    const auto& kernels() const {
        if constexpr (TrianglesForKernels<I>)
            return all().triangles;
        else
            return all().points;
    }
    const AllPointKernels& all() const { return *kernels_->points; }
    static auto scene(const I& index) {
        if constexpr (TrianglesForKernels<I>)
            return kernel_scene(index, {}, {});
        else
            return WidePoints{index.structure().tree(), index.packed().data()};
    }
    // Squared distances of farther points may overflow; NaN is no nearer to anything. Kernels are exact.
    static bool takes(const Vec<float, 3>& point) {  // without a branch
        const auto fits = [](float x) { return unsigned(std::abs(x) <= largest_coordinate<float>); };
        return (fits(point[0]) & fits(point[1]) & fits(point[2])) != 0;
    }
    static bool takes(const Vec<float, 3>& point, const NearOptions<float>& options) {
        return takes(point) && options.factor == 1;
    }
    static bool takes_all(const PointBatch<float, 3>& points, const NearOptions<float>& options) {
        bool all = options.factor == 1;
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

}  // namespace detail

template <class Set, detail::NearForKernels I>
struct Kernel<ClosestPoint<Set>, I> : detail::PointKernel<I> {
    Near<float, 3> answer(const I& index, const Vec<float, 3>& point,
                          const NearOptions<float>& options) const {
        if (!this->takes(point, options)) [[unlikely]]
            return this->template answer_of_walk<ClosestPoint<Set>>(index, point, options);
        return this->kernels().closest(this->scene(index), point, options.max_distance2());
    }
    bool answer_many(const I& index, const PointBatch<float, 3>& points, const NearOptions<float>& options,
                     Near<float, 3>* found) const {
        if (!this->takes_all(points, options)) return false;
        this->kernels().closest_of_many(this->scene(index), points, options.max_distance2(), found);
        return true;
    }
};

template <class Set, detail::NearForKernels I>
struct Kernel<Nearest<Set>, I> : detail::PointKernel<I> {
    std::size_t answer(const I& index, const Vec<float, 3>& point, std::size_t k,
                       const NearOptions<float>& options, std::vector<Near<float, 3>>& found) const {
        if (k > most_nearest || !this->takes(point, options)) [[unlikely]]
            return this->template answer_of_walk<Nearest<Set>>(index, point, k, options, found);
        alignas(64) NearKey keys[most_nearest];
        const std::size_t count =
            this->kernels().nearest(this->scene(index), point, k, options.max_distance2(), keys);
        return this->read(index, point, {keys, count}, found);
    }
    bool answer_many(const I& index, const PointBatch<float, 3>& points, std::size_t k,
                     const NearOptions<float>& options, PrimitiveId* ids, float* distances2) const {
        if (k > most_nearest || !this->takes_all(points, options)) return false;
        this->kernels().nearest_of_many(this->scene(index), points, k, options.max_distance2(), ids,
                                        distances2);
        return true;
    }
};

template <class Set, detail::NearForKernels I>
struct Kernel<Within<Set>, I> : detail::PointKernel<I> {
    std::size_t answer(const I& index, const Vec<float, 3>& point, const NearOptions<float>& options,
                       std::vector<Near<float, 3>>& found) const {
        if (!this->takes(point, options)) [[unlikely]]
            return this->template answer_of_walk<Within<Set>>(index, point, options, found);
        return this->read(index, point, sorted_keys(index, point, options), found);
    }
    /// Appends what is within the options' distance of each point, and where each list ends. False, and
    /// nothing is written, where a point is none for the kernels.
    bool answer_many(const I& index, const PointBatch<float, 3>& points, const NearOptions<float>& options,
                     std::vector<std::size_t>& offsets, std::vector<PrimitiveId>& ids,
                     std::vector<float>& distances2) const {
        if (!this->takes_all(points, options)) return false;
        for (std::size_t i = 0; i < points.size(); ++i) {
            const auto keys = sorted_keys(index, points[i], options);
            const std::size_t first = ids.size();
            ids.resize(first + keys.size()), distances2.resize(first + keys.size());
            for (std::size_t k = 0; k < keys.size(); ++k) {
                ids[first + k] = element_of(keys[k]);
                distances2[first + k] = distance2_of(keys[k]);
            }
            offsets.push_back(ids.size());
        }
        return true;
    }

private:
    /// The keys of one query, in memory that the thread keeps until the next.
    std::span<const NearKey> sorted_keys(const I& index, const Vec<float, 3>& point,
                                         const NearOptions<float>& options) const {
        std::vector<NearKey>& kept = kept_by_thread();
        kept.resize(std::max<std::size_t>(kept.capacity(), 64));
        NearKeys keys{kept.data(), 0, kept.size(), [](NearKeys& full) {
                          kept_by_thread().resize(2 * full.room);
                          full.keys = kept_by_thread().data(), full.room = kept_by_thread().size();
                      }};
        this->kernels().within(this->scene(index), point, options.max_distance2(), keys);
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
