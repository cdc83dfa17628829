#include <hedgerow/base/error.h>
#include <hedgerow/geometry/box.h>
#include <hedgerow/geometry/eigen.h>
#include <hedgerow/geometry/hull.h>

#ifndef HEDGEROW_HAS_QHULL
#define HEDGEROW_HAS_QHULL 1
#endif

#if HEDGEROW_HAS_QHULL
#include <cstdio>
#include <memory>

extern "C" {
#include <libqhull_r/qhull_ra.h>
}
#endif

namespace hedgerow {

#if HEDGEROW_HAS_QHULL
namespace {

/// The points moved and scaled into [-1, 1]³, so that Qhull's tolerances do not depend on where they lie.
/// Empty if they lie in a plane or nearly so.
std::vector<Vec3d> brought_to_one(std::span<const Vec3d> points) {
    Box3d box;
    for (const auto& p : points) box.expand(p);
    const Vec3d middle = box.center();
    const double extent = max_component(box.extent());
    if (points.size() < 4 || !(extent > 0x1p-1000)) return {};
    // Scale the points, and sum their second moments about the first.
    std::vector<Vec3d> brought;
    Rows<3> moments{};
    for (const auto& p : points) {
        const Vec3d x = (p - middle) * (2 / extent);
        brought.push_back(x);
        for (int k = 0; k < 3; ++k) {
            auto& row = moments[static_cast<std::size_t>(k)];
            row = row + (x - brought[0]) * (x - brought[0])[k];
        }
    }
    // Find whether the extent along a principal axis is next to none.
    for (const Vec3d& axis : eigen_of_symmetric(moments).vectors) {
        double low = dot(axis, brought[0]), high = low;
        for (const auto& x : brought) low = std::min(low, dot(axis, x)), high = std::max(high, dot(axis, x));
        if (high - low < 1e-7) return {};
    }
    return brought;
}

/// A run of Qhull. Qhull keeps its state in the struct `qh_`, and its memory in that struct.
class Run {
public:
    explicit Run(std::vector<Vec3d>& points) : said_(std::fopen("/dev/null", "w"), &std::fclose) {
        QHULL_LIB_CHECK
        qh_zero(&qh_, said_.get());
        static char options[] = "qhull";
        const int points_count = static_cast<int>(points.size());
        failed_ = said_ == nullptr || qh_new_qhull(&qh_, 3, points_count, points[0].data, False, options,
                                                   said_.get(), said_.get()) != 0;
    }
    Run(const Run&) = delete;
    Run& operator=(const Run&) = delete;
    ~Run() {
        qh_freeqhull(&qh_, !qh_ALL);
        int left, bytes;
        qh_memfreeshort(&qh_, &left, &bytes);
    }
    std::vector<Vec3d> normals() {
        std::vector<Vec3d> found;
        if (failed_) return found;
        const qhT* const qh = &qh_;
        const facetT* facet;
        FORALLfacets {
            if (facet->normal != nullptr)
                found.push_back({facet->normal[0], facet->normal[1], facet->normal[2]});
        }
        return found;
    }

private:
    std::unique_ptr<std::FILE, int (*)(std::FILE*)> said_;  // takes what Qhull prints
    qhT qh_;
    bool failed_ = true;
};

}  // namespace

std::vector<Vec3d> hull_normals(std::span<const Vec3d> points) {
    auto brought = brought_to_one(points);
    if (brought.empty()) return {};
    return Run(brought).normals();
}
#else
std::vector<Vec3d> hull_normals(std::span<const Vec3d>) {
    throw InputError(
        "this build has no Qhull, so no convex hulls: build with HEDGEROW_QHULL=ON, or use volume=kdop26");
}
#endif

}  // namespace hedgerow
