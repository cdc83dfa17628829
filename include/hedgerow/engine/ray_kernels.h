/// The engine of rays (walks/engine.h): kernels answer closest and any hits of float triangles in a WideBvh,
/// and of instances of such indexes; of the former also the first hits.
#pragma once

#include <atomic>
#include <type_traits>
#include <utility>

#include <hedgerow/engine/kernel_scenes.h>
#include <hedgerow/engine/wide_bvh.h>
#include <hedgerow/geometry/transform.h>
#include <hedgerow/queries/any_hit.h>
#include <hedgerow/queries/closest_hit.h>
#include <hedgerow/queries/first_hits.h>
#include <hedgerow/walks/engine.h>

namespace hedgerow {

namespace detail {

/// One kind of query, answered by the kernels that are in use when the object is made.
template <auto question, class I>
class RayEngine {
public:
    explicit RayEngine(const I& index) : index_(index) {}
    explicit operator bool() const { return kernels_ != nullptr; }

    /// A function object that answers single rays without a filter, where there are kernels, as long as the
    /// index stays at its address.
    auto single() const {
        using Kernels = std::remove_cvref_t<decltype(std::declval<const AllRayKernels&>().*question)>;
        const Kernels kernels = kernels_ != nullptr ? kernels_->*question : Kernels{};
        if constexpr (TrianglesForKernels<I>)
            return [one = kernels.one, scene = kernel_scene(index_, {}, {})](const Ray<float, 3>& ray) {
                return one(scene, ray);
            };
        else
            return [one = kernels.among_instances, &index = index_](const Ray<float, 3>& ray) {
                return one(kernel_scene(index, ray, {}), ray);
            };
    }
    template <class Filter>
    auto answer(const Ray<float, 3>& ray, const Filter& filter) const {
        const auto scene = kernel_scene(index_, ray, hit_filter(filter));
        if constexpr (TrianglesForKernels<I>)
            return (kernels_->*question).one(scene, ray);
        else
            return (kernels_->*question).among_instances(scene, ray);
    }
    template <class Answer, class How>
    requires TrianglesForKernels<I> KernelUse answer_batch(const RayArray<float, 3>& rays, Answer* answers,
                                                           const How& how)
    const {
        std::atomic<std::size_t> phased{0}, packets{0};
        how.executor.for_each_piece(rays.size(), 4096, [&](std::size_t begin, std::size_t end) {
            WideScene scene = kernel_scene(index_, {}, hit_filter(how.filter));
            scene.first_ray = begin;
            const KernelUse use =
                (kernels_->*question).many(scene, rays.part(begin, end - begin), answers + begin);
            phased += use.phased, packets += use.packets;
        });
        return {rays.size() - phased - packets, phased, packets};
    }

protected:
    template <class Q>
    auto hit_inside(Ray<float, 3> ray, std::uint32_t instance, std::uint32_t geometry, const Q& query) const {
        WideScene scene = kernel_scene(index_, ray, filter_of_query(query));
        scene.instance = instance, scene.geometry = geometry;
        ray.t_max = query.limit();
        return (kernels_->*question).one(scene, ray);
    }

private:
    const I& index_;
    const AllRayKernels* kernels_ = in_use<AllRayKernels>();
};

template <class I>
concept RaysForKernels = TrianglesForKernels<I> || InstancesForKernels<I>;

}  // namespace detail

template <class Set, class Filter, detail::RaysForKernels I>
struct EngineFor<ClosestHit<Set, Filter>, I> : detail::RayEngine<&AllRayKernels::closest, I> {
    using detail::RayEngine<&AllRayKernels::closest, I>::RayEngine;

    template <class Q>
    requires detail::TrianglesForKernels<I> Flow offer_inside(const Ray<float, 3>& ray,
                                                              std::uint32_t instance, std::uint32_t geometry,
                                                              Q& query)
    const {
        const Hit<float> hit = this->hit_inside(ray, instance, geometry, query);
        return hit ? query.offer({hit.t, hit.u, hit.v, hit.element, instance}) : Flow::go_on;
    }
};

template <class Set, class Filter, detail::RaysForKernels I>
struct EngineFor<AnyHit<Set, Filter>, I> : detail::RayEngine<&AllRayKernels::any, I> {
    using detail::RayEngine<&AllRayKernels::any, I>::RayEngine;

    template <class Q>
    requires detail::TrianglesForKernels<I> Flow offer_inside(const Ray<float, 3>& ray,
                                                              std::uint32_t instance, std::uint32_t geometry,
                                                              Q& query)
    const { return this->hit_inside(ray, instance, geometry, query) ? query.found() : Flow::go_on; }
};

/// Inside of instances the walk answers: the kernel writes hits of one index alone.
template <class Set, class Filter, detail::TrianglesForKernels I>
requires std::same_as<Set, typename I::Primitives>
struct EngineFor<FirstHits<Set, Filter>, I> {
    explicit EngineFor(const I& index) : index_(index) {}
    explicit operator bool() const { return kernels_ != nullptr; }
    std::size_t answer(const Ray<float, 3>& ray, std::span<Hit<float>> hits, const PlaceOfHit<float>& after,
                       const Filter& filter = {}) const {
        return kernels_->first_hits(detail::kernel_scene(index_, ray, hit_filter(filter)), ray, hits, after);
    }

private:
    const I& index_;
    const AllRayKernels* kernels_ = in_use<AllRayKernels>();
};

/// Makes the WideInstance of an index, whose pointers are to members of that index.
template <detail::TrianglesForKernels I>
struct InstanceForEngine<I> {
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
