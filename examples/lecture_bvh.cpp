// The lecture's BVH: its node and its find_closest_hit, front to back, with its slips mended (docs/claims.md
// lists them). Every answer is compared with the library's, bit by bit.
#include <algorithm>
#include <cstdio>
#include <limits>
#include <memory>
#include <numeric>
#include <utility>
#include <vector>

#include <hedgerow/hedgerow.h>
#include <hedgerow/render/camera/presets.h>
#include <hedgerow/render/camera/ray_maker.h>
#include <hedgerow/scenes/meshes.h>

using namespace hedgerow;

namespace {

struct BVHNode {
    Box3d bbox;                               // least and greatest coordinates of the enclosed primitives
    std::unique_ptr<BVHNode> child1, child2;  // none in a leaf
    std::vector<PrimitiveId> prim_list;       // of a leaf
};
struct HitInfo {
    PrimitiveId prim = no_primitive;                // which primitive did the ray hit?
    double t = std::numeric_limits<double>::max();  // at what t value?
};
const TriangleMesh<double> mesh = teapot<double>(2000);
int boxes_tested = 0, triangles_tested = 0;

/// Where a ray enters a box; ∞ if it misses it.
double entry(const Ray3d& ray, const Box3d& box) {
    ++boxes_tested;
    const auto inside = meet(ray, box);
    return inside ? inside->entry : std::numeric_limits<double>::infinity();
}
void find_closest_hit(const Ray3d& ray, const BVHNode& node, HitInfo& closest) {
    if (!node.child1) {
        for (const PrimitiveId p : node.prim_list) {
            ++triangles_tested;
            const auto hit = meet_watertight(ray, mesh.view().triangle(p));
            // Of two hits at one t the lower primitive wins, whichever is found first.
            if (hit && std::pair(hit->t, p) < std::pair(closest.t, closest.prim)) closest = {p, hit->t};
        }
        return;
    }
    const BVHNode *first = node.child1.get(), *second = node.child2.get();
    double t1 = entry(ray, first->bbox), t2 = entry(ray, second->bbox);
    if (t2 < t1) std::swap(first, second), std::swap(t1, t2);
    if (t1 <= closest.t) find_closest_hit(ray, *first, closest);
    // The boxes may overlap: the second may hold a nearer hit, unless it begins behind the first one's.
    if (t2 <= closest.t) find_closest_hit(ray, *second, closest);
}
/// Splits by equal counts, at the median of the centroids along the longest side of the box.
std::unique_ptr<BVHNode> build_node(std::vector<PrimitiveId> prims) {
    auto node = std::make_unique<BVHNode>();
    for (const PrimitiveId p : prims)
        for (const auto& corner : mesh.view().corners(p)) node->bbox.expand(corner);
    if (prims.size() <= 4) return node->prim_list = std::move(prims), std::move(node);
    const Vec3d sides = node->bbox.extent();
    const auto axis = static_cast<int>(std::max_element(sides.data, sides.data + 3) - sides.data);
    const auto centroid = [axis](PrimitiveId p) {
        const auto [a, b, c] = mesh.view().corners(p);
        return a[axis] + b[axis] + c[axis];
    };
    const auto middle = prims.begin() + static_cast<std::ptrdiff_t>(prims.size() / 2);
    std::nth_element(prims.begin(), middle, prims.end(),
                     [&](auto p, auto q) { return centroid(p) < centroid(q); });
    node->child1 = build_node({prims.begin(), middle}), node->child2 = build_node({middle, prims.end()});
    return node;
}

}  // namespace

int main() {
    std::vector<PrimitiveId> all(mesh.size());
    std::iota(all.begin(), all.end(), PrimitiveId{0});
    const auto root = build_node(all);
    const auto index = build(mesh);
    constexpr int width = 160, height = 120;
    const RayMaker make(automatic_camera(Box3f{Vec3f(root->bbox.low), Vec3f(root->bbox.high)}), width,
                        height);
    int hits = 0, wrong = 0;
    for (int i = 0; i < width * height; ++i) {
        const auto ray = make.ray<double>(float(i % width) + 0.5f, float(i / width) + 0.5f);
        HitInfo closest;
        if (entry(ray, root->bbox) <= closest.t) find_closest_hit(ray, *root, closest);
        const auto expected = closest_hit(index, ray);
        hits += closest.prim != no_primitive;
        wrong += closest.prim != expected.primitive || (expected && closest.t != expected.t);
    }
    std::printf(
        "%d of %d rays hit; a ray tests %.1f boxes and %.1f of %zu triangles; %d differ from the library\n",
        hits, width * height, double(boxes_tested) / (width * height),
        double(triangles_tested) / (width * height), mesh.size(), wrong);
    return wrong == 0 && hits > 1000 ? 0 : 1;
}
