#include <limits>
#include <stdexcept>
#include <vector>

#include "embree_scene.h"
#include "tracers.h"

namespace hedgerow::measure {

namespace {

/// Queries with what Embree calls for each hit that it finds: false refuses the hit. The rays' ids are their
/// numbers.
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
            if (!self.keep(RTCRayN_id(const_cast<RTCRayN*>(ray), a->N, i),
                           RTCRayN_tfar(const_cast<RTCRayN*>(ray), a->N, i),
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
    EmbreeTracer(const TriangleMesh<float>& mesh, EmbreeCalls calls)
        : mesh_(mesh.view()),
          calls_(calls),
          held_(mesh, "threads=1", RTC_SCENE_FLAG_CONTEXT_FILTER_FUNCTION, RTC_BUILD_QUALITY_MEDIUM) {
        for (const Vec3f& v : mesh.vertices) bounds_.expand(v);
        held_.commit();
    }
    using Tracer::any_hits;
    using Tracer::closest_hits;

    Box3f bounds() const override { return bounds_; }
    KernelUse closest_hits(const RayArray<float, 3>& rays, std::span<Hit<float>> hits,
                           std::span<Visits> visits, const Filter& filter) const override {
        static thread_local std::vector<RTCRayHit> asked;
        answer(asked, rays, visits, filter, rtcIntersect1, rtcIntersect1M);
        for (std::size_t i = 0; i < rays.size(); ++i) {
            const RTCRayHit& h = asked[i];
            hits[i] = h.hit.geomID == RTC_INVALID_GEOMETRY_ID
                          ? Hit<float>()
                          : hit_of(h.ray.tfar, h.hit.u, h.hit.v, h.hit.primID);
        }
        return {rays.size(), 0, 0};
    }
    KernelUse any_hits(const RayArray<float, 3>& rays, std::span<bool> hits, std::span<Visits> visits,
                       const Filter& filter) const override {
        static thread_local std::vector<RTCRay> asked;
        answer(asked, rays, visits, filter, rtcOccluded1, rtcOccluded1M);
        for (std::size_t i = 0; i < rays.size(); ++i) hits[i] = asked[i].tfar < 0;
        return {rays.size(), 0, 0};
    }
    void first_hits(const RayArray<float, 3>& rays, std::size_t k, HitLists<float>& lists,
                    const AfterHits& after, const Filter& filter) const override {
        const FlushToZero flush;
        std::vector<Hit<float>> found(k);
        lists.clear();
        for (std::size_t i = 0; i < rays.size(); ++i) {
            SortedHits<float> sorted(found, after.of(i));
            // All hits are offered, and all are refused, so that Embree goes on.
            auto offer = [&](std::size_t, float t, float u, float v, std::uint32_t element) {
                const Hit<float> hit = hit_of(t, u, v, element);
                if (filter && !filter(i, hit)) return false;
                if (const std::size_t place = sorted.place_of(hit); place != sorted.nowhere && k > 0)
                    sorted.insert(place, hit);
                return false;
            };
            Context context(offer);
            RTCRay ray = ray_of(rays[i]);
            rtcOccluded1(held_.scene(), &context, &ray);
            lists.hits.append(std::span(found).first(sorted.size()));
            lists.offsets.push_back(lists.hits.size());
        }
    }

private:
    Hit<float> hit_of(float t, float u, float v, std::uint32_t element) const {
        return {t, u, v, mesh_.id(element), 0, 0, element};
    }
    static void set(RTCRay& asked, const Ray3f& ray, std::size_t i) {
        asked = ray_of(ray);
        asked.id = static_cast<unsigned>(i);
    }
    static void set(RTCRayHit& asked, const Ray3f& ray, std::size_t i) {
        set(asked.ray, ray, i);
        asked.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    }
    /// Copies the rays to `asked`, and puts them to Embree: by `one` each, or by `many` all at once.
    template <class Asked>
    void answer(std::vector<Asked>& asked, const RayArray<float, 3>& rays, std::span<const Visits> visits,
                const Filter& filter, void (*one)(RTCScene, RTCIntersectContext*, Asked*),
                void (*many)(RTCScene, RTCIntersectContext*, Asked*, unsigned, std::size_t)) const {
        if (!visits.empty()) throw std::invalid_argument("Embree does not count visits");
        const FlushToZero flush;
        auto keep = [&](std::size_t i, float t, float u, float v, std::uint32_t element) {
            return filter(i, hit_of(t, u, v, element));
        };
        Context context(keep);
        if (!filter) context.filter = nullptr;
        if (calls_ == EmbreeCalls::coherent_stream) context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
        if (asked.size() < rays.size()) asked.resize(rays.size());
        for (std::size_t i = 0; i < rays.size(); ++i) {
            set(asked[i], rays[i], i);
            if (calls_ == EmbreeCalls::single) one(held_.scene(), &context, &asked[i]);
        }
        if (calls_ != EmbreeCalls::single)
            many(held_.scene(), &context, asked.data(), static_cast<unsigned>(rays.size()), sizeof(Asked));
    }

    TriangleMeshView<float> mesh_;
    EmbreeCalls calls_;
    EmbreeScene held_;
    Box3f bounds_;
};

}  // namespace

std::unique_ptr<Tracer<float>> embree_tracer(const TriangleMesh<float>& mesh, EmbreeCalls calls) {
    return std::make_unique<EmbreeTracer>(mesh, calls);
}

}  // namespace hedgerow::measure
