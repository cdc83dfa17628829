/// A mesh in a scene of Embree's, and what its calls need. For the files of this folder that use Embree.
#pragma once

#include <embree3/rtcore.h>

#include <stdexcept>
#include <string>
#include <vector>

#if defined(__SSE3__) || defined(__x86_64__)
#include <xmmintrin.h>
#endif

#include <hedgerow/geometry/ray.h>
#include <hedgerow/primitives/triangle_mesh.h>

namespace hedgerow::measure {

/// Sets flush-to-zero and denormals-are-zero while it lives, which Embree's manual asks of its callers.
class FlushToZero {
public:
#if defined(__SSE3__) || defined(__x86_64__)
    FlushToZero() : before_(_mm_getcsr()) {
        _mm_setcsr(before_ | 0x8040u);
    }
    ~FlushToZero() {
        _mm_setcsr(before_);
    }
    FlushToZero(const FlushToZero&) = delete;
    FlushToZero& operator=(const FlushToZero&) = delete;

private:
    unsigned before_;
#else
    FlushToZero() {}
#endif
};

inline RTCRay ray_of(const Ray3f& r) {
    return {r.origin[0], r.origin[1], r.origin[2], r.t_min, r.direction[0], r.direction[1], r.direction[2], 0,
            r.t_max,     0xFFFFFFFFu, 0,           0};
}

/// A device with a scene of one mesh, which is shared with it: `commit` builds.
class EmbreeScene {
public:
    EmbreeScene(const TriangleMesh<float>& mesh, const std::string& config, RTCSceneFlags flags,
                RTCBuildQuality quality)
        : device_(rtcNewDevice(config.c_str())), vertices_(mesh.vertices) {
        if (device_ == nullptr) throw std::runtime_error("Embree refuses '" + config + "'");
        scene_ = rtcNewScene(device_);
        rtcSetSceneFlags(scene_, flags);
        rtcSetSceneBuildQuality(scene_, quality);
        RTCGeometry g = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
        vertices_.emplace_back();  // Embree reads 16 bytes at the last vertex
        rtcSetSharedGeometryBuffer(g, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, vertices_.data(), 0, 12,
                                   mesh.vertices.size());
        rtcSetSharedGeometryBuffer(g, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, mesh.triangles.data(), 0,
                                   12, mesh.triangles.size());
        rtcCommitGeometry(g);
        rtcAttachGeometry(scene_, g);
        rtcReleaseGeometry(g);
    }
    ~EmbreeScene() {
        rtcReleaseScene(scene_);
        rtcReleaseDevice(device_);
    }
    EmbreeScene(const EmbreeScene&) = delete;
    EmbreeScene& operator=(const EmbreeScene&) = delete;

    RTCDevice device() const { return device_; }
    RTCScene scene() const { return scene_; }
    void commit() { rtcCommitScene(scene_); }

private:
    RTCDevice device_;
    RTCScene scene_ = nullptr;
    std::vector<Vec3f> vertices_;
};

}  // namespace hedgerow::measure
