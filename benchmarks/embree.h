/// Embree, where it is there.
#pragma once

#ifdef HEDGEROW_HAS_EMBREE
#include <embree3/rtcore.h>

#include "ray_sets.h"

namespace hedgerow::benchmark {

/// Embree, robust or not, its single-ray call.
class Embree {
public:
    Embree(const TriangleMesh<float>& mesh, bool robust, int threads, RTCBuildQuality quality) {
        device_ = rtcNewDevice(("threads=" + std::to_string(threads)).c_str());
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
            h.ray = {r.origin[0],
                     r.origin[1],
                     r.origin[2],
                     r.t_min,
                     r.direction[0],
                     r.direction[1],
                     r.direction[2],
                     0,
                     r.t_max,
                     0xFFFFFFFFu,
                     0,
                     0};
            h.hit.geomID = RTC_INVALID_GEOMETRY_ID;
            rtcIntersect1(scene_, &context, &h);
            found += h.hit.geomID != RTC_INVALID_GEOMETRY_ID;
        }
        return found;
    }
    double build_seconds = 0;

private:
    RTCDevice device_;
    RTCScene scene_;
    std::vector<Vec3f> vertices_;
};

/// Its medium build on one thread.
inline double embree_build_seconds(int repeats, const TriangleMesh<float>& mesh) {
    std::vector<double> times;
    for (int r = 0; r < repeats; ++r)
        times.push_back(Embree(mesh, false, 1, RTC_BUILD_QUALITY_MEDIUM).build_seconds);
    return median(times);
}

}  // namespace hedgerow::benchmark
#endif
