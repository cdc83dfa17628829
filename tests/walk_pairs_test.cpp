/// The walk over pairs of nodes: each pair once, and pairwise monopoles, the potential energy of unit masses
/// as a multipole method sums it.
#include <gtest/gtest.h>

#include <hedgerow/scenes/meshes.h>
#include <hedgerow/scenes/sets.h>

#include "every_structure.h"

using namespace hedgerow;

namespace {

struct Masses {
    double count = 0;
    Vec3d sum;
};
/// Two nodes that are small for their distance count as two masses, each at its center of mass.
struct Monopoles {
    using BoxType = Box3d;
    static constexpr Order order = Order::none;
    const PointCloud<double, 3>& cloud;
    const std::vector<Masses>& masses;
    const std::vector<double>& radii;
    double opening_angle;
    double energy = 0;
    std::size_t accepted = 0;

    static double bound(const Box3d&, const Box3d&) { return 0; }
    static double limit() { return 0; }
    Verdict accept(NodeId a, NodeId b) {
        const double distance = length(center(a) - center(b));
        if (!(radii[a] + radii[b] < opening_angle * distance)) return Verdict::open;
        energy += masses[a].count * masses[b].count / distance;
        ++accepted;
        return Verdict::accept;
    }
    Flow offer(const BoxedLeaf<double, 3>& a, const BoxedLeaf<double, 3>& b) {
        for (std::uint32_t i = 0; i < a.items.count; ++i)
            for (std::uint32_t j = 0; j < b.items.count; ++j) add(id(a, i), id(b, j));
        return Flow::go_on;
    }
    Flow offer(const BoxedLeaf<double, 3>& leaf) {
        for (std::uint32_t i = 0; i < leaf.items.count; ++i)
            for (std::uint32_t j = i + 1; j < leaf.items.count; ++j) add(id(leaf, i), id(leaf, j));
        return Flow::go_on;
    }

private:
    static PrimitiveId id(const BoxedLeaf<double, 3>& leaf, std::uint32_t i) {
        return leaf.items.ids[leaf.items.first + i];
    }
    Vec3d center(NodeId n) const { return masses[n].sum / masses[n].count; }
    void add(PrimitiveId i, PrimitiveId j) { energy += 1 / length(cloud.points[i] - cloud.points[j]); }
};

template <class Index>
void expect_energy(const Index& index, const PointCloud<double, 3>& cloud, double direct) {
    // Masses by node come from `fold`; the radius of a node reaches from its center to its box's corners.
    const auto& tree = index.structure();
    const auto masses = fold(
        tree,
        [&](const Leaf& leaf) {
            Masses m;
            for (std::uint32_t i = leaf.first; i < leaf.first + leaf.count; ++i)
                m = {m.count + 1, m.sum + cloud.points[leaf.ids[i]]};
            return m;
        },
        [](const Masses& a, const Masses& b) {
            return Masses{a.count + b.count, a.sum + b.sum};
        });
    const auto nodes = hierarchy_of(tree, index.primitives());
    std::vector<double> radii(nodes.node_count());
    const auto set_radius = [&](auto& self, const auto& node) -> void {
        const Vec3d center = masses[node.id].sum / masses[node.id].count;
        radii[node.id] = length(max(node.box.high - center, center - node.box.low));
        if (!nodes.is_leaf(node)) nodes.for_each_child(node, [&](const auto& child) { self(self, child); });
    };
    set_radius(set_radius, nodes.root());
    std::size_t before = std::numeric_limits<std::size_t>::max();
    for (const double angle : {0.0, 0.2, 0.4, 0.8}) {
        Monopoles query{cloud, masses, radii, angle};
        Visits visits;
        walk_pairs(nodes, query, visits);
        // A pair's first terms vanish about the centers of mass; the next is of the order of the angle².
        EXPECT_NEAR(query.energy, direct, std::max(1e-12, angle * angle / 2) * direct) << angle;
        const std::size_t work = visits.primitives + query.accepted;
        EXPECT_LT(work, before);
        before = work;
    }
}
TEST(Monopoles, NearTheDirectSumAsTheAngleShrinks) {
    const auto cloud = points<double>(3000);
    double direct = 0;
    for (std::size_t i = 0; i < cloud.size(); ++i)
        for (std::size_t j = i + 1; j < cloud.size(); ++j)
            direct += 1 / length(cloud.points[i] - cloud.points[j]);
    expect_energy(build<Bvh>(cloud), cloud, direct);
    expect_energy(build<WideBvh>(cloud), cloud, direct);
    expect_energy(build<Orthtree>(cloud), cloud, direct);
    expect_energy(build<KdTree>(cloud), cloud, direct);
}

/// A walk of a tree with itself meets each unordered pair of primitives once.
struct CountPairs {
    using BoxType = Box3f;
    static constexpr Order order = Order::none;
    std::vector<std::uint8_t>& seen;
    std::size_t size;

    static float bound(const Box3f&, const Box3f&) { return 0; }
    static float limit() { return 0; }
    void see(PrimitiveId i, PrimitiveId j) { ++seen[std::min(i, j) * size + std::max(i, j)]; }
    Flow offer(const BoxedLeaf<float, 3>& a, const BoxedLeaf<float, 3>& b) {
        for (std::uint32_t i = 0; i < a.items.count; ++i)
            for (std::uint32_t j = 0; j < b.items.count; ++j)
                see(a.items.ids[a.items.first + i], b.items.ids[b.items.first + j]);
        return Flow::go_on;
    }
    Flow offer(const BoxedLeaf<float, 3>& a) {
        for (std::uint32_t i = 0; i < a.items.count; ++i)
            for (std::uint32_t j = i + 1; j < a.items.count; ++j)
                see(a.items.ids[a.items.first + i], a.items.ids[a.items.first + j]);
        return Flow::go_on;
    }
};
TEST(WalkPairs, MeetsEachPairOnce) {
    const auto mesh = soup<float>(300);
    for_each_index(mesh, [&](const char* name, const auto& index) {
        std::vector<std::uint8_t> seen(mesh.size() * mesh.size());
        CountPairs query{seen, mesh.size()};
        Visits visits;
        walk_pairs(hierarchy_of(index.structure(), index.primitives()), query, visits);
        for (std::size_t i = 0; i < mesh.size(); ++i)
            for (std::size_t j = i + 1; j < mesh.size(); ++j) {
                ASSERT_GE(seen[i * mesh.size() + j], 1) << name;
                if (index.structure().exclusive()) {
                    ASSERT_EQ(seen[i * mesh.size() + j], 1) << name;
                }
            }
    });
}

}  // namespace
