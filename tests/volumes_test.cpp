/// Bounding volumes contain what they are fitted around, and a probe of something in a volume enters it.
#include <hedgerow/any_index.h>
#include <hedgerow/hedgerow.h>
#include <hedgerow/scenes/sets.h>

#include "exact.h"

using namespace hedgerow;
using exact::Real;
using exact::real;
using exact::Real3;

namespace {

// `holds`: whether a volume contains a point, in long double and by the shapes' definitions.

template <SlabVolume V>
bool holds(const V& volume, const Real3& p) {
    for (int i = 0; i < volume.slab_count(); ++i) {
        const auto s = volume.slab(i);
        const Real height = exact::dot(real(s.normal), p);
        if (!(height >= Real(s.low) && height <= Real(s.high))) return false;
    }
    return true;
}
template <class T, int D>
bool holds(const Sphere<T, D>& s, const Real3& p) {
    return exact::size(p - real(s.center)) <= Real(s.radius);
}
template <class T>
bool holds(const Cylinder<T>& c, const Real3& p) {
    const Real3 a = real(c.axis), from = p - real(c.point);
    const Real height = exact::dot(a, p);
    const Real3 across = from - a * (exact::dot(a, from) / exact::dot(a, a));
    return exact::size(across) <= Real(c.radius) && height >= Real(c.low) && height <= Real(c.high);
}

/// Whether the first V::orthonormal normals are orthonormal but for their rounding to float. Distances to a
/// volume are summed as if they were exactly so.
template <SlabVolume V>
bool orthonormal(const V& volume) {
    for (int i = 0; i < V::orthonormal; ++i)
        for (int j = 0; j <= i; ++j)
            if (std::abs(dot(volume.slab(i).normal, volume.slab(j).normal) - (i == j)) > 0x1p-22)
                return false;
    return true;
}
template <class V>
bool orthonormal(const V&) {
    return true;
}

/// Points with coordinates in T, and a name for their arrangement.
template <class T, int D>
using Points = std::vector<Vec<T, D>>;
template <class T, int D>
struct Arrangement {
    const char* name;
    Points<T, D> points;
};

template <class T, int D>
std::vector<Arrangement<T, D>> arrangements() {
    using V = Vec<T, D>;
    std::vector<Arrangement<T, D>> all = {{"one point", {V::all(T(0.3))}},
                                          {"one point many times", Points<T, D>(7, V::all(T(-2)))}};
    const auto some = [&](const char* name, auto point) {
        Points<T, D> points;
        for (std::uint64_t i = 0; i < 40; ++i) {
            Random random(4, i);
            points.push_back(V(point(random)));
        }
        all.push_back({name, points});
    };
    using W = Vec<double, D>;
    Random directions(6);
    const W along = directions.direction<D>(), other = directions.direction<D>();
    some("in a cube", [](Random& r) { return r.in_cube<D>(); });
    some("on a sphere", [](Random& r) { return r.direction<D>(); });
    some("long and askew", [&](Random& r) { return along * r.uniform(-50, 50) + r.in_cube<D>(); });
    some("on a line", [&](Random& r) { return along * r.uniform(); });
    some("on an axis", [](Random& r) {
        W p;
        p[0] = r.uniform();
        return p;
    });
    some("in a plane", [&](Random& r) { return along * r.uniform() + other * r.uniform(); });
    some("in a plane across an axis", [](Random& r) {
        W p = r.in_cube<D>();
        p[D - 1] = 0.25;
        return p;
    });
    some("far away", [&](Random& r) { return along * 1e6 + r.in_cube<D>(); });
    some("tiny", [](Random& r) { return r.in_cube<D>() * (std::is_same_v<T, float> ? 1e-42 : 1e-300); });
    some("huge", [](Random& r) {
        return (r.in_cube<D>() - W::all(0.5)) * static_cast<double>(largest_coordinate<T>);
    });
    const auto units = [](double x, Random& r) {  // adds 0 to 3 units in the last place
        T near = static_cast<T>(x);
        for (auto n = r.bits() % 4; n > 0; --n)
            near = std::nextafter(near, std::numeric_limits<T>::infinity());
        return static_cast<double>(near);
    };
    some("in a plane but for the last places", [&](Random& r) {
        W p = map(r.in_cube<D>(), [](double x) { return std::floor(x * 8) / 8; });
        p[0] = 0.3;
        return map(p, [&](double x) { return units(x, r); });
    });
    some("in a plane, turned and turned back", [&](Random& r) {
        W p = map(r.in_cube<D>(), [](double x) { return x < 0.5 ? 0.3 : 0.7; });
        p[D - 1] = 0.1;
        const double c = std::cos(0.5), s = std::sin(0.5);
        const T x = static_cast<T>(c * p[0] - s * p[1]), y = static_cast<T>(s * p[0] + c * p[1]);
        p[0] = c * static_cast<double>(x) + s * static_cast<double>(y);
        p[1] = c * static_cast<double>(y) - s * static_cast<double>(x);
        return p;
    });
    some("of small whole numbers", [](Random& r) { return exact::integers<double, D>(r, 1); });
    return all;
}

template <class T, int D, class F>
void with_each_arrangement(F f) {
    for (const auto& arrangement : arrangements<T, D>()) {
        SCOPED_TRACE(arrangement.name);
        f(arrangement.points);
    }
}

/// Calls f(list) with each kind of volume, fitted around the points and enlarged by `share` of the margin for
/// errors of answers (cell_margin).
template <class T, int D, class F>
void with_each_volume(const Points<T, D>& points, F f, double share = 1) {
    std::vector<Vec<double, D>> wide;
    Box<T, D> box;
    for (const auto& p : points) wide.push_back(Vec<double, D>(p)), box.expand(p);
    int kinds = 0, kinds_seen = 0;
    for (const std::string_view name : volume_names) {
        const auto kind = static_cast<Volume>(kinds_seen++);
        const bool of_space = kind == Volume::kdop6 || kind == Volume::kdop14 || kind == Volume::kdop18 ||
                              kind == Volume::kdop26 || kind == Volume::cylinder || kind == Volume::hull;
        const bool of_plane = kind == Volume::kdop4 || kind == Volume::kdop8;
        // Kinds of the other dimension are refused, and plain boxes.
        if (kind == Volume::box || (D == 2 && of_space) || (D == 3 && of_plane)) {
            EXPECT_THROW((list_of<T, D>(kind)), InputError) << name;
            continue;
        }
        SCOPED_TRACE(name);
        auto list = list_of<T, D>(kind);
        std::visit(
            [&](auto& volumes) {
                volumes.resize(1);
                volumes.fit(0, wide, share * static_cast<double>(cell_margin(box)));
            },
            list);
        f(list);
        ++kinds;
    }
    EXPECT_EQ(kinds, D == 3 ? 8 : 4);
}

/// A point in the hull of the points: one of them, or a weighted mean of four, rounded to T.
template <class T, int D>
Vec<T, D> point_of(const Points<T, D>& points, Random& random) {
    const auto any = [&] { return Vec<double, D>(points[random.bits() % points.size()]); };
    if (random.bits() % 3 == 0) return Vec<T, D>(any());
    const double u = random.uniform(), v = random.uniform();
    return Vec<T, D>((any() * u + any() * (1 - u)) * v + (any() * u + any() * (1 - u)) * (1 - v));
}

template <class T>
class Volumes : public testing::Test {};
using Scalars = testing::Types<float, double>;
TYPED_TEST_SUITE(Volumes, Scalars);

/// Expects that volumes contain their points, fitted with the margin and without it. A margin would hide
/// heights that were measured along another normal than the stored one.
template <class T, int D>
void expect_points_held() {
    with_each_arrangement<T, D>([](const Points<T, D>& points) {
        const auto look = [&](const auto& list) {
            std::visit(
                [&](const auto& volumes) {
                    EXPECT_TRUE(orthonormal(volumes[0]));
                    for (const auto& p : points) EXPECT_TRUE(holds(volumes[0], real(p)));
                },
                list);
        };
        with_each_volume(points, look);
        with_each_volume(points, look, 0);
    });
}
TYPED_TEST(Volumes, HoldWhatTheyAreFittedAround) {
    expect_points_held<TypeParam, 2>();
    expect_points_held<TypeParam, 3>();
}

/// Rays that go through a point of the hull at t = 1, 2^30 or 2^-20, from near and far and from inside.
template <class T, int D>
void expect_rays_enter() {
    with_each_arrangement<T, D>([](const Points<T, D>& points) {
        Box<T, D> box;
        for (const auto& p : points) box.expand(p);
        const double size = std::max(static_cast<double>(max_component(box.extent())),
                                     static_cast<double>(std::numeric_limits<T>::min()));
        with_each_volume(points, [&](const auto& list) {
            const AnyVolume<T, D> volume{list, 0};
            for (std::uint64_t i = 0; i < 600; ++i) {
                Random random(7, i);
                // Aim at a point of the hull, in some cases across an axis.
                const Vec<T, D> x = point_of(points, random);
                const double away = i % 5 == 0 ? 1e4 : (i % 5 == 1 ? 0.1 : 2);
                Ray<T, D> ray;
                ray.origin = Vec<T, D>(Vec<double, D>(x) + random.direction<D>() * (size * away));
                if (max_component(abs(ray.origin)) > largest_coordinate<T>) continue;
                ray.direction = x - ray.origin;
                if (i % 7 == 3) ray.origin[0] = x[0], ray.direction[0] = T(-0.0);
                // Change the length of the direction.
                T t = T(1);
                if (i % 4 == 1) ray.direction = ray.direction * T(0x1p-30), t = T(0x1p30);
                if (i % 4 == 2) ray.direction = ray.direction * T(0x1p20), t = T(0x1p-20);
                const RayProbe<T, D> probe(ray, box);
                // Leave out rays that miss x, since directions of tiny scenes underflow.
                if (!probe.usable() || probe.ray().at(t) != ray.origin + (x - ray.origin)) continue;
                T at;
                EXPECT_TRUE(probe.enter(volume, t, at)) << "ray " << i;
                EXPECT_LE(at, t);
            }
        });
    });
}
TYPED_TEST(Volumes, AreEnteredByEveryRayThatMeetsWhatTheyHold) {
    expect_rays_enter<TypeParam, 2>();
    expect_rays_enter<TypeParam, 3>();
}

template <class T, int D>
void expect_regions_enter() {
    with_each_arrangement<T, D>([](const Points<T, D>& points) {
        Box<T, D> box;
        for (const auto& p : points) box.expand(p);
        with_each_volume(points, [&](const auto& list) {
            const AnyVolume<T, D> volume{list, 0};
            for (std::uint64_t i = 0; i < 600; ++i) {
                Random random(8, i);
                // Choose a point of the hull, and a point p in the hull, near it or far from it.
                const Vec<T, D> x = point_of(points, random);
                Vec<T, D> p = point_of(points, random);
                if (i % 3 != 0)
                    p = Vec<T, D>(Vec<double, D>(p) +
                                  random.direction<D>() *
                                      (random.uniform() * static_cast<double>(max_component(box.extent())) *
                                       (i % 3 == 1 ? 1 : 100)));
                if (max_component(abs(p)) > largest_coordinate<T>) continue;
                // Enter the volume by p with a limit that reaches x, and by boxes that contain x.
                T at;
                EXPECT_TRUE((PointProbe<T, D>(p).enter(volume, distance2(p, x), at))) << "point " << i;
                const auto around = Box<T, D>().expand(x).expand(p);
                EXPECT_TRUE((BoxProbe<T, D>(around).enter(volume, T(0), at))) << "box " << i;
                EXPECT_TRUE((BoxProbe<T, D>({x, x}).enter(volume, T(0), at))) << "box " << i;
                auto unbounded = around;
                unbounded.high[0] = std::numeric_limits<T>::infinity();
                EXPECT_TRUE((BoxProbe<T, D>(unbounded).enter(volume, T(0), at))) << "box " << i;
            }
        });
    });
}
TYPED_TEST(Volumes, AreEnteredByPointsAndBoxes) {
    expect_regions_enter<TypeParam, 2>();
    expect_regions_enter<TypeParam, 3>();
}

/// Volumes refuse probes that are plainly elsewhere, and give a useful bound of the distance.
template <class T, int D>
void expect_rest_refused() {
    Points<T, D> points;
    for (std::uint64_t i = 0; i < 40; ++i) points.push_back(Vec<T, D>(Random(4, i).in_cube<D>()));
    Box<T, D> box;
    for (const auto& p : points) box.expand(p);
    with_each_volume(points, [&](const auto& list) {
        const AnyVolume<T, D> volume{list, 0};
        for (std::uint64_t i = 0; i < 300; ++i) {
            Random random(9, i);
            const Vec<double, D> out = random.direction<D>() * 10.0 + Vec<double, D>::all(0.5);
            const Vec<T, D> p(out);
            T at;
            // From p outside: a ray outward, a ray towards the volume that is too short, and a ray across.
            const Vec<double, D> outward = out - Vec<double, D>::all(0.5);
            Vec<double, D> across;
            across[0] = -outward[1], across[1] = outward[0];
            const Ray<T, D> rays[] = {
                {p, Vec<T, D>(outward)}, {p, -Vec<T, D>(outward), T(0), T(0.5)}, {p, Vec<T, D>(across)}};
            for (const auto& ray : rays)
                EXPECT_FALSE((RayProbe<T, D>(ray, box).enter(volume, ray.t_max, at)));
            EXPECT_FALSE((PointProbe<T, D>(p).enter(volume, T(36), at)));
            EXPECT_GT(at, T(36));
            EXPECT_FALSE((BoxProbe<T, D>({p, p + Vec<T, D>::all(T(0.01))}).enter(volume, T(0), at)));
        }
    });
}
TYPED_TEST(Volumes, RefuseWhatIsElsewhere) {
    expect_rest_refused<TypeParam, 2>();
    expect_rest_refused<TypeParam, 3>();
}

/// Fits are tight around points that a volume of that kind can fit tightly.
TEST(Fits, FollowWhatTheyHold) {
    Random random(3);
    const Vec3d along = normalized(Vec3d(1, 2, -1.5));
    std::vector<Vec3d> rod, ball;
    for (int i = 0; i < 200; ++i) {
        rod.push_back(along * random.uniform(0, 10) + random.direction<3>() * 0.1);
        ball.push_back(random.direction<3>());
    }
    const auto obb = VolumeFit<Obb<float, 3>>::around(rod, 0);
    EXPECT_LT((Box3f{obb.low, obb.high}.half_area()), 10 * 0.2f * 2 * 1.3f);
    const auto cylinder = VolumeFit<Cylinder<float>>::around(rod, 0);
    EXPECT_LT(cylinder.radius, 0.13f);
    EXPECT_LT(cylinder.high - cylinder.low, 10.3f);
    EXPECT_LT((VolumeFit<Sphere<float, 3>>::around(ball, 0).radius), 1.05f);
    EXPECT_LT((VolumeFit<Sphere<float, 3>>::around(rod, 0).radius), 5.3f);
}

TEST(Hulls, HaveTheFacesOfTheirPoints) {
    std::vector<Vec3d> cube;
    cube.reserve(9);
    for (int i = 0; i < 8; ++i) cube.push_back(Vec3d(i & 1, i >> 1 & 1, i >> 2) * 100.0 + Vec3d(1e6, 0, 0));
    cube.push_back(Vec3d(1e6 + 50, 50, 50));
    const auto normals = hull_normals(cube);
    EXPECT_EQ(normals.size(), 6u);
    for (const auto& n : normals) {
        EXPECT_NEAR(length(n), 1, 1e-12);
        EXPECT_NEAR(max_component(abs(n)), 1, 1e-12);
    }
    for (const auto& [name, points] : arrangements<double, 3>()) {
        const std::string of = name;
        const bool flat = of.find("point") != of.npos || of.find("on a line") != of.npos ||
                          of.find("axis") != of.npos || of.find("plane") != of.npos;
        EXPECT_EQ(hull_normals(points).empty(), flat) << name;
    }
    EXPECT_TRUE(hull_normals({}).empty());
}

TEST(VolumeBvhs, AreNamedAndRefused) {
    const auto cloud = points<float>(100);
    EXPECT_EQ(build_any("bvh:volume=obb", cloud)->structure(), "bvh:volume=obb");
    EXPECT_EQ(build_any("bvh:volume=hull,builder=sweep", cloud)->validate(), "");
    EXPECT_EQ(build_any("bvh:volume=box", cloud)->bytes(), build_any("bvh", cloud)->bytes());
    EXPECT_NE(build_any("bvh:volume=sphere", cloud)->bytes(), build_any("bvh", cloud)->bytes());
    const auto said = [](auto f) -> std::string {
        try {
            f();
        } catch (const InputError& error) {
            return error.what();
        }
        return "nothing";
    };
    EXPECT_NE(said([&] { build_any("bvh:volume=cone", cloud); }).find("one of box, sphere"),
              std::string::npos);
    const auto plane = points2d<float>(100);
    EXPECT_NE(said([&] { build_any("bvh:volume=hull", plane); }).find("use one of sphere, obb, kdop4, kdop8"),
              std::string::npos);
}

}  // namespace
