#include <limits>
#include <stdexcept>
#include <type_traits>

#include "embree_scene.h"
#include "tracers.h"

namespace hedgerow::measure {

namespace {

/// A query with what Embree calls for each hit that it finds: false refuses the hit.
template <class Keep>
struct Context : RTCIntersectContext {
    explicit Context(Keep& keeps) : keep(keeps) {
        rtcInitIntersectContext(this);
        filter = &Context::decide;
    }
    static void decide(const RTCFilterFunctionNArguments* a) {
        const auto& self = *static_cast<const Context*>(a->context);
        for (unsigned i = 0; i < a->N; ++i) {
            if (a->valid[i] != -1) continue;
            const RTCRayN* const ray = a->ray;
            const RTCHitN* const hit = a->hit;
            if (!self.keep(RTCRayN_tfar(const_cast<RTCRayN*>(ray), a->N, i),
                           RTCHitN_u(const_cast<RTCHitN*>(hit), a->N, i),
                           RTCHitN_v(const_cast<RTCHitN*>(hit), a->N, i),
                           RTCHitN_primID(const_cast<RTCHitN*>(hit), a->N, i)))
                a->valid[i] = 0;
        }
    }
    Keep& keep;
};

class EmbreeTracer final : public Tracer<float> {
public:
    explicit EmbreeTracer(const TriangleMesh<float>& mesh)
        : mesh_(mesh.view()),
          held_(mesh, "threads=1", RTC_SCENE_FLAG_CONTEXT_FILTER_FUNCTION, RTC_BUILD_QUALITY_MEDIUM) {
        for (const Vec3f& v : mesh.vertices) bounds_.expand(v);
        held_.commit();
    }
    using Tracer::any_hits;
    using Tracer::closest_hits;

    Box3f bounds() const override { return bounds_; }
    KernelUse closest_hits(const RayArray<float, 3>& rays, std::span<Hit<float>> hits,
                           std::span<Visits> visits, const Filter& filter) const override {
        expect_no_counts(visits);
        return each(rays, filter, [&](std::size_t i, const Ray3f& ray, RTCIntersectContext* context) {
            RTCRayHit h;
            h.ray = ray_of(ray);
            h.hit.geomID = RTC_INVALID_GEOMETRY_ID;
            rtcIntersect1(held_.scene(), context, &h);
            hits[i] = h.hit.geomID == RTC_INVALID_GEOMETRY_ID
                          ? Hit<float>()
                          : hit_of(h.ray.tfar, h.hit.u, h.hit.v, h.hit.primID);
        });
    }
    KernelUse any_hits(const RayArray<float, 3>& rays, std::span<bool> hits, std::span<Visits> visits,
                       const Filter& filter) const override {
        expect_no_counts(visits);
        return each(rays, filter, [&](std::size_t i, const Ray3f& ray, RTCIntersectContext* context) {
            RTCRay r = ray_of(ray);
            rtcOccluded1(held_.scene(), context, &r);
            hits[i] = r.tfar < 0;
        });
    }
    void first_hits(const RayArray<float, 3>& rays, std::size_t k, const FirstHitsColumns<float>& columns,
                    std::span<const AfterHit<float>> after, const Filter& filter) const override {
        const FlushToZero flush;
        for (std::size_t i = 0; i < rays.size(); ++i) {
            const auto found = columns.hits.subspan(i * k, k);
            std::ranges::fill(found, Hit<float>());
            SortedHits<float> sorted(found, after.empty() ? AfterHit<float>() : after[i]);
            // All hits are offered, and all are refused, so that Embree goes on.
            auto offer = [&](float t, float u, float v, std::uint32_t element) {
                const Hit<float> hit = hit_of(t, u, v, element);
                if (filter && !filter(i, hit)) return false;
                if (const std::size_t place = sorted.place_of(hit); place != sorted.nowhere && k > 0)
                    sorted.insert(place, hit);
                return false;
            };
            Context context(offer);
            RTCRay ray = ray_of(rays[i]);
            rtcOccluded1(held_.scene(), &context, &ray);
            if (!columns.counts.empty()) columns.counts[i] = static_cast<std::uint32_t>(sorted.size());
        }
    }

private:
    static void expect_no_counts(std::span<Visits> visits) {
        if (!visits.empty()) throw std::invalid_argument("Embree does not count visits");
    }
    Hit<float> hit_of(float t, float u, float v, std::uint32_t element) const {
        return {t, u, v, mesh_.id(element), 0, 0, element};
    }
    /// Calls ask(i, ray, context) for each ray, with the filter in the context.
    template <class Ask>
    KernelUse each(const RayArray<float, 3>& rays, const Filter& filter, Ask ask) const {
        const FlushToZero flush;
        for (std::size_t i = 0; i < rays.size(); ++i) {
            auto keep = [&](float t, float u, float v, std::uint32_t element) {
                return filter(i, hit_of(t, u, v, element));
            };
            Context context(keep);
            if (!filter) context.filter = nullptr;
            ask(i, rays[i], &context);
        }
        return {rays.size(), 0, 0};
    }

    TriangleMeshView<float> mesh_;
    EmbreeScene held_;
    Box3f bounds_;
};

}  // namespace

std::unique_ptr<Tracer<float>> embree_tracer(const TriangleMesh<float>& mesh) {
    return std::make_unique<EmbreeTracer>(mesh);
}

}  // namespace hedgerow::measure
