/// nanoflann as a peer: a kd-tree over points in the caller's array.
#include <cstdio>
#include <vector>

#include <nanoflann.hpp>

#include "points.h"

namespace hedgerow {
namespace {

/// The points as nanoflann reads them.
struct Adaptor {
    const std::vector<Vec3f>& points;

    std::size_t kdtree_get_point_count() const { return points.size(); }
    float kdtree_get_pt(std::size_t i, std::size_t axis) const { return points[i][static_cast<int>(axis)]; }
    template <class Box>
    bool kdtree_get_bbox(Box&) const {
        return false;  // it computes the box itself
    }
};
using Tree = nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<float, Adaptor>, Adaptor, 3,
                                                 std::uint32_t>;

class NanoflannPoints final : public PointPeer {
public:
    explicit NanoflannPoints(const PointCloud<float, 3>& cloud)
        : points_{cloud.points}, tree_(3, points_, nanoflann::KDTreeSingleIndexAdaptorParams(10)) {
        tree_.buildIndex();
    }
    std::string name() const override { return "nanoflann"; }
    std::size_t nearest(std::span<const Vec3f> points, std::size_t k,
                        std::span<float> distances2) const override {
        std::vector<std::uint32_t> ids(k);
        std::vector<float> found(k);
        for (std::size_t i = 0; i < points.size(); ++i) {
            nanoflann::KNNResultSet<float, std::uint32_t> results(k);
            results.init(ids.data(), found.data());
            tree_.findNeighbors(results, points[i].data, nanoflann::SearchParams());
            distances2[i] = found[k - 1];
        }
        return points.size();
    }
    std::optional<std::size_t> within(std::span<const Vec3f> points, float radius,
                                      bool sorted) const override {
        std::size_t all = 0;
        std::vector<std::pair<std::uint32_t, float>> found;
        for (const Vec3f& p : points)
            all += tree_.radiusSearch(p.data, radius * radius, found, nanoflann::SearchParams(32, 0, sorted));
        return all;
    }

private:
    Adaptor points_;
    Tree tree_;
};

}  // namespace

std::unique_ptr<PointPeer> nanoflann_points(const PointCloud<float, 3>& cloud) {
    return std::make_unique<NanoflannPoints>(cloud);
}

}  // namespace hedgerow
