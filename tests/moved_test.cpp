/// Indexes that were moved from are empty. They can be queried, changed, saved and assigned to.
#include <hedgerow/io/index_file.h>
#include <hedgerow/scenes/meshes.h>
#include <hedgerow/scenes/sets.h>
#include <hedgerow/trace.h>
#include <hedgerow/walks/fold.h>

#include "contract.h"
#include "engine.h"
#include "io_support.h"

using namespace hedgerow;

namespace {

// What is left of a moved index is what is tested here. NOLINTBEGIN(bugprone-use-after-move)

template <class T, int D>
bool finds_nothing(const contract::Answers<T, D>& said) {
    const auto empty = [](const auto& lists) {
        return std::all_of(lists.begin(), lists.end(), [](const auto& list) { return list.empty(); });
    };
    const auto none = [](const auto& list) {
        return std::none_of(list.begin(), list.end(), [](const auto& x) { return bool(x); });
    };
    return none(said.closest) && none(said.counts) && none(said.near) && empty(said.all) &&
           empty(said.nearest) && empty(said.overlapping);
}

/// Expects that an index is empty for every query and every instruction set.
template <class I, class Questions>
void expect_empty(const I& index, const Questions& questions) {
    using T = typename I::Scalar;
    EXPECT_EQ(index.size(), 0u);
    EXPECT_TRUE(index.bounds().empty());
    EXPECT_EQ(index.validate(), "");
    EXPECT_TRUE(index.structure().items().empty());
    EXPECT_LE(index.structure().node_count(), 1u);
    EXPECT_EQ(index.structure().leaf_count(), 0u);
    EXPECT_EQ(index.structure().depth(), 0);
    EXPECT_TRUE(outline(index.structure()).empty());
    // Single queries and batches find nothing.
    for (const auto set : instruction_sets()) {
        SCOPED_TRACE(set);
        const Using use(set);
        EXPECT_TRUE(finds_nothing(contract::answers(index, questions)));
        std::vector<Hit<T>> hits(questions.rays.size());
        const std::unique_ptr<bool[]> any(new bool[hits.size()]);
        closest_hits(index, questions.rays, hits);
        any_hits(index, questions.rays, {any.get(), hits.size()});
        for (std::size_t i = 0; i < hits.size(); ++i) EXPECT_FALSE(hits[i] || any[i]);
        std::vector<Near<T, I::dimension>> near(questions.points.size());
        closest_points(index, questions.points, near);
        for (const auto& found : near) EXPECT_EQ(found, (Near<T, I::dimension>()));
        EXPECT_EQ(all_hits(index, questions.rays).count(), 0u);
        EXPECT_EQ(nearest(index, questions.points, 3).count(), 0u);
        EXPECT_EQ(overlapping(index, questions.boxes).count(), 0u);
    }
    // Counted queries and traces find nothing.
    Visits visits;
    EXPECT_FALSE(closest_hit(index, questions.rays[0], KeepAll{}, visits));
    EXPECT_FALSE(trace(index, questions.rays[0]).hit);
}

template <class I>
void expect_moved(I index) {
    const contract::Questions questions(index, 100);
    const auto expected = contract::answers(index, questions);
    ASSERT_FALSE(finds_nothing(expected));

    I other = std::move(index);
    EXPECT_TRUE(contract::answers(other, questions) == expected);
    expect_empty(index, questions);
    I after_it = index;  // an empty index can be copied and moved again
    I and_again = std::move(after_it);
    expect_empty(and_again, questions);

    I* const itself = &other;
    other = std::move(*itself);
    EXPECT_TRUE(contract::answers(other, questions) == expected);
    index = std::move(other);
    EXPECT_TRUE(contract::answers(index, questions) == expected);
    EXPECT_EQ(index.validate(), "");
    expect_empty(other, questions);
    expect_empty(I(), questions);
}

TEST(Moved, IsEmpty) {
    const auto mesh = teapot<float>(200);
    contract::with_each_structure(mesh, [](auto index) { expect_moved(std::move(index)); });
    const auto balls = spheres<double>(100);
    expect_moved(build<AnyStructure>(balls, {"kdtree"}));
    const auto segments = segments2d<float>(100);
    expect_moved(build<AnyStructure>(segments, {"quadtree"}));
}
/// The same for one question to a structure of each type.
template <template <class, int> class S, class P>
void expect_left_empty(const P& set) {
    const auto one = view_of(set).bounds(0).low;
    auto from = build<S>(set);
    const auto want = closest_point(from, one);
    EXPECT_TRUE(want);
    const auto to = std::move(from);
    EXPECT_EQ(closest_point(to, one), want);
    EXPECT_FALSE(closest_point(from, one));
    EXPECT_EQ(from.size(), 0u);
    EXPECT_TRUE(from.bounds().empty());
    EXPECT_TRUE(from.structure().items().empty());
    EXPECT_EQ(from.structure().leaf_count(), 0u);
    EXPECT_EQ(from.validate(), "");
}
TEST(Moved, LeavesAStructureOfEachTypeEmpty) {
    const auto cloud = points<float>(100);
    expect_left_empty<BruteForce>(cloud);
    expect_left_empty<Grid>(cloud);
    expect_left_empty<TwoLevelGrid>(cloud);
    expect_left_empty<HashGrid>(cloud);
    expect_left_empty<KdTree>(cloud);
    expect_left_empty<PointKdTree>(cloud);
    expect_left_empty<Orthtree>(cloud);
    expect_left_empty<PointOrthtree>(cloud);
    expect_left_empty<BspTree>(cloud);
    expect_left_empty<Bvh>(cloud);
    expect_left_empty<VolumeBvh>(cloud);
    expect_left_empty<WideBvh>(cloud);
    expect_left_empty<AnyStructure>(cloud);
}

TEST(Moved, FindsTheNearestWhereItWent) {
    const auto cloud = points<float>(100);
    const auto index = build<PointKdTree>(cloud);
    std::vector<Near<float, 3>> near;
    auto from = index;
    const auto to = std::move(from);
    EXPECT_EQ(nearest(from, cloud.points[0], 3, near), 0u);
    EXPECT_EQ(nearest(to, cloud.points[0], 3, near), 3u);
    EXPECT_EQ(from.size(), 0u);
}

TEST(Moved, OwnedPrimitivesGoAlong) {
    auto index = build<Bvh>(teapot<double>(200));
    const contract::Questions questions(index, 100);
    const auto expected = contract::answers(index, questions);
    {
        const auto gone = std::move(index);
        EXPECT_TRUE(contract::answers(gone, questions) == expected);
    }
    expect_empty(index, questions);
}

TEST(Moved, TakesPrimitivesUpAgain) {
    const auto cloud = points<float>(50);
    const auto check = [&](auto index) {
        const auto gone = std::move(index);
        EXPECT_FALSE(index.erase(cloud, 3));
        EXPECT_TRUE(index.insert(cloud, 3));
        EXPECT_EQ(closest_point(index, cloud.points[7]).element, 3u);
        EXPECT_EQ(index.validate(), "");
    };
    check(build<Bvh>(cloud));
    check(build<Orthtree>(cloud));
    check(build<BruteForce>(cloud));
}

/// Instances of an index that was moved from are empty.
TEST(Moved, InstancesOfItAreEmpty) {
    const auto mesh = teapot<float>(200);
    auto index = build(mesh);
    const InstanceSet set{Instance(index), Instance(index, Transform<3>::translation({9, 0, 0}))};
    const auto wide = build<WideBvh>(set);
    const auto grid = build<Grid>(set);
    const auto rays = together(wide.bounds(), 500);
    std::vector<Hit<float>> hits(rays.size());
    closest_hits(wide, rays, hits);
    EXPECT_TRUE(std::any_of(hits.begin(), hits.end(), [](const auto& hit) { return bool(hit); }));
    const auto gone = std::move(index);
    for (const auto instructions : instruction_sets()) {
        const Using use(instructions);
        for (const auto& ray : rays) {
            EXPECT_FALSE(closest_hit(wide, ray) || any_hit(wide, ray));
            EXPECT_FALSE(closest_hit(grid, ray) || any_hit(grid, ray));
        }
    }
    EXPECT_THROW((InstanceSet{Instance(index)}), InputError);
}

TEST(Moved, IsSavedAsEmpty) {
    const testing_io::TempFolder folder;
    const auto path = folder / "moved.hedgerow";
    auto index = build(teapot<float>(100));
    const auto gone = std::move(index);
    save_index(path.string(), index);
    const auto loaded = load_index<float>(path.string());
    EXPECT_EQ(loaded.size(), 0u);
    EXPECT_FALSE(closest_hit(loaded, Ray3f{{0, 0, 9}, {0, 0, -1}}));
}

// NOLINTEND(bugprone-use-after-move)

}  // namespace
