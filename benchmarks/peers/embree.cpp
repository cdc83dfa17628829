#include "embree.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <limits>

#include <hedgerow/measure/clock.h>

#include "embree_scene.h"

namespace hedgerow::measure {

namespace {

/// Bytes that Embree has allocated, now and at most, as its memory monitor reports them.
struct Memory {
    std::atomic<ssize_t> now{0}, most{0};

    static bool changed(void* memory, ssize_t bytes, bool) {
        auto& m = *static_cast<Memory*>(memory);
        const ssize_t held = m.now += bytes;
        for (ssize_t most = m.most; held > most && !m.most.compare_exchange_weak(most, held);) {
        }
        return true;
    }
};

struct Packets16 final : PeerIndex::Packets {
    Packets16(std::span<const Ray3f> from, bool together) : rays(from.size() / 16), coherent(together) {
        for (std::size_t p = 0; p < rays.size(); ++p)
            for (std::size_t i = 0; i < 16; ++i) {
                const Ray3f& r = from[16 * p + i];
                RTCRay16& to = rays[p];
                to.org_x[i] = r.origin[0], to.org_y[i] = r.origin[1], to.org_z[i] = r.origin[2];
                to.dir_x[i] = r.direction[0], to.dir_y[i] = r.direction[1], to.dir_z[i] = r.direction[2];
                to.tnear[i] = r.t_min, to.tfar[i] = r.t_max, to.time[i] = 0;
                to.mask[i] = 0xFFFFFFFFu, to.id[i] = 0, to.flags[i] = 0;
            }
    }
    std::vector<RTCRay16> rays;
    bool coherent;
};

class EmbreeIndex final : public PeerIndex {
public:
    EmbreeIndex(const TriangleMesh<float>& mesh, const PeerBuild& how, const std::string& config)
        : held_(mesh, config, how.robust ? RTC_SCENE_FLAG_ROBUST : RTC_SCENE_FLAG_NONE,
                how.like == WideBuilder::high ? RTC_BUILD_QUALITY_HIGH : RTC_BUILD_QUALITY_MEDIUM) {
        // Measure the time and the bytes of the build alone.
        rtcSetDeviceMemoryMonitorFunction(held_.device(), &Memory::changed, &memory_);
        build_seconds = measure::seconds_of([&] { held_.commit(); }, measure::Clock::process);
        bytes = static_cast<std::size_t>(std::max<ssize_t>(0, memory_.now));
        most_bytes = static_cast<std::size_t>(std::max<ssize_t>(0, memory_.most));
    }

    std::size_t closest(std::span<const Ray3f> rays) const override {
        const FlushToZero flush;
        RTCIntersectContext context;
        rtcInitIntersectContext(&context);
        std::size_t found = 0;
        for (const Ray3f& r : rays) found += intersected(r, context).hit.geomID != RTC_INVALID_GEOMETRY_ID;
        return found;
    }
    std::size_t any(std::span<const Ray3f> rays) const override {
        const FlushToZero flush;
        RTCIntersectContext context;
        rtcInitIntersectContext(&context);
        std::size_t found = 0;
        for (const Ray3f& r : rays) found += occluded(r, context);
        return found;
    }
    std::unique_ptr<Packets> packets(std::span<const Ray3f> rays, bool coherent) const override {
        return std::make_unique<Packets16>(rays, coherent);
    }
    std::size_t closest(const Packets& packets) const override {
        return by_sixteen(packets, [&](const int* valid, RTCIntersectContext* context, const RTCRay16& rays) {
            RTCRayHit16 h;
            h.ray = rays;
            for (auto& id : h.hit.geomID) id = RTC_INVALID_GEOMETRY_ID;
            rtcIntersect16(valid, scene_, context, &h);
            return h.hit.geomID[0] != RTC_INVALID_GEOMETRY_ID;
        });
    }
    std::size_t any(const Packets& packets) const override {
        return by_sixteen(packets, [&](const int* valid, RTCIntersectContext* context, const RTCRay16& rays) {
            RTCRay16 asked = rays;
            rtcOccluded16(valid, scene_, context, &asked);
            return asked.tfar[0] < 0;
        });
    }
    float distance(const Ray3f& ray) const override {
        const FlushToZero flush;
        RTCIntersectContext context;
        rtcInitIntersectContext(&context);
        const RTCRayHit h = intersected(ray, context);
        return h.hit.geomID != RTC_INVALID_GEOMETRY_ID ? h.ray.tfar : std::numeric_limits<float>::infinity();
    }
    bool hits(const Ray3f& ray) const override { return any({&ray, 1}) > 0; }

private:
    RTCRayHit intersected(const Ray3f& r, RTCIntersectContext& context) const {
        RTCRayHit h;
        h.ray = ray_of(r);
        h.hit.geomID = RTC_INVALID_GEOMETRY_ID;
        rtcIntersect1(scene_, &context, &h);
        return h;
    }
    bool occluded(const Ray3f& r, RTCIntersectContext& context) const {
        RTCRay ray = ray_of(r);
        rtcOccluded1(scene_, &context, &ray);
        return ray.tfar < 0;
    }
    template <class F>
    static std::size_t by_sixteen(const Packets& packets, F hit) {
        const FlushToZero flush;
        RTCIntersectContext context;
        rtcInitIntersectContext(&context);
        const auto& asked = static_cast<const Packets16&>(packets);
        context.flags =
            asked.coherent ? RTC_INTERSECT_CONTEXT_FLAG_COHERENT : RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
        alignas(64) std::array<int, 16> valid;
        valid.fill(-1);
        std::size_t found = 0;
        for (const RTCRay16& rays : asked.rays) found += hit(valid.data(), &context, rays);
        return found;
    }

    Memory memory_;  // outlives the device, which reports to it
    EmbreeScene held_;
    RTCScene scene_ = held_.scene();
};

class Embree final : public Peer {
public:
    std::string name() const override { return "Embree"; }
    std::string version() const override {
        const RTCDevice device = rtcNewDevice("threads=1");
        const auto v = rtcGetDeviceProperty(device, RTC_DEVICE_PROPERTY_VERSION);
        rtcReleaseDevice(device);
        return std::to_string(v / 10000) + "." + std::to_string(v / 100 % 100) + "." +
               std::to_string(v % 100);
    }
    std::vector<PeerBuild> builds() const override {
        return {{"medium", WideBuilder::medium},
                {"high", WideBuilder::high},
                {"robust", WideBuilder::medium, true}};
    }
    std::unique_ptr<PeerIndex> build(const TriangleMesh<float>& mesh, const PeerBuild& how,
                                     std::string_view instruction_set) const override {
        std::string config = "threads=1";
        if (instruction_set == "avx2") config += ",max_isa=avx2";
        // Embree has no code without vectors: our plain walk is compared with its least instruction set.
        if (instruction_set == "sse4" || instruction_set == "plain") config += ",max_isa=sse4.2";
        return std::make_unique<EmbreeIndex>(mesh, how, config);
    }
};

}  // namespace

std::unique_ptr<Peer> embree() {
    return std::make_unique<Embree>();
}

}  // namespace hedgerow::measure
