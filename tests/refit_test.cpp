/// Refits: trees that are refitted to moved primitives answer as brute force does, and report their drift.
#include "trees.h"

using namespace hedgerow;
using namespace hedgerow::contract;
using namespace hedgerow::trees;

namespace {

TriangleMesh<float> swayed(TriangleMesh<float> mesh, float by) {
    for (auto& v : mesh.vertices)
        v = v + Vec3f(std::sin(9 * v[1]), std::sin(7 * v[2]), std::sin(8 * v[0])) * by;
    return mesh;
}

/// Structures that can be refitted, and the options to try.
struct RefitsBinary {
    template <class P>
    static auto over(const P& set, const BvhOptions& options = {}) {
        return build<Bvh>(set, options);
    }
    static std::vector<BvhOptions> all() {
        std::vector<BvhOptions> list;
        for (const auto builder : bvh_builders) list.push_back(options_of(builder));
        return list;
    }
};
struct RefitsWide {
    template <class P>
    static auto over(const P& set, const WideOptions& options = {}) {
        return build<WideBvh>(set, options);
    }
    static std::vector<WideOptions> all() {
        return {{.builder = WideBuilder::fast, .width = 4},
                {.builder = WideBuilder::medium, .width = 8},
                {.builder = WideBuilder::high, .width = 16}};
    }
};

template <class S>
class Refit : public testing::Test {};
using Refitted = testing::Types<RefitsBinary, RefitsWide>;
TYPED_TEST_SUITE(Refit, Refitted);

TYPED_TEST(Refit, AnswersAsBruteForceDoes) {
    const auto still = teapot<float>(2000);
    for (const auto& options : TypeParam::all()) {
        auto mesh = still;
        auto index = TypeParam::over(mesh, options);
        for (const float by : {0.f, 0.1f, 0.5f, 0.f}) {
            std::ranges::copy(swayed(still, by).vertices, mesh.vertices.begin());
            const double drift = index.refit(default_executor());
            EXPECT_EQ(index.validate(), "");
            EXPECT_EQ(drift, index.structure().drift());
            // A refit fits cut primitives whole. So drift returns to 1 only where nothing was cut.
            if (by == 0 && index.structure().exclusive()) {
                EXPECT_EQ(drift, 1);
            }
            const auto oracle = build<BruteForce>(mesh);
            const Questions questions(oracle, 300);
            EXPECT_EQ(answers(index, questions), answers(oracle, questions));
        }
    }
}

TYPED_TEST(Refit, IsTheSameForAnyExecutor) {
    const auto still = soup<float>(30000), moved = swayed(still, 0.2f);
    auto serial = TypeParam::over(still), other = TypeParam::over(still);
    Backwards backwards;
    EXPECT_EQ(serial.refit(moved.view()), other.refit(moved.view(), backwards));
    expect_same_tree(serial, other);
    EXPECT_EQ(serial.refit(still.view()), 1);
}

TYPED_TEST(Refit, TellsHowFarTheQualityDrifts) {
    const auto still = soup<float>(5000);
    auto index = TypeParam::over(still);
    EXPECT_EQ(index.structure().drift(), 1);
    EXPECT_EQ(index.refit(), 1);
    double last = 1;
    for (const std::size_t exchanged : {50u, 500u, 5000u}) {  // triangles that change places
        auto mesh = still;
        for (std::size_t i = 0; i < exchanged; ++i)
            std::swap(mesh.triangles[i], mesh.triangles[Random(1, i).bits() % mesh.size()]);
        const double drift = index.refit(mesh.view());
        EXPECT_GT(drift, 1.1 * last);
        last = drift;
    }
    EXPECT_GT(last, 5);
    EXPECT_EQ(index.refit(still.view()), 1);
}

TYPED_TEST(Refit, SaysWhenToBuildAgain) {
    const auto still = soup<float>(5000);
    auto index = TypeParam::over(still);
    EXPECT_FALSE(index.refit().build_again());
    bool before = false, after = false;
    for (const float by : {0.001f, 0.01f, 0.1f, 0.3f, 1.f, 3.f}) {
        const auto mesh = swayed(still, by);
        const Drift drift = index.refit(mesh.view());
        EXPECT_EQ(drift.build_again(), drift > 1.4) << by;
        before |= !drift.build_again(), after |= drift.build_again();
        // What the rule promises of rays: where it says no, a tree built anew opens few boxes less.
        const auto anew = TypeParam::over(mesh);
        const Questions questions(anew, 2000);
        Visits fitted, built;
        for (const auto& ray : questions.rays) {
            closest_hit(index, ray, KeepAll(), fitted);
            closest_hit(anew, ray, KeepAll(), built);
        }
        if (!drift.build_again())
            EXPECT_LT(double(fitted.nodes), 1.5 * double(built.nodes)) << by;
        else
            EXPECT_GT(fitted.nodes, built.nodes) << by;
    }
    EXPECT_TRUE(before && after);
}

/// Throws when work is split for the k-th time.
class Failing final : public Executor {
public:
    explicit Failing(int k) : k_(k) {}
    void for_each_piece(std::size_t count, std::size_t,
                        FunctionRef<void(std::size_t, std::size_t)> body) override {
        split();
        for (std::size_t i = 0; i < count; i += worth_a_task) body(i, std::min(count, i + worth_a_task));
    }
    void both(FunctionRef<void()> first, FunctionRef<void()> second) override {
        first();
        split();
        second();
    }

private:
    void split() {
        if (--k_ == 0) throw Cancelled("the k-th split");
    }
    int k_;
};

TYPED_TEST(Refit, ThatIsStoppedAnywhereLeavesAnIndexThatIsRight) {
    const auto still = soup<float>(20000), moved = swayed(still, 0.3f);
    const auto then = build<BruteForce>(still), now = build<BruteForce>(moved);
    const Questions questions(now, 20);
    const auto of_still = answers(then, questions), of_moved = answers(now, questions);
    int finished = 0, stopped = 0;
    for (int k = 1; k < 100; ++k) {
        auto index = TypeParam::over(still);
        Failing failing(k);
        try {
            index.refit(moved.view(), failing);
            break;
        } catch (const Cancelled&) {
            ++stopped;
        }
        const auto got = answers(index, questions);
        finished += got == of_moved;
        EXPECT_TRUE(got == of_moved || got == of_still) << "split " << k;
    }
    EXPECT_GT(finished, 0);
    EXPECT_GT(stopped, finished);
}

TYPED_TEST(Refit, ThatIsRefusedLeavesTheIndexAsItWas) {
    const auto still = teapot<float>(2000);
    auto mesh = still;
    auto index = TypeParam::over(still);
    const Questions questions(index, 200);
    const auto before = answers(index, questions);
    mesh = swayed(still, 0.3f);
    mesh.vertices[mesh.triangles[900][1]][2] = std::numeric_limits<float>::quiet_NaN();
    EXPECT_THROW(index.refit(mesh.view()), InputError);
    mesh.vertices[mesh.triangles[900][1]][2] = 1e30f;
    EXPECT_THROW(index.refit(mesh.view()), InputError);
    mesh = still;
    mesh.triangles.pop_back();
    EXPECT_THROW(index.refit(mesh.view()), InputError);
    EXPECT_EQ(answers(index, questions), before);
    EXPECT_EQ(index.structure().drift(), 1);
}

TYPED_TEST(Refit, HoldsForNoneOneAndOtherPrimitives) {
    PointCloud<double, 2> cloud;
    auto none = TypeParam::over(cloud);
    EXPECT_EQ(none.refit(), 1);
    cloud.points.emplace_back(1.0, 2.0);
    auto one = TypeParam::over(cloud);
    cloud.points[0] = {5, 6};
    EXPECT_EQ(one.refit(), 1);
    EXPECT_EQ(one.bounds().low, cloud.points[0]);
    cloud = points2d<double>(1000);
    auto many = TypeParam::over(cloud);
    for (auto& p : cloud.points) p = {p[1] * p[1], p[0]};
    many.refit();
    EXPECT_EQ(many.validate(), "");
    const auto oracle = build<BruteForce>(cloud);
    const Questions questions(oracle, 100);
    EXPECT_EQ(answers(many, questions), answers(oracle, questions));
    for (auto& p : cloud.points) p = {3, 3};  // one point has no area, so no random line meets it
    EXPECT_GT(many.refit(), 0);
}

}  // namespace
