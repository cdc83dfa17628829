/// Closest-hit rates and build times of the BVH, beside Embree in the same run when it is there.
///
///   rays_benchmark [SCENE ...]     a mesh file or gen:NAME[:SIZE]; default: gen:teapot-in-stadium
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <functional>
#include <string>
#include <vector>

#include "ray_sets.h"

#ifdef HEDGEROW_HAS_EMBREE
#include <embree3/rtcore.h>
#endif

using namespace hedgerow;
using namespace hedgerow::benchmark;

namespace {

#ifdef HEDGEROW_HAS_EMBREE
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
#endif

constexpr int repeats = 7;

/// Million rays a second of each contender, measured in turn, as medians.
std::vector<double> rates(const std::vector<Ray3f>& rays,
                          const std::vector<std::function<std::size_t()>>& contenders) {
    std::vector<std::vector<double>> times(contenders.size());
    for (int r = 0; r < repeats; ++r)
        for (std::size_t c = 0; c < contenders.size(); ++c) {
            const double start = seconds();
            const std::size_t found = contenders[c]();
            times[c].push_back(seconds() - start);
            if (found > rays.size()) std::abort();
        }
    std::vector<double> result;
    for (auto& t : times) result.push_back(double(rays.size()) / median(t) * 1e-6);
    return result;
}

template <class Build>
double build_seconds(Build build) {
    std::vector<double> times;
    for (int r = 0; r < repeats; ++r) {
        const double start = seconds();
        build();
        times.push_back(seconds() - start);
    }
    return median(times);
}

void builds(const TriangleMesh<float>& mesh) {
    const double one = build_seconds([&] { build(mesh); });
    double two;
    {
        const ThreadLimit limit(2);
        two = build_seconds([&] { build(mesh, default_executor()); });
    }
    std::printf("  binned build  %7.1f ms on one thread, %7.1f ms on two: %.2f x as fast\n", one * 1e3,
                two * 1e3, one / two);
#ifdef HEDGEROW_HAS_EMBREE
    std::vector<double> medium;
    for (int r = 0; r < repeats; ++r)
        medium.push_back(Embree(mesh, false, 1, RTC_BUILD_QUALITY_MEDIUM).build_seconds);
    std::printf("  Embree medium %7.1f ms on one thread: ours takes %.2f of it\n", median(medium) * 1e3,
                one / median(medium));
#endif
}

void traces(const TriangleMesh<float>& mesh) {
    const auto index = build(mesh);
    std::printf("  %.1f bytes a triangle, depth %d, SAH cost %.1f\n",
                double(index.bytes()) / double(mesh.size()), index.structure().depth(),
                index.structure().sah_cost());
    const auto sets = ray_sets(mesh, index.bounds(), 1024, 1 << 19);
#ifdef HEDGEROW_HAS_EMBREE
    const Embree embree(mesh, false, 1, RTC_BUILD_QUALITY_MEDIUM),
        robust(mesh, true, 1, RTC_BUILD_QUALITY_MEDIUM);
#endif
    std::printf("  %-8s %9s %8s %8s %8s", "rays", "Mrays/s", "nodes", "leaves", "prims");
    std::printf("   Embree Mrays/s (ratio)   robust (ratio)\n");
    for (const auto& [name, rays] : sets) {
        Visits v;
        for (const auto& r : rays) closest_hit(index, r, KeepAll{}, v);
        std::vector<std::function<std::size_t()>> contenders = {[&, &rays = rays] {
            std::size_t found = 0;
            for (const auto& r : rays) found += closest_hit(index, r).has_value();
            return found;
        }};
#ifdef HEDGEROW_HAS_EMBREE
        contenders.emplace_back([&, &rays = rays] { return embree.trace(rays); });
        contenders.emplace_back([&, &rays = rays] { return robust.trace(rays); });
#endif
        const auto rate = rates(rays, contenders);
        const double n = double(rays.size());
        std::printf("  %-8s %9.2f %8.2f %8.2f %8.2f", name.c_str(), rate[0], double(v.nodes) / n,
                    double(v.leaves) / n, double(v.primitives) / n);
        for (std::size_t c = 1; c < rate.size(); ++c)
            std::printf("   %9.2f (%.2f)", rate[c], rate[0] / rate[c]);
        std::printf("\n");
    }
}

}  // namespace

int main(int count, char** arguments) {
    std::printf("%s, g++ %d.%d, one thread, medians of %d\n", processor().c_str(), __GNUC__, __GNUC_MINOR__,
                repeats);
    std::vector<std::string> names(arguments + 1, arguments + count);
    if (names.empty()) names = {"gen:teapot-in-stadium"};
    for (const auto& name : names) {
        const auto mesh = scene(name);
        std::printf("%s: %zu triangles\n", name.substr(name.rfind('/') + 1).c_str(), mesh.size());
        builds(mesh);
        traces(mesh);
    }
}
