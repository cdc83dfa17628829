/// Other libraries' answers to questions of points, to be measured beside ours: those that were found when
/// the benchmark was compiled, or null.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>

#include <hedgerow/primitives/point_cloud.h>
#include <hedgerow/primitives/triangle_mesh.h>

namespace hedgerow {

/// A library's index, which finds closest points of triangles or the k nearest of points.
class PointPeer {
public:
    virtual ~PointPeer() = default;
    virtual std::string name() const = 0;
    /// Writes the squared distance of the k-th nearest primitive to each point. Returns the number of points.
    virtual std::size_t nearest(std::span<const Vec3f> points, std::size_t k,
                                std::span<float> distances2) const = 0;
    /// Lists the primitives within a radius of each point, if `sorted` nearest first. Returns how many there
    /// are in all, or nothing where the peer has no such query.
    virtual std::optional<std::size_t> within(std::span<const Vec3f> /*points*/, float /*radius*/,
                                              bool /*sorted*/ = true) const {
        return std::nullopt;
    }
};

/// CGAL's tree of boxes, with the hint that it finds by a kd-tree of the vertices. Only for k = 1.
std::unique_ptr<PointPeer> cgal_points(const TriangleMesh<float>& mesh);
/// nanoflann's kd-tree over the caller's points, ten a leaf.
std::unique_ptr<PointPeer> nanoflann_points(const PointCloud<float, 3>& cloud);

#if !HEDGEROW_HAS_CGAL
inline std::unique_ptr<PointPeer> cgal_points(const TriangleMesh<float>&) {
    return nullptr;
}
#endif
#if !HEDGEROW_HAS_NANOFLANN
inline std::unique_ptr<PointPeer> nanoflann_points(const PointCloud<float, 3>&) {
    return nullptr;
}
#endif

}  // namespace hedgerow
