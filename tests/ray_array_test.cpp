/// Batches of rays in every layout give the bits of a span of rays, and no byte beside the rays is read.
#include "engine.h"

#include <hedgerow/scenes/meshes.h>
#include <hedgerow/structures/brute_force.h>
#include <hedgerow/structures/bvh/bvh.h>

using namespace hedgerow;
using namespace hedgerow::matrix;

namespace {

template <class T>
constexpr std::size_t words = RayArray<T, 3>::words;

/// Number w of a ray's eight, in the order of Ray's members.
template <class T>
T word_of(const Ray<T, 3>& ray, std::size_t w) {
    const auto k = static_cast<int>(w % 3);
    return w < 3 ? ray.origin[k] : w < 6 ? ray.direction[k] : w == 6 ? ray.t_min : ray.t_max;
}

/// The numbers `order` of every ray, in that order, in memory of exactly their size, so that the address
/// sanitizer finds reads beyond it. The bytes `before` and `between` the rays read as NaN.
template <class T>
class Bytes {
public:
    Bytes(std::span<const Ray<T, 3>> rays, const std::vector<std::size_t>& order, std::size_t before,
          std::size_t between)
        : size_(rays.size()), stride_(order.size() * sizeof(T) + between), before_(before) {
        const std::size_t last = rays.empty() ? 0 : stride_ * size_ - between;
        data_.reset(new std::byte[before + last]);
        std::fill_n(data_.get(), before + last, std::byte{0xFF});
        for (std::size_t i = 0; i < size_; ++i)
            for (std::size_t w = 0; w < order.size(); ++w) {
                const T value = word_of(rays[i], order[w]);
                std::memcpy(data_.get() + before + i * stride_ + w * sizeof(T), &value, sizeof value);
            }
    }
    /// A view that begins with number w of the order.
    template <class E>
    Strided<E> view(std::size_t w = 0) const {
        return Strided<E>::in_bytes(size_ == 0 ? nullptr : data_.get() + before_ + w * sizeof(T), size_,
                                    stride_);
    }

private:
    std::size_t size_, stride_, before_;
    std::unique_ptr<std::byte[]> data_;
};

/// Calls f(name, rays) with an array of the same rays in each layout.
template <class T, class F>
void in_every_layout(std::span<const Ray<T, 3>> rays, F f) {
    using Array = RayArray<T, 3>;
    using V = Vec<T, 3>;
    f("span", Array(rays));
    const std::vector<std::size_t> all = {0, 1, 2, 3, 4, 5, 6, 7}, mixed = {3, 4, 5, 7, 0, 1, 2, 6};
    for (const auto& [before, between] : {std::pair<std::size_t, std::size_t>{0, 0}, {3, 0}, {1, 13}}) {
        const Bytes<T> whole(rays, all, before, between), turned(rays, mixed, before, between);
        f("whole rays", Array(whole.template view<Ray<T, 3>>()));
        f("parts of whole rays", Array(whole.template view<V>(0), whole.template view<V>(3),
                                       whole.template view<T>(6), whole.template view<T>(7)));
        f("in another order", Array(turned.template view<V>(4), turned.template view<V>(0),
                                    turned.template view<T>(7), turned.template view<T>(3)));
        std::vector<Bytes<T>> columns;
        for (std::size_t w = 0; w < words<T>; ++w)
            columns.emplace_back(rays, std::vector<std::size_t>{w}, before, w % 3 == 0 ? between : 0);
        const auto column = [&](std::size_t w) { return columns[w].template view<T>(); };
        f("components",
          Array({column(0), column(1), column(2)}, {column(3), column(4), column(5)}, column(6), column(7)));
        const Bytes<T> origins(rays, {0, 1, 2}, before, between), directions(rays, {3, 4, 5}, between, 0);
        f("origins and directions",
          Array(origins.template view<V>(), directions.template view<V>(), column(6), column(7)));
    }
}

template <class Index, class T>
void expect_same_in_every_layout(const Index& index, std::span<const Ray<T, 3>> rays) {
    std::vector<Hit<T>> want(rays.size()), got(rays.size());
    const std::unique_ptr<bool[]> any(new bool[rays.size() + 1]);
    for (std::size_t i = 0; i < rays.size(); ++i) want[i] = closest_hit(index, rays[i]);
    in_every_layout<T>(rays, [&](const char* layout, const RayArray<T, 3>& array) {
        closest_hits(index, array, std::span(got));
        any_hits(index, array, {any.get(), rays.size()});
        for (std::size_t i = 0; i < rays.size(); ++i) {
            ASSERT_EQ(want[i], got[i]) << layout << ", ray " << i << " of " << rays.size();
            ASSERT_EQ(bool(want[i]), any[i]) << "any, " << layout << ", ray " << i << " of " << rays.size();
        }
    });
}

TEST(RayArrays, EveryLayoutGivesTheSameBits) {
    const auto mesh = teapot_in_stadium<float>(1000);
    const auto targets = targets_of(mesh);
    const Box3f box = build<BruteForce>(mesh).bounds();
    const auto go_apart = apart(box, targets, 5000), go_together = together(box, 5000);
    std::vector<std::size_t> counts = {0, 1, 2, 3, 5000};
    for (std::size_t n = 4; n <= 200; n += in_long_runs(1, 5)) counts.push_back(n);
    for_each_kernel(mesh, [&](const auto& index, std::string_view) {
        for (const std::size_t count : counts) {
            expect_same_in_every_layout<decltype(index), float>(index, std::span(go_apart).first(count));
            expect_same_in_every_layout<decltype(index), float>(index, std::span(go_together).first(count));
            if (testing::Test::HasFatalFailure()) return;
        }
    });
}

/// Rays that go the same way are answered in packets, whatever their layout.
TEST(RayArrays, PacketsAreTakenInEveryLayout) {
    const auto mesh = teapot_in_stadium<float>(3000);
    const auto index = build<WideBvh>(mesh);
    const auto rays = together(index.bounds(), 960);
    std::vector<Hit<float>> hits(rays.size());
    for (const auto set : instruction_sets()) {
        const Using use(set);
        in_every_layout<float>(rays, [&](const char* layout, const RayArray<float, 3>& array) {
            EXPECT_EQ(closest_hits(index, array, std::span(hits)).packets, set == "plain" ? 0u : 960u)
                << layout;
        });
    }
}

TEST(RayArrays, OfDoubleAndOverOtherStructures) {
    const auto of_float = soup<float>(200);
    const auto rays = apart(build<BruteForce>(of_float).bounds(), targets_of(of_float), 300);
    expect_same_in_every_layout<decltype(build<Bvh>(of_float)), float>(build<Bvh>(of_float), rays);
    const auto of_double = soup<double>(200);
    const auto index = build<WideBvh>(of_double);
    std::vector<Ray3d> doubles;
    for (std::size_t i = 0; i < 300; ++i) doubles.push_back(ray_of(index.bounds(), targets_of(of_double), i));
    expect_same_in_every_layout<decltype(index), double>(index, doubles);
}

TEST(RayArrays, GoThroughAnyIndexToTheKernels) {
    const auto mesh = soup<float>(12);
    const auto index = build<WideBvh>(mesh);
    const auto any_index = build_any("wide", mesh);
    const auto rays = together(index.bounds(), 960);
    std::vector<Hit<float>> hits(rays.size());
    std::vector<Visits> visits(rays.size());
    in_every_layout<float>(rays, [&](const char* layout, const RayArray<float, 3>& array) {
        EXPECT_EQ(closest_hits(*any_index, array, hits).packets,
                  in_use<AllRayKernels>() == nullptr ? 0u : 960u)
            << layout;
        for (std::size_t i = 0; i < rays.size(); ++i)
            ASSERT_EQ(hits[i], closest_hit(index, rays[i])) << layout << ", ray " << i;
        EXPECT_EQ(closest_hits(*any_index, array, hits, {}, KeepAll(), visits).single, 960u)
            << layout << ", counted";
    });
    EXPECT_GT(visits[0].nodes, 0u);
}

TEST(RayArrays, WithoutIntervalsRaysGoOnForEver) {
    const std::vector<Vec3f> origins = {{1, 2, 3}, {4, 5, 6}}, directions = {{0, 0, 1}, {0, 1, 0}};
    const RayArray<float, 3> rays(origins, directions);
    ASSERT_EQ(rays.size(), 2u);
    EXPECT_EQ(rays[1].origin, origins[1]);
    EXPECT_EQ(rays[1].direction, directions[1]);
    EXPECT_EQ(rays[1].t_min, 0);
    EXPECT_EQ(rays[1].t_max, std::numeric_limits<float>::infinity());
    const std::vector<float> t_max = {7, 8}, x = {1, 2}, y = {3, 4};
    const RayArray<float, 2> flat({x, y}, {y, x}, {}, t_max);
    EXPECT_EQ(flat[1].origin, Vec2f(2, 4));
    EXPECT_EQ(flat[1].direction, Vec2f(4, 2));
    EXPECT_EQ(flat[1].t_max, 8);
    EXPECT_EQ(flat.part(1, 1)[0].origin, Vec2f(2, 4));
}

/// The containers that convert to an array of rays, in calls that name no type of view.
TEST(RayArrays, AreMadeOfWhatHoldsRays) {
    const auto mesh = soup<float>(100);
    const auto index = build<WideBvh>(mesh);
    std::vector<Ray3f> rays(10, Ray3f{{0, 0, 0}, {1, 1, 1}});
    std::array<Ray3f, 10> array;
    std::vector<Hit<float>> hits(10);
    bool any[10];
    EXPECT_NO_THROW(closest_hits(index, rays, hits));
    EXPECT_NO_THROW(closest_hits(index, array, hits));
    EXPECT_NO_THROW(closest_hits(index, std::span(rays), hits, {.threads = default_executor()}));
    EXPECT_NO_THROW(closest_hits(index, std::span<const Ray3f>(rays), std::span(hits)));
    EXPECT_NO_THROW(any_hits(index, {rays.data(), 3}, any));
    EXPECT_NO_THROW(any_hits(index, Strided<Ray3f>(rays.data(), 5, 2 * sizeof(Ray3f)), any));
}

template <class F>
void expect_refused(F f, const std::string& wanted) {
    try {
        f();
        FAIL() << "not refused: " << wanted;
    } catch (const InputError& error) {
        EXPECT_NE(std::string(error.what()).find(wanted), std::string::npos) << error.what();
    }
}
TEST(RayArrays, OfDifferentLengthsAreRefused) {
    using Array = RayArray<float, 3>;
    const std::vector<Vec3f> three(3), two(2), none;
    const std::vector<float> few(2), enough(3);
    expect_refused([&] { Array(three, two); }, "3 origins of rays, but 2 directions");
    expect_refused([&] { Array(three, three, few); }, "3 origins of rays, but 2 t_min");
    expect_refused([&] { Array(three, three, {}, few); }, "3 origins of rays, but 2 t_max");
    expect_refused([&] { Array(none, none, few); }, "0 origins of rays, but 2 t_min");
    expect_refused([&] { Array({enough, few, enough}, {enough, enough, enough}); }, "2 y of origins");
    expect_refused([&] { Array({enough, enough, enough}, {enough, enough, few}); }, "2 z of directions");
    EXPECT_NO_THROW(Array({enough, enough, enough}, {enough, enough, enough}, enough, enough));
}

}  // namespace
