/// Batches of every query return what single calls return, over any executor. Also tests the short overloads.
#include <hedgerow/hedgerow.h>
#include <hedgerow/scenes/meshes.h>
#include <hedgerow/scenes/sets.h>

#include "backwards.h"
#include "contract.h"
#include "lists.h"

using namespace hedgerow;

namespace {

template <class I>
void expect_same_as_alone(const I& index, Executor& executor) {
    using T = typename I::Scalar;
    constexpr int D = I::dimension;
    const contract::Questions questions(index, 3000);
    const auto alone = contract::answers(index, questions);

    // Query in batches.
    std::vector<Near<T, D>> found(questions.points.size());
    closest_points(index, questions.points, found, {.threads = executor});
    const auto hits = all_hits(index, questions.rays, {.threads = executor});
    const auto near = nearest(index, questions.points, 5, {.threads = executor});
    const auto overlaps = overlapping(index, questions.boxes, {.threads = executor});
    ASSERT_EQ(hits.size(), questions.rays.size());
    ASSERT_EQ(near.size(), questions.points.size());
    ASSERT_EQ(overlaps.size(), questions.boxes.size());
    // Compare each answer with that of a single call.
    std::size_t answers = 0;
    for (std::size_t i = 0; i < hits.size(); ++i) {
        ASSERT_TRUE(same_list(hits[i], alone.all[i])) << "ray " << i;
        answers += hits[i].size();
    }
    EXPECT_EQ(hits.count(), answers);
    EXPECT_GT(answers, 100u);
    for (std::size_t i = 0; i < found.size(); ++i) {
        ASSERT_EQ(found[i], alone.near[i]) << "point " << i;
        ASSERT_TRUE(same_list(near[i], alone.nearest[i])) << "point " << i;
        ASSERT_TRUE(same_list(overlaps[i], alone.overlapping[i])) << "box " << i;
    }
    EXPECT_GT(overlaps.count(), 100u);
}

TEST(Batches, GiveWhatSingleCallsDo) {
    const auto mesh = teapot<float>(300);
    const auto balls = spheres<double>(200);
    const auto segments = segments2d<float>(200);
    Backwards backwards;
    for (Executor* const executor : {static_cast<Executor*>(&serial_executor()), &default_executor(),
                                     static_cast<Executor*>(&backwards)}) {
        contract::with_each_structure(mesh,
                                      [&](const auto& index) { expect_same_as_alone(index, *executor); });
        expect_same_as_alone(build<KdTree>(balls), *executor);
        expect_same_as_alone(build<Orthtree>(segments), *executor);
    }
}

/// An executor that cuts as many pieces as there might be threads, some of them empty.
class EmptyPieces final : public Executor {
public:
    void for_each_piece(std::size_t count, std::size_t,
                        FunctionRef<void(std::size_t, std::size_t)> body) override {
        for (const std::size_t i : {count, std::size_t(0), count / 2}) body(i, i);
        body(0, count / 2), body(count / 2, count), body(count, count);
    }
    void both(FunctionRef<void()> first, FunctionRef<void()> second) override { first(), second(); }
};
TEST(Batches, MayBeCutIntoEmptyPieces) {
    EmptyPieces executor;
    for (const std::size_t count : {0u, 5u, 1000u}) {
        IdLists<> lists;
        detail::list_in_pieces(count, executor, lists, [](std::size_t begin, std::size_t end, IdLists<>& to) {
            for (std::size_t i = begin; i < end; ++i) {
                to.ids.append(std::vector<PrimitiveId>(i % 7, static_cast<PrimitiveId>(i)));
                to.offsets.push_back(to.ids.size());
            }
        });
        ASSERT_EQ(lists.size(), count);
        for (std::size_t i = 0; i < count; ++i)
            EXPECT_TRUE(same_list(lists[i], std::vector<PrimitiveId>(i % 7, static_cast<PrimitiveId>(i))));
    }
}

TEST(Batches, OfInstancesNameThem) {
    const auto mesh = teapot<float>(100);
    const auto pot = build(mesh);
    const InstanceSet set{Instance(pot), Instance(pot, Transform<3>::translation({9, 0, 0}))};
    const auto index = build<Bvh>(set);
    const std::vector<Box3f> boxes = {pot.bounds(), index.bounds()};
    const auto found = overlapping(index, boxes);
    EXPECT_EQ(found[0].size(), mesh.size());
    EXPECT_EQ(found[1].size(), 2 * mesh.size());
    EXPECT_EQ(found[1].back().instance, 1u);
}

TEST(Batches, NeedNoExecutorForAFilter) {
    const auto mesh = teapot<float>(300);
    const auto index = build<Bvh>(mesh);
    const contract::Questions questions(index, 500);
    const auto odd = [](const Hit<float>& hit) { return hit.element % 2 != 0; };
    const auto of_even_rays = [](std::size_t ray, const Hit<float>&) { return ray % 2 == 0; };
    // Compare calls with and without an executor.
    const auto expect_same = [&](const auto& filter) {
        const std::size_t n = questions.rays.size();
        std::vector<Hit<float>> want(n), got(n);
        const std::unique_ptr<bool[]> any(new bool[n]);
        closest_hits(index, questions.rays, want, {.threads = serial_executor()}, filter);
        closest_hits(index, questions.rays, got, filter);
        any_hits(index, questions.rays, {any.get(), n}, filter);
        const auto all = all_hits(index, questions.rays, filter);
        EXPECT_EQ(want, got);
        std::size_t kept = 0;
        for (std::size_t i = 0; i < n; ++i) {
            EXPECT_EQ(bool(want[i]), any[i]);
            EXPECT_EQ(want[i], all[i].empty() ? Hit<float>() : all[i][0]);
            kept += bool(want[i]);
        }
        EXPECT_GT(kept, n / 10);
        EXPECT_LT(kept, all_hits(index, questions.rays).count());
    };
    expect_same(odd);
    expect_same(of_even_rays);
    expect_same(Except{7});
}

// A filter may keep state, so that threads have to be asked for: an executor, or a number of them.
TEST(Batches, WithAFilterUseTheThreadsThatTheyAreGiven) {
    constexpr std::size_t many = 3 * worth_a_task;
    EXPECT_EQ(&detail::executor_for<Except>({}, many), &serial_executor());
    EXPECT_EQ(&detail::executor_for<Except>(2, many), &executor_of(2));
    EXPECT_EQ(&detail::executor_for<Except>(default_executor(), many), &default_executor());
    EXPECT_EQ(&detail::executor_for<Except>(0, many), &default_executor()) << "0 is all, and chosen";
    EXPECT_EQ(&detail::executor_for<Except>(2, 10), &serial_executor()) << "too few to share";
    EXPECT_EQ(&detail::executor_for<KeepAll>({}, many), &default_executor());
}

TEST(Batches, OfNothingLeaveOutNothing) {
    const auto cloud = points<float>(100);
    const auto index = build(cloud);
    const std::vector<Vec3f> none;
    const std::vector<PrimitiveId> own;
    EXPECT_EQ(within(index, none, 0.1, {.leave_out = own}).size(), 0u);
    EXPECT_EQ(nearest(index, none, 3, {.leave_out = own}).size(), 0u);
    closest_points(index, none, std::span<Near<float, 3>>(), {.leave_out = own});
}

TEST(Batches, KeepToTheDistanceAndTheRoom) {
    const auto cloud = points<double>(500);
    const auto index = build<PointKdTree>(cloud);
    const std::vector<Vec3d> at = {{0.5, 0.5, 0.5}, {9, 9, 9}};
    std::vector<Near<double, 3>> found(2);
    closest_points(index, at, found, {.radius = 1, .threads = serial_executor()});
    EXPECT_EQ(found[0], closest_point(index, at[0]));
    EXPECT_EQ(found[1], (Near<double, 3>()));
    const auto near = nearest(index, at, 4, {.radius2 = 1, .threads = default_executor()});
    EXPECT_EQ(near[0].size(), 4u);
    EXPECT_TRUE(near[1].empty());
    found.pop_back();
    EXPECT_THROW(closest_points(index, at, found), InputError);
    EXPECT_EQ(all_hits(index, std::vector<Ray3d>()).size(), 0u);
}

/// `build` takes an executor with the default options or with given ones.
TEST(Batches, BuildsTakeAnExecutorAlone) {
    const auto mesh = teapot<float>(300);
    const auto balls = spheres<double>(100);
    EXPECT_EQ(build<KdTree>(mesh, default_executor()).structure().node_count(),
              build<KdTree>(mesh).structure().node_count());
    EXPECT_EQ(build<Grid>(balls, default_executor()).size(), balls.size());
    EXPECT_EQ(build<Bvh>(teapot<double>(50), default_executor()).size(), teapot<double>(50).size());
    Backwards backwards;
    EXPECT_EQ(build<KdTree>(mesh, {.leaf_size = 2}, backwards).validate(), "");
}

}  // namespace
