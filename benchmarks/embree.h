/// Embree, where it is there.
#pragma once

#ifdef HEDGEROW_HAS_EMBREE
#include <embree3/rtcore.h>

#include <span>

#include "ray_sets.h"

namespace hedgerow::benchmark {

/// Embree, robust or not: its single-ray calls, and its calls of 16.
class Embree {
public:
    /// `isa` is the most that it may use, as its `max_isa` has it; empty for all.
    Embree(const TriangleMesh<float>& mesh, bool robust, int threads, RTCBuildQuality quality,
           const std::string& isa = "") {
        const std::string most = isa.empty() ? "" : ",max_isa=" + isa;
        device_ = rtcNewDevice(("threads=" + std::to_string(threads) + most).c_str());
        scene_ = rtcNewScene(device_);
        rtcSetSceneFlags(scene_, robust ? RTC_SCENE_FLAG_ROBUST : RTC_SCENE_FLAG_NONE);
        rtcSetSceneBuildQuality(scene_, quality);
        RTCGeometry g = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
        vertices_ = mesh.vertices;
        vertices_.emplace_back();  // it reads 16 bytes at the last vertex
        rtcSetSharedGeometryBuffer(g, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, vertices_.data(), 0, 12,
                                   mesh.vertices.size());
        rtcSetSharedGeometryBuffer(g, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, mesh.triangles.data(), 0,
                                   12, mesh.triangles.size());
        rtcCommitGeometry(g);
        rtcAttachGeometry(scene_, g);
        rtcReleaseGeometry(g);
        const double start = seconds();
        rtcCommitScene(scene_);
        build_seconds = seconds() - start;
    }
    ~Embree() {
        rtcReleaseScene(scene_);
        rtcReleaseDevice(device_);
    }
    std::size_t trace(const std::vector<Ray3f>& rays) const {
        RTCIntersectContext context;
        rtcInitIntersectContext(&context);
        std::size_t found = 0;
        for (const Ray3f& r : rays) {
            RTCRayHit h;
            h.ray = ray_of(r);
            h.hit.geomID = RTC_INVALID_GEOMETRY_ID;
            rtcIntersect1(scene_, &context, &h);
            found += h.hit.geomID != RTC_INVALID_GEOMETRY_ID;
        }
        return found;
    }
    std::size_t occluded(const std::vector<Ray3f>& rays) const {
        RTCIntersectContext context;
        rtcInitIntersectContext(&context);
        std::size_t found = 0;
        for (const Ray3f& r : rays) {
            RTCRay ray = ray_of(r);
            rtcOccluded1(scene_, &context, &ray);
            found += ray.tfar < 0;
        }
        return found;
    }

    /// Rays by sixteen, in Embree's layout; the last that do not fill one are left out.
    struct Packets {
        std::vector<RTCRay16> rays;

        explicit Packets(std::span<const Ray3f> from) : rays(from.size() / 16) {
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
    };
    std::size_t trace(const Packets& packets, bool closest) const {
        RTCIntersectContext context;
        rtcInitIntersectContext(&context);
        context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
        alignas(64) int valid[16];
        for (int& v : valid) v = -1;
        std::size_t found = 0;
        for (const RTCRay16& rays : packets.rays) {
            if (closest) {
                RTCRayHit16 h;
                h.ray = rays;
                for (auto& id : h.hit.geomID) id = RTC_INVALID_GEOMETRY_ID;
                rtcIntersect16(valid, scene_, &context, &h);
                found += h.hit.geomID[0] != RTC_INVALID_GEOMETRY_ID;
            } else {
                RTCRay16 ray = rays;
                rtcOccluded16(valid, scene_, &context, &ray);
                found += ray.tfar[0] < 0;
            }
        }
        return found;
    }
    double build_seconds = 0;

private:
    static RTCRay ray_of(const Ray3f& r) {
        return {
            r.origin[0], r.origin[1], r.origin[2], r.t_min, r.direction[0], r.direction[1], r.direction[2], 0,
            r.t_max,     0xFFFFFFFFu, 0,           0};
    }

    RTCDevice device_;
    RTCScene scene_;
    std::vector<Vec3f> vertices_;
};

/// Its build on one thread.
inline double embree_build_seconds(int repeats, const TriangleMesh<float>& mesh,
                                   RTCBuildQuality quality = RTC_BUILD_QUALITY_MEDIUM) {
    std::vector<double> times;
    for (int r = 0; r < repeats; ++r) times.push_back(Embree(mesh, false, 1, quality).build_seconds);
    return median(times);
}

}  // namespace hedgerow::benchmark
#endif
