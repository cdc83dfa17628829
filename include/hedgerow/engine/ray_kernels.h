/// The engine's specialisations of Kernel (walks/kernel.h): the kernels answer closest and any hits of float
/// triangles in a WideBvh, and of instances of such indexes; of the former also the first hits.
#pragma once

#include <type_traits>
#include <utility>

#include <hedgerow/engine/kernel_scenes.h>
#include <hedgerow/engine/wide_bvh.h>
#include <hedgerow/geometry/transform.h>
#include <hedgerow/queries/any_hit.h>
#include <hedgerow/queries/closest_hit.h>
#include <hedgerow/queries/first_hits.h>
#include <hedgerow/walks/kernel.h>

namespace hedgerow {

namespace detail {

/// One kind of query, answered by the kernels that are in use when the object is made.
template <auto question>
class RayKernel {
public:
    explicit operator bool() const { return kernels_ != nullptr; }

    /// Answers single rays, where there are kernels.
    template <class I>
    auto single(const I& index) const {
        using Kernels = std::remove_cvref_t<decltype(std::declval<const WideKernels&>().*question)>;
        const Kernels kernels = kernels_ != nullptr ? kernels_->*question : Kernels{};
        if constexpr (TrianglesForKernels<I>)
            return [one = kernels.one, scene = kernel_scene(index, {}, {})](const Ray<float, 3>& ray) {
                return one(scene, ray);
            };
        else
            return [one = kernels.among_instances, &index](const Ray<float, 3>& ray) {
                return one(kernel_scene(index, ray, {}), ray);
            };
    }
    /// Answers rays[i], which is ray `first + i` of the batch, into answers[i].
    template <TrianglesForKernels I, class Answer, class Filter>
    KernelUse answer_many(const I& index, std::size_t first, const RayArray<float, 3>& rays, Answer* answers,
                          const Filter& filter) const {
        WideScene scene = kernel_scene(index, {}, hit_filter(filter));
        scene.first_ray = first;
        return (kernels_->*question).many(scene, rays, answers);
    }

protected:
    template <class I, class Filter>
    auto hit(const I& index, const Ray<float, 3>& ray, const Filter& filter) const {
        const auto scene = kernel_scene(index, ray, hit_filter(filter));
        if constexpr (TrianglesForKernels<I>)
            return (kernels_->*question).one(scene, ray);
        else
            return (kernels_->*question).among_instances(scene, ray);
    }
    template <TrianglesForKernels I, class Q>
    auto hit_inside(const I& index, Ray<float, 3> ray, std::uint32_t instance, std::uint32_t geometry,
                    const Q& query) const {
        WideScene scene = kernel_scene(index, ray, filter_of_query(query));
        scene.instance = instance, scene.geometry = geometry;
        ray.t_max = query.limit();
        return (kernels_->*question).one(scene, ray);
    }

private:
    const WideKernels* kernels_ = wide_kernels();
};

}  // namespace detail

template <class Set, class Filter, class I>
requires(detail::TrianglesForKernels<I> || detail::InstancesForKernels<I>)  //
    struct Kernel<ClosestHit<Set, Filter>, I> : detail::RayKernel<&WideKernels::closest> {
    Hit<float> answer(const I& index, const Ray<float, 3>& ray, const Filter& filter) const {
        return this->hit(index, ray, filter);
    }
    template <class Q>
    Flow offer_inside(const I& index, const Ray<float, 3>& ray, std::uint32_t instance,
                      std::uint32_t geometry, Q& query) const {
        const Hit<float> hit = this->hit_inside(index, ray, instance, geometry, query);
        return hit ? query.offer({hit.t, hit.u, hit.v, hit.element, instance}) : Flow::go_on;
    }
};

template <class Set, class Filter, class I>
requires(detail::TrianglesForKernels<I> || detail::InstancesForKernels<I>)  //
    struct Kernel<AnyHit<Set, Filter>, I> : detail::RayKernel<&WideKernels::any> {
    bool answer(const I& index, const Ray<float, 3>& ray, const Filter& filter) const {
        return this->hit(index, ray, filter);
    }
    template <class Q>
    Flow offer_inside(const I& index, const Ray<float, 3>& ray, std::uint32_t instance,
                      std::uint32_t geometry, Q& query) const {
        return this->hit_inside(index, ray, instance, geometry, query) ? query.found() : Flow::go_on;
    }
};

/// Inside of instances the walk answers: the kernel writes hits of one index alone.
template <class Set, class Filter, detail::TrianglesForKernels I>
requires std::same_as<Set, typename I::Primitives>
struct Kernel<FirstHits<Set, Filter>, I> {
    explicit operator bool() const { return kernels_ != nullptr; }
    std::size_t answer(const I& index, const Ray<float, 3>& ray, std::span<Hit<float>> hits,
                       const PlaceOfHit<float>& after, const Filter& filter = {}) const {
        return kernels_->first_hits(detail::kernel_scene(index, ray, hit_filter(filter)), ray, hits, after);
    }

private:
    const WideKernels* kernels_ = wide_kernels();
};

/// Makes the WideInstance of an index, whose pointers are to members of that index.
template <detail::TrianglesForKernels I>
struct InstanceKernel<I> {
    using Instance = WideInstance;

    static WideInstance of(const I& index, const Affine<3>& back, std::uint32_t mask,
                           std::uint32_t geometry) {
        WideInstance placed{
            {}, &index.structure().tree(), &index.packed(), &index.primitives().faces(), mask, geometry};
        for (int k = 0; k < 3; ++k) {
            for (int c = 0; c < 3; ++c) placed.back[c][k] = back.linear[static_cast<std::size_t>(k)][c];
            placed.back[3][k] = back.shift[k];
        }
        return placed;
    }
};

}  // namespace hedgerow
