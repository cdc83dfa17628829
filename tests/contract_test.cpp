/// Promises of the library beyond its answers: views of any stride, ownership, filters, origins offset from a
/// surface, and independence of the caller's floating-point mode.
#include <memory>

#include <hedgerow/scenes/meshes.h>
#include <hedgerow/scenes/sets.h>

#include "contract.h"

using namespace hedgerow;
using namespace hedgerow::contract;

namespace {

template <class T>
class Contract : public testing::Test {};
using Scalars = testing::Types<float, double>;
TYPED_TEST_SUITE(Contract, Scalars);

// ---- Views

/// Elements with other bytes (NaN, if read as numbers) before and between them.
template <class E>
struct Interleaved {
    std::vector<std::byte> bytes;
    std::size_t first, stride, size;

    Interleaved(const std::vector<E>& elements, std::size_t before, std::size_t between)
        : first(before), stride(sizeof(E) + between), size(elements.size()) {
        bytes.assign(first + stride * size, std::byte{0xFF});
        for (std::size_t i = 0; i < size; ++i)
            std::memcpy(bytes.data() + first + i * stride, &elements[i], sizeof(E));
    }
    Strided<E> view() const { return Strided<E>::in_bytes(bytes.data() + first, size, stride); }
};

/// Expects the same answers from `set` and `scattered`, a view of equal elements in another layout.
template <class P, class V>
void expect_same_bits(const P& set, const V& scattered) {
    const auto plain = build_any("bvh", set);
    const Questions questions(plain->bounds(), {plain->bounds().low, plain->bounds().center()}, 400);
    const auto expected = answers(*plain, questions);
    for (const auto& name : structures_for<P>()) {
        const auto index = build_any(name, scattered);
        EXPECT_EQ(index->validate(), "") << name;
        EXPECT_TRUE(answers(*index, questions) == expected) << name;
    }
}

TYPED_TEST(Contract, ViewsOfAnyStrideGiveTheSameBits) {
    using T = TypeParam;
    auto mesh = teapot<T>(300);
    for (std::size_t i = 0; i < mesh.size(); ++i) mesh.faces.push_back(static_cast<std::uint32_t>(i / 2));
    const auto cloud = points<T>(300);
    const auto balls = spheres<T>(300);
    const auto segments = segments2d<T>(300);
    // Aligned elements with gaps, unaligned elements with gaps, and unaligned elements without gaps.
    for (const auto& [before, between] : {std::pair{0, 24}, {1, 7}, {3, 0}}) {
        SCOPED_TRACE(before);
        const auto a = static_cast<std::size_t>(before), b = static_cast<std::size_t>(between);
        const Interleaved vertices(mesh.vertices, a, b);
        const Interleaved triangles(mesh.triangles, b, a);
        const Interleaved faces(mesh.faces, a, a + b);
        expect_same_bits(mesh, TriangleMeshView<T>(vertices.view(), triangles.view(), faces.view()));
        expect_same_bits(cloud, PointCloudView<T, 3>(Interleaved(cloud.points, a, b).view()));
        expect_same_bits(balls, SphereSetView<T, 3>(Interleaved(balls.spheres, a, b).view()));
        expect_same_bits(segments, SegmentSetView<T>(Interleaved(segments.segments, a, b).view()));
    }
}

// ---- Ownership

TYPED_TEST(Contract, AnLvalueIsBorrowedAndAnRvalueIsOwned) {
    using T = TypeParam;
    auto mesh = teapot<T>(500);
    const auto borrowing = build(mesh);
    const Questions questions(borrowing, 300);
    const auto expected = answers(borrowing, questions);

    auto given = std::make_unique<TriangleMesh<T>>(mesh);
    auto owning = build(std::move(*given));
    EXPECT_TRUE(given->vertices.empty());  // moved, not copied
    given.reset();
    EXPECT_EQ(answers(owning, questions), expected);
    auto moved = std::make_unique<decltype(owning)>(std::move(owning));
    const auto again = std::move(*moved);
    moved.reset();
    EXPECT_EQ(answers(again, questions), expected);

    const Vec<T, 3> here(1, 2, 3);  // seen through the view only if nothing was copied
    mesh.vertices[0] = here;
    EXPECT_EQ(borrowing.primitives().vertex(0), here);
    EXPECT_NE(again.primitives().vertex(0), here);
}

// ---- Filters

/// Compares filtered queries with `all`, the unfiltered hits of the ray by brute force, after filtering
/// these.
template <class I, class T, class Filter>
void expect_filtered(const I& index, const Ray<T, 3>& ray, const std::vector<Hit<T>>& all,
                     const Filter& filter) {
    std::vector<Hit<T>> kept, got;
    std::ranges::copy_if(all, std::back_inserter(kept), filter);
    const auto closest = closest_hit(index, ray, filter);
    ASSERT_EQ(bool(closest), !kept.empty());
    if (closest) {
        ASSERT_EQ(closest, kept[0]);
    }
    ASSERT_EQ(any_hit(index, ray, filter), !kept.empty());
    ASSERT_EQ(all_hits(index, ray, got, filter), kept.size());
    ASSERT_EQ(got, kept);
    ASSERT_EQ(hit_count(index, ray, filter), kept.size());
}

TYPED_TEST(Contract, FiltersRefuseTheSameInEveryStructure) {
    using T = TypeParam;
    const auto mesh = soup<T>(400);
    const auto oracle = build<BruteForce>(mesh);
    const Questions<T, 3> questions(oracle.bounds(), mesh.vertices, 400);
    std::vector<std::uint32_t> masks(mesh.size());
    for (std::size_t i = 0; i < masks.size(); ++i) masks[i] = 1u << (i % 3);
    const auto masked = [&](const Hit<T>& h) { return (masks[h.element] & 5) != 0; };
    const auto check = [&](const auto& index) {
        std::vector<Hit<T>> all;
        for (const auto& ray : questions.rays) {
            all_hits(oracle, ray, all);
            for (const auto& hit : all) expect_filtered(index, ray, all, Except{hit.element});
            expect_filtered(index, ray, all, masked);
            expect_filtered(index, ray, all, CullBackFaces<TriangleMeshView<T>>{mesh.view(), ray.direction});
            expect_filtered(index, ray, all, [](const Hit<T>& h) { return h.u < h.v; });
            expect_filtered(index, ray, all, [](const Hit<T>&) { return false; });
        }
    };
    with_each_structure(mesh, check);
    check(build<Bvh>(mesh, {{.max_leaf_size = 1}, BvhBuilder::midpoint}));
}

// ---- Offset origins

struct Resent {
    std::size_t rays = 0, same_triangle = 0, got_out = 0;
};
/// Casts rays from around a center, and from each hit four new rays to the side that the first ray came from.
/// Counts the new rays, and those that hit the same triangle or nothing.
template <class T, class Aim>
Resent resend(const TriangleMesh<T>& mesh, const Vec3d& center, double spread, Aim aim) {
    const auto index = build(mesh);
    Resent result;
    for (std::uint64_t i = 0; i < 20000; ++i) {
        // Cast a ray.
        Random random(5, i);
        const Vec<T, 3> from(center + random.direction<3>() * (spread * random.uniform()));
        const Ray<T, 3> ray{from, Vec<T, 3>(aim(random, from))};
        const auto hit = closest_hit(index, ray);
        if (!hit) continue;
        // Offset the origin to the side that the ray came from.
        const Vec<T, 3> normal = index.primitives().normal(hit.element);
        const Vec<T, 3> back = dot(normal, ray.direction) > 0 ? -normal : normal;
        const auto triangle = index.primitives().triangle(hit.element);
        const Vec<T, 3> origin = offset_origin(ray, hit.t, triangle, back);
        // Cast four rays from the new origin.
        for (int k = 0; k < 4; ++k) {
            Vec3d to = random.direction<3>();
            const Vec3d n = normalized(Vec3d(back) / static_cast<double>(max_component(abs(back))));
            if (dot(to, n) < 0) to = -to;
            if (k == 3) to = to - n * (0.999 * dot(to, n));  // grazing
            const auto next = closest_hit(index, Ray<T, 3>{origin, Vec<T, 3>(to)});
            ++result.rays;
            result.same_triangle += next && next.element == hit.element;
            result.got_out += !next;
        }
    }
    EXPECT_GT(result.rays, 1000u);
    return result;
}
const auto anywhere = [](Random& random, const auto&) { return random.direction<3>(); };

TYPED_TEST(Contract, AnOffsetOriginIsOnTheRightSide) {
    const auto room = cube<TypeParam>(1200);
    const auto inside = resend(room, {}, 0.9, anywhere);
    EXPECT_EQ(inside.same_triangle, 0u);
    EXPECT_EQ(inside.got_out, 0u);
    const auto pot = resend(teapot<TypeParam>(3000), {0, 0, 2}, 5, anywhere);
    EXPECT_EQ(pot.same_triangle, 0u);
}

TYPED_TEST(Contract, AnOffsetOriginIsOnTheRightSideAtEveryScale) {
    for (const int exponent : {std::numeric_limits<TypeParam>::min_exponent / 3,
                               std::numeric_limits<TypeParam>::max_exponent / 3}) {
        auto room = cube<TypeParam>(300);
        for (auto& v : room.vertices)
            for (TypeParam& x : v.data) x = std::ldexp(x, exponent);
        const auto inside = resend(room, {}, std::ldexp(0.9, exponent), anywhere);
        EXPECT_EQ(inside.same_triangle, 0u) << exponent;
        EXPECT_EQ(inside.got_out, 0u) << exponent;
    }
}

TYPED_TEST(Contract, AnOffsetOriginIsOnTheRightSideOfALargeTriangle) {
    TriangleMesh<TypeParam> plain;  // through the origin, which is far from its corners
    for (const Vec3d& v : {Vec3d(-110, -97, -71), Vec3d(93, -103, 29), Vec3d(17, 200, 42)})
        plain.vertices.emplace_back(v);
    plain.triangles = {{0, 1, 2}};
    EXPECT_EQ(resend(plain, {}, 1, anywhere).same_triangle, 0u);
}

TYPED_TEST(Contract, AnOffsetOriginIsOnTheRightSideOfTheNeighbours) {
    const auto room = cube<TypeParam>(1200);
    const auto at_an_edge = [&](Random& random, const auto& from) {
        const auto& t = room.triangles[random.bits() % room.size()];
        const double u = random.uniform();
        return Vec3d(room.vertices[t[0]]) * (1 - u) + Vec3d(room.vertices[t[1]]) * u - Vec3d(from);
    };
    const auto inside = resend(room, {}, 0.9, at_an_edge);
    EXPECT_EQ(inside.same_triangle, 0u);
    EXPECT_EQ(inside.got_out, 0u);
}

// ---- Floating-point modes

#if defined(__SSE2__)
constexpr unsigned modes = 0xE040;  // MXCSR: flush to zero, rounding control, denormals are zero

/// Sets a floating-point mode and restores the earlier mode at its end.
class InMode {
public:
    explicit InMode(unsigned mode) : before_(_mm_getcsr()) { _mm_setcsr((before_ & ~modes) | mode); }
    ~InMode() { _mm_setcsr(before_); }
    InMode(const InMode&) = delete;
    InMode& operator=(const InMode&) = delete;

private:
    unsigned before_;
};

/// Runs work in a floating-point mode of its own, like a pool whose threads are in that mode.
class InModeExecutor final : public Executor {
public:
    explicit InModeExecutor(unsigned mode) : mode_(mode) {}
    void for_each_piece(std::size_t count, std::size_t grain,
                        FunctionRef<void(std::size_t, std::size_t)> body) override {
        const InMode here(mode_);
        serial_executor().for_each_piece(count, grain, body);
    }
    void both(FunctionRef<void()> first, FunctionRef<void()> second) override {
        const InMode here(mode_);
        serial_executor().both(first, second);
    }

private:
    unsigned mode_;
};

/// Expects that a mode changes no answer: of an index queried in it, of one built in it too, and of one built
/// by threads in it.
template <class T>
void expect_no_effect(const std::string& name, const TriangleMesh<T>& mesh, const Questions<T, 3>& questions,
                      unsigned mode) {
    const auto index = build_any(name, mesh, serial_executor());
    const auto expected = answers(*index, questions);
    std::optional<Answers<T, 3>> asked, built;
    unsigned after = 0;
    {
        const InMode here(mode);
        asked = answers(*index, questions);
        built = answers(*build_any(name, mesh, serial_executor()), questions);
        after = _mm_getcsr() & modes;
    }
    EXPECT_EQ(after, mode);
    EXPECT_TRUE(*asked == expected) << name << " asked in mode " << mode;
    EXPECT_TRUE(*built == expected) << name << " built in mode " << mode;
    InModeExecutor threads(mode);
    EXPECT_TRUE(answers(*build_any(name, mesh, threads), questions) == expected)
        << name << " built by threads in mode " << mode;
}

TYPED_TEST(Contract, TheCallersFloatingPointModeChangesNothing) {
    using T = TypeParam;
    // Sizes go from ordinary ones down to those whose products, and then whose coordinates, are subnormal.
    const int least = std::numeric_limits<T>::min_exponent;
    for (const int exponent : {0, least / 2, least + 8, least - 4}) {
        SCOPED_TRACE(exponent);
        auto mesh = teapot<T>(150);
        for (auto& v : mesh.vertices)
            for (T& x : v.data) x = std::ldexp(x, exponent);
        const Questions<T, 3> questions(build(mesh).bounds(), mesh.vertices, 160);
        // Flush to zero and denormals are zero; rounding up; all three.
        for (const unsigned mode : {0x8040u, 0x4000u, 0xC040u}) {
            for (const auto& name : structures_for<TriangleMesh<T>>())
                expect_no_effect(name, mesh, questions, mode);
            InModeExecutor threads(mode);
            const auto index = build(mesh, threads);
            std::vector<Hit<T>> hits(questions.rays.size());
            closest_hits(index, questions.rays, hits, {.threads = threads});
            for (std::size_t i = 0; i < hits.size(); ++i)
                EXPECT_EQ(hits[i], closest_hit(index, questions.rays[i]))
                    << "asked by threads in mode " << mode;
        }
    }
}
#endif

}  // namespace
