/// Queries from within queries: filters and own primitives that query again get right answers, and so does
/// the query in whose middle they do.
#include <gtest/gtest.h>

#include <functional>

#include <hedgerow/hedgerow.h>
#include <hedgerow/scenes/meshes.h>
#include <hedgerow/scenes/random.h>

#include "every_structure.h"

using namespace hedgerow;

namespace {

Vec3f place(std::uint64_t i) {
    return Vec3f(Random(61, i).in_cube<3>());
}
Ray3f ray(std::uint64_t i) {
    return {place(i), place(i + 1000) - Vec3f(0.5f, 0.5f, 0.5f)};
}

TEST(Reentrant, FiltersCountHits) {
    const auto mesh = soup<float>(6000);
    const auto oracle = build<BruteForce>(mesh);
    std::vector<std::size_t> want;
    for (std::uint64_t i = 0; i < 40; ++i) want.push_back(hit_count(oracle, ray(i)));
    for_each_index(mesh, [&](const char* name, const auto& index) {
        SCOPED_TRACE(name);
        std::size_t again = 0;
        for (std::size_t i = 0; i < want.size(); ++i) {
            const auto filter = [&](const Hit<float>&) {
                const std::size_t other = (i + ++again) % want.size();
                const auto inner = [&](const Hit<float>&) {
                    EXPECT_EQ(hit_count(index, ray(0)), want[0]);
                    return true;
                };
                EXPECT_EQ(hit_count(index, ray(other), inner), want[other]);
                return true;
            };
            ASSERT_EQ(hit_count(index, ray(i), filter), want[i]) << i;
        }
        EXPECT_GT(again, 20u);
    });
}

/// Triangles of the caller's own, which query something each time that they are looked at, but not while they
/// do.
struct Asking {
    using Scalar = float;
    static constexpr int dimension = 3;

    TriangleMeshView<float> mesh;
    static inline std::function<void()> ask;

    std::size_t size() const { return mesh.size(); }
    Box3f bounds(std::size_t i) const { return mesh.bounds(i); }
    std::array<Vec3f, 3> corners(std::size_t i) const {
        asked();
        return mesh.corners(i);
    }
    Foot<float, 3> closest_point(std::size_t i, const Vec3f& p) const {
        asked();
        return mesh.closest_point(i, p);
    }
    template <Region R>
    bool overlaps(std::size_t i, const R& region) const {
        asked();
        return mesh.overlaps(i, region);
    }

private:
    static void asked() {
        if (!ask) return;
        const auto f = std::exchange(ask, nullptr);
        f();
        ask = f;
    }
};

/// Expects of a question of place i what the oracle answers, while the primitives ask it of another place.
template <class Question, class Answer>
void expect_again(const Question& question, const std::vector<Answer>& want) {
    std::size_t again = 0;
    for (std::size_t i = 0; i < want.size(); ++i) {
        Asking::ask = [&] {
            const std::size_t other = (i + ++again) % want.size();
            EXPECT_EQ(question(other), want[other]);
        };
        const Answer found = question(i);
        Asking::ask = nullptr;
        ASSERT_EQ(found, want[i]) << i;
    }
    EXPECT_GT(again, 20u);
}

template <template <class, int> class S>
void expect_own_primitives_ask() {
    const auto mesh = soup<float>(200);
    const auto index = build<S>(Asking{mesh.view()});
    const auto oracle = build<BruteForce>(mesh);
    constexpr std::size_t count = 30;
    const auto all = [](auto question) {
        std::vector<decltype(question(0))> answers;
        for (std::size_t i = 0; i < count; ++i) answers.push_back(question(i));
        return answers;
    };
    const auto ball = [](std::size_t i) { return Sphere<float, 3>{place(i), 0.3f}; };
    expect_again([&](std::size_t i) { return overlap_count(index, ball(i)); },
                 all([&](std::size_t i) { return overlap_count(oracle, ball(i)); }));

    const Solid solid(index);
    const Solid of_oracle(oracle);
    expect_again([&](std::size_t i) { return winding_number(solid, place(i)); },
                 all([&](std::size_t i) { return winding_number(of_oracle, place(i)); }));
    // Expansions hang on the tree, so the solid itself is the oracle.
    const Solid expanded(index, {.by = SideBy::expansion});
    const auto expansion = [&](std::size_t i) { return winding_number(expanded, place(i)); };
    expect_again(expansion, all(expansion));

    const auto nearest_ids = [](const auto& of) {
        return [&of](std::size_t i) {
            return nearest(of, std::vector{place(i)}, 4, {.threads = serial_executor()});
        };
    };
    expect_again(nearest_ids(index), all(nearest_ids(oracle)));
}
TEST(Reentrant, OwnPrimitivesAskAgain) {
    expect_own_primitives_ask<Bvh>();
    expect_own_primitives_ask<KdTree>();
    expect_own_primitives_ask<BspTree>();
    expect_own_primitives_ask<Grid>();
    expect_own_primitives_ask<Orthtree>();
}

}  // namespace
