/// Outlines of structures (walks/outline.h) and traces of rays through them (trace.h).
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <set>

#include <gtest/gtest.h>

#include <hedgerow/scenes/meshes.h>
#include <hedgerow/scenes/sets.h>

#include "matrix.h"

namespace hedgerow {
namespace {

template <class T, int D>
double volume(const Box<T, D>& b) {
    double v = 1;
    for (int k = 0; k < D; ++k) v *= static_cast<double>(b.extent()[k]);
    return v;
}
template <int D>
Box<double, D> enlarged_by(const Box<double, D>& b, double margin) {
    return {b.low - Vec<double, D>::all(margin), b.high + Vec<double, D>::all(margin)};
}
/// Calls f(set) for a small set of every kind.
template <class T, class F>
void for_each_set(F f) {
    f(soup<T>(150));
    f(teapot<T>(400));
    f(spheres<T>(100));
    f(points<T>(200));
    f(points2d<T>(200));
    f(segments2d<T>(200));
}

template <class P>
void expect_sound_outline(const P& set, const std::string& spec) {
    SCOPED_TRACE(spec);
    constexpr int D = P::dimension;
    const auto index = build_any(spec, set);
    const auto cells = index->outline();
    const double extent = static_cast<double>(length(index->bounds().extent()));
    std::map<NodeId, const OutlineCell<D>*> by_id;
    std::size_t leaves = 0, occupied = 0, items = 0;
    int depth = 0;
    for (const auto& c : cells) {
        ASSERT_TRUE(by_id.emplace(c.id, &c).second) << "cell " << c.id << " is listed twice";
        // A child is listed after its parent, one level below, and within the parent.
        if (c.parent == c.id) {
            EXPECT_EQ(c.level, 1);
        } else {
            const auto parent = by_id.find(c.parent);
            ASSERT_NE(parent, by_id.end()) << "cell " << c.id << " comes before its parent";
            EXPECT_EQ(c.level, parent->second->level + 1);
            EXPECT_FALSE(parent->second->leaf);
            // Inner cells of a two-level grid may reach out of their cell by its pad. Volumes other than
            // boxes contain the primitives below them, but not always the volumes below them.
            const auto& around = parent->second->box;
            const double beyond = spec.starts_with("two-level") ? 0.01 * length(around.extent()) : 0;
            EXPECT_TRUE(spec.find("volume=") != std::string::npos ||
                        enlarged_by(around, beyond + 1e-9 * extent).contains(c.box))
                << "cell " << c.id << " reaches out of its parent";
        }
        leaves += c.leaf, occupied += c.leaf && !c.items.empty(), items += c.items.size();
        depth = std::max(depth, c.level);
        for (const PrimitiveId id : c.items) {
            // Grids insert a primitive also into cells of the first level that it misses by a little; other
            // structures within a margin.
            const auto reach =
                enlarged_by(c.box, 0.02 * length(by_id.at(c.parent)->box.extent()) + 1e-4 * extent);
            EXPECT_TRUE(overlap(reach, detail::box_in_double(view_of(set).bounds(id))))
                << "primitive " << id << " is far from cell " << c.id;
        }
    }
    EXPECT_TRUE(index->leaf_count() == leaves || index->leaf_count() == occupied)
        << leaves << ' ' << occupied;
    EXPECT_EQ(index->item_count(), items);
    EXPECT_EQ(std::max(1, index->depth()), depth);
}

template <class T>
class Outline : public testing::Test {};
using Scalars = testing::Types<float, double>;
TYPED_TEST_SUITE(Outline, Scalars);

TYPED_TEST(Outline, CellsLieInTheirParentsAndHoldWhatMeetsThem) {
    for_each_set<TypeParam>([](const auto& set) {
        for (const std::string spec : matrix::structures)
            expect_sound_outline(set, matrix::named_for<std::remove_cvref_t<decltype(set)>>(spec));
    });
}

/// The leaves have the volume of the root together, and each point of the root is in a leaf. So leaves do not
/// overlap.
TYPED_TEST(Outline, LeavesOfPartitionsTileTheRoot) {
    for_each_set<TypeParam>([](const auto& set) {
        using P = std::remove_cvref_t<decltype(set)>;
        constexpr int D = P::dimension;
        for (const std::string spec : {"kdtree", "kdtree:builder=midpoint", "bsp", "octree", "grid"}) {
            const auto index = build_any(matrix::named_for<P>(spec), set);
            SCOPED_TRACE(index->structure());
            const auto cells = index->outline();
            const auto root = spec == "octree" ? cells[0].box : detail::box_in_double(index->bounds());
            double sum = 0;
            for (const auto& c : cells)
                if (c.leaf) sum += c.region().volume();
            EXPECT_NEAR(sum / volume(root), 1, 1e-6);
            for (std::uint64_t i = 0; i < 200; ++i) {
                Random random(5, i);
                const auto p = matrix::point_in(root, 0, random);
                EXPECT_TRUE(std::any_of(cells.begin(), cells.end(), [&](const OutlineCell<D>& c) {
                    return c.leaf && c.box.contains(p);
                }));
            }
        }
    });
}

TYPED_TEST(Outline, LimitsLeaveOutWhatIsDeepOrElsewhere) {
    const auto set = soup<TypeParam>(300);
    for (const std::string& spec : structures_for<TriangleMesh<TypeParam>>()) {
        SCOPED_TRACE(spec);
        const auto index = build_any(spec, set);
        const auto all = index->outline();
        OutlineLimits<3> limits;
        limits.levels = 4;
        limits.within.low[1] = limits.within.high[1] = 0.37;
        const auto some = index->outline(limits);
        std::set<NodeId> wanted, got;
        for (const auto& c : all)
            if (c.level <= 4 && c.box.low[1] <= 0.37 && c.box.high[1] >= 0.37) wanted.insert(c.id);
        for (const auto& c : some) got.insert(c.id);
        EXPECT_EQ(wanted, got);
        EXPECT_LT(0u, got.size());
        if (std::string(spec) != "brute-force") {
            EXPECT_LT(got.size(), all.size());
        }
    }
}

TYPED_TEST(Outline, TracesTellWhatTheQueryDid) {
    for_each_set<TypeParam>([](const auto& set) {
        using T = TypeParam;
        using P = std::remove_cvref_t<decltype(set)>;
        constexpr int D = P::dimension;
        const auto oracle = build_any("brute-force", set);
        matrix::Points<T, D> targets;
        for (std::size_t i = 0; i < set.size(); ++i) targets.push_back(view_of(set).bounds(i).center());
        for (const std::string spec : matrix::structures) {
            const auto index = build_any(matrix::named_for<P>(spec), set);
            SCOPED_TRACE(index->structure());
            for (std::uint64_t i = 0; i < 60; ++i) {
                SCOPED_TRACE(i);
                const Ray<T, D> ray = matrix::ray_of(index->bounds(), targets, i);
                // Query the index with counts, and brute force.
                Hit<T> hit, best;
                Visits visits;
                closest_hits(*index, {&ray, 1}, {&hit, 1}, {}, KeepAll(), std::span(&visits, 1));
                closest_hits(*oracle, {&ray, 1}, {&best, 1});
                const auto walked = trace(*index, ray);
                EXPECT_EQ(walked.visits, visits);
                EXPECT_EQ(walked.hit, best);
                // Sum up the steps of the trace: its tests, and whether one of them found the hit.
                std::size_t tested = 0, skipped = 0, leaves = 0;
                bool found = false;
                T limit = std::numeric_limits<T>::infinity();
                for (const auto& step : walked.steps) {
                    leaves += !step.tests.empty();
                    EXPECT_LE(step.limit, limit) << "a limit may only shrink";
                    limit = step.limit;
                    for (const auto& t : step.tests) {
                        ++(t.skipped ? skipped : tested);
                        found = found || (t.id == best.element && t.t == best.t && !t.skipped);
                    }
                }
                // The sums equal the counts of the query.
                EXPECT_EQ(tested, visits.primitives);
                EXPECT_EQ(skipped, visits.skipped);
                EXPECT_LE(leaves, visits.leaves);
                EXPECT_EQ(walked.steps.empty(), visits.nodes + visits.leaves == 0);
                EXPECT_EQ(found, bool(best));
            }
        }
    });
}

/// The middle of a step's interval is a point of the ray in the step's cell.
TEST(Trace, IntervalsAreTheRaysPartsInTheCells) {
    const auto set = soup<float>(200);
    const Ray3f ray{{-0.5f, 0.4f, 0.45f}, {1, 0.1f, 0.05f}};
    for (const std::string& spec : structures_for<TriangleMesh<float>>()) {
        const auto index = build_any(spec, set);
        SCOPED_TRACE(spec);
        const auto walked = trace(*index, ray);
        ASSERT_FALSE(walked.steps.empty());
        for (const auto& step : walked.steps) {
            const auto p = Vec3d(ray.at(step.inside.entry)) * 0.5 + Vec3d(ray.at(step.inside.exit)) * 0.5;
            EXPECT_TRUE(enlarged_by(step.cell.box, 1e-4).contains(p));
        }
    }
}

/// Cuts through one corner, as those along the blades of a fan, doubled that corner again and again.
TEST(Polytope, CutsThroughACornerKeepItOnce) {
    Polytope<3> part(Box3d{{0, 0, 0}, {1, 1, 1}});
    for (int i = 1; i <= 20; ++i) {
        const double angle = std::numbers::pi / 2 * i / 21;
        part = part.cut({{std::cos(angle), -std::sin(angle), 0}}).second;
        ASSERT_LE(part.faces().size(), 6u);
        for (const auto& face : part.faces()) ASSERT_LE(face.size(), 4u) << i;
    }
}

TEST(Polytope, ItsPartsMakeUpTheWhole) {
    const Polytope<3> cube(Box3d{{0, 0, 0}, {2, 2, 2}});
    EXPECT_DOUBLE_EQ(cube.volume(), 8);
    const CutPlane<3> corner{{1, 1, 1}, 1, 0};
    const auto [low, high] = cube.cut(corner);
    EXPECT_NEAR(low.volume(), 1.0 / 6, 1e-12);
    EXPECT_NEAR(high.volume(), 8 - 1.0 / 6, 1e-12);
    EXPECT_EQ(cube.section(corner).size(), 3u);
    EXPECT_EQ(cube.section({{1, 0, 0}, 5, 0}).size(), 0u);
    // A cut along a face does not count the face twice.
    const auto [all, face] = cube.cut({{1, 0, 0}, 2, 0});
    EXPECT_DOUBLE_EQ(all.volume(), 8);
    EXPECT_DOUBLE_EQ(all.surface(), 24);
    EXPECT_DOUBLE_EQ(face.volume(), 0);
    EXPECT_DOUBLE_EQ(face.surface(), 8);

    const Polytope<2> square(Box2d{{0, 0}, {2, 2}});
    EXPECT_DOUBLE_EQ(square.volume(), 4);
    const auto [left, right] = square.cut({{1, 1}, 1, 0});
    EXPECT_DOUBLE_EQ(left.volume(), 0.5);
    EXPECT_DOUBLE_EQ(right.volume(), 3.5);
    EXPECT_EQ(right.corners().size(), 5u);
}

}  // namespace
}  // namespace hedgerow
