/// Transparent surfaces along rays: both orders agree, rays that end early change nothing that is seen, masks
/// are filters, and shadows are products.
#include <gtest/gtest.h>

#include <hedgerow/any_index.h>
#include <hedgerow/hedgerow.h>
#include <hedgerow/render/shading/transparency.h>
#include <hedgerow/scenes/meshes.h>
#include <hedgerow/scenes/random.h>
#include <hedgerow/scenes/sets.h>

#include "backwards.h"
#include "layers.h"
#include "structure_names.h"

using namespace hedgerow;

namespace {

/// Rays from an eye before a box through a square of points in it.
template <class T>
std::vector<Ray<T, 3>> picture(const Box<T, 3>& box, int side) {
    std::vector<Ray<T, 3>> rays;
    const Vec<T, 3> middle = box.center(), size = box.extent();
    const Vec<T, 3> eye = middle - Vec<T, 3>(T(0.3) * size[0], T(0.2) * size[1], size[2] + T(1));
    for (int y = 0; y < side; ++y)
        for (int x = 0; x < side; ++x) {
            const Vec<T, 3> at(size[0] * (T(x) / T(side) - T(0.5)), size[1] * (T(y) / T(side) - T(0.5)),
                               T(0));
            rays.push_back({eye, middle + at - eye});
        }
    return rays;
}

/// A colour for each element and instance, and an opacity between two values.
struct Coloured {
    float least, most;

    template <class R, class T>
    Layer operator()(const R&, const Hit<T>& hit) const {
        Random random(17, hit.element + 1000003u * hit.instance);
        const Vec3f colour(Vec3d(random.uniform(), random.uniform(), random.uniform()));
        return {colour, least + (most - least) * static_cast<float>(random.uniform())};
    }
};

float difference(const Composite& a, const Composite& b) {
    return std::max(max_component(abs(a.colour - b.colour)), std::abs(a.through - b.through));
}
/// Expects both orders to agree, and pictures with rays that end early to be those without them.
template <class I, class T = typename I::Scalar>
TransparencyCounts expect_same(const I& index, const std::vector<Ray<T, 3>>& rays, const Coloured& layer) {
    std::vector<Composite> front(rays.size()), back(rays.size()), ended(rays.size());
    const auto whole = composite_front_to_back(index, rays, layer, front, {.ends_below = 0});
    const auto layers = composite_back_to_front(index, rays, layer, back);
    EXPECT_EQ(whole.layers, layers);
    EXPECT_EQ(whole.ended, 0u);
    const auto counts = composite_front_to_back(index, rays, layer, ended, {.counts_saved = true});
    EXPECT_EQ(counts.layers + counts.saved, layers);
    float orders = 0, ends = 0;
    for (std::size_t i = 0; i < rays.size(); ++i) {
        orders = std::max(orders, difference(front[i], back[i]));
        ends = std::max(ends, difference(front[i], ended[i]));
    }
    EXPECT_LE(orders, 1e-5f);
    EXPECT_LE(ends, 1.0f / 1024);
    EXPECT_LT(ends, 1.0f / 255);
    return counts;
}

template <class T>
class TransparencyOf : public testing::Test {};
using Scalars = testing::Types<float, double>;
TYPED_TEST_SUITE(TransparencyOf, Scalars);

TYPED_TEST(TransparencyOf, AThousandLayersInBothOrders) {
    using T = TypeParam;
    const auto mesh = stack<T>(1000);
    const auto index = build(mesh);
    // Along z, so that all rays pass all layers.
    std::vector<Ray<T, 3>> rays(64);
    for (std::size_t i = 0; i < rays.size(); ++i) {
        const std::size_t column = i % 8, row = i / 8;
        rays[i] = {{T(column) / 8 + T(0.06), T(row) / 8 + T(0.03), T(-1)}, {T(0), T(0), T(1)}};
    }
    // So thin that every layer counts, and so opaque that few do.
    for (const Coloured layer : {Coloured{0, 0.001f}, Coloured{0.001f, 0.01f}, Coloured{0.2f, 0.9f}}) {
        SCOPED_TRACE(layer.most);
        const auto counts = expect_same(index, rays, layer);
        EXPECT_EQ(counts.layers + counts.saved, 64u * 1000);
        EXPECT_EQ(counts.ended > 0, layer.most > 0.1f);
    }
}

TYPED_TEST(TransparencyOf, CoplanarFacesAndEqualT) {
    using T = TypeParam;
    // Six squares in each of three places, and rays through their diagonals, where two triangles are hit.
    const auto mesh = stack<T>(3, 6);
    for (const std::string& structure : structures_for<TriangleMesh<T>>()) {
        SCOPED_TRACE(structure);
        const auto index = build_any(structure, mesh);
        auto rays = picture(index->bounds(), 24);
        for (int i = 1; i < 16; ++i) rays.push_back({{T(i) / 16, 1 - T(i) / 16, T(-1)}, {T(0), T(0), T(1)}});
        expect_same(*index, rays, {0.05f, 0.6f});
    }
    // Instances in one place.
    const auto inner = build(mesh);
    const auto index = build(InstanceSet{Instance(inner), Instance(inner), Instance(inner)});
    expect_same(index, picture(index.bounds(), 24), {0.05f, 0.6f});
}

TYPED_TEST(TransparencyOf, SpheresAndSoups) {
    using T = TypeParam;
    const auto balls = spheres<T>(400);
    const auto of_balls = build<Bvh>(balls);
    expect_same(of_balls, picture(of_balls.bounds(), 32), {0.0f, 1.0f});
    const auto triangles = soup<T>(3000);
    const auto index = build(triangles);
    const auto counts = expect_same(index, picture(index.bounds(), 32), {0.3f, 1.0f});
    EXPECT_GT(counts.saved, 0u);
    EXPECT_GT(counts.ended, 0u);
}

TEST(Transparency, AnOpaqueSurfaceGivesItsColourExactly) {
    const auto mesh = soup<float>(2000);
    const auto index = build(mesh);
    const auto rays = picture(index.bounds(), 40);
    const Coloured opaque{1, 1};
    std::vector<Composite> composites(rays.size());
    const auto counts = composite_front_to_back(index, rays, opaque, composites);
    std::uint64_t hit = 0;
    for (std::size_t i = 0; i < rays.size(); ++i) {
        const auto closest = closest_hit(index, rays[i]);
        const Composite want = closest ? Composite{opaque(rays[i], closest).colour, 0} : Composite{};
        ASSERT_EQ(composites[i].colour, want.colour);
        ASSERT_EQ(composites[i].through, want.through);
        ASSERT_EQ(composites[i].over({1, 2, 3}), closest ? want.colour : Vec3f(1, 2, 3));
        hit += bool(closest);
    }
    EXPECT_GT(hit, 100u);
    // Each ray that hits something ended at its first layer, in its first call.
    EXPECT_EQ(counts.layers, hit);
    EXPECT_EQ(counts.ended, hit);
    EXPECT_EQ(counts.calls, rays.size());
}

/// The compositing of two layers over a background, by hand.
TEST(Transparency, LayersOverABackground) {
    const auto mesh = stack(2);
    const auto index = build(mesh);
    const Ray3f ray{{0.25f, 0.5f, -1}, {0, 0, 1}};
    const auto layer = [](const Ray3f&, const Hit<float>& hit) {
        return hit.t < 1.5f ? Layer{{1, 0, 0}, 0.5f} : Layer{{0, 1, 0}, 0.25f};
    };
    Composite composite;
    composite_front_to_back(index, std::span(&ray, 1), layer, {&composite, 1});
    EXPECT_EQ(composite.colour, Vec3f(0.5f, 0.125f, 0));
    EXPECT_EQ(composite.through, 0.375f);
    EXPECT_EQ(composite.over({0, 0, 1}), Vec3f(0.5f, 0.125f, 0.375f));
}

/// The number of hits in a call changes only what is counted, and threads change nothing.
TEST(Transparency, BatchesAndThreadsChangeNoBit) {
    const auto mesh = soup<float>(2000);
    const auto index = build(mesh);
    const auto rays = picture(index.bounds(), 60);
    const Coloured layer{0.1f, 0.7f};
    std::vector<Composite> want(rays.size()), got(rays.size());
    const auto counts = composite_front_to_back(index, rays, layer, want, {.threads = serial_executor()});
    Backwards backwards;
    std::uint64_t calls = std::numeric_limits<std::uint64_t>::max();
    for (const std::size_t batch : {1u, 2u, 5u, 100u}) {
        for (Executor* const threads :
             std::initializer_list<Executor*>{&serial_executor(), &default_executor(), &backwards}) {
            const auto now =
                composite_front_to_back(index, rays, layer, got, {.batch = batch, .threads = *threads});
            EXPECT_EQ(now.layers, counts.layers);
            EXPECT_EQ(now.ended, counts.ended);
            for (std::size_t i = 0; i < rays.size(); ++i) {
                ASSERT_EQ(got[i].colour, want[i].colour);
                ASSERT_EQ(got[i].through, want[i].through);
            }
            EXPECT_LE(now.calls, calls);
            calls = now.calls;
        }
    }
    EXPECT_EQ(calls, rays.size());
}

TEST(Transparency, FiltersLeaveLayersOut) {
    const auto mesh = soup<float>(1000);
    const auto index = build(mesh);
    const auto rays = picture(index.bounds(), 30);
    const Coloured layer{0.1f, 0.7f};
    // Rays with an odd number see elements with an odd number.
    const auto odd = [](std::size_t ray, const Hit<float>& hit) { return (ray + hit.element) % 2 == 0; };
    std::vector<Composite> front(rays.size()), back(rays.size()), all(rays.size());
    composite_front_to_back(index, rays, layer, front, {.ends_below = 0, .batch = 2}, odd);
    const auto layers = composite_back_to_front(index, rays, layer, back, {}, odd);
    EXPECT_GT(composite_back_to_front(index, rays, layer, all), layers);
    for (std::size_t i = 0; i < rays.size(); ++i) {
        ASSERT_LE(difference(front[i], back[i]), 1e-5f);
        Composite one;
        composite_back_to_front(index, std::span(&rays[i], 1), layer, {&one, 1}, {},
                                [&](const Hit<float>& hit) { return odd(i, hit); });
        ASSERT_EQ(one.colour, back[i].colour);
    }
}

TEST(Transparency, MasksAreFilters) {
    const auto mesh = soup<float>(1500);
    const auto index = build(mesh);
    const auto rays = picture(index.bounds(), 40);
    const Coloured paint{0, 1};
    const auto opacity = [&](const Ray3f& ray, const Hit<float>& hit) { return paint(ray, hit).opacity; };
    // What the mask lets be seen is what compositing with opacities of 0 and 1 shows.
    const auto layer = [&](const Ray3f& ray, const Hit<float>& hit) {
        const Layer given = paint(ray, hit);
        return Layer{given.colour, masked(given.opacity, 0.7f)};
    };
    std::vector<Composite> composites(rays.size());
    composite_front_to_back(index, rays, layer, composites);
    std::vector<Hit<float>> hits(rays.size());
    const std::unique_ptr<bool[]> any(new bool[rays.size()]);
    const AlphaMask mask(opacity, rays, 0.7f);
    closest_hits(index, rays, hits, mask);
    any_hits(index, rays, {any.get(), rays.size()}, mask);
    std::size_t seen = 0, other = 0;
    for (std::size_t i = 0; i < rays.size(); ++i) {
        ASSERT_EQ(bool(hits[i]), any[i]);
        ASSERT_EQ(composites[i].colour, hits[i] ? paint(rays[i], hits[i]).colour : Vec3f());
        const AlphaMask own(opacity, rays[i], 0.7f);
        ASSERT_EQ(hits[i], closest_hit(index, rays[i], own));
        ASSERT_EQ(any[i], any_hit(index, rays[i], own));
        seen += any[i];
        other += hits[i] && !(hits[i] == closest_hit(index, rays[i]));
    }
    EXPECT_GT(seen, 100u);
    EXPECT_GT(other, 100u);
    // Rays in another layout, by a view of them.
    std::vector<Hit<float>> again(rays.size());
    closest_hits(index, rays, again, AlphaMask(opacity, RayArray<float, 3>(rays), 0.7f));
    EXPECT_EQ(again, hits);
    // The cutoff itself is opaque.
    EXPECT_EQ(masked(0.5f, 0.5f), 1);
    EXPECT_EQ(masked(0.49f, 0.5f), 0);
}

TEST(Transparency, ShadowsAreProducts) {
    const auto mesh = stack(40);
    const auto index = build(mesh);
    const auto opacity = [](const Ray3f&, const Hit<float>& hit) {
        return hit.element % 4 < 2 ? 0.25f : 0.0f;
    };
    // Segments from before the first layer to between layers: half of them let a quarter less through.
    std::vector<Ray3f> segments;
    for (int i = 0; i <= 40; ++i)
        segments.push_back(
            {.origin = {0.25f, 0.5f, -0.5f}, .direction = {0, 0, static_cast<float>(i)}, .t_max = 1});
    segments[0].direction = {0, 0, -1};
    std::vector<float> through(segments.size()), whole(segments.size());
    transmittances(index, segments, opacity, through);
    const auto counts = transmittances(index, segments, opacity, whole, {.ends_below = 0});
    EXPECT_EQ(counts.layers, 40u * 41 / 2);
    for (std::size_t i = 0; i < segments.size(); ++i) {
        const std::size_t passed = (i + 1) / 2;
        const auto want = static_cast<float>(std::pow(0.75, double(passed)));
        EXPECT_NEAR(whole[i], want, 1e-6f) << i;
        EXPECT_NEAR(through[i], want, 1.0f / 1024) << i;
    }
    // An opaque thing in the way lets nothing through.
    const auto opaque = [](const Ray3f&, const Hit<float>&) { return 1.0f; };
    transmittances(index, segments, opaque, through);
    for (std::size_t i = 0; i < segments.size(); ++i)
        EXPECT_EQ(through[i], any_hit(index, segments[i]) ? 0.0f : 1.0f);
}

TEST(Transparency, RefuseOpacitiesAndShortArrays) {
    const auto mesh = stack(3);
    const auto index = build(mesh);
    const std::vector<Ray3f> rays(3, Ray3f{{0.25f, 0.5f, -1}, {0, 0, 1}});
    std::vector<Composite> composites(3);
    std::vector<float> through(2);
    const Coloured layer{0.1f, 0.2f};
    const auto room = std::span(composites).first(2);
    EXPECT_THROW(composite_front_to_back(index, rays, layer, room), InputError);
    EXPECT_THROW(composite_back_to_front(index, rays, layer, room), InputError);
    const auto half = [](const Ray3f&, const Hit<float>&) { return 0.5f; };
    EXPECT_THROW(transmittances(index, rays, half, through), InputError);
    for (const float bad : {-0.5f, 1.5f, std::numeric_limits<float>::quiet_NaN()}) {
        const auto wrong = [&](const Ray3f&, const Hit<float>& hit) {
            return Layer{{}, hit.element == 2 ? bad : 0.5f};
        };
        try {
            composite_front_to_back(index, rays, wrong, composites);
            FAIL() << bad;
        } catch (const InputError& e) {
            EXPECT_NE(std::string(e.what()).find("primitive 2 "), std::string::npos) << e.what();
        }
        EXPECT_THROW(composite_back_to_front(index, rays, wrong, composites), InputError);
    }
    // A batch of no hits counts as one of one hit.
    EXPECT_EQ(composite_front_to_back(index, rays, layer, composites, {.batch = 0}).layers, 9u);
}

}  // namespace
